//#import raster/frame.wgsl
//#import raster/repair/octahedron.wgsl
// Light of the second bounce, gathered at a part of the picture's size, brought to its pixels by surfaces alone (joint bilateral
// upsampling, Kopf et al. 2007). No twin: the rasteriser runs on devices alone.

// How alike two places of surfaces are: 1 of one plane, 0 across a corner or a step.
fn alike(p: vec3f, n: vec3f, other: vec4u) -> f32 {
    let away = bitcast<vec3f>(other.xyz) - p;
    let facing = max(dot(n, unpacked_direction(other.w)), 0.0);
    let off = abs(dot(n, away)) / max(length(away), 1e-30);
    let turned = facing * facing * facing * facing;
    return turned * turned * saturate(1.0 - 4.0 * off);
}

// What a white Lambert surface of unit normal n at p sends back of it; `at` is the pixel's place in the picture.
fn bounced(p: vec3f, n: vec3f, at: vec2f) -> vec3f {
    let place = at * view.texel - 0.5;
    let corner = vec2i(floor(place));
    let f = fract(place);
    let last = vec2i(textureDimensions(bounce_light)) - 1;
    var sum = vec4f(0.0);
    for (var i = 0; i < 4; i++) {
        let step = vec2i(i & 1, i >> 1u);
        let texel = clamp(corner + step, vec2i(0), last);
        let light = bitcast<vec4f>(textureLoad(bounce_light, texel, 0));
        let near = select(1.0 - f, f, step == vec2i(1));
        let weight = light.w * (near.x * near.y + 0.01) * (alike(p, n, textureLoad(bounce_places, texel, 0)) + 1e-5);
        sum += vec4f(light.rgb, 1.0) * weight;
    }
    // cube maps have none: their views say no size
    return select(vec3f(0.0), sum.rgb / max(sum.w, 1e-30), view.texel.x > 0.0);
}
