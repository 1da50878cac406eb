//#import denoise/a_trous/picture.wgsl
// Light gets its albedo back, three numbers a pixel. Twin: crates/denoise/src/a_trous.rs, which ends so.

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> albedos: array<f32>;
@group(0) @binding(2) var<storage, read> light: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> colors: array<f32>;

@compute @workgroup_size(16, 8)
fn finish(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= params.width || id.y >= params.height {
        return;
    }
    let pixel = id.y * params.width + id.x;
    for (var channel = 0u; channel < 3u; channel++) {
        let albedo = max(sanitized(albedos[3u * pixel + channel]), LEAST_ALBEDO);
        colors[3u * pixel + channel] = light[pixel][channel] * albedo;
    }
}
