//#import raster/frame.wgsl
//#import raster/repair/bounce.wgsl
// The mean of gathered light over the square of pixels that took all patches between them, on one surface. No twin: the
// rasteriser runs on devices alone.

// pixels along a side of the square
override STRIDE: u32 = 4u;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    // one triangle that covers the picture
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4u {
    let middle = vec2i(at.xy);
    let here = textureLoad(bounce_places, middle, 0);
    let p = bitcast<vec3f>(here.xyz);
    let n = unpacked_direction(here.w);
    let last = vec2i(textureDimensions(bounce_places)) - 1;
    let own = bitcast<vec4f>(textureLoad(bounce_light, middle, 0));
    var sum = vec4f(own.rgb, 1.0) * 1e-4;
    let side = i32(STRIDE);
    for (var y = 0; y < side; y++) {
        for (var x = 0; x < side; x++) {
            let texel = middle + vec2i(x, y) - side / 2;
            let inside = all(texel >= vec2i(0)) & all(texel <= last);
            let there = clamp(texel, vec2i(0), last);
            let light = bitcast<vec4f>(textureLoad(bounce_light, there, 0));
            let weight = select(0.0, light.w, inside) * alike(p, n, textureLoad(bounce_places, there, 0));
            sum += vec4f(light.rgb, 1.0) * weight;
        }
    }
    return bitcast<vec4u>(vec4f(sum.rgb / sum.w, own.w));
}
