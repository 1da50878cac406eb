//#import pathtrace/bsdf/interaction.wgsl
//#import pathtrace/sampling/warp.wgsl
// Lambert's law: BRDF = albedo / pi. Twin: crates/pathtrace/src/bsdf/lambert.rs.

// Draws directions by the cosine, of which the weight is the albedo.
fn sample_lambert(at: Interaction, u: vec2f) -> BsdfSample {
    let local = cosine_hemisphere(u);
    return BsdfSample(to_world(local, at.normal), at.colour, local.z * FRAC_1_PI);
}

// The same in all directions.
fn eval_lambert(at: Interaction) -> ScaledColour {
    return ScaledColour(at.colour, FRAC_1_PI);
}

// Density of directions at this cosine to the normal.
fn pdf_lambert(cosine: f32) -> f32 {
    return cosine * FRAC_1_PI;
}
