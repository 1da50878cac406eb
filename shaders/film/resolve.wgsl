// The box filter: the mean of the picture's sub-pixel passes. Texels are bits of f32, which every backend can draw.
// No twin: the rasteriser runs on devices alone.

@group(0) @binding(0) var passes: texture_2d_array<u32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    // one triangle that covers the picture
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4u {
    let count = textureNumLayers(passes);
    var sum = vec4f(0.0);
    for (var layer = 0u; layer < count; layer++) {
        sum += bitcast<vec4f>(textureLoad(passes, vec2i(at.xy), layer, 0));
    }
    return bitcast<vec4u>(sum / f32(count));
}
