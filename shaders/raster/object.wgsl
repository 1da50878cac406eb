//#import shared/checkerboard.wgsl
// What one shape looks like, whatever the pass. Mirror of the struct:
// crates/raster/src/gpu_data.rs, which has those of all passes.

struct Object {
    even: vec3f,
    refraction_ratio: f32,
    odd: vec3f,
    reflectivity: f32,
    origin: vec3f,
    specular: f32,
    cells_per_unit: vec3f,
    shininess: f32,
    emission: vec3f,
    emitting_sides: u32,
    kind: u32,
    has_cube_map: u32,
    // texels by which the shape's own depth may differ within the shadow kernel
    slack: f32,
    // what Lambert's term takes of the colour
    diffuse: f32,
    // of Cook and Torrance's highlight: share of metal, roughness, and what the coat of the rest reflects head-on
    metallic: f32,
    roughness: f32,
    coat: f32,
    // of the sphere that its cube map is taken to lie on
    proxy_radius: f32,
    // middle and radius; radius 0 of other shapes
    sphere: vec4f,
    // from where its cube map looks, and the unit of the distances in it
    cube_middle: vec4f,
    // of corners and their normals, where those are in a mesh's own space; a row of the map in each column
    to_world: mat3x4f,
    normal_to_world: mat3x4f,
}

// By which interpolated positions may be off, relative. Here alone: rays know the error of each point.
const SIDE_ROUNDING: f32 = 1.0 / 1048576.0;

// The colour of its surface at p, of unit normal n.
fn colour_of(object: Object, p: vec3f, n: vec3f) -> vec3f {
    let upper = on_upper_side(object, p, n);
    return checkerboard(Checkerboard(object.even, object.odd, object.origin, object.cells_per_unit), upper);
}

// A surface in the side between two cells belongs to the upper one, wherever its points are rounded to.
fn on_upper_side(object: Object, p: vec3f, n: vec3f) -> vec3f {
    return p + abs(n) * (abs(p) + abs(object.origin)) * SIDE_ROUNDING;
}

// The radiance that one of its sides sends out.
fn emitted(object: Object, front: bool) -> vec3f {
    let shines = (object.emitting_sides == 2u) | ((object.emitting_sides == 1u) & front);
    return select(vec3f(0.0), object.emission, shines);
}
