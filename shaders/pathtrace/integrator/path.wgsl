//#import pathtrace/prepared.wgsl
//#import pathtrace/bsdf/bsdf.wgsl
//#import pathtrace/caster/cone.wgsl
//#import pathtrace/integrator/path_state.wgsl
//#import pathtrace/integrator/connected.wgsl
//#import pathtrace/integrator/light_paths.wgsl
//#import pathtrace/integrator/roulette.wgsl
//#import pathtrace/drive/pixels.wgsl
// One path: the tutorial's `shade`, turned from recursion into a state that moves from vertex to vertex (Task 2 d).
// Twins: crates/pathtrace/src/integrator/path.rs, directions.rs, forks.rs
// and splits.rs.
//
// Each step is one segment: meet a surface, take its emission, sample a light, draw a direction, play roulette.

// whether a diffuse vertex may be left in more than one direction
override BRANCHING: bool = true;
// whether glass that the camera sees sends paths on both ways
override SPLITTING: bool = true;

// Vertices that can wait for more branches at a time.
const MOST_FORKS: u32 = 16u;

// Vertices of a path up to which glass splits it.
const SPLITTING_VERTICES: u32 = 2u;

// The largest of the random numbers: glass refracts, unless all is reflected.
const ALWAYS_REFRACTED: f32 = 0.99999994;

// What comes after a segment. Here alone: lanes have masks for it.
const PATH_ENDS: u32 = 0u;
const PATH_GOES_ON: u32 = 1u;
const PATH_SCATTERS: u32 = 2u;

var<private> vertex: Interaction;
// vertices that more branches will leave, and the path as it arrived there: one list for each part, because compilers
// take long over lists of structures
var<private> fork_positions: array<vec3f, MOST_FORKS>;
var<private> fork_errors: array<vec3f, MOST_FORKS>;
// geometric ones; of the side that the path came from in the vertex itself
var<private> fork_normals: array<vec3f, MOST_FORKS>;
// of spheres
var<private> fork_radii: array<f32, MOST_FORKS>;
var<private> fork_sides: array<vec3f, MOST_FORKS>;
var<private> fork_albedos: array<vec3f, MOST_FORKS>;
var<private> fork_throughputs: array<vec3f, MOST_FORKS>;
// vertices, forked, branch, and branches to come
var<private> fork_counts: array<vec4u, MOST_FORKS>;
var<private> waiting: u32;
// whether the path has met nothing but mirrors and glass
var<private> from_camera: bool;
// paths that glass has split off, by their parts; of each its vertices and its branch
var<private> split_origins: array<vec3f, SPLITTING_VERTICES>;
var<private> split_directions: array<vec3f, SPLITTING_VERTICES>;
var<private> split_throughputs: array<vec3f, SPLITTING_VERTICES>;
var<private> split_numbers: array<vec2u, SPLITTING_VERTICES>;
var<private> split_off: u32;
// rows of the light paths of both
var<private> fork_light_paths: array<u32, MOST_FORKS>;
var<private> split_light_paths: array<u32, SPLITTING_VERTICES>;

// Begins a sample.
fn begin(ray: Ray) {
    path = PathState(ray, vec3f(1.0), 0u, 0u, 0u, ray.origin, MET_BY_CHANCE);
    waiting = 0u;
    if CASTERS && CONNECTIONS {
        chain_state.stage = STAGE_NONE;
    }
    from_camera = true;
    split_off = 0u;
    if LIGHT_PATHS {
        light_path = light_path_row(BEGINS);
    }
}

// One segment, or one more branch of a vertex that waits; false when the sample is done.
fn step_on() -> bool {
    var then = PATH_SCATTERS;
    if !BRANCHING || !at_fork() {
        then = segment();
    }
    if LIGHT_PATHS && then == PATH_SCATTERS {
        light_path = light_path_after(light_path, vertex.lobe);
        then = select(PATH_SCATTERS, PATH_ENDS, light_path == 0u);
    }
    if then == PATH_SCATTERS {
        then = select(PATH_ENDS, PATH_GOES_ON, scatter());
    }
    if BRANCHING && then == PATH_ENDS && waiting > 0u {
        next_branch();
        return true;
    }
    if SPLITTING && then == PATH_ENDS && split_off > 0u {
        next_split();
        return true;
    }
    return then == PATH_GOES_ON;
}

