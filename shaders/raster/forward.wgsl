//#import raster/frame.wgsl
//#import raster/surface.wgsl
//#import raster/refraction.wgsl
//#import raster/shading.wgsl
//#import raster/shadow.wgsl
//#import raster/repair/area_light.wgsl
//#import raster/repair/bounce.wgsl
//#import raster/repair/glass.wgsl
//#import raster/repair/soft_shadow.wgsl
//#import raster/repair/sunlight.wgsl
// Pass 2: every shape, shaded where it is drawn. The same pass fills the faces of the cube maps and the picture.
// No twin: the rasteriser runs on devices alone.

const SHADING_THREE: u32 = 0u;
const SHADING_PHONG: u32 = 1u;
const SHADING_BLINN_PHONG: u32 = 2u;
const SHADING_COOK_TORRANCE: u32 = 3u;

const AREA_LIGHT_NONE: u32 = 0u;
const AREA_LIGHT_WITHOUT_DECAY: u32 = 1u;
const AREA_LIGHT_ALL_AROUND: u32 = 2u;
const AREA_LIGHT_ONE_SIDED: u32 = 3u;
const AREA_LIGHT_TWO_SIDED: u32 = 4u;
const AREA_LIGHT_SPOT: u32 = 5u;

// What fragments branch on is compiled in. Uniforms must not decide it: Mesa's lavapipe 22.3 compiles a fragment shader
// that branches on a uniform anew for every draw, and keeps all of them until the pipeline goes. So `select` and `&`
// stand below where `if` and `&&` could.

// one of FILTER_*
override SHADOW_FILTER: u32 = FILTER_PCF_SOFT;
override GLASS: bool = false;
override MIRROR: bool = false;
override SUN: bool = true;
// one of AREA_LIGHT_*
override AREA_LIGHT: u32 = AREA_LIGHT_NONE;
// one of SHADING_*
override SHADING: u32 = SHADING_THREE;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) refracted: vec3f,
    @location(3) uv: vec2f,
}

@vertex
fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f, @location(2) uv: vec2f) -> Varying {
    let p = world_position(object, position);
    let n = world_normal(object, normal);
    return Varying(view.clip_from_world * vec4f(p, 1.0), p, n, refracted(p, n), picture_place(uv));
}

// What a half float holds: beyond it lies infinity, which filtering turns into NaN. Here alone: only devices draw.
const LARGEST_HALF: f32 = 65504.0;

@fragment
fn fragment(in: Varying, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return vec4f(min(radiance(in, front), vec3f(LARGEST_HALF)), distance_in_cube_map(in));
}

// What cube maps keep beside the light.
fn distance_in_cube_map(in: Varying) -> f32 {
    if repaired(REPAIR_SURROUNDINGS) || repaired(REPAIR_SKY) {
        return length(in.position - view.eye) * view.per_distance;
    }
    return 1.0;
}

// Into a target of f32 bits, which every backend can draw.
@fragment
fn fragment_bits(in: Varying, @builtin(front_facing) front: bool) -> @location(0) vec4u {
    return bitcast<vec4u>(vec4f(radiance(in, front), 1.0));
}

