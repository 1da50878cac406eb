//#import raster/frame.wgsl
//#import raster/repair/octahedron.wgsl
// Light of the second bounce at what the eye sees, from the patches of the lights' reflective shadow maps: E = Phi / pi
// max(0, n_p.d) max(0, n.-d) / |d|^4 (Dachsbacher and Stamminger 2005). Neighbouring pixels take other patches, all of them in
// a square of pixels (Keller and Heidrich 2001). No twin: the rasteriser runs on devices alone.

// Texels along a side of a reflective shadow map.
const PATCHES_SIDE: u32 = 64u;

// a bit for each layer that is drawn: the sun's, and six of the area light
override LAYERS: u32 = 1u;
// every how manieth patch a pixel takes, along either side
override STRIDE: u32 = 4u;
// whether a patch is as large as it is, which keeps the inverse square finite
override DISC: bool = true;
// whether known shapes stand in the way, and how many they are
override SHAPES_HIDE: bool = true;
override SPHERE_COUNT: u32 = 0u;
override BOX_COUNT: u32 = 0u;

@group(1) @binding(0) var patch_places: texture_2d_array<u32>;
@group(1) @binding(1) var patch_lights: texture_2d_array<u32>;
@group(1) @binding(2) var seen_places: texture_2d<u32>;
@group(1) @binding(3) var seen_marks: texture_2d<u32>;

const PI: f32 = 3.14159265;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    // one triangle that covers the picture
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4u {
    let texel = vec2i(at.xy);
    let place = textureLoad(seen_places, texel, 0);
    let there = bitcast<f32>(textureLoad(seen_marks, texel, 0).w) > 0.0;
    let p = bitcast<vec3f>(place.xyz);
    let n = unpacked_direction(place.w);
    let first = vec2u(texel) % STRIDE;
    var sum = vec3f(0.0);
    for (var layer = 0u; layer < 7u; layer++) {
        if ((LAYERS >> layer) & 1u) != 0u {
            for (var y = first.y; y < PATCHES_SIDE; y += STRIDE) {
                for (var x = first.x; x < PATCHES_SIDE; x += STRIDE) {
                    sum += from_patch(p, n, vec2u(x, y), layer);
                }
            }
        }
    }
    let light = sum * f32(STRIDE * STRIDE) / PI;
    return bitcast<vec4u>(select(vec4f(0.0), vec4f(light, 1.0), there));
}

// By how much packed directions may be off: a plane does not light itself. Here alone: only devices draw.
const ROUNDED: f32 = 1e-4;

fn from_patch(p: vec3f, n: vec3f, texel: vec2u, layer: u32) -> vec3f {
    let light = bitcast<vec4f>(textureLoad(patch_lights, texel, layer, 0));
    let place = textureLoad(patch_places, texel, layer, 0);
    let away = bitcast<vec3f>(place.xyz) - p;
    let square = dot(away, away);
    let d = away * inverseSqrt(max(square, 1e-30));
    let cosines = max(dot(n, d) - ROUNDED, 0.0) * max(-dot(unpacked_direction(place.w), d) - ROUNDED, 0.0);
    // a disc of that area right in front of a point fills its share of the hemisphere and no more
    let size = select(0.0, light.w / PI, DISC);
    let seen = cosines / max(square + size, 1e-30);
    return light.rgb * select(seen, 0.0, hidden(p, away));
}

// What of the way shapes do not hide, at either end. Here alone: only devices draw.
const SLACK: f32 = 0.001;
// What of a sphere's radius hides, for what is drawn of it lies within. Here alone: only devices draw.
const SPHERE_SLACK: f32 = 0.98;

// Whether a shape that is known stands between p and p + away.
fn hidden(p: vec3f, away: vec3f) -> bool {
    var hides = false;
    if SHAPES_HIDE {
        for (var i = 0u; i < SPHERE_COUNT; i++) {
            // light goes through those of glass, which come first
            hides |= sphere_hides(lights.spheres[lights.glass_count + i], p, away);
        }
        for (var i = 0u; i < BOX_COUNT; i++) {
            hides |= box_hides(lights.boxes[i], p, away);
        }
    }
    return hides;
}

fn sphere_hides(sphere: Sphere, p: vec3f, away: vec3f) -> bool {
    let towards = sphere.middle - p;
    let along = clamp(dot(towards, away) / max(dot(away, away), 1e-30), SLACK, 1.0 - SLACK);
    let nearest = towards - along * away;
    let radius = SPHERE_SLACK * sphere.radius;
    return dot(nearest, nearest) < radius * radius;
}

fn box_hides(known: KnownBox, p: vec3f, away: vec3f) -> bool {
    let from_middle = turned(p - known.middle, known);
    let d = turned(away, known);
    // a ray along a face enters its slab nowhere
    let inverse = 1.0 / select(d, vec3f(1e-20), abs(d) < vec3f(1e-20));
    let one = (-known.half - from_middle) * inverse;
    let other = (known.half - from_middle) * inverse;
    let enters = min(one, other);
    let leaves = max(one, other);
    let first = max(max(enters.x, enters.y), max(enters.z, SLACK));
    let last = min(min(leaves.x, leaves.y), min(leaves.z, 1.0 - SLACK));
    return first < last;
}

// Into a box's own axes, which are turned about the vertical.
fn turned(v: vec3f, known: KnownBox) -> vec3f {
    return vec3f(known.cosine * v.x + known.sine * v.z, v.y, known.cosine * v.z - known.sine * v.x);
}
