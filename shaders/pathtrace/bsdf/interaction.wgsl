//#import pathtrace/needs.wgsl
//#import pathtrace/scene.wgsl
//#import pathtrace/intersect/surface_point.wgsl
// A point of a surface as a ray meets it: what an integrator asks the scene for, and then asks how light goes on. Twin:
// crates/pathtrace/src/bsdf/interaction.rs.

struct Interaction {
    // where, with the bound on its error and the outward normal
    point: SurfacePoint,
    // unit normal that it is shaded by, on the side of the surface that wo sees; where facets cover a body that of the body
    normal: vec3f,
    // unit direction back along the ray
    wo: vec3f,
    // albedo of diffuse surfaces there, reflectance of mirrors and of metal at normal incidence, base colour of
    // metallic-roughness, 1 for glass
    colour: vec3f,
    // what the surface does to light
    lobe: u32,
    // index into the scene's materials
    material: u32,
    // place in textures
    uv: vec2f,
}

// A BSDF's value: a colour times a number, kept apart so that products are rounded in one order whatever the lobe.
struct ScaledColour {
    colour: vec3f,
    factor: f32,
}

// A direction that was drawn.
struct BsdfSample {
    // unit direction in which the path goes on
    wi: vec3f,
    // BSDF times cosine over density
    weight: vec3f,
    // density per solid angle; DELTA_PDF where the lobe left no choice
    pdf: f32,
}

// Stands for infinity. Here alone: lanes have infinity, which shaders may take away.
const DELTA_PDF: f32 = -1.0;

fn delta_sample(at: Interaction, wi: vec3f) -> BsdfSample {
    return BsdfSample(wi, at.colour, DELTA_PDF);
}

// Whether the surface scatters by Lambert's law.
fn is_diffuse(at: Interaction) -> bool {
    return (at.lobe & LOBE_LAMBERT) != 0u;
}

// Whether the surface scatters any light: a coat does also on a black body.
fn scatters(at: Interaction) -> bool {
    return any(at.colour != vec3f(0.0)) || (METALLIC_ROUGHNESS && (at.lobe & LOBE_METALLIC_ROUGHNESS) != 0u);
}

// Whether the surface leaves no choice of direction but among few: what falls on it from a light that is sampled is
// never seen.
fn is_delta(at: Interaction) -> bool {
    return (MIRROR && at.lobe == LOBE_MIRROR) || (DIELECTRIC && at.lobe == LOBE_DIELECTRIC);
}

// The normal on the side of wo.
fn facing(normal: vec3f, wo: vec3f) -> vec3f {
    return select(normal, -normal, dot(normal, wo) < 0.0);
}
