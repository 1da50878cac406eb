//#import pathtrace/scene.wgsl
// Arithmetic with more bits than a float has, where the processor uses f64. A shader's compiler may fuse, reorder and
// cancel sums, which breaks the usual algorithms. Here products have few enough bits to be exact, fused or not, and
// every rounded sum passes through `opaque`, which no compiler sees through. No twin: the processor has f64.

// A float that is not 0 is larger, whatever its sign, unless it is so small that devices may take it for 0.
const SMALLEST_POSITIVE: f32 = 1.1754944e-38;

// The same vector, as far as a compiler knows another one.
fn opaque(x: vec3f) -> vec3f {
    return bitcast<vec3f>(bitcast<vec3u>(x) ^ vec3u(header.zero));
}

// Sums of two floats each, rounded and the rest.
struct TwoSum {
    sum: vec3f,
    rest: vec3f,
}

// Dekker, "A floating-point technique for extending the available precision" (1971).
fn two_sum(a: vec3f, b: vec3f) -> TwoSum {
    let a_is_larger = abs(a) >= abs(b);
    let larger = select(b, a, a_is_larger);
    let smaller = select(a, b, a_is_larger);
    let sum = opaque(larger + smaller);
    return TwoSum(sum, smaller - opaque(sum - larger));
}

// The upper half of the bits: products of halves are exact.
fn upper_half(x: vec3f) -> vec3f {
    return bitcast<vec3f>(bitcast<vec3u>(x) & vec3u(0xfffff000u));
}

// (a + a_low) . (b + b_low), off by about 2^-34 of the sum of |a_i b_i|.
fn exact_dot(a: vec3f, a_low: vec3f, b: vec3f, b_low: vec3f) -> f32 {
    let a1 = upper_half(a);
    let b1 = upper_half(b);
    let a2 = a - a1;
    let b2 = b - b1;
    let first = a1 * b1;
    let second = a1 * b2 + a2 * b1;
    let third = a2 * b2 + a_low * b + a * b_low;
    let two = two_sum(vec3f(first.x, second.x, third.x), vec3f(first.y, second.y, third.y));
    let three = two_sum(two.sum, vec3f(first.z, second.z, third.z));
    let rest = two.rest + three.rest;
    return three.sum.x + (three.sum.y + (rest.x + (three.sum.z + rest.y)));
}

// a x b, off by about 2^-34 of the sums of |a_i b_j|.
fn exact_cross(a: TwoSum, b: TwoSum) -> TwoSum {
    let a1 = upper_half(a.sum);
    let b1 = upper_half(b.sum);
    let a2 = a.sum - a1;
    let b2 = b.sum - b1;
    let first = two_sum(a1.yzx * b1.zxy, -(a1.zxy * b1.yzx));
    let second = two_sum(a1.yzx * b2.zxy + a2.yzx * b1.zxy, -(a1.zxy * b2.yzx + a2.zxy * b1.yzx));
    let third = cross(a2, b2) + cross(a.sum, b.rest) + cross(a.rest, b.sum);
    let both = two_sum(first.sum, second.sum);
    return two_sum(both.sum, both.rest + (first.rest + (second.rest + third)));
}

// v without its length. A device's root and quotient may be off by some ulp, always to the same side: normals and
// directions that are too short by one turn a ray a little at each of a hundred reflections inside a glass ball, until
// it cannot leave any more. So one step of Newton's follows, as a small correction that is added: a factor near 1 would
// itself be rounded to one side.
fn unit_vector(v: vec3f) -> vec3f {
    let rough = v / sqrt(dot(v, v));
    return rough + rough * (0.5 - 0.5 * dot(rough, rough));
}

// Below this share of the sum of |a_i b_i| a plain dot product is not good to 20 bits. Here alone: f64 is.
const CANCELLED: f32 = 0.25;

// `size` with the sign of `sign_of`.
fn copysign(size: f32, sign_of: f32) -> f32 {
    return bitcast<f32>((bitcast<u32>(size) & 0x7fffffffu) | (bitcast<u32>(sign_of) & 0x80000000u));
}
