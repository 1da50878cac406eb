//#import pathtrace/light/light.wgsl
//#import pathtrace/intersect/surface_point.wgsl
//#import pathtrace/sampling/warp.wgsl
//#import pathtrace/scene.wgsl
// Light as it leaves what shines: a light, a point of it or of the scene's disc, and a direction, with the power that
// goes along. Half of the photons are aimed at the spheres around casters, and the density is that of the mixture. Twin:
// crates/pathtrace/src/light/emission.rs. Mirror of the structs: crates/pathtrace/src/drive/gpu/photon_data.rs.

struct EmissionHeader {
    // the sphere around the scene
    center: vec3f,
    radius: f32,
    // of a sky of one colour, which light sampling leaves to chance and which is the last of the emitters
    sky: vec3f,
    // rows of what shines: running sum of the probabilities, and the probability
    emitters: u32,
    // rows behind them of what focuses light: centre and radius of a sphere around it
    casters: u32,
}

struct Emission {
    header: EmissionHeader,
    rows: array<vec4f>,
}

// Share of the photons that are aimed at casters, where there are any. Here alone: the processor has what is seen too.
const AIMED: f32 = 0.5;

// Stands for a caster at which nothing is aimed. Here alone: the processor has options.
const NOT_AIMED: u32 = 0xffffffffu;

// A photon as it leaves a light; without power where nothing leaves that way.
struct Emitted {
    ray: Ray,
    // power over the density of the choices
    power: vec3f,
}

// Numbers in [0, 1) that choose a photon.
struct EmissionChoice {
    light: f32,
    // whether to aim, and at what
    aim: f32,
    // which side of what shines on both
    side: f32,
    // a point of the light, or a direction towards the sun or the sky
    place: vec2f,
    // the direction from there, or a point of the disc through which light from far away comes
    way: vec2f,
}

// A direction from a point, with its density.
struct AimedDirection {
    direction: vec3f,
    pdf: f32,
}

@group(1) @binding(1) var<storage, read> emission: Emission;

// Centre and radius.
fn caster(index: u32) -> vec4f {
    return emission.rows[emission.header.emitters + index];
}

fn emit(choice: EmissionChoice) -> Emitted {
    if emission.header.emitters == 0u {
        return Emitted(Ray(vec3f(0.0), vec3f(0.0), 0.0), vec3f(0.0));
    }
    let emitter = choose_emitter(choice.light);
    var emitted = emitted_by(emitter, choice);
    emitted.power /= emission.rows[emitter].y;
    // by their bits: shaders may take for granted that no float is infinite or NaN
    let exponents = bitcast<vec3u>(emitted.power) & vec3u(0x7f800000u);
    let finite = all(exponents != vec3u(0x7f800000u));
    emitted.power = select(vec3f(0.0), emitted.power, finite);
    return emitted;
}

