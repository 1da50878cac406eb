//#import pathtrace/prepared.wgsl
//#import pathtrace/bsdf/bsdf.wgsl
//#import pathtrace/integrator/light_paths.wgsl
//#import pathtrace/drive/pixels.wgsl
// Whitted-style ray tracing, "An improved illumination model for shaded display" (1980), as on the slides: L = ka La +
// kd Id N.L + ks S + kt T. Twins:
// crates/pathtrace/src/integrator/whitted.rs and branches.rs.
//
// Each step follows one branch to the next surface; where glass splits a ray the reflected branch waits on a small
// stack.

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

var<private> branch: Branch;
// reflected branches that wait, one list for each of their parts: compilers take long over lists of structures
var<private> waiting_origins: array<vec3f, MOST_DEPTH>;
var<private> waiting_directions: array<vec3f, MOST_DEPTH>;
var<private> waiting_weights: array<vec3f, MOST_DEPTH>;
var<private> waiting_depths: array<u32, MOST_DEPTH>;
var<private> waiting_light_paths: array<u32, MOST_DEPTH>;
var<private> waiting: u32;
// the next block of random numbers; the camera took block 0
var<private> dimension: u32;
// branches followed so far
var<private> followed: u32;

// Begins a sample.
fn begin(ray: Ray) {
    branch = Branch(ray, vec3f(1.0), 0u);
    waiting = 0u;
    dimension = 1u;
    followed = 0u;
    if LIGHT_PATHS {
        light_path = light_path_row(BEGINS);
    }
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
    if LIGHT_PATHS {
        waiting_light_paths[waiting] = light_path;
    }
    waiting += 1u;
}

fn pop() {
    waiting -= 1u;
    let ray = Ray(waiting_origins[waiting], waiting_directions[waiting], FAR);
    branch = Branch(ray, waiting_weights[waiting], waiting_depths[waiting]);
    if LIGHT_PATHS {
        light_path = waiting_light_paths[waiting];
    }
}

// Follows the branch to the next surface; false if it ends there.
fn follow() -> bool {
    followed += 1u;
    outcome.rays += 1u;
    let nearest = closest(branch.ray);
    if nearest.index == NOTHING && !counts(light_path) {
        return false;
    }
    if nearest.index == NOTHING {
        outcome.radiance += branch.weight * environment(1.0, branch.ray.direction);
        if ENVIRONMENT {
            outcome.radiance += branch.weight * environment_look_up(branch.ray.direction).xyz;
        }
        return false;
    }
    let hit = hit_of(nearest, branch.ray);
    let at = interaction_of(hit, -branch.ray.direction);
    if counts(light_path) {
        outcome.radiance += branch.weight * emitted(at);
    }
    if LIGHT_PATHS {
        light_path = light_path_after(light_path, at.lobe);
    }
    let albedo = lit_albedo(at);
    if any(albedo != vec3f(0.0)) {
        light(at, albedo);
    }
    return !is_diffuse(at) && branch.depth < params.limit && send_on(at);
}

// Adds the light that a diffuse surface sends along the branch: direct, and the ambient that stands for the rest.
fn light(at: Interaction, albedo: vec3f) {
    let direct = irradiance(at.point, at.normal);
    // ambient light stands for what comes from other diffuse surfaces
    var ambient = params.ambient;
    if LIGHT_PATHS && !counts(light_path_after(light_path, LOBE_LAMBERT)) {
        ambient = 0.0;
    }
    outcome.radiance += branch.weight * albedo * (direct * FRAC_1_PI + ambient);
}

// Goes on with the refracted ray, while the reflected one waits; or with the one of them that there is, if any.
fn send_on(at: Interaction) -> bool {
    let specular = specular_of(at);
    let reflectance = specular.reflectance.colour * specular.reflectance.factor;
    let reflected = leaving(at.point, specular.reflected, branch.weight * reflectance);
    if !specular.refracts {
        branch = reflected;
        return specular.reflects;
    }
    if specular.reflects {
        push(reflected);
    }
    branch = leaving(at.point, specular.refracted, branch.weight * specular.transmittance);
    return true;
}

// The branch that leaves a specular surface.
fn leaving(point: SurfacePoint, wi: vec3f, weight: vec3f) -> Branch {
    return Branch(Ray(leaving_towards(point, wi), wi, FAR), weight, branch.depth + 1u);
}

// Light that arrives at a surface: every light by itself, or of very many a choice.
fn irradiance(at: SurfacePoint, normal: vec3f) -> vec3f {
    let each = header.lights <= MOST_LIGHTS;
    let share = select(1.0 / f32(MOST_LIGHTS), 1.0, each);
    var sum = vec3f(0.0);
    for (var turn = 0u; turn < min(header.lights, MOST_LIGHTS); turn++) {
        let rays = select(params.shadow_rays, 1u, each && is_delta_light(turn));
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
    var sample: LightSample;
    if each {
        sample = sample_one(turn, at.position, u.xy);
    } else {
        sample = sample_light(at.position, u.z, u.xy);
    }
    let cosine = dot(normal, sample.wi);
    if sample.pdf == 0.0 || cosine <= 0.0 || !counts(light_path) {
        return vec3f(0.0);
    }
    outcome.rays += 1u;
    if in_shadow(at, sample) {
        return vec3f(0.0);
    }
    return sample.radiance_over_pdf * shadowed(normal, at.normal, sample.wi, cosine);
}

// Whether one sample of this light is exact: it shines from one direction.
fn is_delta_light(light: u32) -> bool {
    let outline = lights[light].outline;
    return outline == LIGHT_POINT || (outline == LIGHT_SUN && lights[light].area == 0.0);
}
