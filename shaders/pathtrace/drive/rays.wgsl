//#import pathtrace/prepared.wgsl
//#import pathtrace/bsdf/bsdf.wgsl
// Rays by themselves, for whoever wants to know what they meet. Mirror:
// crates/pathtrace/src/drive/gpu/rays.rs.

struct RayQuery {
    origin: vec3f,
    tmax: f32,
    direction: vec3f,
    unused: u32,
}

struct RayAnswer {
    position: vec3f,
    // 0 where nothing is met
    t: f32,
    error: vec3f,
    material: u32,
    normal: vec3f,
    // whether anything at all is met, asked as shadow rays ask
    occluded: u32,
    // unit direction behind a dielectric surface; 0 where there is none
    refracted: vec3f,
    // what a dielectric surface reflects, 1 beyond the critical angle; 0 of others
    reflectance: f32,
    // of a sphere; 0 if the surface is flat
    radius: f32,
}

@group(1) @binding(0) var<storage, read> queries: array<RayQuery>;
@group(1) @binding(1) var<storage, read_write> answers: array<RayAnswer>;

@compute @workgroup_size(64)
fn trace(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = id.y * groups.x * 64u + id.x;
    if index >= arrayLength(&queries) {
        return;
    }
    let query = queries[index];
    let ray = Ray(query.origin, query.direction, query.tmax);
    let nearest = closest(ray);
    var answer: RayAnswer;
    if nearest.index != NOTHING {
        let hit = hit_of(nearest, ray);
        answer.position = hit.point.position;
        answer.t = nearest.t;
        answer.error = hit.point.error;
        answer.material = hit.material;
        answer.normal = hit.point.normal;
        answer.radius = hit.point.radius;
        let met = interaction_of(hit, -ray.direction);
        if met.lobe == LOBE_DIELECTRIC {
            meet_dielectric(&answer, met);
        }
    }
    answer.occluded = select(0u, 1u, meets_anything(ray));
    answers[index] = answer;
}

// What a smooth dielectric does to light, as paths and trees ask it.
fn meet_dielectric(answer: ptr<function, RayAnswer>, at: Interaction) {
    let boundary = interface_of(at);
    (*answer).reflectance = fresnel(boundary, dot(at.normal, at.wo));
    if refracted_cosine(boundary, dot(at.normal, at.wo)) != ALL_REFLECTED {
        let wi = refract(boundary, at.wo, at.normal);
        (*answer).refracted = unit_vector(wi);
    }
}
