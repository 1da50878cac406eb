//#import denoise/a_trous/picture.wgsl
// One level of the filter, and the variance where nobody knows it: a thread is a pixel. Twin:
// crates/denoise/src/a_trous/pass.rs.

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> guides: array<vec4u>;
@group(0) @binding(2) var<storage, read> slopes: array<vec2f>;
// red, green and blue, and the variance of the luminance
@group(0) @binding(3) var<storage, read> light: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> next: array<vec4f>;

const SIGMA_DEPTH: f32 = 1.0;
const SIGMA_LUMINANCE: f32 = 4.0;
const LOG2_SIGMA_NORMAL: u32 = 7u;
const SIGMA_ALBEDO: f32 = 0.15;

const LEAST_DEPTH: f32 = 1e-4;
const LEAST_DIFFERENCE: f32 = 1e-30;
const LEAST_DEVIATION: f32 = 1e-6;

// A cubic B-spline's values, half of the kernel.
const SPLINE_0: f32 = 0.375;
const SPLINE_1: f32 = 0.25;
const SPLINE_2: f32 = 0.0625;

// What a pixel's taps are held against.
struct Place {
    at: vec2i,
    guide: Guide,
    slopes: vec2f,
}

@compute @workgroup_size(16, 8)
fn level(@builtin(global_invocation_id) id: vec3u) {
    if is_inside(vec2i(id.xy)) {
        let place = place_at(vec2i(id.xy));
        next[index(place.at)] = filtered(place, i32(params.step));
    }
}

@compute @workgroup_size(16, 8)
fn moments(@builtin(global_invocation_id) id: vec3u) {
    if is_inside(vec2i(id.xy)) {
        let place = place_at(vec2i(id.xy));
        let own = light[index(place.at)].rgb;
        next[index(place.at)] = vec4f(own, variance_among_neighbours(place, luminance(own)));
    }
}

fn is_inside(at: vec2i) -> bool {
    return all(at >= vec2i(0)) && all(at < vec2i(vec2u(params.width, params.height)));
}

fn index(at: vec2i) -> u32 {
    return u32(at.y) * params.width + u32(at.x);
}

fn place_at(at: vec2i) -> Place {
    return Place(at, unpacked_guide(guides[index(at)]), slopes[index(at)]);
}

// How alike the normals are (equation 4), and how unlike the depths (3) and the albedos, as a negative exponent.
fn likeness(place: Place, tap: u32, offset: vec2i) -> vec2f {
    let guide = unpacked_guide(guides[tap]);
    let both_miss = all(place.guide.normal == vec3f(0.0)) && all(guide.normal == vec3f(0.0));
    var alike = select(max(dot(place.guide.normal, guide.normal), 0.0), 1.0, both_miss);
    for (var i = 0u; i < LOG2_SIGMA_NORMAL; i++) {
        alike *= alike;
    }
    let expected = dot(place.slopes, vec2f(abs(offset)));
    let least = abs(place.guide.depth) * LEAST_DEPTH + LEAST_DIFFERENCE;
    let unlike = abs(guide.depth - place.guide.depth) / (expected * SIGMA_DEPTH + least);
    let albedo = guide.albedo - place.guide.albedo;
    return vec2f(alike, -unlike - dot(albedo, albedo) / (SIGMA_ALBEDO * SIGMA_ALBEDO));
}

// Light and its variance, whose weights are squared (equations 1, 2).
fn filtered(place: Place, stride: i32) -> vec4f {
    let own = light[index(place.at)];
    let own_luminance = luminance(own.rgb);
    let scale = -1.0 / (sqrt(blurred_variance(place.at)) * SIGMA_LUMINANCE + LEAST_DEVIATION);
    let centre = SPLINE_0 * SPLINE_0;
    var sum = own * vec4f(vec3f(centre), centre * centre);
    var weights = centre;
    for (var j = -2; j <= 2; j++) {
        for (var i = -2; i <= 2; i++) {
            let offset = vec2i(i, j) * stride;
            if (i == 0 && j == 0) || !is_inside(place.at + offset) {
                continue;
            }
            let tap = index(place.at + offset);
            let like = likeness(place, tap, offset);
            let other = light[tap];
            let unlike = like.y + abs(luminance(other.rgb) - own_luminance) * scale;
            let weight = like.x * exp(unlike) * spline(abs(i)) * spline(abs(j));
            sum += other * vec4f(vec3f(weight), weight * weight);
            weights += weight;
        }
    }
    return sum / vec4f(vec3f(weights), weights * weights);
}

fn spline(distance: i32) -> f32 {
    return select(select(SPLINE_2, SPLINE_1, distance == 1), SPLINE_0, distance == 0);
}

// A mean over 3 x 3 pixels, in equation 5: the variance is an estimate, and itself noisy.
fn blurred_variance(at: vec2i) -> f32 {
    let last = vec2i(vec2u(params.width, params.height)) - 1;
    var sum = 0.0;
    for (var j = -1; j <= 1; j++) {
        for (var i = -1; i <= 1; i++) {
            let share = 0.25 / f32((1 + abs(i)) * (1 + abs(j)));
            sum += light[index(clamp(at + vec2i(i, j), vec2i(0), last))].a * share;
        }
    }
    return sum;
}

// Among neighbours of the same surface, 7 x 7 pixels, around the pixel's own value.
fn variance_among_neighbours(place: Place, own: f32) -> f32 {
    var first = 0.0;
    var second = 0.0;
    var weights = 1.0;
    for (var j = -3; j <= 3; j++) {
        for (var i = -3; i <= 3; i++) {
            let offset = vec2i(i, j);
            if (i == 0 && j == 0) || !is_inside(place.at + offset) {
                continue;
            }
            let tap = index(place.at + offset);
            let like = likeness(place, tap, offset);
            let weight = like.x * exp(like.y);
            let off = luminance(light[tap].rgb) - own;
            first += weight * off;
            second += weight * off * off;
            weights += weight;
        }
    }
    let mean = first / weights;
    return max(second / weights - mean * mean, 0.0);
}
