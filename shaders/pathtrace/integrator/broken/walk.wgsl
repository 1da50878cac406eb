//#import pathtrace/prepared.wgsl
//#import pathtrace/bsdf/bsdf.wgsl
//#import pathtrace/integrator/broken/wrong.wgsl
//#import pathtrace/integrator/path_state.wgsl
//#import pathtrace/integrator/light_paths.wgsl
//#import pathtrace/integrator/roulette.wgsl
//#import pathtrace/drive/pixels.wgsl
// The tutorial's path tracer, plain: one direction at each vertex, one sample of the lights, no way by spheres and no cones.
// Its bugs are what wrong.wgsl makes of each factor. Twin: crates/pathtrace/src/integrator/broken/walk.rs.

var<private> vertex: Interaction;
// of the sample on its way
var<private> numbers: Sampler;

fn begin(ray: Ray) {
    path = PathState(ray, vec3f(1.0), 0u, 0u, 0u, ray.origin, MET_BY_CHANCE);
    numbers = wrong_numbers(sampler_);
    if LIGHT_PATHS {
        light_path = light_path_row(BEGINS);
    }
}

// One segment; false when the sample is done.
fn step_on() -> bool {
    if segment() {
        return true;
    }
    outcome.radiance = wrong_sample(outcome.radiance);
    return false;
}

// To the next surface, and on from there; whether the path goes on.
fn segment() -> bool {
    outcome.rays += 1u;
    let nearest = closest(path.ray);
    if nearest.index == NOTHING {
        meet_the_sky();
        return false;
    }
    let hit = hit_of(nearest, path.ray);
    vertex = interaction_of(hit, -path.ray.direction);
    if materials[hit.material].emitting_sides != 0u && counts(light_path) {
        outcome.radiance += path.throughput * emitted(vertex) * weight_of_hit(hit);
    }
    if path.vertices == params.limit {
        outcome.cut = outcome.cut || params.capped == 1u;
        return false;
    }
    vertex = wrong_seen(vertex);
    if !scatters(vertex) {
        return false;
    }
    if LIGHT_PATHS {
        light_path = light_path_after(light_path, vertex.lobe);
        if light_path == 0u {
            return false;
        }
    }
    let delta = is_delta(vertex);
    if LIGHT_SAMPLING != BY_CHANCE && header.lights > 0u && !delta {
        sample_lights(unit4(numbers, light_dimension()));
    }
    let u = unit4(numbers, direction_dimension());
    let deserved = draw_direction(delta, u.xyw);
    return goes_on(delta, deserved, u.z);
}

// Sky and sun, where the path met nothing.
fn meet_the_sky() {
    if !counts(light_path) {
        return;
    }
    outcome.radiance += path.throughput * environment(weight_of_meeting(header.sun_pdf), path.ray.direction);
    if ENVIRONMENT {
        let found = environment_look_up(path.ray.direction);
        outcome.radiance += path.throughput * found.xyz * weight_of_meeting(found.w);
    }
}

// How much the light of a hit counts, beside the same light sampled.
fn weight_of_hit(hit: Hit) -> f32 {
    var density = 0.0;
    if LIGHT_SAMPLING == BY_BOTH && path.direction_pdf > 0.0 && hit.light != NO_LIGHT {
        density = light_pdf(hit.light, path.from_, hit.point.position);
    }
    return weight_of_meeting(density);
}

// Density per solid angle of a direction whose cosine is above 0.
fn direction_pdf(wi: vec3f, cosine: f32) -> f32 {
    if UNIFORM_DIRECTIONS {
        return UNIFORM_HEMISPHERE_PDF;
    }
    return bsdf_pdf(vertex, wi, cosine);
}

// Takes the light of one sample of the lights, unless it is in shadow. Under MIS weighted against meeting the same light
// by chance.
fn sample_lights(u: vec4f) {
    if !counts(light_path) {
        return;
    }
    let x = vertex.point.position;
    let sample = wrong_light(x, sample_light(x, u.z, u.xy), u.w);
    let cosine = cosine_of(vertex, sample.wi);
    if sample.pdf == 0.0 || cosine <= 0.0 {
        return;
    }
    outcome.rays += 1u;
    if wrong_in_shadow(vertex.point, sample) {
        return;
    }
    var weight = 1.0;
    if LIGHT_SAMPLING == BY_BOTH && !broken(BUG_EMISSION_TWICE) {
        weight = balance(sample.pdf, direction_pdf(sample.wi, cosine));
    }
    let bsdf = eval_bsdf(vertex, sample.wi);
    let factor = wrong_cosine(cosine) * wrong_brdf_factor(vertex) * weight;
    outcome.radiance += path.throughput * bsdf.colour * bsdf.factor * (sample.radiance_over_pdf * factor);
}

// Takes the direction in which the path leaves its vertex; what roulette goes by.
fn draw_direction(delta: bool, u: vec3f) -> vec3f {
    var sample: BsdfSample;
    if UNIFORM_DIRECTIONS && !delta {
        sample = sample_uniformly(u.xy);
    } else {
        sample = sample_bsdf(vertex, u);
    }
    var weight = sample.weight;
    if !delta {
        let cosine = cosine_of(vertex, sample.wi);
        var others = UNIFORM_HEMISPHERE_PDF;
        if UNIFORM_DIRECTIONS {
            others = bsdf_pdf(vertex, sample.wi, cosine);
        }
        weight *= wrong_direction_factor(cosine, sample.pdf, others);
    }
    path.throughput *= weight;
    path.direction_pdf = sample.pdf;
    if delta || LIGHT_SAMPLING == BY_CHANCE || broken(BUG_EMISSION_TWICE) {
        path.direction_pdf = MET_BY_CHANCE;
    } else if LIGHT_SAMPLING == BY_SAMPLING {
        path.direction_pdf = ALREADY_COUNTED;
    }
    path.from_ = vertex.point.position;
    path.ray = Ray(wrong_leaving_towards(vertex.point, sample.wi), sample.wi, FAR);
    return path.throughput;
}

// A direction of the tutorial's naive tracer, whatever the surface (Task 2 b).
fn sample_uniformly(u: vec2f) -> BsdfSample {
    let local = uniform_hemisphere(u);
    var above = vertex.normal;
    if SHADING_NORMALS {
        above = facing(vertex.point.normal, vertex.normal);
    }
    let wi = to_world(local, above);
    let bsdf = eval_bsdf(vertex, wi);
    var cosine = local.z;
    if SHADING_NORMALS {
        cosine = max(cosine_of(vertex, wi), 0.0);
    }
    return BsdfSample(wi, bsdf.colour * (bsdf.factor * cosine / UNIFORM_HEMISPHERE_PDF), UNIFORM_HEMISPHERE_PDF);
}

// Counts the vertex and plays roulette; whether the path goes on.
fn goes_on(delta: bool, deserved: vec3f, u: f32) -> bool {
    let spared = delta && path.vertices < SPARED_VERTICES;
    path.vertices += 1u;
    var probability = params.probability;
    if params.by_throughput == 1u && !spared {
        probability *= survival(deserved, 1.0);
    }
    probability = in_steps(probability);
    if probability == 0.0 || all(path.throughput == vec3f(0.0)) {
        return false;
    }
    if !broken(BUG_ROULETTE_LOST) {
        path.throughput /= probability;
    }
    return u < probability;
}
