//#import raster/object.wgsl
//#import raster/bent.wgsl
// Where corners of a mesh lie, and what pictures say of its surface.
// Mirror of the structs: crates/raster/src/gpu_data.rs, which has those of all passes.

const IMAGE_COLOUR: u32 = 1u;
const IMAGE_METALLIC_ROUGHNESS: u32 = 2u;
const IMAGE_NORMAL: u32 = 4u;
const IMAGE_EMISSION: u32 = 8u;
const IMAGE_ALPHA: u32 = 16u;

const BOARD_AS_FORMULA: u32 = 0u;
const BOARD_BILINEAR: u32 = 1u;
const BOARD_TRILINEAR: u32 = 2u;
const BOARD_ANISOTROPIC: u32 = 3u;


// which of IMAGE_* a material has; no others are looked up
override IMAGES: u32 = 0u;
// how a checkerboard is looked up, one of BOARD_*
override BOARD: u32 = BOARD_AS_FORMULA;
// whether corners are in the mesh's own space
override PLACED: bool = false;
// whether normals are those of triangles, which share their corners with others
override FLAT: bool = false;
// whether corners have normals of their own, which are not those of the triangles
override SMOOTH: bool = false;
// whether corners have places in pictures
override UVS: bool = false;

// From a surface's place in pictures to one picture's own: a map of two columns, and what is added.
struct ImagePlace {
    turn_and_scale: vec4f,
    offset: vec2f,
}

struct Look {
    // in the order of IMAGE_*
    places: array<ImagePlace, 5>,
    // what x and y of normals are multiplied by
    normal_scale: f32,
    // least alpha that is a surface
    cutoff: f32,
    // what alpha is multiplied by
    alpha: f32,
}

@group(2) @binding(0) var<uniform> look: Look;
@group(2) @binding(1) var colour_image: texture_2d<f32>;
@group(2) @binding(2) var metallic_roughness_image: texture_2d<f32>;
@group(2) @binding(3) var normal_image: texture_2d<f32>;
@group(2) @binding(4) var emission_image: texture_2d<f32>;
@group(2) @binding(5) var alpha_image: texture_2d<f32>;
@group(2) @binding(6) var colour_sampler: sampler;
@group(2) @binding(7) var metallic_roughness_sampler: sampler;
@group(2) @binding(8) var normal_sampler: sampler;
@group(2) @binding(9) var emission_sampler: sampler;
@group(2) @binding(10) var alpha_sampler: sampler;

fn world_position(object: Object, position: vec3f) -> vec3f {
    if PLACED {
        return vec4f(position, 1.0) * object.to_world;
    }
    return position;
}

fn world_normal(object: Object, normal: vec3f) -> vec3f {
    if PLACED {
        return normalize(vec4f(normal, 0.0) * object.normal_to_world);
    }
    return normal;
}

// Of a corner's place in pictures.
fn picture_place(uv: vec2f) -> vec2f {
    if UVS {
        return uv;
    }
    return vec2f(0.0);
}

fn placed(index: u32, uv: vec2f) -> vec2f {
    let turn_and_scale = look.places[index].turn_and_scale;
    return mat2x2f(turn_and_scale.xy, turn_and_scale.zw) * uv + look.places[index].offset;
}

// Whether an alpha mask leaves nothing of the surface.
fn cut_out(uv: vec2f) -> bool {
    if (IMAGES & IMAGE_ALPHA) != 0u {
        return look.alpha * textureSample(alpha_image, alpha_sampler, placed(4u, uv)).a < look.cutoff;
    }
    return false;
}

fn surface_colour(object: Object, p: vec3f, n: vec3f, uv: vec2f, footprint: f32) -> vec3f {
    if BOARD != BOARD_AS_FORMULA {
        return mapped_board(object, p, n, footprint);
    }
    let own = colour_of(object, p, n);
    if (IMAGES & IMAGE_COLOUR) != 0u {
        return own * textureSample(colour_image, colour_sampler, placed(0u, uv)).rgb;
    }
    return own;
}

// Lookups along the longer side of a footprint. Here alone: only devices draw.
const LOOKUPS: i32 = 8;

// The checkerboard as a texture, which lies across the axis that n is nearest to; along that, cells are counted. A sample
// is `footprint` pixels wide.
fn mapped_board(object: Object, p: vec3f, n: vec3f, footprint: f32) -> vec3f {
    let across = abs(n);
    let x = (across.x > across.y) & (across.x > across.z);
    let z = !x & (across.z > across.y);
    let cells = object.cells_per_unit;
    // two cells are the width of the texture
    let uv = 0.5 * along_board((p - object.origin) * cells, x, z);
    let side_x = 0.5 * footprint * along_board(dpdx(p) * cells, x, z);
    let side_y = 0.5 * footprint * along_board(dpdy(p) * cells, x, z);
    let even = share_of_even(uv, side_x, side_y);
    let place = (on_upper_side(object, p, n) - object.origin) * cells;
    let layer = floor(select(select(place.y, place.z, z), place.x, x));
    let odd_layer = layer - 2.0 * floor(0.5 * layer) > 0.5;
    return mix(object.odd, object.even, select(even, 1.0 - even, odd_layer));
}

// The two coordinates that are left without x or z, or else without y.
fn along_board(v: vec3f, x: bool, z: bool) -> vec2f {
    return select(select(v.xz, v.xy, z), v.yz, x);
}

