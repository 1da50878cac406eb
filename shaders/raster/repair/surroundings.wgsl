//#import raster/frame.wgsl
//#import raster/refraction.wgsl
//#import raster/repair/repairs.wgsl
// What a ray meets that leaves glass or a mirror, by the cube map about that: the texels keep radiance and distance.
// No twin: the rasteriser runs on devices alone.

// Distances of the sky in cube maps, which are multiples of the scene's size.
const NOWHERE: f32 = 65504.0;

// Steps of the search along a ray. Here alone: only devices draw.
const SEARCH_STEPS: u32 = 24u;
// Halvings of the step that it ends in. Here alone: only devices draw.
const HALVINGS: u32 = 5u;

// The radiance that arrives at p from unit direction d, which is not that of the object itself.
fn surroundings(p: vec3f, d: vec3f) -> vec3f {
    let from_middle = p - object.cube_middle.xyz;
    var towards = d;
    if repaired(REPAIR_SURROUNDINGS) {
        towards = towards_what_is_met(from_middle, d);
    } else if repaired(REPAIR_PROXY_SPHERE) {
        towards = towards_sphere(from_middle, d, object.proxy_radius);
    }
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
    var low = 0.0;
    var high = 1.0;
    let length_of_way = max(length(origin), 1e-6 / object.cube_middle.w);
    for (var step = 1u; step < SEARCH_STEPS; step++) {
        let share = f32(step) / f32(SEARCH_STEPS);
        if behind(origin + d * (length_of_way * share / (1.0 - share))) > 0.0 {
            high = share;
            break;
        }
        low = share;
    }
    if high >= 1.0 {
        return d;
    }
    for (var halving = 0u; halving < HALVINGS; halving++) {
        let middle = 0.5 * (low + high);
        if behind(origin + d * (length_of_way * middle / (1.0 - middle))) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    return origin + d * (length_of_way * high / (1.0 - high));
}