// Whether the path stands at a vertex that it leaves once more.
fn at_fork() -> bool {
    return path.ray.tmax == 0.0;
}

// Goes back to the deepest vertex that waits.
fn next_branch() {
    let top = waiting - 1u;
    let point = SurfacePoint(fork_positions[top], fork_errors[top], fork_normals[top], fork_radii[top]);
    vertex = Interaction(point, fork_sides[top], fork_sides[top], fork_albedos[top], LOBE_LAMBERT, 0u, vec2f(0.0));
    let counts = fork_counts[top];
    path.throughput = fork_throughputs[top];
    path.vertices = counts.x;
    path.forked = counts.y;
    path.branch = child(counts.z, params.branches, params.branches - counts.w);
    path.ray.tmax = 0.0;
    if LIGHT_PATHS {
        light_path = fork_light_paths[top];
    }
    fork_counts[top] = vec4u(counts.xyz, counts.w - 1u);
    if counts.w == 1u {
        waiting = top;
    }
}

// Keeps the vertex, and the path as it arrived, for branches to come.
fn fork() {
    fork_positions[waiting] = vertex.point.position;
    fork_errors[waiting] = vertex.point.error;
    fork_normals[waiting] = vertex.point.normal;
    fork_radii[waiting] = vertex.point.radius;
    fork_sides[waiting] = vertex.normal;
    fork_albedos[waiting] = vertex.colour;
    fork_throughputs[waiting] = path.throughput;
    fork_counts[waiting] = vec4u(path.vertices, path.forked, path.branch, params.branches - 1u);
    if LIGHT_PATHS {
        fork_light_paths[waiting] = light_path;
    }
    waiting += 1u;
}

// Goes on with the last path that glass has split off.
fn next_split() {
    split_off -= 1u;
    let ray = Ray(split_origins[split_off], split_directions[split_off], FAR);
    let numbers = split_numbers[split_off];
    path = PathState(ray, split_throughputs[split_off], numbers.x, 0u, numbers.y, ray.origin, MET_BY_CHANCE);
    from_camera = true;
    if CASTERS && CONNECTIONS {
        chain_state.stage = STAGE_NONE;
    }
    if LIGHT_PATHS {
        light_path = split_light_paths[split_off];
    }
}

// Whether glass that the camera sees is to split the path.
fn splits_here() -> bool {
    let glass = DIELECTRIC && vertex.lobe == LOBE_DIELECTRIC;
    return SPLITTING && glass && from_camera && path.vertices < SPLITTING_VERTICES;
}

// Lets the part of the path that glass reflects wait where it goes on by refraction.
fn split() {
    if dot(vertex.normal, path.ray.direction) >= 0.0 {
        return;
    }
    let share = fresnel(interface_of(vertex), dot(vertex.normal, vertex.wo));
    if share > 0.0 {
        let mirrored = reflect(vertex.wo, vertex.normal);
        let wi = unit_vector(mirrored);
        split_origins[split_off] = leaving_towards(vertex.point, wi);
        split_directions[split_off] = wi;
        split_throughputs[split_off] = path.throughput * share;
        split_numbers[split_off] = vec2u(path.vertices + 1u, child(path.branch, 2u, 1u));
        if LIGHT_PATHS {
            split_light_paths[split_off] = light_path;
        }
        split_off += 1u;
    }
    path.throughput *= 1.0 - share;
    path.branch = child(path.branch, 2u, 0u);
}

// Number of a path's branch `index` in a tree where each has `branches`.
fn child(parent: u32, branches: u32, index: u32) -> u32 {
    return parent * branches + index + 1u;
}

