//#import pathtrace/caster/connect.wgsl
//#import pathtrace/prepared.wgsl
// Which chain by a sphere a path is on since its last vertex that has a choice of directions: what light found by chance
// needs to know, to be weighed against connections. Of no use where a scene has no casters. Twin:
// crates/pathtrace/src/integrator/chain_state.rs.

// On no chain: from the camera, or by more than one sphere, or otherwise than chains go.
const STAGE_NONE: u32 = 0u;
// Has left the vertex.
const STAGE_LEFT: u32 = 1u;
// Inside the sphere.
const STAGE_INSIDE: u32 = 2u;
// Has been reflected off the sphere.
const STAGE_OFF: u32 = 3u;
// Has come out of the sphere.
const STAGE_THROUGH: u32 = 4u;

// The chain of a path on its way.
struct ChainState {
    stage: u32,
    vertex: vec3f,
    // density per solid angle with which chance takes the direction at the vertex, and then the chain
    chance: f32,
    center: vec3f,
    radius: f32,
    // sine and cosine
    incidence: vec2f,
    material: u32,
}

var<private> chain_state: ChainState;

// Light that was found, as seen from a sphere's centre.
struct SeenFromCenter {
    // unit direction to it
    direction: vec3f,
    // how far it is
    end: End,
    // density per solid angle with which it is sampled from there; 0 if it is not
    pdf: f32,
    // see facing_ratio
    facing: f32,
}

// Leaves a vertex in a direction of this density.
fn leave_vertex(from_: vec3f, pdf: f32) {
    chain_state.stage = STAGE_LEFT;
    chain_state.vertex = from_;
    chain_state.chance = pdf;
}

// Is reflected or refracted towards `wi` by a surface that leaves no other choice.
fn scatter_on_chain(at: Interaction, wi: vec3f) {
    let stage = chain_state.stage;
    chain_state.stage = STAGE_NONE;
    let outside = dot(at.point.normal, at.wo) >= 0.0;
    let reflected = dot(at.normal, wi) > 0.0;
    if at.point.radius == 0.0 {
        return;
    }
    if outside && stage == STAGE_LEFT {
        meet_sphere(at, reflected);
    } else if !outside && !reflected && stage == STAGE_INSIDE && is_around(at.point) {
        chain_state.stage = STAGE_THROUGH;
    }
}

// Notes the sphere that was met, and how.
fn meet_sphere(at: Interaction, reflected: bool) {
    let surface = chain_surface(at.material, !reflected);
    if surface.probability == 0.0 {
        return;
    }
    let across = cross(at.normal, at.wo);
    chain_state.incidence = vec2f(sqrt(dot(across, across)), dot(at.normal, at.wo));
    chain_state.chance *= chain_passes(surface, !reflected, chain_state.incidence);
    chain_state.center = sphere_center(at.point);
    chain_state.radius = at.point.radius;
    chain_state.material = at.material;
    chain_state.stage = select(STAGE_INSIDE, STAGE_OFF, reflected);
}

// Whether the sphere that was met is the one that this point is on.
fn is_around(point: SurfacePoint) -> bool {
    let apart = abs(sphere_center(point) - chain_state.center);
    let error = max(point.error.x, max(point.error.y, point.error.z));
    return point.radius == chain_state.radius && max(apart.x, max(apart.y, apart.z)) <= 4.0 * error;
}

// Whether light that is met now was found by a chain.
fn is_chain_complete() -> bool {
    return chain_state.stage > STAGE_INSIDE;
}

// Density per solid angle, at the vertex, with which connections find what has been found by chance, and chance's own.
fn chain_densities(light: SeenFromCenter) -> vec2f {
    let through = chain_state.stage == STAGE_THROUGH;
    let surface = chain_surface(chain_state.material, through);
    let to_center = chain_state.center - chain_state.vertex;
    let distance = sqrt(dot(to_center, to_center));
    let near = End(distance / chain_state.radius, false);
    if !(is_chain_complete() && is_outside(near) && is_outside(light.end)) {
        return vec2f(0.0, chain_state.chance);
    }
    let across = cross(to_center, light.direction);
    let chain = sphere_chain(through, end_ratio(near), end_ratio(light.end), surface.inside);
    let density = chain_density(chain, chain_state.incidence, sqrt(dot(across, across)) / distance);
    return vec2f(density * light.facing * light.pdf * surface.probability, chain_state.chance);
}

fn sphere_center(point: SurfacePoint) -> vec3f {
    return point.position - point.normal * point.radius;
}
