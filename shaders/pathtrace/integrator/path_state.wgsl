//#import pathtrace/bsdf/interaction.wgsl
//#import pathtrace/intersect/ray.wgsl
// A path between two of its vertices, and what it knows of how light is found. Twin:
// crates/pathtrace/src/integrator/path_state.rs.

// whether diffuse vertices draw directions uniformly; by the cosine if not
override UNIFORM_DIRECTIONS: bool = true;
// how light is found: by chance, by sampling, or both, weighted
override LIGHT_SAMPLING: u32 = BY_BOTH;

const BY_CHANCE: u32 = 0u;
const BY_SAMPLING: u32 = 1u;
const BY_BOTH: u32 = 2u;

struct PathState {
    ray: Ray,
    // what radiance met now is worth at the camera
    throughput: vec3f,
    // vertices at which the path has scattered
    vertices: u32,
    // diffuse ones among them, as far as they branched
    forked: u32,
    // the path's number in the tree of its sample's branches, 0 if nothing branches
    branch: u32,
    // the last vertex
    from_: vec3f,
    // density per solid angle of the direction taken there, as far as the light met now needs it
    direction_pdf: f32,
}

// No light was sampled at the last vertex, or none could be: the camera, a mirror, glass. Other than
// the twin's: shaders may take infinity away.
const MET_BY_CHANCE: f32 = -1.0;
// Light was sampled at the last vertex: meeting it now would count it twice.
const ALREADY_COUNTED: f32 = 0.0;

var<private> path: PathState;

// Set in the number of the blocks of connections.
const CONNECTION: u32 = 0x80000000u;

// Blocks of random numbers: the camera takes block 0, each vertex two; branches keep apart by the bits above these.
fn direction_dimension() -> u32 {
    return 1u + 2u * path.vertices + (path.branch << 11u);
}

fn light_dimension() -> u32 {
    return direction_dimension() + 1u;
}

// Of connections by way of spheres, by the one bit that no other block has.
fn connection_dimension() -> u32 {
    return light_dimension() | CONNECTION;
}

// How much light that was met counts beside the same light sampled at the last vertex with density `light_pdf`.
fn weight_of_meeting(light_pdf: f32) -> f32 {
    if path.direction_pdf == MET_BY_CHANCE {
        return 1.0;
    }
    if path.direction_pdf == ALREADY_COUNTED {
        return 0.0;
    }
    return balance(path.direction_pdf, light_pdf);
}

// The balance heuristic: the weight of a sample of density `own` against one of density `other`.
fn balance(own: f32, other: f32) -> f32 {
    return 1.0 / (1.0 + other / own);
}