// To the next surface.
fn segment() -> u32 {
    outcome.rays += 1u;
    let nearest = closest(path.ray);
    if nearest.index == NOTHING && !counts(light_path) {
        return PATH_ENDS;
    }
    if nearest.index == NOTHING {
        let weight = weight_of_endless(header.sun_pdf);
        outcome.radiance += path.throughput * environment(weight, path.ray.direction);
        if ENVIRONMENT {
            let found = environment_look_up(path.ray.direction);
            outcome.radiance += path.throughput * found.xyz * weight_of_environment(found.w);
        }
        return PATH_ENDS;
    }
    let hit = hit_of(nearest, path.ray);
    vertex = interaction_of(hit, -path.ray.direction);
    if materials[hit.material].emitting_sides != 0u && counts(light_path) {
        var weight = 1.0;
        if LIGHT_SAMPLING != BY_CHANCE {
            weight = weight_of_hit(hit);
        }
        outcome.radiance += path.throughput * emitted(vertex) * weight;
    }
    if path.vertices == params.limit {
        outcome.cut = outcome.cut || params.capped == 1u;
        return PATH_ENDS;
    }
    if !scatters(vertex) {
        return PATH_ENDS;
    }
    if BRANCHING && is_diffuse(vertex) && path.forked < params.branching_vertices {
        path.forked += 1u;
        path.throughput /= f32(params.branches);
        fork();
        path.branch = child(path.branch, params.branches, 0u);
    }
    return PATH_SCATTERS;
}

// Samples a light and draws the direction in which the path leaves its vertex; false where it ends.
fn scatter() -> bool {
    let delta = is_delta(vertex);
    if has_cones() && !delta {
        see_cones(vertex);
    }
    if LIGHT_SAMPLING != BY_CHANCE && header.lights > 0u && !delta {
        sample_lights(unit4(sampler_, light_dimension()));
        if CASTERS && CONNECTIONS && header.chains > 0u {
            connect(vertex, unit4(sampler_, connection_dimension()));
        }
    }
    let u = unit4(sampler_, direction_dimension());
    let splitting = splits_here();
    var sample: BsdfSample;
    var deserved = path.throughput * vertex.colour;
    if UNIFORM_DIRECTIONS && !delta {
        sample = sample_uniformly(u.xy);
        deserved = path.throughput;
    } else if has_cones() && is_diffuse(vertex) {
        sample = sample_with_cones(u.xyw);
        path.throughput *= sample.weight;
    } else {
        sample = sample_bsdf(vertex, vec3f(u.xy, select(u.w, ALWAYS_REFRACTED, splitting)));
        path.throughput *= sample.weight;
        deserved = path.throughput;
    }
    if delta || LIGHT_SAMPLING == BY_CHANCE {
        path.direction_pdf = MET_BY_CHANCE;
    } else if LIGHT_SAMPLING == BY_SAMPLING {
        path.direction_pdf = ALREADY_COUNTED;
    } else {
        path.direction_pdf = sample.pdf;
    }
    if CASTERS && CONNECTIONS && delta {
        scatter_on_chain(vertex, sample.wi);
    } else if CASTERS && CONNECTIONS {
        leave_vertex(vertex.point.position, sample.pdf);
    }
    path.from_ = vertex.point.position;
    path.ray = Ray(leaving_towards(vertex.point, sample.wi), sample.wi, FAR);
    if SPLITTING {
        from_camera = from_camera && delta;
    }
    if splitting {
        split();
    }
    return goes_on(delta, deserved, u.z);
}

// A direction of Lambert's lobe or into a cone, weighted by the density of both.
fn sample_with_cones(u: vec3f) -> BsdfSample {
    var wi: vec3f;
    if u.z < cone_share {
        wi = sample_cones(u.z, u.xy);
    } else {
        wi = sample_lambert(vertex, u.xy).wi;
    }
    let lobe = pdf_lambert(max(dot(vertex.normal, wi), 0.0));
    let pdf = pdf_with_cones(wi, lobe);
    // rounding takes a direction at a rim out of its cone, and it may lie below the horizon: then neither draws it
    let weight = shadowed(vertex.normal, vertex.point.normal, wi, lobe / max(pdf, SMALLEST_POSITIVE));
    return BsdfSample(wi, vertex.colour * weight, pdf);
}

