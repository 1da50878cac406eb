//#import shared/checkerboard.wgsl
// The scene as the device holds it. Mirrors: crates/pathtrace/src/drive/gpu/scene_data.rs, shape_data.rs and
// tables.rs, so called beside `scene`, the crate.

struct Header {
    // radiance where nothing is hit, of a sky of one colour
    sky: vec3f,
    // how many triangles, spheres and disks there are in the tree
    primitives: u32,
    // unit direction of a sun that has a disc
    sun_towards: vec3f,
    // square of the chord that spans the disc's angular radius, 0 without a disc
    sun_chord_squared: f32,
    sun_radiance: vec3f,
    // density per solid angle with which the sun's disc is sampled
    sun_pdf: f32,
    // what is sampled as a light
    lights: u32,
    // 0, which no compiler knows
    zero: u32,
    // width and height of the picture that is the sky, and by which it is turned about y, in turns
    environment_size: vec2u,
    environment_turn: f32,
    // of being chosen among the lights
    environment_probability: f32,
    // ways by the spheres that cast caustics; they stand behind the lights
    chains: u32,
    // whether nothing lies inside of any sphere that they go through
    hollow: u32,
    // large meshes that stand in the world ...
    instances: u32,
    // ... contents of the root of the tree over their boxes ...
    instance_root: u32,
    // ... the first of the primitives that hold their maps, two each ...
    instance_primitives: u32,
    // ... and of their surfaces
    instance_surfaces: u32,
    // where attributes of corners begin in mesh_data, and where textures do
    attributes: u32,
    textures: u32,
    // rows in each layer of texels
    texel_rows: u32,
    // with which one of many lights is chosen by the tree
    tree_share: f32,
    // of few shapes: where among them quadrilaterals, triangles, spheres and disks end
    seen: vec4u,
    // the same of those that shadow rays may meet, which stand first in each kind
    shading: vec4u,
    // spheres around the shapes of mirror and glass that usually get cones, and around all such shapes: centre and radius, 0 where there are no more
    usual_cones: array<vec4f, 4>,
    all_cones: array<vec4f, 4>,
}

// Two children lie side by side; the root's children are 0 and 1.
struct Node {
    low: vec3f,
    // index of an inner node's first child, or of a leaf's first primitive with their number above
    contents: u32,
    high: vec3f,
    unused: u32,
}

// In the order of the leaves; behind them two for each instance, see Instance: the rows of its map back into the mesh's
// space, how far it is moved and where its mesh stands in the tables; the rows of its map into the world. A sphere is `a` and a radius, a disk also has a normal in `b`.
struct Primitive {
    // corners in lexicographic order
    a: vec3f,
    // normal of the sorted corners, largest component 1, as a sum of two floats; or a radius
    normal_x: f32,
    b: vec3f,
    normal_y: f32,
    c: vec3f,
    normal_z: f32,
    normal_low: vec3f,
    // place in the scene's order, area lights first, which decides ties; the kind above
    tag: u32,
}

// One of few. A sphere is `a` and a radius, a disk also has a normal in `b`, a triangle is its first three corners.
struct Shape {
    // corners, see Quadrilateral and Triangle
    a: vec3f,
    // normal of its plane, largest component 1, as a sum of two floats; or a radius
    normal_x: f32,
    b: vec3f,
    normal_y: f32,
    c: vec3f,
    normal_z: f32,
    d: vec3f,
    // place in the scene's order, area lights first, which decides ties
    id: u32,
    normal_low: vec3f,
    // how far from its plane its points may lie
    flatness: f32,
    // of its plane, the same for all shapes in it
    plane_point: vec3f,
}

const MOST_SHAPES: u32 = 64u;

const KIND_SHIFT: u32 = 30u;
const KIND_TRIANGLE: u32 = 0u;
const KIND_SPHERE: u32 = 1u;
const KIND_DISK: u32 = 2u;

// What shading needs of a primitive, in the order of the leaves; of few shapes in the order of their ids. Those of
// instances stand behind.
struct Surface {
    // unit normal of a flat one
    normal: vec3f,
    material: u32,
    // index into the lights, or NO_LIGHT
    light: u32,
    // of what it coincides with, or NO_GROUP
    group: u32,
    // place of its row in mesh_data, 0 if it has none
    triangle: u32,
}

const NO_LIGHT: u32 = 0xffffffffu;
const NO_GROUP: u32 = 0xffffffffu;

