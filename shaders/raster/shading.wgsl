// What one light adds at a point: n unit normal, l unit direction to the light, v unit direction to the viewer,
// `incident` the light that a white Lambert surface facing it would send back. Ambient light, colour * ambient, is
// the caller's.
// Twin: crates/raster/src/shading.rs.

// Keeps log2 finite inside pow, so that 0^0 is 1 and no exponent makes a NaN: the smallest power of ten that is a
// normal f32.
const SMALLEST: f32 = 1e-37;

fn power(base: f32, exponent: f32) -> f32 {
    return pow(max(base, SMALLEST), exponent);
}

fn half_vector(l: vec3f, v: vec3f) -> vec3f {
    let h = l + v;
    return h * inverseSqrt(max(dot(h, h), SMALLEST));
}

// Phong 1975, as on the slides: k_d max(0, N.L) + k_s max(0, R.V)^p, dark where the light is behind the surface.
fn phong(n: vec3f, l: vec3f, v: vec3f, kd: vec3f, ks: f32, p: f32, incident: vec3f) -> vec3f {
    let cosine = dot(n, l);
    if cosine <= 0.0 {
        return vec3f(0.0);
    }
    let r = 2.0 * cosine * n - l;
    return incident * (kd * cosine + ks * power(max(dot(r, v), 0.0), p));
}

// Blinn 1977, as on the slides: k_d max(0, N.L) + k_s max(0, N.H)^p, dark where the light is behind the surface.
fn blinn_phong(n: vec3f, l: vec3f, v: vec3f, kd: vec3f, ks: f32, p: f32, incident: vec3f) -> vec3f {
    let cosine = dot(n, l);
    if cosine <= 0.0 {
        return vec3f(0.0);
    }
    return incident * (kd * cosine + ks * power(max(dot(n, half_vector(l, v)), 0.0), p));
}

// What three.js r115 calls MeshPhong: Blinn's lobe, normalised, times Schlick's Fresnel term in Lagarde's spherical
// Gaussian form, times the cosine.
fn three_blinn_phong(n: vec3f, l: vec3f, v: vec3f, kd: vec3f, f0: f32, s: f32, incident: vec3f) -> vec3f {
    let h = half_vector(l, v);
    let l_dot_h = clamp(dot(l, h), 0.0, 1.0);
    let fresnel = f0 + (1.0 - f0) * exp2((-5.55473 * l_dot_h - 6.98316) * l_dot_h);
    let lobe = 0.25 * (0.5 * s + 1.0) * power(clamp(dot(n, h), 0.0, 1.0), s);
    return incident * max(dot(n, l), 0.0) * (kd + fresnel * lobe);
}