// The first whose running sum exceeds u; the last sum may be rounded to below 1.
fn choose_emitter(u: f32) -> u32 {
    var low = 0u;
    var high = emission.header.emitters - 1u;
    while low < high {
        let middle = (low + high) / 2u;
        if emission.rows[middle].x <= u {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

fn emitted_by(emitter: u32, choice: EmissionChoice) -> Emitted {
    if emitter >= header.lights {
        let towards = cone(ALL_DIRECTIONS, choice.place);
        return coming_from_afar(towards, emission.header.sky * (2.0 / UNIFORM_HEMISPHERE_PDF), choice);
    }
    let light = lights[emitter];
    if BALL_LIGHTS && light.outline == LIGHT_BALL {
        let point = on_sphere(light.position, light.area, cone(ALL_DIRECTIONS, choice.place));
        return leaving_surface(point, light, 2.0 * light.area * light.area / UNIFORM_HEMISPHERE_PDF, choice);
    }
    if POINT_LIGHTS && light.outline == LIGHT_POINT {
        let aimed = aimed_direction(light.position, cone(ALL_DIRECTIONS, choice.way), vec3f(0.0), choice);
        return Emitted(Ray(light.position, aimed.direction, FAR), light.radiance / aimed.pdf);
    }
    if SUN && light.outline == LIGHT_SUN {
        let sample = sun_sample(light, choice.place);
        return coming_from_afar(sample.wi, sample.radiance_over_pdf, choice);
    }
    if ENVIRONMENT && light.outline == LIGHT_ENVIRONMENT {
        let sample = environment_sample(choice.place);
        return coming_from_afar(sample.wi, sample.radiance_over_pdf, choice);
    }
    return leaving_surface(flat_point(light, choice.place), light, light.area, choice);
}

fn leaving_surface(at: SurfacePoint, light: Light, area: f32, choice: EmissionChoice) -> Emitted {
    let two_sided = light.two_sided == 1u;
    let sides = select(1.0, 2.0, two_sided);
    let normal = select(at.normal, -at.normal, two_sided && choice.side < 0.5);
    let by_cosine = to_world(cosine_hemisphere(choice.way), normal);
    let aimed = aimed_direction(at.position, by_cosine, normal, choice);
    let cosine = max(dot(aimed.direction, normal), 0.0);
    let power = light.radiance * (cosine * area * sides / aimed.pdf);
    return Emitted(Ray(leaving_towards(at, aimed.direction), aimed.direction, FAR), power);
}

// Density of directions that are not aimed: all alike from a point light, whose normal is zero, and else by the cosine.
fn pdf_elsewhere(direction: vec3f, normal: vec3f) -> f32 {
    let by_cosine = max(dot(direction, normal), 0.0) * FRAC_1_PI;
    return select(by_cosine, 0.5 * UNIFORM_HEMISPHERE_PDF, all(normal == vec3f(0.0)));
}

// A direction from a point: `elsewhere`, or one towards a caster that the point lies outside of.
fn aimed_direction(start: vec3f, elsewhere: vec3f, normal: vec3f, choice: EmissionChoice) -> AimedDirection {
    var cones = 0u;
    for (var i = 0u; i < emission.header.casters; i++) {
        cones += select(0u, 1u, lies_outside(start, caster(i)));
    }
    let share = select(AIMED, 0.0, cones == 0u);
    let aim = aim_at(cones, share, choice.aim);
    let direction = direction_of_aim(start, elsewhere, aim, choice.way);
    var aimed = 0.0;
    var passed = 0u;
    for (var i = 0u; i < emission.header.casters; i++) {
        if lies_outside(start, caster(i)) {
            aimed += pdf_of_cone(cone_from(start, caster(i)), direction, passed == aim);
            passed += 1u;
        }
    }
    let pdf = (1.0 - share) * pdf_elsewhere(direction, normal) + share * aimed / f32(max(cones, 1u));
    return AimedDirection(direction, pdf);
}

// Towards the caster of this number among those that the point lies outside of.
fn direction_of_aim(start: vec3f, elsewhere: vec3f, aim: u32, u: vec2f) -> vec3f {
    var passed = 0u;
    for (var i = 0u; i < emission.header.casters; i++) {
        if !lies_outside(start, caster(i)) {
            continue;
        }
        if passed == aim {
            let filled = cone_from(start, caster(i));
            return to_world(cone(filled.w, u), filled.xyz);
        }
        passed += 1u;
    }
    return elsewhere;
}

// By the chord, which stays exact for small cones; rounding must not put what was `drawn` there outside.
fn pdf_of_cone(filled: vec4f, direction: vec3f, drawn: bool) -> f32 {
    let chord = direction - filled.xyz;
    let inside = drawn || dot(chord, chord) < 2.0 * filled.w;
    return select(0.0, cone_pdf(filled.w), inside);
}

// At which of so many casters a photon is aimed, or NOT_AIMED.
fn aim_at(casters: u32, share: f32, u: f32) -> u32 {
    if u >= share {
        return NOT_AIMED;
    }
    return min(u32(u / share * f32(casters)), casters - 1u);
}

// A photon from the sun or the sky, on the disc that the scene fills as seen from there, or on that of a caster.
fn coming_from_afar(towards: vec3f, radiance_over_pdf: vec3f, choice: EmissionChoice) -> Emitted {
    let across = orthonormal_basis(towards);
    let casters = emission.header.casters;
    let share = select(AIMED, 0.0, casters == 0u);
    let aim = aim_at(casters, share, choice.aim);
    var disc = vec3f(0.0, 0.0, emission.header.radius);
    if aim != NOT_AIMED {
        disc = disc_of(caster(aim), across);
    }
    let place = disc.xy + disc.z * disk(choice.way).xy;
    var aimed = 0.0;
    for (var i = 0u; i < casters; i++) {
        let other = disc_of(caster(i), across);
        let off = place - other.xy;
        let inside = i == aim || dot(off, off) < other.z * other.z;
        aimed += select(0.0, FRAC_1_PI / (other.z * other.z), inside);
    }
    let everywhere = FRAC_1_PI / (emission.header.radius * emission.header.radius);
    let pdf = (1.0 - share) * everywhere + share * aimed / f32(max(casters, 1u));
    // a caster's sphere may reach out of the scene's: twice its radius is outside of both
    let above = emission.header.center + towards * (2.0 * emission.header.radius);
    let origin = above + across.s * place.x + across.t * place.y;
    return Emitted(Ray(origin, -towards, FAR), radiance_over_pdf / pdf);
}

// Middle and radius of the disc that a caster's sphere fills as seen from far away, from the scene's middle.
fn disc_of(sphere: vec4f, across: Basis) -> vec3f {
    let from_middle = sphere.xyz - emission.header.center;
    return vec3f(dot(from_middle, across.s), dot(from_middle, across.t), sphere.w);
}

fn lies_outside(start: vec3f, sphere: vec4f) -> bool {
    let to_center = sphere.xyz - start;
    return sqrt(dot(to_center, to_center)) > sphere.w;
}

// Axis and 1 - cos of the cone that a sphere fills as seen from a point outside.
fn cone_from(start: vec3f, sphere: vec4f) -> vec4f {
    let to_center = sphere.xyz - start;
    let distance = sqrt(dot(to_center, to_center));
    let cosine = sqrt((distance - sphere.w) * (distance + sphere.w)) / distance;
    let sine = sphere.w / distance;
    return vec4f(to_center / distance, sine * sine / (1.0 + cosine));
}
