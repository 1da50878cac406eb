//#import pathtrace/camera.wgsl
//#import pathtrace/sampling/sampler.wgsl
//#import pathtrace/exact.wgsl
// What a dispatch is asked for, and the film that it adds to. Twin: crates/film/src/film.rs. Mirror of the structs:
// crates/pathtrace/src/drive/gpu/film_data.rs. Sums are pairs of floats, where the twin has f64: a plain f32 sum of a
// million samples of .1 is off by a percent, and one of a thousand by 1e-5.

struct RenderParams {
    frame: PictureFrame,
    // of the picture, in pixels
    size: vec2f,
    // the film's part at hand begins with this row ...
    film_row: u32,
    // ... and these rows are sampled ...
    first_row: u32,
    end_row: u32,
    // ... between these columns
    first_column: u32,
    end_column: u32,
    // samples that every pixel shall have
    until: u32,
    seed: u32,
    // vertices at which a path may scatter; specular scatterings along a branch
    limit: u32,
    // whether that is the hard cap rather than the user's wish
    capped: u32,
    branches: u32,
    // diffuse vertices of a path that may branch
    branching_vertices: u32,
    // 1 if roulette looks at the throughput
    by_throughput: u32,
    // of surviving a vertex, beside that
    probability: f32,
    // Whitted's: shadow rays to each area light, and radiance of the ambient light
    shadow_rays: u32,
    ambient: f32,
    // rows of the automaton that tells which light counts
    light_paths: array<vec4u, 8>,
}

struct Pixel {
    sum: vec3f,
    samples: u32,
    sum_of_squares: vec3f,
    largest: f32,
    // what rounding left of the sums
    sum_low: vec3f,
    rays: u32,
    squares_low: vec3f,
    // samples that were not finite; those that lost light to a cap above
    faults: u32,
}

// Radiance beyond which the sum of squares takes a sample for no brighter. Here alone: f64 holds every square of an
// f32.
const MOST_IN_SQUARES: f32 = 1e17;

const CUT_SHIFT: u32 = 16u;

// Threads along each side of a group: a thread is a pixel.
const GROUP: u32 = 8u;

// What a sample of a pixel brought home.
struct Outcome {
    radiance: vec3f,
    rays: u32,
    cut: bool,
}

// of the sample on its way
var<private> outcome: Outcome;

@group(1) @binding(0) var<uniform> params: RenderParams;
@group(1) @binding(1) var<storage, read_write> film: array<Pixel>;

// Adds a sample to a pixel.
fn record(pixel: ptr<function, Pixel>, outcome: Outcome) {
    // by their bits: shaders may take for granted that no float is infinite or NaN
    let exponents = bitcast<vec3u>(outcome.radiance) & vec3u(0x7f800000u);
    let finite = all(exponents != vec3u(0x7f800000u));
    let radiance = select(vec3f(0.0), outcome.radiance, finite);
    let sum = two_sum((*pixel).sum, radiance);
    (*pixel).sum = sum.sum;
    (*pixel).sum_low += sum.rest;
    // their sum shall be finite too
    let within = min(radiance, vec3f(MOST_IN_SQUARES));
    let squares = two_sum((*pixel).sum_of_squares, within * within);
    (*pixel).sum_of_squares = squares.sum;
    (*pixel).squares_low += squares.rest;
    (*pixel).largest = max((*pixel).largest, max(radiance.x, max(radiance.y, radiance.z)));
    // rather too few than from 0 again
    (*pixel).rays = max((*pixel).rays + outcome.rays, (*pixel).rays);
    (*pixel).faults += select(1u, 0u, finite) + select(0u, 1u << CUT_SHIFT, outcome.cut);
    (*pixel).samples += 1u;
}

// The ray of a sample through a place in its pixel.
fn sample_ray(pixel: vec2u, sampler_: Sampler) -> Ray {
    let jitter = unit4(sampler_, 0u).xy;
    return camera_ray(params.frame, (vec2f(pixel) + jitter) / params.size);
}
