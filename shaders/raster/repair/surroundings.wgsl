//#import raster/frame.wgsl
//#import raster/refraction.wgsl
//#import raster/repair/repairs.wgsl
// What a ray meets that leaves glass or a mirror, by the cube map about that: the texels keep radiance and distance.
// No twin: the rasteriser runs on devices alone.

// Distances of the sky in cube maps, which are multiples of the scene's size.
const NOWHERE: f32 = 65504.0;

// Steps of the search along a ray. Here alone: only devices draw.
const SEARCH_STEPS: u32 = 28u;
// How often the step that it ends in is cut. Here alone: only devices draw.
const CUTS: u32 = 3u;

// The radiance that arrives at p from unit direction d, which is not that of the object itself.
fn surroundings(p: vec3f, d: vec3f) -> vec3f {
    let from_middle = p - object.cube_middle.xyz;
    var towards = d;
    if repaired(REPAIR_SURROUNDINGS) {
        towards = towards_what_is_met(from_middle, d);
    } else if repaired(REPAIR_PROXY_SPHERE) {
        towards = towards_sphere(from_middle, d, object.proxy_radius);
    }
    return shown(towards, d);
}

// What the cube map shows in a direction, for a ray along d.
fn shown(towards: vec3f, d: vec3f) -> vec3f {
    let seen = textureSampleLevel(cube_map, cube_sampler, cube_direction(towards), 0.0);
    // where its own may not be seen another cube map is bound, and not looked at
    let sees = (object.has_cube_map != 0u) & (view.sees_cube_maps != 0u);
    var light = select(lights.sky, seen.rgb, sees);
    if repaired(REPAIR_SKY) {
        let open = select(1.0, saturate(seen.a - 1.0), sees);
        light += open * select(vec3f(0.0), lights.sun_radiance, dot(d, lights.sun_towards) > lights.sun_cosine);
    }
    return min(light, vec3f(NOWHERE));
}

// To where a ray from a place inside of a sphere leaves it, both as seen from its middle.
fn towards_sphere(origin: vec3f, d: vec3f, radius: f32) -> vec3f {
    let along = dot(origin, d);
    let square = max(along * along + radius * radius - dot(origin, origin), 0.0);
    return origin + d * (sqrt(square) - along);
}

// How far behind what the cube map shows a place lies, in units of the cube map; negative before it.
fn behind(place: vec3f) -> f32 {
    let seen = textureSampleLevel(cube_map, cube_sampler, cube_direction(place), 0.0).a;
    return length(place) * object.cube_middle.w - seen;
}

// To what a ray meets, seen from the cube map's middle (Szirmay-Kalos et al. 2005). As the ray goes to infinity it is seen
// in directions from that of its origin to its own: those are gone through evenly.
fn towards_what_is_met(origin: vec3f, d: vec3f) -> vec3f {
    // a place on the way, and how far behind what is shown there it lies
    var low = vec2f(0.0, -1.0);
    var high = vec2f(1.0, 0.0);
    let way = max(length(origin), 1e-6 / object.cube_middle.w);
    for (var step = 1u; step < SEARCH_STEPS; step++) {
        let share = f32(step) / f32(SEARCH_STEPS);
        let here = vec2f(share, behind(origin + d * (way * share / (1.0 - share))));
        if here.y > 0.0 {
            high = here;
            break;
        }
        low = here;
    }
    if high.x >= 1.0 {
        return d;
    }
    // the step is cut where a straight line would be at 0, but never near an end, where that is far off
    for (var i = 0u; i < CUTS; i++) {
        let share = clamp(low.y / (low.y - high.y), 0.1, 0.9);
        let cut = mix(low.x, high.x, share);
        let here = vec2f(cut, behind(origin + d * (way * cut / (1.0 - cut))));
        if here.y > 0.0 {
            high = here;
        } else {
            low = here;
        }
    }
    let met = mix(low.x, high.x, clamp(low.y / (low.y - high.y), 0.0, 1.0));
    return origin + d * (way * met / (1.0 - met));
}
