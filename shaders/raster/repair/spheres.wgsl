//#import raster/repair/fresnel.wgsl
// What spheres take of the light of sky and sun, in closed form. Twin: crates/raster/src/shading.rs, which has
// all formulas of the rasteriser.

const PI: f32 = 3.14159265;

// The share of the cosine-weighted hemisphere about unit normal n that a sphere covers, seen from outside of it; `towards` is
// the way to its middle. Where the horizon cuts it, by the view factor of a tilted patch (Naraghi and Chung 1982).
fn covered_sky(n: vec3f, towards: vec3f, radius: f32) -> f32 {
    let distance = max(length(towards), radius * 1.000001);
    let cosine = dot(n, towards) / distance;
    // of the distance in radii
    let square = distance * distance / (radius * radius);
    let beyond = 1.0 - square * cosine * cosine;
    if beyond <= 0.0 {
        return max(cosine, 0.0) / square;
    }
    let tangent = sqrt(max(square - 1.0, 1e-12));
    let sine = sqrt(max(1.0 - cosine * cosine, 1e-12));
    let horizon = clamp(-cosine * tangent / sine, -1.0, 1.0);
    let share = cosine * acos(horizon) - sqrt(beyond) * tangent;
    return max((share / square + atan(sqrt(beyond) / tangent)) / PI, 0.0);
}

// The share of the sun's disc that a sphere covers, its edge taken to be straight there; `l` unit direction to the sun,
// `spread` the tangent of its angular radius. x: that share; y: how far from the sphere's middle light passes, in radii.
fn covered_sun(towards: vec3f, radius: f32, l: vec3f, spread: f32) -> vec2f {
    let along = dot(towards, l);
    let aside = length(towards - along * l);
    let into = (radius - aside) / max(along * spread, 1e-6 * radius);
    let x = clamp(into, -1.0, 1.0);
    let share = 0.5 + (asin(x) + x * sqrt(1.0 - x * x)) / PI;
    return vec2f(select(0.0, share, along > 0.0), min(aside / radius, 1.0));
}

// What of light goes straight through a sphere of glass that it meets at this distance from its middle, in radii.
fn let_through(aside: f32, ratio: f32) -> f32 {
    let passed = 1.0 - dielectric_reflectance(sqrt(max(1.0 - aside * aside, 0.0)), ratio);
    return passed * passed;
}
