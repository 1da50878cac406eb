//#import pathtrace/bsdf/interaction.wgsl
// A perfect mirror. Twin: crates/pathtrace/src/bsdf/mirror.rs.

// The one direction that there is; the weight is the reflectance.
fn sample_mirror(at: Interaction) -> BsdfSample {
    return delta_sample(at, reflect(at.wo, at.normal));
}

// The mirror direction of wo (pointing away from the surface) about the unit normal n.
fn reflect(wo: vec3f, n: vec3f) -> vec3f {
    return 2.0 * dot(n, wo) * n - wo;
}
