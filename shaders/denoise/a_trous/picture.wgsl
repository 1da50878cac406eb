// What the passes know of each pixel. Sixteen bytes guide a tap: the normal's components in sixteen bits each, albedo
// likewise, and depth in full; slopes are asked for at the pixel itself alone, and lie apart. Twin:
// crates/denoise/src/a_trous/picture.rs, whose lanes read each kind of numbers for itself.

struct Params {
    width: u32,
    height: u32,
    // pixels from tap to tap
    step: u32,
    // 1 where variance comes with the picture
    knows_variance: u32,
}

// Of the normal 0 where nothing is hit.
struct Guide {
    normal: vec3f,
    albedo: vec3f,
    depth: f32,
}

// Light is divided by this albedo at least.
const LEAST_ALBEDO: f32 = 0.05;

fn packed_guide(guide: Guide) -> vec4u {
    let z_and_blue = (pack2x16snorm(vec2f(guide.normal.z, 0.0)) & 0xffffu) | (pack2x16unorm(vec2f(0.0, guide.albedo.b)));
    let red_and_green = pack2x16unorm(guide.albedo.rg);
    return vec4u(pack2x16snorm(guide.normal.xy), z_and_blue, red_and_green, bitcast<u32>(guide.depth));
}

// With a normal of length 1 again: rounded ones would count as unlike themselves.
fn unpacked_guide(words: vec4u) -> Guide {
    let rounded = vec3f(unpack2x16snorm(words.x), unpack2x16snorm(words.y).x);
    let normal = rounded * inverseSqrt(max(dot(rounded, rounded), 1e-12));
    let albedo = vec3f(unpack2x16unorm(words.z), unpack2x16unorm(words.y).y);
    return Guide(normal, albedo, bitcast<f32>(words.w));
}

// By its bits: a compiler may take for granted that numbers are finite.
fn is_finite(number: f32) -> bool {
    return (bitcast<u32>(number) & 0x7f800000u) != 0x7f800000u;
}

// What is not finite becomes 0, as does what is negative.
fn sanitized(number: f32) -> f32 {
    return select(0.0, max(number, 0.0), is_finite(number));
}

// What light is divided by.
fn divisor(albedo: vec3f) -> vec3f {
    return max(albedo, vec3f(LEAST_ALBEDO));
}

fn luminance(rgb: vec3f) -> f32 {
    return dot(rgb, vec3f(0.2126, 0.7152, 0.0722));
}
