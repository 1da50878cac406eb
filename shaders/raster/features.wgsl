//#import raster/view.wgsl
//#import raster/surface.wgsl
// What is seen of the first surface, without light: albedo, distance and normal, as bits of f32. No twin: the
// rasteriser runs on devices alone.

@group(0) @binding(0) var<uniform> view: View;
@group(1) @binding(0) var<uniform> object: Object;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
}

// Where nothing is drawn both are cleared: to what shines there at distance 0, and to null.
struct Features {
    // albedo, and the distance from the eye
    @location(0) albedo: vec4u,
    // the normal on the side of the eye, and 1
    @location(1) normal: vec4u,
}

// For OpenGL, as in forward.wgsl.
struct FeaturesAndDepth {
    @location(0) albedo: vec4u,
    @location(1) normal: vec4u,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f, @location(2) uv: vec2f) -> Varying {
    let p = world_position(object, position);
    return Varying(view.clip_from_world * vec4f(p, 1.0), p, world_normal(object, normal), picture_place(uv));
}

@fragment
fn fragment_bits(in: Varying, @builtin(front_facing) front: bool) -> Features {
    return features(in, front);
}

@fragment
fn fragment_bits_and_depth(in: Varying, @builtin(front_facing) front: bool) -> FeaturesAndDepth {
    let seen = features(in, front);
    return FeaturesAndDepth(seen.albedo, seen.normal, view.near * in.clip.w);
}

// Clear glass takes no light away: its albedo is 1.
fn features(in: Varying, front: bool) -> Features {
    let n = shading_normals(in.position, in.normal, in.uv, view.eye, front).matt;
    let own = select(surface_colour(object, in.position, n, in.uv, 1.0), vec3f(1.0), object.kind == 1u);
    let albedo = min(own + surface_emission(object, front, in.uv), vec3f(1.0));
    let from_eye = length(in.position - view.eye);
    if cut_out(in.uv) {
        discard;
    }
    return Features(bitcast<vec4u>(vec4f(albedo, from_eye)), bitcast<vec4u>(vec4f(n, 1.0)));
}
