//#import pathtrace/prepared.wgsl
//#import pathtrace/bsdf/bsdf.wgsl
//#import pathtrace/camera.wgsl
//#import pathtrace/sampling/sampler.wgsl
// Pictures without light, which guide denoisers: albedo, normal and depth of what each pixel shows. A thread takes one
// sample of a pixel. Mirrors of the structs: crates/pathtrace/src/features/gpu.rs and sums.rs. Twin:
// crates/pathtrace/src/features/lanes.rs, in lanes.

// Mirrors and faces of glass that are looked through, before light that is trapped is taken for a surface.
const MOST_SPECULARS: u32 = 32u;

// What a dispatch is asked for.
struct FeatureParams {
    frame: PictureFrame,
    // of the picture, in pixels
    size: vec2u,
    // the list at hand begins with this pixel of the picture ...
    start: u32,
    // ... and these of it are sampled ...
    first: u32,
    // ... up to before this one
    end: u32,
    // samples that every pixel shall have
    until: u32,
    seed: u32,
}

// Of one pixel's samples.
struct Sums {
    albedo: vec3f,
    // those that met nothing among them
    samples: u32,
    normal: vec3f,
    // to the first surfaces
    distance: f32,
    // samples that met anything
    met: u32,
    rays: u32,
}

// What one sample shows.
struct Seen {
    // what the mirrors and glass on the way leave of it
    throughput: vec3f,
    albedo: vec3f,
    normal: vec3f,
    distance: f32,
    met: bool,
    rays: u32,
}

@group(1) @binding(0) var<uniform> asked: FeatureParams;
@group(1) @binding(1) var<storage, read_write> sums: array<Sums>;

@compute @workgroup_size(64)
fn trace(@builtin(global_invocation_id) id: vec3u) {
    let index = asked.first + id.x;
    if index >= asked.end || sums[index].samples >= asked.until {
        return;
    }
    let pixel = asked.start + index;
    let sampler_ = Sampler(pixel, sums[index].samples, asked.seed);
    let place = vec2f(vec2u(pixel % asked.size.x, pixel / asked.size.x)) + unit4(sampler_, 0u).xy;
    add(index, seen_along(camera_ray(asked.frame, place / vec2f(asked.size)), sampler_));
}

fn seen_along(camera: Ray, sampler_: Sampler) -> Seen {
    var seen = Seen(vec3f(1.0), vec3f(0.0), vec3f(0.0), 0.0, false, 0u);
    var ray = camera;
    for (var vertex = 0u; vertex <= MOST_SPECULARS; vertex++) {
        seen.rays += 1u;
        let nearest = closest(ray);
        if nearest.index == NOTHING {
            show(&seen, sky(ray.direction));
            break;
        }
        let hit = hit_of(nearest, ray);
        let at = interaction_of(hit, -ray.direction);
        if vertex == 0u {
            let way = hit.point.position - ray.origin;
            seen.met = true;
            seen.distance = sqrt(dot(way, way));
        }
        let goes_on = vertex < MOST_SPECULARS && is_delta(at) && any(at.colour != vec3f(0.0));
        show(&seen, select(at.colour, vec3f(0.0), goes_on) + emitted(at));
        if !goes_on {
            seen.normal = at.normal;
            break;
        }
        // the block of random numbers that a path's vertex has for its direction
        let u = unit4(sampler_, 2u * vertex + 1u);
        let sample = sample_bsdf(at, u.xyw);
        seen.throughput *= sample.weight;
        ray = Ray(leaving_towards(at.point, sample.wi), sample.wi, FAR);
    }
    return seen;
}

// What shines where nothing is met.
fn sky(direction: vec3f) -> vec3f {
    let radiance = environment(1.0, direction);
    if ENVIRONMENT {
        return radiance + environment_look_up(direction).xyz;
    }
    return radiance;
}

// Adds a colour at the end of the way, or a light on it, at most 1.
fn show(seen: ptr<function, Seen>, colour: vec3f) {
    (*seen).albedo += (*seen).throughput * min(colour, vec3f(1.0));
}

fn add(index: u32, seen: Seen) {
    sums[index].albedo += min(seen.albedo, vec3f(1.0));
    sums[index].normal += seen.normal;
    sums[index].distance += seen.distance;
    sums[index].met += select(0u, 1u, seen.met);
    sums[index].samples += 1u;
    sums[index].rays += seen.rays;
}
