//#import raster/forward.wgsl
//#import raster/repair/octahedron.wgsl
// A reflective shadow map (Dachsbacher and Stamminger 2005): of what a light sees through each texel, a patch of surface, the
// place and normal and the light that it sends back. The same pass keeps where the surfaces are that the eye sees.
// No twin: the rasteriser runs on devices alone.

const PATCHES_SEEN: u32 = 0u;
const PATCHES_OF_SUN: u32 = 1u;
const PATCHES_OF_AREA_LIGHT: u32 = 2u;
const PATCHES_OF_PROBES: u32 = 3u;

// one of PATCHES_*: who looks
override PATCHES_OF: u32 = PATCHES_SEEN;

// What grazes light more than this is not taken to reach on behind the texel: its patch would be as long as the room. Here
// alone: only devices draw.
const LEAST_LIT_COSINE: f32 = 0.05;

struct Patch {
    // place, and packed normal
    @location(0) place: vec4u,
    // radiance sent back times area, and area; an area of 0 where nothing is seen. For probes radiance alone, and packed colour
    @location(1) light: vec4u,
}

// For OpenGL, as in forward.wgsl.
struct PatchAndDepth {
    @location(0) place: vec4u,
    @location(1) light: vec4u,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn patch_bits(in: Varying, @builtin(front_facing) front: bool) -> Patch {
    return patch_at(in, front);
}

@fragment
fn patch_bits_and_depth(in: Varying, @builtin(front_facing) front: bool) -> PatchAndDepth {
    let seen = patch_at(in, front);
    let from_sun = 1.0 - dot(view.depth_from_world, vec4f(in.position, 1.0));
    return PatchAndDepth(seen.place, seen.light, select(reversed_depth(in), from_sun, PATCHES_OF == PATCHES_OF_SUN));
}

fn patch_at(in: Varying, front: bool) -> Patch {
    let n = shading_normals(in.position, in.normal, in.uv, view.eye, front).matt;
    let light = patch_light(in, n);
    if cut_out(in.uv) {
        discard;
    }
    let place = vec4u(bitcast<vec3u>(in.position), packed_direction(n));
    return Patch(place, light);
}

fn patch_light(in: Varying, n: vec3f) -> vec4u {
    let p = in.position;
    let colour = matt_colour(p, n, in.uv);
    if PATCHES_OF == PATCHES_OF_SUN {
        let cosine = max(dot(n, lights.sun_towards), 0.0);
        let area = view.texel.x / max(cosine, LEAST_LIT_COSINE);
        return bitcast<vec4u>(area * vec4f(colour * lights.sun_incident * cosine, 1.0));
    }
    if PATCHES_OF == PATCHES_OF_AREA_LIGHT {
        let to_light = lights.area_light_position - p;
        let l = normalize(to_light);
        // of the texel as the light sees it: its solid angle falls with the cube of the cosine to the view's axis
        let along = dot(view.depth_from_world, vec4f(p, 1.0)) / length(to_light);
        let facing = view.texel.y * along * along * along * dot(to_light, to_light);
        let cosine = max(dot(n, l), 0.0);
        let area = facing / max(cosine, LEAST_LIT_COSINE);
        var light = area_light_incident(to_light, l) * cosine;
        if AREA_FORM != AREA_FORM_POINT {
            light = whole_area_light(p, n);
        }
        return bitcast<vec4u>(area * vec4f(colour * light, 1.0));
    }
    if PATCHES_OF == PATCHES_OF_PROBES {
        return vec4u(bitcast<vec3u>(colour * lit_straight(p, n)), pack4x8unorm(vec4f(min(colour, vec3f(1.0)), 1.0)));
    }
    return bitcast<vec4u>(vec4f(0.0, 0.0, 0.0, 1.0));
}

// What a white Lambert surface sends back of the lights and of the sky.
fn lit_straight(p: vec3f, n: vec3f) -> vec3f {
    var sum = lights.ambient;
    if repaired(REPAIR_SKY) {
        sum *= open_sky(p, n);
    }
    if SUN {
        let cosine = dot(n, lights.sun_towards);
        sum += sunlit(p, cosine) * max(cosine, 0.0) * lights.sun_incident;
    }
    if AREA_LIGHT != AREA_LIGHT_NONE {
        let to_light = lights.area_light_position - p;
        let l = normalize(to_light);
        let cosine = dot(n, l);
        var light = max(cosine, 0.0) * area_light_incident(to_light, l);
        if AREA_FORM != AREA_FORM_POINT {
            light = whole_area_light(p, n);
        }
        sum += sees_area_light(p, to_light, cosine) * light;
    }
    return sum;
}
