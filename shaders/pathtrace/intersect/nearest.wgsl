//#import pathtrace/needs.wgsl
//#import pathtrace/scene.wgsl
//#import pathtrace/intersect/surface_point.wgsl
// What rays find, whatever the structure that they are traced through. Twin:
// crates/pathtrace/src/intersect/hit.rs, which has what is found and not the comparison.

// The nearest meeting so far.
struct Nearest {
    t: f32,
    // into the shapes or the tree's primitives, or NOTHING
    index: u32,
    // place in the scene's order, area lights first, which decides ties
    id: u32,
}

// Here alone: lanes have a mask for it.
const NOTHING: u32 = 0xffffffffu;

struct Hit {
    // where, with the outward normal
    point: SurfacePoint,
    material: u32,
    // index into the lights, or NO_LIGHT
    light: u32,
}

// Whether a shadow ray goes through what has this entry among the surfaces.
fn passes(surface: u32, shadow: bool) -> bool {
    if CLEAR_GLASS {
        return shadow && materials[surfaces[surface].material].lobe == LOBE_DIELECTRIC;
    }
    return false;
}
