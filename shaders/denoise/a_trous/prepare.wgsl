//#import denoise/a_trous/picture.wgsl
// From a picture as it comes, three numbers a pixel, to what the passes read: guides, and light without albedo. Twin:
// crates/denoise/src/a_trous.rs, with crates/denoise/src/a_trous/picture.rs, which do this on the way into tables.

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> colors: array<f32>;
@group(0) @binding(2) var<storage, read> normals: array<f32>;
@group(0) @binding(3) var<storage, read> albedos: array<f32>;
@group(0) @binding(4) var<storage, read> depths: array<f32>;
@group(0) @binding(5) var<storage, read> variances: array<f32>;
@group(0) @binding(6) var<storage, read_write> guides: array<vec4u>;
@group(0) @binding(7) var<storage, read_write> slopes: array<vec2f>;
@group(0) @binding(8) var<storage, read_write> light: array<vec4f>;

// Light above this counts as this much: squares of it are still finite.
const MOST_LIGHT: f32 = 1e15;

@compute @workgroup_size(16, 8)
fn prepare(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= params.width || id.y >= params.height {
        return;
    }
    let pixel = id.y * params.width + id.x;
    let albedo = vec3f(sanitized(albedos[3u * pixel]), sanitized(albedos[3u * pixel + 1u]), sanitized(albedos[3u * pixel + 2u]));
    guides[pixel] = packed_guide(Guide(normal_at(pixel), min(albedo, vec3f(1.0)), depth_at(pixel)));
    let across = slope(pixel, 1u, id.x > 0u, id.x + 1u < params.width);
    let down = slope(pixel, params.width, id.y > 0u, id.y + 1u < params.height);
    slopes[pixel] = vec2f(across, down);
    light[pixel] = light_at(pixel, divisor(albedo));
}

// 0 where nothing is hit.
fn normal_at(pixel: u32) -> vec3f {
    let normal = vec3f(normals[3u * pixel], normals[3u * pixel + 1u], normals[3u * pixel + 2u]);
    let square = dot(normal, normal);
    let is_direction = is_finite(square) && square > 0.0;
    return select(vec3f(0.0), normal * inverseSqrt(square), is_direction);
}

fn depth_at(pixel: u32) -> f32 {
    let depth = depths[pixel];
    return select(0.0, depth, is_finite(depth) && any(normal_at(pixel) != vec3f(0.0)));
}

// The flatter of the slopes to both sides: the other may be that of an edge.
fn slope(pixel: u32, stride: u32, before: bool, behind: bool) -> f32 {
    let depth = depth_at(pixel);
    if before && behind {
        return min(abs(depth_at(pixel - stride) - depth), abs(depth_at(pixel + stride) - depth));
    } else if before {
        return abs(depth_at(pixel - stride) - depth);
    } else if behind {
        return abs(depth_at(pixel + stride) - depth);
    }
    return 0.0;
}

fn light_at(pixel: u32, albedo: vec3f) -> vec4f {
    let color = vec3f(sanitized(colors[3u * pixel]), sanitized(colors[3u * pixel + 1u]), sanitized(colors[3u * pixel + 2u]));
    let most = vec3f(MOST_LIGHT);
    // twice, so that nothing is beyond all numbers on the way
    let rgb = min(min(color, most) / albedo, most);
    var variance = 0.0;
    if params.knows_variance == 1u {
        let share = luminance(albedo);
        variance = sanitized(variances[pixel] / (share * share));
    }
    return vec4f(rgb, variance);
}