// The mask's mean over a footprint of these two sides, as exactly as BOARD says. Devices differ in what they call
// anisotropic, and llvmpipe's does not heed the sides that it is given: so its lookups are made here.
fn share_of_even(uv: vec2f, side_x: vec2f, side_y: vec2f) -> f32 {
    if BOARD == BOARD_BILINEAR {
        return textureSampleLevel(colour_image, colour_sampler, uv, 0.0).r;
    }
    if BOARD == BOARD_TRILINEAR {
        return textureSampleGrad(colour_image, colour_sampler, uv, side_x, side_y).r;
    }
    let x_is_longer = dot(side_x, side_x) > dot(side_y, side_y);
    let longer = select(side_y, side_x, x_is_longer);
    let shorter = length(select(side_x, side_y, x_is_longer));
    let fine = vec2f(max(shorter, length(longer) / f32(LOOKUPS)), 0.0);
    var sum = 0.0;
    for (var i = 0; i < LOOKUPS; i++) {
        let along = (f32(i) + 0.5) / f32(LOOKUPS) - 0.5;
        sum += textureSampleGrad(colour_image, colour_sampler, uv + along * longer, fine, fine.yx).r;
    }
    return sum / f32(LOOKUPS);
}

// Share of metal, and roughness.
fn metallic_and_roughness(object: Object, uv: vec2f) -> vec2f {
    let own = vec2f(object.metallic, object.roughness);
    if (IMAGES & IMAGE_METALLIC_ROUGHNESS) != 0u {
        return own * textureSample(metallic_roughness_image, metallic_roughness_sampler, placed(1u, uv)).bg;
    }
    return own;
}

// The radiance that the side in view sends out.
fn surface_emission(object: Object, front: bool, uv: vec2f) -> vec3f {
    let own = emitted(object, front);
    if (IMAGES & IMAGE_EMISSION) != 0u {
        return own * textureSample(emission_image, emission_sampler, placed(3u, uv)).rgb;
    }
    return own;
}

// The unit normals that a surface is shaded by, on its side that the eye sees: what is matt by the one that the mesh and its
// pictures say, highlights by the one that mirrors nothing from below.
struct Normals {
    matt: vec3f,
    mirroring: vec3f,
}

// Whether both may differ.
fn has_two_normals() -> bool {
    return SMOOTH || (UVS && (IMAGES & IMAGE_NORMAL) != 0u);
}

// Those at p. `outwards` is interpolated.
fn shading_normals(p: vec3f, outwards: vec3f, uv: vec2f, eye: vec3f, front: bool) -> Normals {
    let side = select(-1.0, 1.0, front);
    var n = normalize(outwards);
    let g = triangle_normal(p, eye, n * side);
    if FLAT {
        n = g * side;
    }
    if SMOOTH {
        n = n * select(-1.0, 1.0, dot(n, g) * side >= 0.0);
    }
    if (IMAGES & IMAGE_NORMAL) != 0u {
        n = mapped_normal(p, n, uv);
    }
    n = n * side;
    if has_two_normals() {
        return Normals(upright(g, n), bent(g, n, normalize(eye - p)));
    }
    return Normals(n, n);
}

// The unit normal of the triangle at p on the side of the eye; where neighbouring pixels are too near to tell, `n`.
fn triangle_normal(p: vec3f, eye: vec3f, n: vec3f) -> vec3f {
    let across = cross(unit_or_shorter(dpdy(p)), unit_or_shorter(dpdx(p)));
    let towards = unit_or_shorter(across) * select(-1.0, 1.0, dot(across, eye - p) > 0.0);
    return select(n, towards, dot(across, across) > SMALLEST_SQUARE);
}

// A vector of unit length, or a shorter one where it has no length to speak of.
fn unit_or_shorter(along: vec3f) -> vec3f {
    return along * inverseSqrt(max(dot(along, along), SMALLEST_SQUARE));
}

// What a normal map makes of unit normal n: its x goes with u and its y against v, as they lie on the surface
// (Schueler, "Normal mapping without precomputed tangents", 2006). Without places in pictures n itself.
fn mapped_normal(p: vec3f, n: vec3f, uv: vec2f) -> vec3f {
    let texel = 2.0 * textureSample(normal_image, normal_sampler, placed(2u, uv)).xyz - 1.0;
    let p_x = dpdx(p);
    let p_y = dpdy(p);
    let uv_x = dpdx(uv);
    let uv_y = dpdy(uv);
    let area = uv_x.x * uv_y.y - uv_y.x * uv_x.y;
    let along_u = (p_x * uv_y.y - p_y * uv_x.y) * sign(area);
    let against_v = (p_x * uv_y.x - p_y * uv_x.x) * sign(area);
    let tangent = along_u - n * dot(n, along_u);
    let length_squared = dot(tangent, tangent);
    let t = tangent * inverseSqrt(max(length_squared, SMALLEST_SQUARE));
    let across = cross(n, t);
    let b = across * select(-1.0, 1.0, dot(across, against_v) > 0.0);
    let scaled = vec3f(texel.xy * look.normal_scale, texel.z);
    let mapped = scaled.x * t + scaled.y * b + scaled.z * n;
    return select(n, normalize(mapped), length_squared > SMALLEST_SQUARE);
}
