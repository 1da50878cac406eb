//#import raster/view.wgsl
//#import raster/surface.wgsl
// Pass 1: the depths nearest to a light, as a colour of f32 bits: not every backend reads single texels of a depth
// texture, nor draws floats. No twin: the rasteriser runs on devices alone.

@group(0) @binding(0) var<uniform> view: View;
@group(1) @binding(0) var<uniform> object: Object;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) depth: f32,
    @location(1) uv: vec2f,
}

@vertex
fn vertex(@location(0) position: vec3f, @location(2) uv: vec2f) -> Varying {
    let p = vec4f(world_position(object, position), 1.0);
    return Varying(view.clip_from_world * p, dot(view.depth_from_world, p), picture_place(uv));
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4u {
    return texel(in);
}

struct TexelAndDepth {
    @location(0) texel: vec4u,
    @builtin(frag_depth) depth: f32,
}

// For OpenGL, as in forward.wgsl.
@fragment
fn fragment_and_depth(in: Varying) -> TexelAndDepth {
    return TexelAndDepth(texel(in), 1.0 - in.depth);
}

fn texel(in: Varying) -> vec4u {
    if cut_out(in.uv) {
        discard;
    }
    return vec4u(bitcast<u32>(in.depth), 0u, 0u, 0u);
}
