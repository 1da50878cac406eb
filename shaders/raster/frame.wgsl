//#import raster/view.wgsl
//#import raster/object.wgsl
// What the forward pass is told of a frame and of the shape that it draws.
// Mirror of the structs: crates/raster/src/gpu_data.rs, which has those of all passes.

const MOST_SPHERES: u32 = 16u;
const MOST_BOXES: u32 = 16u;

// Half the width of a caustic map, in radii of its sphere.
const CAUSTIC_REACH: f32 = 4.0;

// A sphere that repairs know in closed form.
struct Sphere {
    middle: vec3f,
    radius: f32,
    // index of refraction outside over inside; 0 of what is no glass
    refraction_ratio: f32,
}

// A box that repairs know, turned about the vertical.
struct KnownBox {
    middle: vec3f,
    cosine: f32,
    half: vec3f,
    sine: f32,
}

struct Lights {
    sun_towards: vec3f,
    sun_incident: vec3f,
    refracts_per_vertex: u32,
    area_light_position: vec3f,
    area_light_pattern: u32,
    area_light_normal: vec3f,
    // cosine to a spot's axis, which area_light_normal is, at which it is dark
    cone_outer: f32,
    area_light_incident: vec3f,
    // added to depths before they are compared
    shadow_bias: f32,
    ambient: vec3f,
    // how much of its way to full light a cosine above cone_outer is
    cone_slope: f32,
    sky: vec3f,
    // of the sun's angular radius
    sun_tangent: f32,
    // 0: the sun's; 1 to 6: the area light's, +x, -x, +y, -y, +z, -z
    shadow_views: array<View, 7>,
    // of its disc; zero of a mere direction
    sun_radiance: vec3f,
    // of the sun's angular radius
    sun_cosine: f32,
    // across sunlight, to the right in caustic maps, and upwards in them
    sun_right: vec3f,
    // of a disc as large as the area light
    area_light_radius: f32,
    sun_up: vec3f,
    // spheres of glass come first
    glass_count: u32,
    sphere_count: u32,
    // the plane whose value is how far along sunlight a point lies, 0 to 1 across the scene
    receiver_depth: vec4f,
    // of the area light: from its middle on all around, or a parallelogram from a corner
    area_light_radiance: vec3f,
    area_light_sides: u32,
    area_light_corner: vec3f,
    // how many boxes there are
    box_count: u32,
    area_light_edge_u: vec3f,
    area_light_form: u32,
    area_light_edge_v: vec3f,
    // a corner of the grid of probes, the size of its cells, and a bit for each that lies within something
    probe_low: vec3f,
    probe_cell: vec3f,
    probes_buried: vec4u,
    spheres: array<Sphere, MOST_SPHERES>,
    boxes: array<KnownBox, MOST_BOXES>,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<uniform> lights: Lights;
@group(0) @binding(2) var shadow_map: texture_2d_array<u32>;
// what falls on each sphere's surroundings through it, and the depths that this fell to; a layer for each sphere of glass
@group(0) @binding(3) var caustic_map: texture_2d_array<f32>;
@group(0) @binding(4) var receiver_map: texture_2d_array<u32>;
@group(0) @binding(5) var caustic_sampler: sampler;
// light of the second bounce at a part of the picture's size, and where that is
@group(0) @binding(6) var bounce_light: texture_2d<u32>;
@group(0) @binding(7) var bounce_places: texture_2d<u32>;
@group(1) @binding(0) var<uniform> object: Object;
@group(1) @binding(1) var cube_map: texture_cube<f32>;
@group(1) @binding(2) var cube_sampler: sampler;
