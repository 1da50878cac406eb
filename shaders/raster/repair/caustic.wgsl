//#import raster/frame.wgsl
//#import raster/refraction.wgsl
//#import raster/repair/spheres.wgsl
// A mesh of sunlight, bent through a sphere of glass to where it lands: drawn from the sun, with what each piece of the mesh has
// on each texel added up (after Shah, Konttinen and Pattanaik 2007). No twin: the rasteriser runs on devices alone.

// Cells along a side of the mesh, and places of the sun's disc that it is drawn from.
const CELLS: u32 = 96u;
const SUNS: u32 = 16u;

// Steps to what light falls on. Here alone: only devices draw.
const FALL_STEPS: u32 = 32u;
// Halvings of the last one. Here alone: only devices draw.
const FALL_HALVINGS: u32 = 8u;

struct Landed {
    @builtin(position) clip: vec4f,
    // where on the sphere's disc it entered: equal areas of a square
    @location(0) entered: vec2f,
    // what went through both interfaces
    @location(1) passed: f32,
}

// A strip of triangles for each row of cells, each place of the sun, each sphere.
@vertex
fn vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> Landed {
    let row = instance % CELLS;
    let sun = (instance / CELLS) % SUNS;
    let index = instance / (CELLS * SUNS);
    let sphere = lights.spheres[index];
    let cell = vec2f(f32(corner / 2u), f32(row + corner % 2u));
    let entered = 2.0 * cell / f32(CELLS) - 1.0;
    let place = disc_place(sun);
    let l = normalize(lights.sun_towards + lights.sun_tangent * (place.x * lights.sun_right + place.y * lights.sun_up));
    // across this light
    let right = normalize(lights.sun_right - dot(lights.sun_right, l) * l);
    let up = cross(l, right);
    let on_disc = 0.9999 * concentric(entered);
    let normal = on_disc.x * right + on_disc.y * up + sqrt(1.0 - dot(on_disc, on_disc)) * l;
    let reflected = dielectric_reflectance(dot(normal, l), sphere.refraction_ratio);
    let inside = refract(-l, normal, sphere.refraction_ratio);
    let n_out = normal - 2.0 * dot(inside, normal) * inside;
    let out = refract(inside, -n_out, 1.0 / sphere.refraction_ratio);
    let landed = landed_at(sphere.middle + sphere.radius * n_out, out, index);
    let let_in = select((1.0 - reflected) * (1.0 - reflected), 0.0, reflected >= 1.0);
    return Landed(vec4f(landed.xy, 0.5, 1.0), entered, select(0.0, let_in, landed.z > 0.0));
}

// Light goes on to a place of the map in clip space; z is 0 where it lands nowhere.
fn landed_at(origin: vec3f, d: vec3f, index: u32) -> vec3f {
    let sphere = lights.spheres[index];
    let unit = 1.0 / (CAUSTIC_REACH * sphere.radius);
    // as far as the map reaches, and the deepest thing in it
    let farthest = 2.0 * CAUSTIC_REACH * sphere.radius;
    var low = 0.0;
    var high = 0.0;
    for (var step = 1u; step <= FALL_STEPS; step++) {
        let t = farthest * f32(step) / f32(FALL_STEPS);
        if fallen(origin + t * d, index, unit) {
            high = t;
            break;
        }
        low = t;
    }
    if high > 0.0 {
        for (var halving = 0u; halving < FALL_HALVINGS; halving++) {
            let middle = 0.5 * (low + high);
            if fallen(origin + middle * d, index, unit) {
                high = middle;
            } else {
                low = middle;
            }
        }
    }
    let landed = map_place(origin + 0.5 * (low + high) * d, sphere, unit);
    return vec3f(landed, high);
}

fn map_place(p: vec3f, sphere: Sphere, unit: f32) -> vec2f {
    let away = (p - sphere.middle) * unit;
    return vec2f(dot(away, lights.sun_right), dot(away, lights.sun_up));
}

// Whether a place lies behind what the sun sees.
fn fallen(p: vec3f, index: u32, unit: f32) -> bool {
    let place = map_place(p, lights.spheres[index], unit);
    let size = vec2f(textureDimensions(receiver_map));
    let texel = clamp(vec2i((vec2f(0.5, -0.5) * place + 0.5) * size), vec2i(0), vec2i(size) - 1);
    return dot(lights.receiver_depth, vec4f(p, 1.0)) > bitcast<f32>(textureLoad(receiver_map, texel, index, 0).x);
}

// Place of the sun's disc, evenly spread: Vogel 1979.
fn disc_place(index: u32) -> vec2f {
    let angle = 2.39996323 * f32(index);
    return sqrt((f32(index) + 0.5) / f32(SUNS)) * vec2f(cos(angle), sin(angle));
}

// From a square to the unit disc, equal areas to equal areas (Shirley and Chiu 1997).
fn concentric(square: vec2f) -> vec2f {
    let a = abs(square);
    let radius = max(a.x, a.y);
    if radius <= 0.0 {
        return vec2f(0.0);
    }
    let upright = a.y > a.x;
    let share = select(square.y / square.x, square.x / square.y, upright);
    let angle = 0.25 * PI * share;
    let along = select(vec2f(cos(angle), sin(angle)), vec2f(sin(angle), cos(angle)), upright);
    return along * select(square.x, square.y, upright);
}

// What of the light that falls on this texel's area entered, as a multiple of what would fall there without the sphere: the
// Jacobian of the way that it took, from texels to the square, times areas.
@fragment
fn fragment(in: Landed) -> @location(0) vec4f {
    let x = dpdx(in.entered);
    let y = dpdy(in.entered);
    let size = f32(textureDimensions(receiver_map).x);
    // a quarter of the square's area is a quarter of the disc's: pi r^2; a texel is 2 reach r / size wide
    let disc_per_square = 0.25 * PI;
    let texel = 2.0 * CAUSTIC_REACH / size;
    let density = abs(x.x * y.y - x.y * y.x) * disc_per_square / (texel * texel);
    return vec4f(min(in.passed * density / f32(SUNS), 1000.0));
}