// The same for OpenGL, with their depths. There what a vertex says of depth is taken to -1..1 on its way, which rounds
// away all that reversed depth is for.
struct FragmentAndDepth {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

struct BitsAndDepth {
    @location(0) bits: vec4u,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment_and_depth(in: Varying, @builtin(front_facing) front: bool) -> FragmentAndDepth {
    return FragmentAndDepth(vec4f(min(radiance(in, front), vec3f(LARGEST_HALF)), distance_in_cube_map(in)), reversed_depth(in));
}

@fragment
fn fragment_bits_and_depth(in: Varying, @builtin(front_facing) front: bool) -> BitsAndDepth {
    return BitsAndDepth(bitcast<vec4u>(vec4f(radiance(in, front), 1.0)), reversed_depth(in));
}

// In a fragment w is the reciprocal of the distance along the line of sight.
fn reversed_depth(in: Varying) -> f32 {
    return view.near * in.clip.w;
}

fn radiance(in: Varying, front: bool) -> vec3f {
    let light = seen(in, front);
    if cut_out(in.uv) {
        discard;
    }
    return light;
}

fn seen(in: Varying, front: bool) -> vec3f {
    if GLASS {
        return glass(in);
    }
    let n = shading_normals(in.position, in.normal, in.uv, view.eye, front);
    if MIRROR {
        return mirrored(in.position, n.mirroring, object.even) + surface_emission(object, front, in.uv);
    }
    var light = surface(in.position, n, in.uv) + surface_emission(object, front, in.uv);
    if repaired(REPAIR_REFLECTIVE_SHADOW_MAP) || repaired(REPAIR_IRRADIANCE_PROBES) {
        light += matt_colour(in.position, n.matt, in.uv) * bounced(in.position, n.matt, in.clip.xy);
    }
    return light;
}

// Only back faces of glass are drawn: the normal that faces the viewer is the inner one.
fn refracted(position: vec3f, normal: vec3f) -> vec3f {
    return refract(normalize(position - view.eye), -normal, object.refraction_ratio);
}

fn glass(in: Varying) -> vec3f {
    if repaired(REPAIR_FRONT_FACE) || repaired(REPAIR_TWO_INTERFACES) || repaired(REPAIR_FRESNEL) {
        return repaired_glass(in.position, normalize(in.normal));
    }
    if repaired(REPAIR_PROXY_SPHERE) || repaired(REPAIR_SURROUNDINGS) {
        let seen = surroundings(in.position, refracted(in.position, normalize(in.normal)));
        return mix(vec3f(1.0), seen, object.reflectivity);
    }
    let per_fragment = refracted(in.position, normalize(in.normal));
    let direction = select(per_fragment, in.refracted, lights.refracts_per_vertex != 0u);
    // where its own may not be seen another cube map is bound, and not looked at
    let seen = textureSampleLevel(cube_map, cube_sampler, cube_direction(direction), 0.0).rgb;
    let sees = (object.has_cube_map != 0u) & (view.sees_cube_maps != 0u);
    return mix(vec3f(1.0), select(lights.sky, seen, sees), object.reflectivity);
}

fn surface(p: vec3f, n: Normals, uv: vec2f) -> vec3f {
    let colour = surface_colour(object, p, n.matt, uv, footprint());
    let facets = metallic_and_roughness(object, uv);
    let v = normalize(view.eye - p);
    var sum = colour * lights.ambient;
    if repaired(REPAIR_SKY) {
        sum *= open_sky(p, n.matt);
    }
    if SUN {
        let l = lights.sun_towards;
        sum += sunlit(p, dot(n.matt, l)) * shaded(n, l, v, colour, facets, lights.sun_incident);
    }
    if AREA_LIGHT != AREA_LIGHT_NONE {
        let to_area_light = lights.area_light_position - p;
        let l = normalize(to_area_light);
        let seen = sees_area_light(p, to_area_light, dot(n.matt, l));
        let incident = area_light_incident(to_area_light, l);
        if AREA_FORM == AREA_FORM_POINT {
            sum += seen * shaded(n, l, v, colour, facets, incident);
        } else {
            let highlight = shaded_by_one(n.mirroring, l, v, vec3f(0.0), colour, facets, incident);
            sum += seen * (body(l, v, colour, facets) * whole_area_light(p, n.matt) + highlight);
        }
    }
    return sum;
}

// How wide a sample is, in pixels: there are as many as together fill one. A cube map's face has one a texel, and distances.
fn footprint() -> f32 {
    let of_picture = select(0.5, inverseSqrt(8.0), repaired(REPAIR_ANTIALIASING));
    return select(of_picture, 1.0, view.per_distance > 0.0);
}

// What a surface sends back of light from all around, but for highlights: metal nothing.
fn matt_colour(p: vec3f, n: vec3f, uv: vec2f) -> vec3f {
    return object.diffuse * (1.0 - metallic_and_roughness(object, uv).x) * surface_colour(object, p, n, uv, footprint());
}

// What reaches p of the sun's light, as a multiple of it.
fn sunlit(p: vec3f, n_dot_l: f32) -> f32 {
    var share = 0.0;
    if repaired(REPAIR_SOFT_SHADOWS) {
        share = soft_sun(p, n_dot_l);
    } else {
        share = shadow(0u, p, n_dot_l);
    }
    if repaired(REPAIR_LIGHT_THROUGH_GLASS) || repaired(REPAIR_CAUSTICS) {
        share *= through_glass(p);
    }
    if repaired(REPAIR_CAUSTICS) {
        share += caustics(p);
    }
    return share;
}

// The share of the area light that is seen from p.
fn sees_area_light(p: vec3f, to_area_light: vec3f, n_dot_l: f32) -> f32 {
    if repaired(REPAIR_SOFT_SHADOWS) {
        return soft_area_light(p, n_dot_l);
    }
    return shadow(1u + face_of(-to_area_light), p, n_dot_l);
}

fn shaded(n: Normals, l: vec3f, v: vec3f, colour: vec3f, facets: vec2f, incident: vec3f) -> vec3f {
    let kd = object.diffuse * colour;
    if !has_two_normals() {
        return shaded_by_one(n.matt, l, v, kd, colour, facets, incident);
    }
    let highlight = shaded_by_one(n.mirroring, l, v, vec3f(0.0), colour, facets, incident);
    return lambert(n.matt, l, body(l, v, colour, facets), incident) + highlight;
}

// What Lambert's term takes of light.
fn body(l: vec3f, v: vec3f, colour: vec3f, facets: vec2f) -> vec3f {
    let kd = object.diffuse * colour;
    if SHADING == SHADING_COOK_TORRANCE {
        return below_coat(l, v, kd, facets.x, object.coat);
    }
    return kd;
}

fn shaded_by_one(
    n: vec3f,
    l: vec3f,
    v: vec3f,
    kd: vec3f,
    colour: vec3f,
    facets: vec2f,
    incident: vec3f,
) -> vec3f {
    switch SHADING {
        case SHADING_COOK_TORRANCE: {
            return cook_torrance(n, l, v, kd, colour, facets.x, facets.y, object.coat, incident);
        }
        case SHADING_PHONG: { return phong(n, l, v, kd, object.specular, object.shininess, incident); }
        case SHADING_BLINN_PHONG: { return blinn_phong(n, l, v, kd, object.specular, object.shininess, incident); }
        default: { return three_blinn_phong(n, l, v, kd, object.specular, object.shininess, incident); }
    }
}

fn area_light_incident(to_area_light: vec3f, l: vec3f) -> vec3f {
    if AREA_LIGHT == AREA_LIGHT_WITHOUT_DECAY {
        return lights.area_light_incident;
    }
    let decayed = lights.area_light_incident / dot(to_area_light, to_area_light);
    if AREA_LIGHT == AREA_LIGHT_ALL_AROUND {
        return decayed;
    }
    let cosine = dot(lights.area_light_normal, -l);
    if AREA_LIGHT == AREA_LIGHT_SPOT {
        let way = saturate((cosine - lights.cone_outer) * lights.cone_slope);
        return decayed * way * way;
    }
    return decayed * select(abs(cosine), max(cosine, 0.0), AREA_LIGHT == AREA_LIGHT_ONE_SIDED);
}

// A plane's depth changes by at most 1 / (N.L) per unit across the light's view: that times the kernel's reach is what
// a shape that casts its own lit side must be forgiven. Light that grazes below 3 degrees (N.L < .05) is not told
// apart.
fn shadow(index: u32, p: vec3f, n_dot_l: f32) -> f32 {
    let clip = lights.shadow_views[index].clip_from_world * vec4f(p, 1.0);
    let uv = vec2f(0.5, -0.5) * clip.xy / clip.w + 0.5;
    let depth = dot(lights.shadow_views[index].depth_from_world, vec4f(p, 1.0)) + lights.shadow_bias;
    if any(uv < vec2f(0.0)) || any(uv > vec2f(1.0)) || depth > 1.0 {
        return 1.0;
    }
    let texel = lights.shadow_views[index].texel.x + lights.shadow_views[index].texel.y * depth;
    let slack = object.slack * texel / max(n_dot_l, 0.05);
    return lit_share(SHADOW_FILTER, shadow_map, index, uv, depth - slack);
}
