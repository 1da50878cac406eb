//#import pathtrace/bsdf/interaction.wgsl
//#import pathtrace/light/light.wgsl
//#import pathtrace/prepared.wgsl
//#import pathtrace/sampling/sampler.wgsl
// What each bug does, at the place in the walk where the factor belongs that it gets wrong. Densities that weights of
// multiple importance sampling need stay right, so that a bug's error is its own. Twins:
// crates/pathtrace/src/integrator/broken/wrong.rs and bug.rs.

// the bugs that are on: the bit of each number below
override BUGS: u32 = 0xffffu;

const BUG_NO_COSINE: u32 = 0u;
const BUG_NO_PDF: u32 = 1u;
const BUG_WRONG_PDF: u32 = 2u;
const BUG_NO_INVERSE_PI: u32 = 3u;
const BUG_ROULETTE_LOST: u32 = 4u;
const BUG_AREA_MEASURE: u32 = 5u;
const BUG_WIDTH_TWICE: u32 = 6u;
const BUG_THICK_LAMP: u32 = 7u;
const BUG_EMISSION_TWICE: u32 = 8u;
const BUG_BACK_FACE: u32 = 9u;
const BUG_EPSILON: u32 = 10u;
const BUG_CLAMPED: u32 = 11u;
const BUG_ENCODED: u32 = 12u;
const BUG_FLOAT_SEED: u32 = 13u;

// The step by which rays leave surfaces whatever the size of the scene.
const EPSILON: f32 = 0.01;
// Half of the thickness of the box that points on lamps are drawn in.
const HALF_THICKNESS: f32 = 1.0;
// Where samples are cut off.
const WHITE: f32 = 1.0;
// Cosines are at least this where something is divided by them.
const LEAST_COSINE: f32 = 1e-6;
// Bits of a sample's number that an f32 of 2^28 milliseconds has lost.
const LOST_BITS: u32 = 5u;

fn broken(bug: u32) -> bool {
    return (BUGS & (1u << bug)) != 0u;
}

// The cosine of light that was sampled.
fn wrong_cosine(right: f32) -> f32 {
    return select(right, 1.0, broken(BUG_NO_COSINE));
}

// What is made of BSDF x cosine / density of a direction, whose density is `pdf` and would be `others` by the other sampler.
fn wrong_direction_factor(cosine: f32, pdf: f32, others: f32) -> f32 {
    var factor = 1.0;
    if broken(BUG_NO_COSINE) {
        factor /= max(cosine, LEAST_COSINE);
    }
    if broken(BUG_NO_PDF) {
        factor *= pdf;
    } else if broken(BUG_WRONG_PDF) {
        factor *= pdf / max(others, LEAST_COSINE);
    }
    return factor;
}

// What Lambert's BRDF is multiplied by where a light is sampled.
fn wrong_brdf_factor(at: Interaction) -> f32 {
    return select(1.0, 1.0 / FRAC_1_PI, broken(BUG_NO_INVERSE_PI) && is_diffuse(at));
}

// Whether a light is a flat shape.
fn is_flat_lamp(light: u32) -> bool {
    let outline = lights[light].outline;
    return outline == LIGHT_RECTANGLE || outline == LIGHT_TRIANGLE || outline == LIGHT_DISK;
}

// The length of a rectangle's first edge over that of its second; 1 of other lights.
fn width_over_height(light: u32) -> f32 {
    if lights[light].outline != LIGHT_RECTANGLE {
        return 1.0;
    }
    return length(lights[light].u) / length(lights[light].v);
}

// cos / distance^2 of a point on a flat lamp: the density of the point over that of its direction from x.
fn by_area(x: vec3f, sample: LightSample) -> f32 {
    let cosine = max(abs(dot(lights[sample.light].normal, sample.wi)), LEAST_COSINE);
    let to_lamp = sample.end - x;
    return cosine / dot(to_lamp, to_lamp);
}

// The same sample, moved along the lamp's normal.
fn in_a_box(x: vec3f, on_face: LightSample, u: f32) -> LightSample {
    var moved = on_face;
    moved.end = on_face.end + lights[on_face.light].normal * ((u * 2.0 - 1.0) * HALF_THICKNESS);
    moved.wi = normalize(moved.end - x);
    moved.radiance_over_pdf *= by_area(x, moved) / by_area(x, on_face);
    return moved;
}

// Light that was sampled at x; u is a random number to spare.
fn wrong_light(x: vec3f, right: LightSample, u: f32) -> LightSample {
    if right.pdf == 0.0 || !is_flat_lamp(right.light) {
        return right;
    }
    var sample = right;
    if broken(BUG_THICK_LAMP) {
        sample = in_a_box(x, sample, u);
    }
    if broken(BUG_AREA_MEASURE) {
        sample.radiance_over_pdf /= by_area(x, sample);
    }
    if broken(BUG_WIDTH_TWICE) {
        sample.radiance_over_pdf *= width_over_height(sample.light);
    }
    return sample;
}

// The surface as it is met.
fn wrong_seen(right: Interaction) -> Interaction {
    var seen = right;
    if broken(BUG_BACK_FACE) && is_diffuse(right) {
        seen.normal = facing(right.normal, right.point.normal);
    }
    return seen;
}

// Where a ray begins that leaves the surface in this unit direction.
fn wrong_leaving_towards(point: SurfacePoint, direction: vec3f) -> vec3f {
    if broken(BUG_EPSILON) {
        return point.position + point.normal * copysign(EPSILON, dot(direction, point.normal));
    }
    return leaving_towards(point, direction);
}

// Whether something stands between a point and what shines on it.
fn wrong_in_shadow(at: SurfacePoint, sample: LightSample) -> bool {
    if !broken(BUG_THICK_LAMP) && !broken(BUG_BACK_FACE) && !broken(BUG_EPSILON) {
        return in_shadow(at, sample);
    }
    // between places where none should be anything may stand, the lamp itself too
    let start = wrong_leaving_towards(at, sample.wi);
    if sample.endless {
        return meets_anything(Ray(start, sample.wi, FAR));
    }
    return meets_anything(Ray(start, sample.end - start, SHADOW_END));
}

// The random numbers of a sample.
fn wrong_numbers(right: Sampler) -> Sampler {
    var numbers = right;
    if broken(BUG_FLOAT_SEED) {
        numbers.sample = (right.sample >> LOST_BITS) << LOST_BITS;
    }
    return numbers;
}

// What the sample brings to its pixel.
fn wrong_sample(right: vec3f) -> vec3f {
    var brought = right;
    if broken(BUG_CLAMPED) {
        brought = min(brought, vec3f(WHITE));
    }
    if broken(BUG_ENCODED) {
        brought = sqrt(brought);
    }
    return brought;
}
