//#import raster/frame.wgsl
//#import raster/shadow.wgsl
//#import raster/repair/repairs.wgsl
//#import raster/repair/spheres.wgsl
// The light of sky and sun beside and behind spheres. No twin: the rasteriser runs on devices alone.

// The share of the sky that spheres which are no glass leave open about unit normal n.
fn open_sky(p: vec3f, n: vec3f) -> f32 {
    var open = 1.0;
    for (var i = lights.glass_count; i < lights.sphere_count; i++) {
        let sphere = lights.spheres[i];
        let towards = sphere.middle - p;
        // a point of the sphere itself sees nothing of it
        let outside = dot(towards, towards) > 1.0001 * sphere.radius * sphere.radius;
        open *= 1.0 - select(0.0, covered_sky(n, towards, sphere.radius), outside);
    }
    return open;
}

// What spheres of glass leave of the sun's light at p, as a multiple of it: what passes by them and what goes straight through.
// Where caustics are drawn these have what goes through.
fn through_glass(p: vec3f) -> f32 {
    var light = 1.0;
    let spread = select(0.0, lights.sun_tangent, repaired(REPAIR_SOFT_SHADOWS));
    for (var i = 0u; i < lights.glass_count; i++) {
        let sphere = lights.spheres[i];
        let covered = covered_sun(sphere.middle - p, sphere.radius, lights.sun_towards, spread);
        let straight = let_through(covered.y, sphere.refraction_ratio);
        light *= 1.0 - covered.x * (1.0 - select(straight, 0.0, repaired(REPAIR_CAUSTICS)));
    }
    return light;
}

// What spheres of glass bend to p of the sun's light, as a multiple of it.
fn caustics(p: vec3f) -> f32 {
    var light = 0.0;
    for (var i = 0u; i < lights.glass_count; i++) {
        light += focused(i, p);
    }
    return light;
}

// By how much of a receiver's depth points may lie behind it. Here alone: only devices draw.
const RECEIVER_SLACK: f32 = 0.004;

// What a sphere of glass adds to the sun's light at p, as a multiple of it.
fn focused(index: u32, p: vec3f) -> f32 {
    let sphere = lights.spheres[index];
    let away = (p - sphere.middle) / (CAUSTIC_REACH * sphere.radius);
    let uv = vec2f(0.5, -0.5) * vec2f(dot(away, lights.sun_right), dot(away, lights.sun_up)) + 0.5;
    let light = textureSampleLevel(caustic_map, caustic_sampler, uv, index, 0.0).x;
    let size = vec2f(textureDimensions(receiver_map));
    let seen = bitcast<f32>(textureLoad(receiver_map, clamp(vec2i(uv * size), vec2i(0), vec2i(size) - 1), index, 0).x);
    let depth = dot(lights.receiver_depth, vec4f(p, 1.0));
    let inside = all(uv > vec2f(0.0)) & all(uv < vec2f(1.0)) & (depth < seen + RECEIVER_SLACK);
    return select(0.0, light, inside);
}
