//#import pathtrace/intersect/ray.wgsl
//#import pathtrace/sampling/warp.wgsl
// What photons are aimed at: spheres around what focuses light and around what the camera sees. The density is that of
// the mixture of all spheres and of no aim at all. Twin: crates/pathtrace/src/light/aim.rs. Mirror of the structs:
// crates/pathtrace/src/drive/gpu/photon_data.rs.

struct EmissionHeader {
    // the sphere around the scene
    center: vec3f,
    radius: f32,
    // of a sky of one colour, which light sampling leaves to chance and which is the last of the emitters
    sky: vec3f,
    // rows of what shines: running sum of the probabilities, and the probability
    emitters: u32,
    // of what is aimed at there are two rows each behind them: centre and radius of a sphere, and its share of the photons
    targets: u32,
}

struct Emission {
    header: EmissionHeader,
    rows: array<vec4f>,
}

// 1 - cos of the narrowest cone that is aimed at: rounding of its directions is a hundredth of its width.
const NARROWEST_AIM: f32 = 2e-11;

// Stands for no sphere. Here alone: the processor has options.
const NOT_AIMED: u32 = 0xffffffffu;

// Which sphere is aimed at, and the share that is left for none.
struct Chosen {
    index: u32,
    not_aimed: f32,
}

// A direction from a point, with its density.
struct AimedDirection {
    direction: vec3f,
    pdf: f32,
}

// A point of a plane, with its density.
struct AimedPlace {
    place: vec2f,
    pdf: f32,
}

@group(1) @binding(1) var<storage, read> emission: Emission;

// Centre and radius.
fn sphere_of(index: u32) -> vec4f {
    return emission.rows[emission.header.emitters + 2u * index];
}

fn share_of(index: u32) -> f32 {
    return emission.rows[emission.header.emitters + 2u * index + 1u].x;
}

// A direction from a point of a surface with this normal, or from a point in the air if it is zero: `elsewhere`, or one
// towards a sphere. The share of those that hold the point, or lie behind its surface, flies without aim.
fn aimed_direction(start: vec3f, normal: vec3f, elsewhere: vec3f, aim: f32, way: vec2f) -> AimedDirection {
    let chosen = chosen_cone(start, normal, aim);
    var direction = elsewhere;
    if chosen.index != NOT_AIMED {
        let filled = cone_from(start, sphere_of(chosen.index));
        direction = to_world(cone(filled.w, way), filled.xyz);
    }
    var pdf = 0.0;
    for (var i = 0u; i < emission.header.targets; i++) {
        let filled = cone_towards(start, normal, i);
        if filled.w > 0.0 {
            pdf += share_of(i) * pdf_of_cone(filled, direction, i == chosen.index);
        }
    }
    return AimedDirection(direction, chosen.not_aimed * pdf_elsewhere(direction, normal) + pdf);
}

// The cone that a number in [0, 1) chooses among those that there are.
fn chosen_cone(start: vec3f, normal: vec3f, u: f32) -> Chosen {
    var sum = 0.0;
    var index = NOT_AIMED;
    for (var i = 0u; i < emission.header.targets; i++) {
        if cone_towards(start, normal, i).w > 0.0 {
            sum += share_of(i);
            index = select(index, i, index == NOT_AIMED && u < sum);
        }
    }
    return Chosen(index, 1.0 - sum);
}

// Density of directions that are not aimed: all alike from a point in the air, and else by the cosine.
fn pdf_elsewhere(direction: vec3f, normal: vec3f) -> f32 {
    let by_cosine = max(dot(direction, normal), 0.0) * FRAC_1_PI;
    return select(by_cosine, 0.5 * UNIFORM_HEMISPHERE_PDF, all(normal == vec3f(0.0)));
}

// By the chord, which stays exact for small cones; rounding must not put what was `drawn` there outside.
fn pdf_of_cone(filled: vec4f, direction: vec3f, drawn: bool) -> f32 {
    let chord = direction - filled.xyz;
    let inside = drawn || dot(chord, chord) < 2.0 * filled.w;
    return select(0.0, cone_pdf(filled.w), inside);
}

// Axis and 1 - cos of the cone that a sphere fills as seen from a point of a surface; 0 where there is none, or behind it.
fn cone_towards(start: vec3f, normal: vec3f, index: u32) -> vec4f {
    let sphere = sphere_of(index);
    let to_center = sphere.xyz - start;
    let faced = all(normal == vec3f(0.0)) || dot(to_center, normal) > -sphere.w;
    if !faced || sqrt(dot(to_center, to_center)) <= sphere.w {
        return vec4f(0.0);
    }
    let filled = cone_from(start, sphere);
    return select(vec4f(0.0), filled, filled.w > NARROWEST_AIM);
}

// The same of any sphere that the point lies outside of.
fn cone_from(start: vec3f, sphere: vec4f) -> vec4f {
    let to_center = sphere.xyz - start;
    let distance = sqrt(dot(to_center, to_center));
    let cosine = sqrt((distance - sphere.w) * (distance + sphere.w)) / distance;
    let sine = sphere.w / distance;
    return vec4f(to_center / distance, sine * sine / (1.0 + cosine));
}

// A point of the plane through the middle of the scene with these two axes: one of the disc that the scene fills as seen
// along its normal, or one of a sphere's. Relative to the scene's middle.
fn aimed_place(across: Basis, aim: f32, way: vec2f) -> AimedPlace {
    let chosen = chosen_disc(aim);
    var disc = vec3f(0.0, 0.0, emission.header.radius);
    if chosen.index != NOT_AIMED {
        disc = disc_of(sphere_of(chosen.index), across);
    }
    let place = disc.xy + disc.z * disk(way).xy;
    var pdf = 0.0;
    for (var i = 0u; i < emission.header.targets; i++) {
        let other = disc_of(sphere_of(i), across);
        let off = place - other.xy;
        if i == chosen.index || dot(off, off) < other.z * other.z {
            pdf += share_of(i) * FRAC_1_PI / (other.z * other.z);
        }
    }
    let everywhere = FRAC_1_PI / (emission.header.radius * emission.header.radius);
    return AimedPlace(place, chosen.not_aimed * everywhere + pdf);
}

// The disc that a number in [0, 1) chooses among those that are wider than a point.
fn chosen_disc(u: f32) -> Chosen {
    var sum = 0.0;
    var index = NOT_AIMED;
    for (var i = 0u; i < emission.header.targets; i++) {
        if sphere_of(i).w > 0.0 {
            sum += share_of(i);
            index = select(index, i, index == NOT_AIMED && u < sum);
        }
    }
    return Chosen(index, 1.0 - sum);
}

// Middle and radius of the disc that a sphere fills as seen from far away, from the scene's middle.
fn disc_of(sphere: vec4f, across: Basis) -> vec3f {
    let from_middle = sphere.xyz - emission.header.center;
    return vec3f(dot(from_middle, across.s), dot(from_middle, across.t), sphere.w);
}
