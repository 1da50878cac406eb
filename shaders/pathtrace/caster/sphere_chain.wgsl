//#import pathtrace/sampling/angles.wgsl
//#import pathtrace/light/spherical_rectangle.wgsl
// Light from a point or a direction to another point by one sphere, off its outside or through it. By symmetry the whole
// ray lies in the plane of both ends and the centre, so that it has one unknown, the angle of incidence, and one convex
// equation. Lengths are in radii. Twin: crates/pathtrace/src/caster/sphere_chain.rs.

// Roots of one chain between two ends at most.
const MOST_ROOTS: u32 = 3u;

// Newton's steps on one branch at most, and the step below which none follows: what it leaves is about its cube.
const MOST_STEPS: u32 = 8u;
const LAST_STEP: f32 = 2e-3;

// Sine of the incidence below which the ratio of two vanishing sines is taken for its limit on the axis.
const NEAR_AXIS: f32 = 1e-3;

const FRAC_PI_2: f32 = 1.57079632679;

// What the sine of an angle is to that of the incidence, at most 1; and 1 - sine^2, known better than that.
struct Ratio {
    sine: f32,
    rest: f32,
}

// One of the roots.
struct Root {
    found: bool,
    // sine and cosine of the angle of incidence
    incidence: vec2f,
    // whether the ray meets the sphere on the other side of the axis than its far end
    crosses: bool,
}

// A chain by one sphere between two ends.
struct SphereChain {
    // at the end that the chain is looked for from, at the other, and inside the sphere
    near: Ratio,
    far: Ratio,
    inside: Ratio,
    // through the sphere; else off its outside
    through: bool,
    // how many times the angle inside counts: 2 or 0
    refractions: f32,
    // derivative of the turn at incidence 0, and the turn at grazing incidence
    first_slope: f32,
    last_turn: f32,
}

// 1 / length, which is at least 1: the angle to the axis at an end so far from the centre, or inside glass of that index.
fn inverse_ratio(length_: f32) -> Ratio {
    let sine = 1.0 / length_;
    return Ratio(sine, (length_ - 1.0) * (length_ + 1.0) * sine * sine);
}

// Of rays that are parallel.
fn zero_ratio() -> Ratio {
    return Ratio(0.0, 1.0);
}

// Cosine of the angle, from that of the incidence.
fn ratio_cosine(ratio: Ratio, cosine: f32) -> f32 {
    return sqrt(ratio.rest + ratio.sine * ratio.sine * cosine * cosine);
}

// The angle, and its first two derivatives by the incidence.
fn ratio_angle(ratio: Ratio, incidence: vec2f) -> vec3f {
    let cosine = ratio_cosine(ratio, incidence.y);
    let inverse = 1.0 / cosine;
    let slope = ratio.sine * inverse;
    let bend = -(slope * ratio.rest) * (inverse * inverse);
    return vec3f(angle_of_sine(ratio.sine * incidence.x, cosine), incidence.y * slope, incidence.x * bend);
}

// The first derivative of the angle alone.
fn ratio_slope(ratio: Ratio, cosine: f32) -> f32 {
    return ratio.sine * cosine / ratio_cosine(ratio, cosine);
}

// Chains between ends with these ratios, in a sphere with this one.
fn sphere_chain(through: bool, near: Ratio, far: Ratio, inside: Ratio) -> SphereChain {
    var chain = SphereChain(near, far, inside, through, select(0.0, 2.0, through), 0.0, 0.0);
    chain.first_slope = turn_slope(chain, 1.0);
    chain.last_turn = turn(chain, FRAC_PI_2, vec2f(1.0, 0.0)).x;
    return chain;
}

// How far a ray of incidence `i` has turned about the centre, between its ends: off the sphere from the direction in which
// the near end lies, through it from the opposite one. Convex in `i`, and 0 at 0. With two derivatives.
fn turn(chain: SphereChain, i: f32, incidence: vec2f) -> vec3f {
    let ends = ratio_angle(chain.near, incidence) + ratio_angle(chain.far, incidence);
    return vec3f(2.0 * i, 2.0, 0.0) - ends - chain.refractions * ratio_angle(chain.inside, incidence);
}