struct Material {
    // albedo or reflectance, 1 for glass
    colour: Checkerboard,
    // radiance sent out
    emission: vec3f,
    // 0 none, 1 the one that the normal points away from, 2 both
    emitting_sides: u32,
    // what the surface does to light
    lobe: u32,
    // index of refraction of the inside over the outside
    ior: f32,
    // root of |ior^2 - 1| as a sum of two floats
    root: f32,
    root_low: f32,
    // of a rough conductor: index of refraction, width of the distribution of its slopes, extinction coefficient
    eta: vec3f,
    alpha: f32,
    k: vec3f,
    // with which a chain off such a sphere is chosen, or through it; 0 if none is
    off: f32,
    through: f32,
    // of metallic-roughness: share of metal, root of its facets' alpha, what its coat reflects at normal incidence
    metallic: f32,
    roughness: f32,
    coat: f32,
    // places among the textures, 1 for the first, of what colour and light sent out are multiplied by, of normals and alpha;
    // 0 for none
    colour_texture: u32,
    emission_texture: u32,
    normal_texture: u32,
    alpha_texture: u32,
    // by which x and y of normals are multiplied, and alpha
    normal_scale: f32,
    alpha_factor: f32,
    // least alpha that is a surface; 0 where there is one everywhere
    alpha_cutoff: f32,
    // place among the textures of what multiplies the share of metal and the roughness
    metallic_roughness_texture: u32,
}

// Codes of lobes and of what varies them. Mirror: crates/pathtrace/src/bsdf/materials.rs.
const LOBE_LAMBERT: u32 = 1u;
const LOBE_MIRROR: u32 = 2u;
const LOBE_DIELECTRIC: u32 = 4u;
const LOBE_ROUGH_CONDUCTOR: u32 = 8u;
const LOBE_METALLIC_ROUGHNESS: u32 = 16u;
// of a Lambert lobe or metallic-roughness: its colour is a checkerboard
const CHECKERED: u32 = 256u;
// of a conductor: it reflects by Fresnel's equations
const HAS_INDEX: u32 = 512u;

// What is sampled as a light; or a chain by a sphere, of which there is a centre, a radius and a material.
struct Light {
    // corner of a flat area light, centre of a disk, ball or caster, a point light, the direction to the sun
    position: vec3f,
    outline: u32,
    // edges of a flat area light; radii of a disk, at right angles; of a point light the cosine of its cone's edge, and the
    // edge's slope
    u: vec3f,
    // area of a flat area light, radius of a ball or caster, 1 - cos of the sun's angular radius
    area: f32,
    v: vec3f,
    // whether a parallelogram's edges are at right angles
    square: u32,
    // unit normal of a flat area light, axis of a point light's cone
    normal: vec3f,
    two_sided: u32,
    // radiance; intensity of a point, irradiance of a delta sun
    radiance: vec3f,
    // of being chosen
    probability: f32,
    // running sum of the probabilities
    cumulative: f32,
    // of what its surface coincides with, or NO_GROUP
    group: u32,
    // of a caster, or of what wears textures
    material: u32,
    // where the places of its corners in textures begin in mesh_data, 0 if it wears none
    corners: u32,
    // of many lights: the way to it in their tree, from the root: bit by bit, whether it is the second of two
    trail: u32,
}

const LIGHT_RECTANGLE: u32 = 0u;
const LIGHT_TRIANGLE: u32 = 1u;
const LIGHT_DISK: u32 = 2u;
const LIGHT_BALL: u32 = 3u;
const LIGHT_POINT: u32 = 4u;
const LIGHT_SUN: u32 = 5u;
const LIGHT_ENVIRONMENT: u32 = 6u;
const CHAIN_OFF: u32 = 7u;
const CHAIN_THROUGH: u32 = 8u;

@group(0) @binding(0) var<uniform> header: Header;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> primitives: array<Primitive>;
@group(0) @binding(3) var<storage, read> surfaces: array<Surface>;
@group(0) @binding(4) var<storage, read> materials: array<Material>;
@group(0) @binding(5) var<storage, read> lights: array<Light>;
// what each byte of an index adds to dimensions 1 to 3 of a Sobol point; behind these 1,024 large meshes: a vector that
// says in which words its triangles and positions begin, its nodes, its triangles, its positions
@group(0) @binding(6) var<storage, read> tables: array<vec4u>;
@group(0) @binding(7) var<uniform> shapes: array<Shape, MOST_SHAPES>;
// the sky's radiance, and the running sum of the texels' probabilities within each row
@group(0) @binding(8) var environment_texels: texture_2d<f32>;
// one texel for each row: the running sum of the rows' probabilities, and minus the height on the unit sphere where the
// row ends
@group(0) @binding(9) var environment_rows: texture_2d<f32>;
// what meshes and textures say of surfaces, behind one word that stands for nothing
@group(0) @binding(10) var<storage, read> mesh_data: array<u32>;
// of all textures, one after the other
@group(0) @binding(11) var texels: texture_2d_array<f32>;
