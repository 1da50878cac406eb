//#import pathtrace/bsdf/interaction.wgsl
//#import pathtrace/bsdf/microfacets.wgsl
// Rough metal: microfacets of metal; single scattering. Directions here are local, z along the normal on the side of wo.
// Twin: crates/pathtrace/src/bsdf/rough_conductor.rs.

struct RoughConductor {
    // width of the distribution of slopes
    alpha: f32,
    // what facets reflect where no equations say it
    reflectance: vec3f,
    // whether Fresnel's equations say it, by these
    has_index: bool,
    eta: vec3f,
    k: vec3f,
}

fn rough_conductor_of(at: Interaction) -> RoughConductor {
    let has_index = (at.lobe & HAS_INDEX) != 0u;
    let material = at.material;
    return RoughConductor(materials[material].alpha, at.colour, has_index, materials[material].eta, materials[material].k);
}

// Draws a direction by the facets that wo sees.
fn sample_rough_conductor(at: Interaction, u: vec2f) -> BsdfSample {
    let basis = orthonormal_basis(at.normal);
    let local = sample_microfacets(rough_conductor_of(at), to_local(basis, at.normal, at.wo), u);
    let wi = basis.s * local.wi.x + basis.t * local.wi.y + at.normal * local.wi.z;
    return BsdfSample(wi, local.weight, local.pdf);
}

// The BSDF for light from the unit direction wi above the surface.
fn eval_rough_conductor(at: Interaction, wi: vec3f) -> ScaledColour {
    let basis = orthonormal_basis(at.normal);
    return eval_microfacets(
        rough_conductor_of(at), to_local(basis, at.normal, at.wo), to_local(basis, at.normal, wi));
}

// Density per solid angle of sample_rough_conductor at wi.
fn pdf_rough_conductor(at: Interaction, wi: vec3f) -> f32 {
    let basis = orthonormal_basis(at.normal);
    return pdf_microfacets(
        rough_conductor_of(at), to_local(basis, at.normal, at.wo), to_local(basis, at.normal, wi));
}

// What a facet reflects of light at this cosine to its normal: Fresnel's equations for a conductor.
fn conductor_fresnel(metal: RoughConductor, cosine: f32) -> vec3f {
    if !metal.has_index {
        return metal.reflectance;
    }
    let cos2 = cosine * cosine;
    let sin2 = 1.0 - cos2;
    let eta2 = metal.eta * metal.eta;
    let k2 = metal.k * metal.k;
    let real = eta2 - k2 - sin2;
    let modulus = sqrt(real * real + 4.0 * eta2 * k2);
    // half of modulus + real, which cancels where that is negative
    let a2 = select(0.5 * (modulus + real), 2.0 * eta2 * k2 / (modulus - real), real < vec3f(0.0));
    let product = 2.0 * cosine * sqrt(a2);
    let perpendicular = (modulus + cos2 - product) / (modulus + cos2 + product);
    let sum = cos2 * modulus + sin2 * sin2;
    let parallel = perpendicular * (sum - product * sin2) / (sum + product * sin2);
    return 0.5 * (perpendicular + parallel);
}

// Draws a direction; the weight is 0 where it lies below the surface.
fn sample_microfacets(metal: RoughConductor, wo: vec3f, u: vec2f) -> BsdfSample {
    let facet = visible_normal(metal.alpha, wo, u);
    let cosine = dot(wo, facet);
    let wi = 2.0 * cosine * facet - wo;
    var passes = 0.0;
    if wi.z > 0.0 {
        passes = facets_pass(metal.alpha, wo, wi);
    }
    return BsdfSample(wi, conductor_fresnel(metal, cosine) * passes, pdf_of_facet(metal.alpha, wo, facet));
}

// F D G2 / (4 cos cos).
fn eval_microfacets(metal: RoughConductor, wo: vec3f, wi: vec3f) -> ScaledColour {
    let facet = facet_between(wo, wi);
    return ScaledColour(conductor_fresnel(metal, dot(wo, facet)), facets_value(metal.alpha, wo, wi, facet));
}

// Density of sample_microfacets per solid angle of wi.
fn pdf_microfacets(metal: RoughConductor, wo: vec3f, wi: vec3f) -> f32 {
    return pdf_of_facet(metal.alpha, wo, facet_between(wo, wi));
}
