// What one light adds at a point: n unit normal, l unit direction to the light, v unit direction to the viewer,
// `incident` the light that a white Lambert surface facing it would send back. Ambient light, colour * ambient, is
// the caller's.
// Twin: crates/raster/src/shading.rs.

// Keeps log2 finite inside pow, so that 0^0 is 1 and no exponent makes a NaN: the smallest power of ten that is a
// normal f32.
const SMALLEST: f32 = 1e-37;

// Keeps the lobe of an all but perfect mirror finite: glTF's materials may have no roughness at all.
const LEAST_WIDTH: f32 = 1e-4;

// Keeps the light that grazes a surface finite, and the one that a normal from a picture turns away from the viewer.
const LEAST_COSINE: f32 = 1e-4;

fn power(base: f32, exponent: f32) -> f32 {
    return pow(max(base, SMALLEST), exponent);
}

fn half_vector(l: vec3f, v: vec3f) -> vec3f {
    let h = l + v;
    return h * inverseSqrt(max(dot(h, h), SMALLEST));
}

// Lambert's law alone.
fn lambert(n: vec3f, l: vec3f, kd: vec3f, incident: vec3f) -> vec3f {
    return incident * (kd * max(dot(n, l), 0.0));
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

// pi times the distribution of microfacets by Trowbridge and Reitz 1975, GGX. The sine is that of the cross product: one
// minus the cosine's square has no digits left of narrow lobes.
fn ggx_times_pi(n: vec3f, h: vec3f, width: f32) -> f32 {
    let cosine = max(dot(n, h), 0.0);
    let sine = cross(n, h);
    let spread = width * width * cosine * cosine + dot(sine, sine);
    return width * width / (spread * spread);
}

// Smith's masking and shadowing, height-correlated, over four times both cosines (Heitz 2014).
fn smith_visibility(n_dot_l: f32, n_dot_v: f32, width: f32) -> f32 {
    let square = width * width;
    let masked = n_dot_l * sqrt(n_dot_v * n_dot_v * (1.0 - square) + square);
    let shadowed = n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - square) + square);
    return 0.5 / (masked + shadowed);
}

// How far Schlick's approximation has gone from the reflectance head-on to 1.
fn schlick(l: vec3f, v: vec3f) -> f32 {
    let away = 1.0 - clamp(dot(v, half_vector(l, v)), 0.0, 1.0);
    return away * away * away * away * away;
}

// What the coat and the metal of cook_torrance leave of the matt body kd.
fn below_coat(l: vec3f, v: vec3f, kd: vec3f, metallic: f32, f0: f32) -> vec3f {
    return (1.0 - metallic) * (1.0 - (f0 + (1.0 - f0) * schlick(l, v))) * kd;
}

// Cook and Torrance 1982 with the terms of glTF 2.0, appendix B: a matt body kd under a coat that reflects f0 head-on,
// mixed with metal that reflects `colour` head-on; F by Schlick 1994, D is GGX, G Smith's. Dark where the light is behind
// the surface.
fn cook_torrance(
    n: vec3f,
    l: vec3f,
    v: vec3f,
    kd: vec3f,
    colour: vec3f,
    metallic: f32,
    roughness: f32,
    f0: f32,
    incident: vec3f,
) -> vec3f {
    let n_dot_l = dot(n, l);
    if n_dot_l <= 0.0 {
        return vec3f(0.0);
    }
    let h = half_vector(l, v);
    let width = max(roughness * roughness, LEAST_WIDTH);
    let lobe = ggx_times_pi(n, h, width) * smith_visibility(n_dot_l, max(dot(n, v), LEAST_COSINE), width);
    let away = 1.0 - clamp(dot(v, h), 0.0, 1.0);
    let grazing = away * away * away * away * away;
    let coat = f0 + (1.0 - f0) * grazing;
    let dielectric = (1.0 - coat) * kd + vec3f(coat * lobe);
    let metal = lobe * (colour + (1.0 - colour) * grazing);
    return incident * n_dot_l * mix(dielectric, metal, metallic);
}
