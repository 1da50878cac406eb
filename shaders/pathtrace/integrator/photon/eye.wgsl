//#import pathtrace/prepared.wgsl
//#import pathtrace/bsdf/bsdf.wgsl
//#import pathtrace/integrator/path_state.wgsl
//#import pathtrace/integrator/roulette.wgsl
//#import pathtrace/integrator/photon/map.wgsl
//#import pathtrace/drive/pixels.wgsl
// Paths from the camera through mirrors, metal and glass to the first diffuse surface, where they gather photons. Twins:
// crates/pathtrace/src/integrator/photon/eye.rs and map.rs, which gathers.

// whether the map has photons that came from a light directly; such light is sampled if not
override DIRECT_GATHERED: bool = false;

@group(2) @binding(0) var<storage, read> map: PhotonMap;

// whether the path has gathered, and looks for a sky of one colour, which no light sampling knows
var<private> to_the_sky: bool;

fn begin(ray: Ray) {
    path = PathState(ray, vec3f(1.0), 0u, 0u, 0u, ray.origin, MET_BY_CHANCE);
    to_the_sky = false;
}

// One segment; false when the sample is done.
fn step_on() -> bool {
    outcome.rays += 1u;
    let nearest = closest(path.ray);
    if nearest.index == NOTHING {
        meet_sky();
        return false;
    }
    let hit = hit_of(nearest, path.ray);
    let vertex = interaction_of(hit, -path.ray.direction);
    if materials[hit.material].emitting_sides != 0u {
        var density = 0.0;
        if path.direction_pdf > 0.0 && hit.light != NO_LIGHT {
            density = light_pdf(hit.light, path.from_, hit.point.position);
        }
        outcome.radiance += path.throughput * emitted(vertex) * weight_of_meeting(density);
    }
    if to_the_sky || !scatters(vertex) {
        return false;
    }
    if path.vertices == HARD_CAP {
        outcome.cut = true;
        return false;
    }
    if is_diffuse(vertex) {
        let gathered = irradiance(vertex.point.position, vertex.normal);
        outcome.radiance += path.throughput * (vertex.colour * gathered * FRAC_1_PI);
    }
    return scatter(vertex);
}

fn meet_sky() {
    let weight = weight_of_meeting(header.sun_pdf);
    outcome.radiance += path.throughput * environment(weight, path.ray.direction);
    if ENVIRONMENT {
        let found = environment_look_up(path.ray.direction);
        outcome.radiance += path.throughput * found.xyz * weight_of_meeting(found.w);
    }
}

// Samples lights, and sends the path on; whether it goes on.
fn scatter(vertex: Interaction) -> bool {
    let diffuse = is_diffuse(vertex);
    let delta = is_delta(vertex);
    if header.lights > 0u && !delta && !(DIRECT_GATHERED && diffuse) {
        sample_lights(vertex, unit4(sampler_, light_dimension()));
    }
    to_the_sky = diffuse;
    if diffuse && (DIRECT_GATHERED || all(header.sky == vec3f(0.0))) {
        return false;
    }
    let u = unit4(sampler_, direction_dimension());
    let sample = sample_bsdf(vertex, u.xyw);
    path.direction_pdf = sample.pdf;
    if delta {
        path.direction_pdf = MET_BY_CHANCE;
    } else if diffuse {
        path.direction_pdf = ALREADY_COUNTED;
    }
    let spared = delta && path.vertices < SPARED_VERTICES;
    path.throughput = surviving(path.throughput * sample.weight, spared, u.z);
    path.from_ = vertex.point.position;
    path.ray = Ray(leaving_towards(vertex.point, sample.wi), sample.wi, FAR);
    path.vertices += 1u;
    return any(path.throughput != vec3f(0.0));
}

// Takes the light of one sample of the lights: all of it at diffuse surfaces, weighted at rough metal, which also meets
// it.
fn sample_lights(vertex: Interaction, u: vec4f) {
    let sample = sample_light(vertex.point.position, u.z, u.xy);
    let cosine = cosine_of(vertex, sample.wi);
    if sample.pdf == 0.0 || cosine <= 0.0 {
        return;
    }
    outcome.rays += 1u;
    if in_shadow(vertex.point, sample) {
        return;
    }
    var weight = 1.0;
    if !is_diffuse(vertex) {
        weight = balance(sample.pdf, bsdf_pdf(vertex, sample.wi, cosine));
    }
    let bsdf = eval_bsdf(vertex, sample.wi);
    outcome.radiance += path.throughput * bsdf.colour * bsdf.factor * (sample.radiance_over_pdf * (cosine * weight));
}

// Irradiance on the side of a surface: the power of the photons within the radius over the disc's area, a constant
// kernel.
fn irradiance(at: vec3f, normal: vec3f) -> vec3f {
    let grid = map.grid;
    let first = cell_of(grid, at - grid.radius);
    let last = min(cell_of(grid, at + grid.radius), first + 2);
    // cells may share a bucket, which counts once
    var seen: array<u32, MOST_CELLS>;
    var count = 0u;
    var power = vec3f(0.0);
    for (var z = first.z; z <= last.z; z++) {
        for (var y = first.y; y <= last.y; y++) {
            for (var x = first.x; x <= last.x; x++) {
                let bucket = bucket_of(grid, vec3i(x, y, z));
                var is_new = true;
                for (var i = 0u; i < count; i++) {
                    is_new = is_new && seen[i] != bucket;
                }
                if is_new {
                    seen[count] = bucket;
                    count += 1u;
                    power += power_in(bucket, at, normal);
                }
            }
        }
    }
    return power * (FRAC_1_PI / (grid.radius * grid.radius));
}

// The power of a bucket's photons around a point.
fn power_in(bucket: u32, at: vec3f, normal: vec3f) -> vec3f {
    let pair = map.words[bucket / 2u];
    let places = select(pair.xy, pair.zw, (bucket & 1u) == 1u);
    var power = vec3f(0.0);
    for (var place = places.x; place < places.y; place++) {
        let word = map.words[map.grid.photons + 2u * place];
        let off = bitcast<vec3f>(word.xyz) - at;
        if dot(off, off) < map.grid.radius * map.grid.radius && dot(unpacked_normal(word.w), normal) > ONE_SURFACE {
            power += bitcast<vec3f>(map.words[map.grid.photons + 2u * place + 1u].xyz);
        }
    }
    return power;
}
