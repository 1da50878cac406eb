//#import pathtrace/bsdf/interaction.wgsl
//#import pathtrace/drive/film.wgsl
// Which light counts: paths are read from the eye, a vertex at a time, by an automaton whose rows hold the states that
// follow a diffuse, a glossy and a specular vertex. Twins:
// crates/pathtrace/src/integrator/light_paths/mod.rs, automaton.rs and counting.rs.

// whether not all light counts
override LIGHT_PATHS: bool = true;

const BEGINS: u32 = 1u;
const ACCEPTS: u32 = 0x80000000u;

// the row behind the path's last vertex
var<private> light_path: u32;

fn light_path_row(state: u32) -> u32 {
    return params.light_paths[state / 4u][state % 4u];
}

// The row behind one more vertex; 0 where no light counts any more.
fn light_path_after(row: u32, lobe: u32) -> u32 {
    var shift = 0u;
    if (lobe & LOBE_LAMBERT) == 0u {
        shift = select(16u, 8u, (lobe & (LOBE_ROUGH_CONDUCTOR | LOBE_METALLIC_ROUGHNESS)) != 0u);
    }
    return light_path_row((row >> shift) & 0xffu);
}

// Whether light that is found now counts.
fn counts(row: u32) -> bool {
    return !LIGHT_PATHS || (row & ACCEPTS) != 0u;
}
