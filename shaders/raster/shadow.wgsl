// Percentage-closer filtering over a shadow map's nearest depths, Reeves et al. 1987; the kernels are those of three.js
// r115. A map's texels are the bits of f32 depths: unlike floats, integers can be drawn by every backend.
// Twin: crates/raster/src/shading.rs, which has all formulas of the rasteriser.

// 1 where nothing lies before `depth`, else 0; the border texels go on outside of the map.
fn lit(map: texture_2d_array<u32>, layer: u32, texel: vec2i, depth: f32) -> f32 {
    let inside = clamp(texel, vec2i(0), vec2i(textureDimensions(map)) - 1);
    return select(0.0, 1.0, bitcast<f32>(textureLoad(map, inside, layer, 0).x) >= depth);
}

const FILTER_HARD: u32 = 0u;
const FILTER_PCF: u32 = 1u;
const FILTER_PCF_SOFT: u32 = 2u;

// The lit share about uv in [0, 1]^2 (from the map's top left corner) by one of the filters.
fn lit_share(filter_code: u32, map: texture_2d_array<u32>, layer: u32, uv: vec2f, depth: f32) -> f32 {
    switch filter_code {
        case FILTER_HARD: { return hard(map, layer, uv, depth); }
        case FILTER_PCF: { return pcf(map, layer, uv, depth); }
        default: { return pcf_soft(map, layer, uv, depth); }
    }
}

// The nearest texel alone: BasicShadowMap.
fn hard(map: texture_2d_array<u32>, layer: u32, uv: vec2f, depth: f32) -> f32 {
    return lit(map, layer, vec2i(floor(uv * vec2f(textureDimensions(map)))), depth);
}

// The mean of 17 nearest texels: at uv, and on two squares about it, half a texel and a whole one away. PCFShadowMap.
fn pcf(map: texture_2d_array<u32>, layer: u32, uv: vec2f, depth: f32) -> f32 {
    let at = uv * vec2f(textureDimensions(map));
    var sum = lit(map, layer, vec2i(floor(at)), depth);
    for (var ring = 1; ring <= 2; ring++) {
        for (var i = 0; i < 9; i++) {
            if i != 4 {
                let offset = 0.5 * f32(ring) * vec2f(f32(i % 3 - 1), f32(i / 3 - 1));
                sum += lit(map, layer, vec2i(floor(at + offset)), depth);
            }
        }
    }
    return sum / 17.0;
}

// PCFSoftShadowMap: the lit share of 3 x 3 texels about uv, blended bilinearly where the kernel's border cuts texels: 4
// whole texels, 4 pairs along one axis, 4 corners.
fn pcf_soft(map: texture_2d_array<u32>, layer: u32, uv: vec2f, depth: f32) -> f32 {
    let at = uv * vec2f(textureDimensions(map)) + 0.5;
    let f = fract(at);
    let t = vec2i(floor(at)) - 1;
    let whole = lit(map, layer, t, depth)
        + lit(map, layer, t + vec2i(1, 0), depth)
        + lit(map, layer, t + vec2i(0, 1), depth)
        + lit(map, layer, t + vec2i(1, 1), depth);
    let sides = mix(lit(map, layer, t + vec2i(-1, 0), depth), lit(map, layer, t + vec2i(2, 0), depth), f.x)
        + mix(lit(map, layer, t + vec2i(-1, 1), depth), lit(map, layer, t + vec2i(2, 1), depth), f.x)
        + mix(lit(map, layer, t + vec2i(0, -1), depth), lit(map, layer, t + vec2i(0, 2), depth), f.y)
        + mix(lit(map, layer, t + vec2i(1, -1), depth), lit(map, layer, t + vec2i(1, 2), depth), f.y);
    let above = mix(lit(map, layer, t + vec2i(-1, -1), depth), lit(map, layer, t + vec2i(2, -1), depth), f.x);
    let below = mix(lit(map, layer, t + vec2i(-1, 2), depth), lit(map, layer, t + vec2i(2, 2), depth), f.x);
    return (whole + sides + mix(above, below, f.y)) / 9.0;
}

// Which face of a cube of cameras sees direction d: +x, -x, +y, -y, +z, -z.
fn face_of(d: vec3f) -> u32 {
    let a = abs(d);
    if a.x >= a.y && a.x >= a.z {
        return select(0u, 1u, d.x < 0.0);
    }
    if a.y >= a.z {
        return select(2u, 3u, d.y < 0.0);
    }
    return select(4u, 5u, d.z < 0.0);
}
