// Photons of one pass where they have landed, sorted by the cells of a hashed grid: Teschner et al., "Optimized Spatial
// Hashing for Collision Detection of Deformable Objects" (2003). Twin: crates/pathtrace/src/integrator/photon/map.rs.
// Mirror of the structs: crates/pathtrace/src/drive/gpu/photon_data.rs.

// What a dispatch of photons is asked for.
struct PhotonParams {
    // these items of a list ...
    first: u32,
    // ... up to before this one
    end: u32,
    // of the pass
    number: u32,
    // that leave the lights in it
    photons: u32,
    seed: u32,
    // most that the list holds
    capacity: u32,
}

// Light that has arrived at a diffuse surface.
struct Photon {
    position: vec3f,
    // on the side that it came from, see packed_normal
    normal: u32,
    power: vec3f,
    // by the photon that left a light, and along its way
    order: u32,
}

// Cells as wide as a disc of photons, so that at most two of them along each axis hold what is within the radius.
struct Grid {
    origin: vec3f,
    cells_per_unit: f32,
    radius: f32,
    // buckets less one, a power of two less one
    mask: u32,
    // where the photons begin behind the buckets, in words
    photons: u32,
}

struct PhotonMap {
    grid: Grid,
    // of two buckets in each word where their photons begin and end; then the photons, two words each
    words: array<vec4u>,
}

// Cosine between two normals below which their surfaces are not one.
const ONE_SURFACE: f32 = 0.5;

// Two along each axis; where coordinates are rounded to the size of cells, three.
const MOST_CELLS: u32 = 27u;

// Cells that far out are all one. Here alone: the processor's conversions saturate.
const FARTHEST_CELL: f32 = 1073741824.0;

fn cell_of(grid: Grid, at: vec3f) -> vec3i {
    let cell = floor((at - grid.origin) * grid.cells_per_unit);
    return vec3i(clamp(cell, vec3f(-FARTHEST_CELL), vec3f(FARTHEST_CELL)));
}

fn bucket_of(grid: Grid, cell: vec3i) -> u32 {
    let scattered = bitcast<vec3u>(cell) * vec3u(73856093u, 19349663u, 83492791u);
    let hash = scattered.x ^ scattered.y ^ scattered.z;
    return (hash ^ (hash >> 15u)) & grid.mask;
}

// A unit vector in 32 bits, on an octahedron: Cigolle et al., "A Survey of Efficient Representations for Independent Unit
// Vectors" (JCGT 3(2), 2014). Off by 6e-5 at most, which decides nothing but whether two surfaces are one.
fn packed_normal(normal: vec3f) -> u32 {
    let flat_ = normal.xy / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    return pack2x16snorm(select(flat_, folded(flat_), normal.z < 0.0));
}

fn unpacked_normal(word: u32) -> vec3f {
    let flat_ = unpack2x16snorm(word);
    let z = 1.0 - abs(flat_.x) - abs(flat_.y);
    return normalize(vec3f(select(flat_, folded(flat_), z < 0.0), z));
}

// The lower half of the octahedron, turned out.
fn folded(flat_: vec2f) -> vec2f {
    return (1.0 - abs(flat_.yx)) * select(vec2f(-1.0), vec2f(1.0), flat_ >= vec2f(0.0));
}