// A direction of the tutorial's naive tracer, whatever the surface (Task 2 b); its weight is in the throughput.
fn sample_uniformly(u: vec2f) -> BsdfSample {
    let local = uniform_hemisphere(u);
    // with shading normals above the triangle, where all are that light may come from by any of them
    var above = vertex.normal;
    if SHADING_NORMALS {
        above = facing(vertex.point.normal, vertex.normal);
    }
    let wi = to_world(local, above);
    let bsdf = eval_bsdf(vertex, wi);
    var factor = bsdf.factor * local.z / UNIFORM_HEMISPHERE_PDF;
    if SHADING_NORMALS {
        let cosine = cosine_of(vertex, wi);
        factor = select(0.0, bsdf.factor * cosine / UNIFORM_HEMISPHERE_PDF, cosine > 0.0);
    }
    path.throughput *= bsdf.colour;
    path.throughput *= factor;
    return BsdfSample(wi, bsdf.colour, UNIFORM_HEMISPHERE_PDF);
}

// Counts the vertex and plays roulette.
fn goes_on(delta: bool, deserved: vec3f, u_roulette: f32) -> bool {
    let spared = delta && path.vertices < SPARED_VERTICES;
    path.vertices += 1u;
    let all_counted = path.direction_pdf == ALREADY_COUNTED && all(header.sky == vec3f(0.0));
    if path.vertices == params.limit && all_counted {
        outcome.cut = outcome.cut || params.capped == 1u;
        return false;
    }
    var shared_by = 1.0;
    if BRANCHING {
        for (var i = 0u; i < path.forked; i++) {
            shared_by *= f32(params.branches);
        }
    }
    return survives(deserved, shared_by, spared, u_roulette);
}

// Takes the light of one sample of the lights, unless it is in shadow. Under MIS weighted against meeting the same light
// by chance.
fn sample_lights(u: vec4f) {
    if !counts(light_path) {
        return;
    }
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
    if LIGHT_SAMPLING == BY_BOTH {
        weight = balance(sample.pdf, direction_pdf(vertex, sample.wi, cosine));
    }
    let bsdf = eval_bsdf(vertex, sample.wi);
    outcome.radiance += path.throughput * bsdf.colour * bsdf.factor * (sample.radiance_over_pdf * (cosine * weight));
}

// How much the light of a hit counts, beside the same light sampled.
fn weight_of_hit(hit: Hit) -> f32 {
    var density = 0.0;
    if LIGHT_SAMPLING == BY_BOTH && path.direction_pdf > 0.0 && hit.light != NO_LIGHT {
        density = light_pdf(hit.light, path.from_, hit.point.position);
    }
    let weight = weight_of_meeting(density);
    if CASTERS && CONNECTIONS {
        return weight * weight_of_chain_to_hit(hit);
    }
    return weight;
}

// How much light from where rays hit nothing counts, beside the same light sampled with this density.
fn weight_of_endless(pdf: f32) -> f32 {
    let weight = weight_of_meeting(pdf);
    if CASTERS && CONNECTIONS {
        return weight * weight_of_chain_to_sky(pdf);
    }
    return weight;
}

// The same of a sky that is a picture.
fn weight_of_environment(pdf: f32) -> f32 {
    if LIGHT_SAMPLING == BY_BOTH {
        return weight_of_endless(pdf);
    }
    return weight_of_meeting(pdf);
}

// Russian roulette by what a path has `deserved`; the survivor carries the light of those that did not. `branches` paths
// share what one would carry; one that is `spared` does not end for what it has deserved.
fn survives(deserved: vec3f, branches: f32, spared: bool, u: f32) -> bool {
    var probability = params.probability;
    if params.by_throughput == 1u && !spared {
        probability *= survival(deserved, branches);
    }
    probability = in_steps(probability);
    // nothing is left to carry: the product has underflowed, or the surface was black
    if probability == 0.0 || all(path.throughput == vec3f(0.0)) {
        return false;
    }
    path.throughput /= probability;
    return u < probability;
}
