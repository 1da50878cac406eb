//#import pathtrace/bsdf/metallic_roughness.wgsl
//#import pathtrace/bsdf/shading.wgsl
// Metallic-roughness where there are shading normals: its body is shaded by the normal that meshes and normal maps say, its
// facets by the one that keeps what they mirror above the triangle, as in Cycles. Light counts for each by its own cosine
// and terminator. Twin: crates/pathtrace/src/bsdf/two_normals.rs.

struct TwoNormals {
    surface: MetallicRoughness,
    // normal of the facets, and what is around it
    mirroring: vec3f,
    basis: Basis,
    // around the facets' normal
    wo: vec3f,
    // the same in the world
    wo_in_world: vec3f,
    // normal of the body
    body: vec3f,
    // normal of the triangle, on the side of wo
    triangle: vec3f,
}

fn two_normals_of(at: Interaction) -> TwoNormals {
    let mirroring = mirroring_normal(at);
    let basis = orthonormal_basis(mirroring);
    let wo = to_local(basis, mirroring, at.wo);
    let triangle = facing(at.point.normal, at.wo);
    return TwoNormals(metallic_roughness_of(at), mirroring, basis, wo, at.wo, at.normal, triangle);
}

// Draws a direction by the facets that wo sees or by the body's cosine, from two random numbers for the direction and one
// for that choice.
fn sample_two_normals(two: TwoNormals, u: vec3f) -> BsdfSample {
    let wi = draw_by(two, two.body, u);
    let scattered = sum_of_parts(two, wi, parts_cosines(two, wi));
    return weighted(wi, density_by(two, two.body, wi), scattered);
}

// The same for a photon that came from wo. The body sends it out by the triangle's cosine.
fn sample_adjoint_of_two(two: TwoNormals, u: vec3f) -> BsdfSample {
    let wi = draw_by(two, two.triangle, u);
    let arrives = dot(two.triangle, two.wo_in_world);
    let leaves = dot(two.triangle, wi);
    var sent = vec3f(0.0);
    if arrives > 0.0 && leaves > 0.0 {
        sent = sum_of_parts(two, wi, parts_cosines(two, two.wo_in_world)) * (leaves / arrives);
    }
    return weighted(wi, density_by(two, two.triangle, wi), sent);
}

fn weighted(wi: vec3f, pdf: f32, scattered: vec3f) -> BsdfSample {
    if all(scattered == vec3f(0.0)) {
        return BsdfSample(wi, vec3f(0.0), pdf);
    }
    return BsdfSample(wi, scattered / pdf, pdf);
}

// The BSDF for light from the unit direction wi over its larger cosine to both normals.
fn eval_two_normals(two: TwoNormals, wi: vec3f) -> ScaledColour {
    let larger = max(dot(two.body, wi), dot(two.mirroring, wi));
    if larger <= 0.0 {
        return ScaledColour(vec3f(0.0), 1.0);
    }
    return ScaledColour(sum_of_parts(two, wi, parts_cosines(two, wi)) / larger, 1.0);
}

// Density per solid angle of sample_two_normals at wi.
fn pdf_two_normals(two: TwoNormals, wi: vec3f) -> f32 {
    return density_by(two, two.body, wi);
}

fn draw_by(two: TwoNormals, body: vec3f, u: vec3f) -> vec3f {
    if u.z >= specular_probability(two.surface, two.wo.z) {
        return to_world(cosine_hemisphere(u.xy), body);
    }
    let facet = visible_normal(two.surface.roughness * two.surface.roughness, two.wo, u.xy);
    let local = 2.0 * dot(two.wo, facet) * facet - two.wo;
    return two.basis.s * local.x + two.basis.t * local.y + two.mirroring * local.z;
}

fn density_by(two: TwoNormals, body: vec3f, wi: vec3f) -> f32 {
    let specular = specular_probability(two.surface, two.wo.z);
    let facet = facet_between(two.wo, to_local(two.basis, two.mirroring, wi));
    var of_facets = 0.0;
    // none is seen from below
    if facet.z > 0.0 {
        of_facets = pdf_of_facet(two.surface.roughness * two.surface.roughness, two.wo, facet);
    }
    return specular * of_facets + (1.0 - specular) * (max(dot(body, wi), 0.0) * FRAC_1_PI);
}

// By how much light from w counts, for the facets and for the body.
fn parts_cosines(two: TwoNormals, w: vec3f) -> vec2f {
    return vec2f(
        dot(two.mirroring, w) * terminator(two.mirroring, two.triangle, w),
        dot(two.body, w) * terminator(two.body, two.triangle, w));
}

// What facets and body scatter between wo and the direction in_world of light with these cosines.
fn sum_of_parts(two: TwoNormals, in_world: vec3f, cosines: vec2f) -> vec3f {
    let alpha = two.surface.roughness * two.surface.roughness;
    let wi = to_local(two.basis, two.mirroring, in_world);
    let facet = facet_between(two.wo, wi);
    let cosine = dot(two.wo, facet);
    var sum = vec3f(0.0);
    if cosines.x > 0.0 && wi.z > 0.0 {
        sum = coated_fresnel(two.surface, cosine) * (facets_value(alpha, two.wo, wi, facet) * cosines.x);
    }
    if cosines.y > 0.0 {
        let body = two.surface.base_colour * (1.0 - two.surface.metallic);
        let lower = min(two.wo.z, max(wi.z, 0.0));
        sum += body * (passes_coat(two.surface, cosine, lower) * FRAC_1_PI * cosines.y);
    }
    return sum;
}
