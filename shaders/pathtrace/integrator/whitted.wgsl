//#import pathtrace/prepared.wgsl
//#import pathtrace/bsdf/bsdf.wgsl
//#import pathtrace/drive/film.wgsl
// Whitted-style ray tracing, "An improved illumination model for shaded display" (1980), as on the slides: L = ka La +
// kd Id N.L + ks S + kt T. Twin: crates/pathtrace/src/integrator/whitted.rs.
//
// A thread is a pixel. Each iteration of its one loop follows one branch to the next surface; where glass splits a ray
// the reflected branch waits on a small stack.

// A ray on its way, or waiting.
struct Branch {
    ray: Ray,
    // what radiance met now is worth at the camera
    weight: vec3f,
    // specular scatterings so far
    depth: u32,
}

// Reflected branches that wait: at most one for each level.
const MOST_DEPTH: u32 = 64u;

// Branches of one sample before its other ones are cut.
const MOST_BRANCHES: u32 = 65536u;

// Lights up to which each is sampled; of more, this many are chosen by power.
const MOST_LIGHTS: u32 = 16u;

var<private> sampler_: Sampler;
var<private> branch: Branch;
var<private> outcome: Outcome;
// reflected branches that wait, one list for each of their parts: compilers take long over lists of structures
var<private> waiting_origins: array<vec3f, MOST_DEPTH>;
var<private> waiting_directions: array<vec3f, MOST_DEPTH>;
var<private> waiting_weights: array<vec3f, MOST_DEPTH>;
var<private> waiting_depths: array<u32, MOST_DEPTH>;
var<private> waiting: u32;
// the next block of random numbers; the camera took block 0
var<private> dimension: u32;
// branches followed so far
var<private> followed: u32;

@compute @workgroup_size(GROUP, GROUP)
fn trace(@builtin(global_invocation_id) id: vec3u) {
    let place = id.xy + vec2u(params.first_column, params.first_row);
    let width = u32(params.size.x);
    if place.x >= params.end_column || place.y >= params.end_row {
        return;
    }
    let index = (place.y - params.film_row) * width + place.x;
    var pixel = film[index];
    sampler_ = Sampler(place.y * width + place.x, pixel.samples, params.seed);
    begin(place);
    loop {
        if pixel.samples >= params.until {
            break;
        }
        if step_on() {
            continue;
        }
        record(&pixel, outcome);
        sampler_.sample = pixel.samples;
        begin(place);
    }
    film[index] = pixel;
}

// Begins a sample.
fn begin(place: vec2u) {
    branch = Branch(sample_ray(place, sampler_), vec3f(1.0), 0u);
    outcome = Outcome(vec3f(0.0), 0u, false);
    waiting = 0u;
    dimension = 1u;
    followed = 0u;
}

// Follows one branch; false when the tree is done.
fn step_on() -> bool {
    if followed >= MOST_BRANCHES {
        outcome.cut = true;
        return false;
    }
    if follow() {
        return true;
    }
    if waiting == 0u {
        return false;
    }
    pop();
    return true;
}

fn push(waits: Branch) {
    waiting_origins[waiting] = waits.ray.origin;
    waiting_directions[waiting] = waits.ray.direction;
    waiting_weights[waiting] = waits.weight;
    waiting_depths[waiting] = waits.depth;
    waiting += 1u;
}

fn pop() {
    waiting -= 1u;
    let ray = Ray(waiting_origins[waiting], waiting_directions[waiting], FAR);
    branch = Branch(ray, waiting_weights[waiting], waiting_depths[waiting]);
}

// Follows the branch to the next surface; false if it ends there.
fn follow() -> bool {
    followed += 1u;
    outcome.rays += 1u;
    let nearest = closest(branch.ray);
    if nearest.index == NOTHING {
        outcome.radiance += branch.weight * environment(1.0, branch.ray.direction);
        return false;
    }
    let hit = hit_of(nearest, branch.ray);
    let material = materials[hit.material];
    outcome.radiance += branch.weight * emitted(material, hit.point.normal, branch.ray.direction);
    let wo = -branch.ray.direction;
    let normal = facing(hit.point.normal, wo);
    let deeper = branch.depth < params.limit;
    if MIRROR && material.bsdf == BSDF_MIRROR {
        branch = leaving(hit.point, reflect(wo, normal), branch.weight * material.colour.even);
        return deeper && any(branch.weight != vec3f(0.0));
    }
    if DIELECTRIC && material.bsdf == BSDF_DIELECTRIC {
        return deeper && split_at_glass(hit.point, wo, normal, material);
    }
    let albedo = colour_at(material, hit.point.position);
    var direct = vec3f(0.0);
    if any(albedo != vec3f(0.0)) {
        direct = irradiance(hit.point, normal);
    }
    outcome.radiance += branch.weight * albedo * (direct * FRAC_1_PI + params.ambient);
    return false;
}

// The branch that leaves a specular surface.
fn leaving(point: SurfacePoint, wi: vec3f, weight: vec3f) -> Branch {
    return Branch(Ray(leaving_towards(point, wi), wi, FAR), weight, branch.depth + 1u);
}

// Goes on with the refracted ray, while the reflected one waits; or with the one of them that there is.
fn split_at_glass(point: SurfacePoint, wo: vec3f, normal: vec3f, material: Material) -> bool {
    let boundary = Interface(material.ior, dot(point.normal, wo) >= 0.0, material.root, material.root_low);
    let reflected = fresnel(boundary, dot(normal, wo));
    let mirrored = leaving(point, reflect(wo, normal), branch.weight * reflected);
    if reflected >= 1.0 {
        branch = mirrored;
        return true;
    }
    if reflected > 0.0 {
        push(mirrored);
    }
    let wi = refract(boundary, wo, normal);
    branch = leaving(point, wi / sqrt(dot(wi, wi)), branch.weight * (1.0 - reflected));
    return true;
}

// Light that arrives at a surface: every light by itself, or of very many a choice.
fn irradiance(at: SurfacePoint, normal: vec3f) -> vec3f {
    let each = header.lights <= MOST_LIGHTS;
    let share = select(1.0 / f32(MOST_LIGHTS), 1.0, each);
    var sum = vec3f(0.0);
    for (var turn = 0u; turn < min(header.lights, MOST_LIGHTS); turn++) {
        let rays = select(params.shadow_rays, 1u, each && is_delta(turn));
        var of_light = vec3f(0.0);
        for (var ray = 0u; ray < rays; ray++) {
            let u = unit4(sampler_, dimension);
            dimension += 1u;
            of_light += unshadowed(at, normal, turn, each, u);
        }
        sum += of_light * (share / f32(rays));
    }
    return sum;
}

// Irradiance from one sample of a light; zero in shadow.
fn unshadowed(at: SurfacePoint, normal: vec3f, turn: u32, each: bool, u: vec4f) -> vec3f {
    let chosen = select(choose(u.z), turn, each);
    var sample = sample_one(chosen, at.position, u.xy);
    let cosine = dot(normal, sample.wi);
    if sample.pdf == 0.0 || cosine <= 0.0 {
        return vec3f(0.0);
    }
    outcome.rays += 1u;
    if in_shadow(at, sample) {
        return vec3f(0.0);
    }
    return sample.radiance_over_pdf * (cosine * select(1.0 / lights[chosen].probability, 1.0, each));
}

// Whether one sample of this light is exact: it shines from one direction.
fn is_delta(light: u32) -> bool {
    let outline = lights[light].outline;
    return outline == LIGHT_POINT || (outline == LIGHT_SUN && lights[light].area == 0.0);
}