// The first derivative of the turn alone.
fn turn_slope(chain: SphereChain, cosine: f32) -> f32 {
    let ends = ratio_slope(chain.near, cosine) + ratio_slope(chain.far, cosine);
    return 2.0 - ends - chain.refractions * ratio_slope(chain.inside, cosine);
}

// How many roots there may be.
fn roots_at_most(chain: SphereChain) -> u32 {
    return select(1u, MOST_ROOTS, chain.through && chain.first_slope < 0.0);
}

// The root number `index` below roots_at_most for an angle in [0, pi] between the far end and the direction that turns are
// counted from. The first crosses the axis where light goes through; near a caustic there are two more on the far end's
// own side.
fn chain_root(chain: SphereChain, index: u32, angle: f32) -> Root {
    let first = index == 0u;
    let rising = index < 2u;
    let target_ = select(-angle, angle, first);
    let none = Root(false, vec2f(0.0, 1.0), first == chain.through);
    if rising && target_ > chain.last_turn {
        return none;
    }
    let i = solve(chain, target_, rising);
    if i == NO_ROOT {
        return none;
    }
    return Root(true, sin_cos(i), none.crosses);
}

// No incidence. Here alone: lanes have a mask for it.
const NO_ROOT: f32 = -1.0;

// The incidence on the rising or falling branch at which the turn is `target_`; NO_ROOT without one. Each step solves the
// parabola through value, slope and bend, so that a double root costs no more than a single one. Where the parabola misses
// the target it goes to the fold, and if it still misses at the end there is none.
fn solve(chain: SphereChain, target_: f32, rising: bool) -> f32 {
    let side = select(-1.0, 1.0, rising);
    var i = select(0.0, right_of(chain, target_), rising);
    var meets = false;
    for (var steps = 0u; steps < MOST_STEPS; steps++) {
        let at = turn(chain, i, sin_cos(i));
        let rest = at.x - target_;
        let along = side * at.y;
        let square = at.y * at.y - 2.0 * at.z * rest;
        let root = sqrt(max(square, 0.0));
        let met = meets;
        meets = square >= 0.0;
        var step_ = -at.y / at.z;
        if meets {
            let uphill = -2.0 * rest / max(along + root, SMALLEST_POSITIVE);
            step_ = side * select((root - along) / at.z, uphill, along >= 0.0);
        }
        i = clamp(i + step_, 0.0, FRAC_PI_2);
        if abs(step_) < LAST_STEP && (meets || !met) {
            break;
        }
    }
    return select(NO_ROOT, i, meets && (i > 0.0 || target_ == 0.0));
}

// An incidence right of the root on the rising branch, by the tangents of the convex turn at both ends.
fn right_of(chain: SphereChain, target_: f32) -> f32 {
    // the slope at grazing incidence is 2
    let by_last = FRAC_PI_2 - 0.5 * max(chain.last_turn - target_, 0.0);
    return select(by_last, min(by_last, target_ / chain.first_slope), chain.first_slope > 0.0);
}

// Density per solid angle of the ray at the near end, for each that the far end has as the centre sees it, at an end that
// faces the centre and the ray alike. `sin_angle` is the sine of the angle that chain_root took.
fn chain_density(chain: SphereChain, incidence: vec2f, sin_angle: f32) -> f32 {
    let slope = abs(turn_slope(chain, incidence.y));
    // both sines vanish together on the axis
    let sines = select(slope, sin_angle / max(incidence.x, NEAR_AXIS), incidence.x > NEAR_AXIS);
    let cosine = max(incidence.y, SMALLEST_POSITIVE);
    let near = ratio_cosine(chain.near, incidence.y) / (chain.near.sine * chain.near.sine * cosine);
    return sines * slope * near * ratio_cosine(chain.far, incidence.y);
}
