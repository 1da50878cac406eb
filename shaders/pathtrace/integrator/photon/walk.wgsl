//#import pathtrace/prepared.wgsl
//#import pathtrace/bsdf/bsdf.wgsl
//#import pathtrace/light/emission.wgsl
//#import pathtrace/integrator/roulette.wgsl
//#import pathtrace/integrator/photon/map.wgsl
//#import pathtrace/sampling/sampler.wgsl
// Photons on their way from the lights: as paths from the camera, but backwards, and what they leave at diffuse surfaces.
// A thread is a photon. They are written as they arrive, which differs from run to run; sort.wgsl puts them in order. Twin:
// crates/pathtrace/src/integrator/photon/walk.rs.

// whether photons are kept that come from a light directly
override DIRECT_PHOTONS: bool = false;

// Blocks of random numbers of photons begin here: two for the light, and one at each surface.
const FIRST_DIMENSION: u32 = 65536u;

// Bits of a photon's order that tell where on its way it was left. Here alone: the processor has pairs.
const VERTEX_BITS: u32 = 10u;

struct PhotonList {
    // how many were found, be there room for them or not
    found: atomic<u32>,
    cut_photons: atomic<u32>,
    // rays traced, and above them what overflowed
    rays: atomic<u32>,
    rays_high: atomic<u32>,
    photons: array<Photon>,
}

@group(1) @binding(0) var<uniform> asked: PhotonParams;
@group(1) @binding(2) var<storage, read_write> list: PhotonList;

var<private> sampler_: Sampler;
var<private> ray: Ray;
// at the light
var<private> power: vec3f;
var<private> throughput: vec3f;
// at which the photon has scattered
var<private> vertices: u32;
// index into the lights of the one that it has left
var<private> light: u32;
var<private> rays: u32;

@compute @workgroup_size(64)
fn trace(@builtin(global_invocation_id) id: vec3u) {
    let index = asked.first + id.x;
    if index >= asked.end {
        return;
    }
    sampler_ = Sampler(asked.number, index, asked.seed);
    let emitted = emit(choice_of_photon());
    if max(emitted.power.x, max(emitted.power.y, emitted.power.z)) <= 0.0 {
        return;
    }
    ray = emitted.ray;
    power = emitted.power / f32(asked.photons);
    light = emitted.light;
    throughput = vec3f(1.0);
    vertices = 0u;
    rays = 0u;
    while segment() {}
    let before = atomicAdd(&list.rays, rays);
    if before + rays < before {
        atomicAdd(&list.rays_high, 1u);
    }
}

// Place and direction are one point of four dimensions.
fn choice_of_photon() -> EmissionChoice {
    let point = unit4(sampler_, FIRST_DIMENSION);
    let chosen = unit4(sampler_, FIRST_DIMENSION + 1u);
    return EmissionChoice(chosen.x, chosen.y, chosen.z, point.xy, point.zw);
}

// One segment; false where the photon has come to its end.
fn segment() -> bool {
    rays += 1u;
    let nearest = closest(ray);
    if nearest.index == NOTHING {
        return false;
    }
    let vertex = interaction_of(hit_of(nearest, ray), -ray.direction);
    if !scatters(vertex) || has_left_another_light(vertex) {
        return false;
    }
    if is_diffuse(vertex) && (DIRECT_PHOTONS || vertices > 0u) {
        keep(vertex);
    }
    let u = unit4(sampler_, FIRST_DIMENSION + 2u + vertices);
    let sample = sample_adjoint(vertex, u.xyw);
    let spared = is_delta(vertex) && vertices < SPARED_VERTICES;
    throughput = surviving(throughput * sample.weight, spared, u.z);
    if DIELECTRIC && vertex.lobe == LOBE_DIELECTRIC && dot(vertex.normal, sample.wi) < 0.0 {
        power *= basic(vertex);
    }
    ray = Ray(leaving_towards(vertex.point, sample.wi), sample.wi, FAR);
    vertices += 1u;
    let survives = any(throughput != vec3f(0.0));
    if survives && vertices == HARD_CAP {
        atomicAdd(&list.cut_photons, 1u);
    }
    return survives && vertices < HARD_CAP;
}

// Whether a photon that has met its first surface comes from where another light is, which coincides with its own: of
// those one is there, as light sampling has it.
fn has_left_another_light(vertex: Interaction) -> bool {
    if !COINCIDENT || vertices > 0u || light >= header.lights || lights[light].group == NO_GROUP {
        return false;
    }
    rays += 1u;
    let start = leaving_towards(vertex.point, -ray.direction);
    return occluded(Ray(start, ray.origin - start, SHADOW_END), light);
}

// What refraction does to power over the square of the index.
fn basic(vertex: Interaction) -> f32 {
    let ior = materials[vertex.material].ior;
    let squared = ior * ior;
    return select(squared, 1.0 / squared, dot(vertex.point.normal, vertex.wo) >= 0.0);
}

// Keeps the photon where it has arrived, if there is room.
fn keep(vertex: Interaction) {
    let place = atomicAdd(&list.found, 1u);
    if place < asked.capacity {
        var arriving = power * throughput;
        if SHADING_NORMALS {
            arriving *= of_arriving(vertex);
        }
        let order = (sampler_.sample << VERTEX_BITS) | vertices;
        list.photons[place] =
            Photon(vertex.point.position, packed_normal(vertex.normal), arriving, order);
    }
}
