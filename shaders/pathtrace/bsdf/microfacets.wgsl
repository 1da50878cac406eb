//#import pathtrace/sampling/warp.wgsl
// Microfacets whose slopes have GGX' distribution, with Smith's height-correlated masking and shadowing; single
// scattering. Directions here are local, z along the normal on the side of wo. Twin:
// crates/pathtrace/src/bsdf/microfacets.rs.

fn to_local(basis: Basis, normal: vec3f, w: vec3f) -> vec3f {
    return vec3f(dot(basis.s, w), dot(basis.t, w), dot(normal, w));
}

// Of what a facet reflects from wo to wi, the share that no other facet takes: G2 / G1(wo).
fn facets_pass(alpha: f32, wo: vec3f, wi: vec3f) -> f32 {
    let wo_slope = slope_length(alpha, wo);
    let wi_slope = slope_length(alpha, wi);
    return wi.z * (wo.z + wo_slope) / (wi.z * wo_slope + wo.z * wi_slope);
}

// D G2 / (4 cos cos), in which the cosines cancel against those of G2.
fn facets_value(alpha: f32, wo: vec3f, wi: vec3f, facet: vec3f) -> f32 {
    let masked = wi.z * slope_length(alpha, wo) + wo.z * slope_length(alpha, wi);
    return facet_density(alpha, facet) * 0.5 / masked;
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
