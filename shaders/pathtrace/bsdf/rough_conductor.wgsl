//#import pathtrace/bsdf/interaction.wgsl
//#import pathtrace/sampling/warp.wgsl
// Rough metal: microfacets whose slopes have GGX' distribution, with Smith's height-correlated masking and shadowing;
// single scattering. Directions here are local, z along the normal on the side of wo. Twin:
// crates/pathtrace/src/bsdf/rough_conductor.rs.

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

fn to_local(basis: Basis, normal: vec3f, w: vec3f) -> vec3f {
    return vec3f(dot(basis.s, w), dot(basis.t, w), dot(normal, w));
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
    // G2 / G1(wo)
    let wo_slope = slope_length(metal.alpha, wo);
    let wi_slope = slope_length(metal.alpha, wi);
    var passes = 0.0;
    if wi.z > 0.0 {
        passes = wi.z * (wo.z + wo_slope) / (wi.z * wo_slope + wo.z * wi_slope);
    }
    return BsdfSample(wi, conductor_fresnel(metal, cosine) * passes, pdf_of_facet(metal.alpha, wo, facet));
}

// F D G2 / (4 cos cos), in which the cosines cancel against those of G2.
fn eval_microfacets(metal: RoughConductor, wo: vec3f, wi: vec3f) -> ScaledColour {
    let facet = facet_between(wo, wi);
    let masked = wi.z * slope_length(metal.alpha, wo) + wo.z * slope_length(metal.alpha, wi);
    return ScaledColour(conductor_fresnel(metal, dot(wo, facet)), facet_density(metal.alpha, facet) * 0.5 / masked);
}

// Density of sample_microfacets per solid angle of wi.
fn pdf_microfacets(metal: RoughConductor, wo: vec3f, wi: vec3f) -> f32 {
    return pdf_of_facet(metal.alpha, wo, facet_between(wo, wi));
}

fn facet_between(wo: vec3f, wi: vec3f) -> vec3f {
    let sum = wo + wi;
    return sum / sqrt(dot(sum, sum));
}

// G1 D / (4 cos), per solid angle of the reflected direction.
fn pdf_of_facet(alpha: f32, wo: vec3f, facet: vec3f) -> f32 {
    return facet_density(alpha, facet) * 0.5 / (wo.z + slope_length(alpha, wo));
}

// Density of facets' normals, per solid angle and area.
fn facet_density(alpha: f32, facet: vec3f) -> f32 {
    let xy = facet.xy / alpha;
    let stretched = dot(xy, xy) + facet.z * facet.z;
    return FRAC_1_PI / (alpha * alpha * stretched * stretched);
}

// cos sqrt(1 + alpha^2 tan^2), around which Smith's terms are: G1 = 2 cos / (cos + this).
fn slope_length(alpha: f32, w: vec3f) -> f32 {
    let xy = w.xy * alpha;
    return sqrt(dot(xy, xy) + w.z * w.z);
}

// Draws a facet's normal as wo sees them: Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps" (2023).
fn visible_normal(alpha: f32, wo: vec3f, u: vec2f) -> vec3f {
    let stretched = vec3f(wo.xy * alpha, wo.z);
    let seen = stretched / sqrt(dot(stretched, stretched));
    let one_minus_cos = seen.z + 1.0;
    let cap = cone(one_minus_cos, u);
    // the sum of both z, which does not cancel
    let sum = vec3f((cap.xy + seen.xy) * alpha, one_minus_cos * (1.0 - u.x));
    return sum / sqrt(dot(sum, sum));
}
