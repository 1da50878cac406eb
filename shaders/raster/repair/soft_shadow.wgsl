//#import raster/frame.wgsl
//#import raster/shadow.wgsl
// Percentage-closer soft shadows (Fernando 2005): how far away what casts is, and then a filter as wide as that and the size of
// the light ask for. No twin: the rasteriser runs on devices alone.

// Places that are looked at for what casts, and for what is lit. Here alone: only devices draw.
const SEARCHED: u32 = 12u;
// See the one before. Here alone: only devices draw.
const FILTERED: u32 = 32u;

// Place number `index` of `count` on the unit disc, evenly spread: Vogel 1979.
fn disc(index: u32, count: u32) -> vec2f {
    let angle = 2.39996323 * f32(index);
    return sqrt((f32(index) + 0.5) / f32(count)) * vec2f(cos(angle), sin(angle));
}

// Where a point is in a layer of the shadow map: place in [0, 1]^2 and depth.
fn in_shadow_map(layer: u32, p: vec3f) -> vec3f {
    let clip = lights.shadow_views[layer].clip_from_world * vec4f(p, 1.0);
    let depth = dot(lights.shadow_views[layer].depth_from_world, vec4f(p, 1.0));
    return vec3f(vec2f(0.5, -0.5) * clip.xy / clip.w + 0.5, depth + lights.shadow_bias);
}

fn nearest_depth(layer: u32, uv: vec2f) -> f32 {
    let size = vec2f(textureDimensions(shadow_map));
    let texel = clamp(vec2i(floor(uv * size)), vec2i(0), vec2i(size) - 1);
    return bitcast<f32>(textureLoad(shadow_map, texel, layer, 0).x);
}

// How steep a receiver may lie, as for the other filters.
fn steepness(n_dot_l: f32) -> f32 {
    return 1.0 / max(n_dot_l, 0.05);
}

// The share of the sun's disc that is seen from p.
fn soft_sun(p: vec3f, n_dot_l: f32) -> f32 {
    let at = in_shadow_map(0u, p);
    if any(at.xy < vec2f(0.0)) || any(at.xy > vec2f(1.0)) || at.z > 1.0 {
        return 1.0;
    }
    // the view's scale: of places by unit of length across, of depth along
    let across = 0.5 * length(vec3f(
        lights.shadow_views[0].clip_from_world[0].x,
        lights.shadow_views[0].clip_from_world[1].x,
        lights.shadow_views[0].clip_from_world[2].x,
    ));
    let along = length(lights.shadow_views[0].depth_from_world.xyz);
    // of places by unit of depth
    let spread = lights.sun_tangent * across / along;
    let texel = lights.shadow_views[0].texel.x;
    let own = select(0.0, 1.0, object.slack > 0.0);
    // what lies behind itself across a filter of this many units of depth
    let widest = spread * at.z;
    var nearer = 0.0;
    var count = 0.0;
    for (var i = 0u; i < SEARCHED; i++) {
        let offset = widest * disc(i, SEARCHED);
        let depth = nearest_depth(0u, at.xy + offset);
        let slack = own * steepness(n_dot_l) * (object.slack * texel + length(offset) * along / across);
        let casts = select(0.0, 1.0, depth < at.z - slack);
        nearer += casts * depth;
        count += casts;
    }
    if count == 0.0 || count == f32(SEARCHED) {
        return 1.0 - count / f32(SEARCHED);
    }
    // at least a texel, or the map shows
    let width = max(spread * (at.z - nearer / count), 1.0 / f32(textureDimensions(shadow_map).x));
    var lit_count = 0.0;
    for (var i = 0u; i < FILTERED; i++) {
        let offset = width * disc(i, FILTERED);
        let slack = own * steepness(n_dot_l) * (object.slack * texel + length(offset) * along / across);
        lit_count += select(0.0, 1.0, nearest_depth(0u, at.xy + offset) >= at.z - slack);
    }
    return lit_count / f32(FILTERED);
}

// The share of the area light that is seen from p, as if it were a disc that faces it.
fn soft_area_light(p: vec3f, n_dot_l: f32) -> f32 {
    let from_light = p - lights.area_light_position;
    let distance = length(from_light);
    let d = from_light / distance;
    let x = normalize(select(vec3f(0.0, d.z, -d.y), vec3f(-d.z, 0.0, d.x), abs(d.y) < 0.7));
    let y = cross(d, x);
    let own = select(0.0, 1.0, object.slack > 0.0);
    // as tangents of the angle at the light: of what is half-way
    let widest = lights.area_light_radius / distance;
    var share = 0.0;
    var count = 0.0;
    for (var i = 0u; i < SEARCHED; i++) {
        let offset = widest * disc(i, SEARCHED);
        let tap = area_light_tap(d, x, y, offset, distance);
        let casts = select(0.0, 1.0, tap.x < tap.y - own * tap.z * steepness(n_dot_l) * (object.slack + length(offset) * tap.w));
        share += casts * tap.x / tap.y;
        count += casts;
    }
    if count == 0.0 || count == f32(SEARCHED) {
        return 1.0 - count / f32(SEARCHED);
    }
    let nearness = share / count;
    let width = min(lights.area_light_radius * (1.0 - nearness) / (distance * nearness), 4.0 * widest);
    var lit_count = 0.0;
    for (var i = 0u; i < FILTERED; i++) {
        let offset = width * disc(i, FILTERED);
        let tap = area_light_tap(d, x, y, offset, distance);
        lit_count += select(0.0, 1.0, tap.x >= tap.y - own * tap.z * steepness(n_dot_l) * (object.slack + length(offset) * tap.w));
    }
    return lit_count / f32(FILTERED);
}

// The depth that the area light sees in a direction, that of a point this far away there, a texel's size in depth there, and
// how many texels a unit of tangent is.
fn area_light_tap(d: vec3f, x: vec3f, y: vec3f, offset: vec2f, distance: f32) -> vec4f {
    let towards = d + offset.x * x + offset.y * y;
    let layer = 1u + face_of(towards);
    let at = in_shadow_map(layer, lights.area_light_position + distance * towards);
    let texel = lights.shadow_views[layer].texel.y;
    return vec4f(nearest_depth(layer, at.xy), at.z, texel * at.z, 1.0 / texel);
}
