//#import pathtrace/bsdf/interaction.wgsl
//#import pathtrace/bsdf/microfacets.wgsl
//#import pathtrace/bsdf/textures.wgsl
// glTF's metallic-roughness model: facets of metal and of a coat, and a body by Lambert's law that gets no more light than
// the coat leaves. Directions are local, z along the normal on the side of wo. Twin:
// crates/pathtrace/src/bsdf/metallic_roughness.rs.

// facets of less roughness are taken for these
const SMOOTHEST: f32 = 0.01;
// least probability with which directions are drawn by the facets
const LEAST_SPECULAR: f32 = 0.125;
// roughness up to which Whitted's method sees a mirror in a coat
const POLISHED: f32 = 0.1;

struct MetallicRoughness {
    // albedo of the body and reflectance of the metal
    base_colour: vec3f,
    // share of metal
    metallic: f32,
    // the facets' roughness, the root of their alpha, from SMOOTHEST
    roughness: f32,
    // what the coat reflects at normal incidence
    coat: f32,
}

// Here alone is asked what pictures may vary from place to place.
fn metallic_roughness_of(at: Interaction) -> MetallicRoughness {
    let material = at.material;
    let texture = materials[material].metallic_roughness_texture;
    var found = vec2f(materials[material].metallic, materials[material].roughness);
    if IMAGE_TEXTURES && texture != 0u {
        found *= texture_at(texture, at.uv).zy;
    }
    return MetallicRoughness(at.colour, found.x, max(found.y, SMOOTHEST), materials[material].coat);
}

// Draws a direction by the facets that wo sees or by the cosine, from two random numbers for the direction and one for
// that choice.
fn sample_metallic_roughness(at: Interaction, u: vec3f) -> BsdfSample {
    let basis = orthonormal_basis(at.normal);
    let local = sample_coated(metallic_roughness_of(at), to_local(basis, at.normal, at.wo), u);
    let wi = basis.s * local.wi.x + basis.t * local.wi.y + at.normal * local.wi.z;
    return BsdfSample(wi, local.weight, local.pdf);
}

// The BSDF for light from the unit direction wi above the surface.
fn eval_metallic_roughness(at: Interaction, wi: vec3f) -> ScaledColour {
    let basis = orthonormal_basis(at.normal);
    return eval_coated(
        metallic_roughness_of(at), to_local(basis, at.normal, at.wo), to_local(basis, at.normal, wi));
}

// Density per solid angle of sample_metallic_roughness at wi.
fn pdf_metallic_roughness(at: Interaction, wi: vec3f) -> f32 {
    let basis = orthonormal_basis(at.normal);
    return pdf_coated(
        metallic_roughness_of(at), to_local(basis, at.normal, at.wo), to_local(basis, at.normal, wi));
}

// What metal and coat reflect at normal incidence, both together.
fn straight(surface: MetallicRoughness) -> vec3f {
    return surface.base_colour * surface.metallic + surface.coat * (1.0 - surface.metallic);
}

// How far Schlick's approximation has gone from the reflectance at normal incidence to 1.
fn grazing(cosine: f32) -> f32 {
    let rest = max(1.0 - cosine, 0.0);
    let squared = rest * rest;
    return squared * squared * rest;
}

// What facets reflect, of metal and coat together.
fn coated_fresnel(surface: MetallicRoughness, cosine: f32) -> vec3f {
    let rest = grazing(cosine);
    return straight(surface) * (1.0 - rest) + rest;
}

// About what all facets together reflect of light at this cosine to the normal.
fn coat_albedo(straight: f32, roughness: f32, cosine: f32) -> f32 {
    let at_grazing = 1.0 / (1.0 + roughness * roughness * roughness * 12.0);
    return straight + (1.0 - straight) * at_grazing * grazing(cosine);
}

// Share of the light that reaches the body and comes back out, by the cosine to the facet and the smaller one of both
// directions to the normal.
fn passes_coat(surface: MetallicRoughness, of_facet: f32, lower: f32) -> f32 {
    let reflected = surface.coat + (1.0 - surface.coat) * grazing(of_facet);
    return 1.0 - max(reflected, coat_albedo(surface.coat, surface.roughness, lower));
}

// Probability of drawing by the facets: their share of what is reflected, as it is estimated for wo at this cosine.
fn specular_probability(surface: MetallicRoughness, cosine: f32) -> f32 {
    let reflected = straight(surface);
    let brightest = max(max(reflected.x, reflected.y), reflected.z);
    let specular = coat_albedo(brightest, surface.roughness, cosine);
    let coat = coat_albedo(surface.coat, surface.roughness, cosine);
    let body = surface.base_colour * (1.0 - surface.metallic);
    let diffuse = max(max(body.x, body.y), body.z) * (1.0 - coat);
    let both = specular + diffuse;
    return max(select(1.0, specular / both, both > 0.0), LEAST_SPECULAR);
}

// Draws a direction; the weight is 0 where it lies below the surface, and at most 1 / LEAST_SPECULAR.
fn sample_coated(surface: MetallicRoughness, wo: vec3f, u: vec3f) -> BsdfSample {
    let alpha = surface.roughness * surface.roughness;
    let specular = specular_probability(surface, wo.z);
    var facet: vec3f;
    var wi: vec3f;
    if u.z < specular {
        facet = visible_normal(alpha, wo, u.xy);
        wi = 2.0 * dot(wo, facet) * facet - wo;
    } else {
        wi = cosine_hemisphere(u.xy);
        facet = facet_between(wo, wi);
    }
    let cosine = dot(wo, facet);
    let diffuse_pdf = max(wi.z, 0.0) * FRAC_1_PI;
    let facet_pdf = pdf_of_facet(alpha, wo, facet);
    let pdf = specular * facet_pdf + (1.0 - specular) * diffuse_pdf;
    if wi.z <= 0.0 {
        return BsdfSample(wi, vec3f(0.0), pdf);
    }
    // BSDF times cosine
    let from_facets = coated_fresnel(surface, cosine) * (facets_pass(alpha, wo, wi) * facet_pdf);
    let body = surface.base_colour * (1.0 - surface.metallic);
    let from_body = body * (passes_coat(surface, cosine, min(wo.z, wi.z)) * diffuse_pdf);
    return BsdfSample(wi, (from_facets + from_body) / pdf, pdf);
}

// Facets and body.
fn eval_coated(surface: MetallicRoughness, wo: vec3f, wi: vec3f) -> ScaledColour {
    let alpha = surface.roughness * surface.roughness;
    let facet = facet_between(wo, wi);
    let cosine = dot(wo, facet);
    let from_facets = coated_fresnel(surface, cosine) * facets_value(alpha, wo, wi, facet);
    let body = surface.base_colour * (1.0 - surface.metallic);
    let from_body = body * (passes_coat(surface, cosine, min(wo.z, wi.z)) * FRAC_1_PI);
    return ScaledColour(from_facets + from_body, 1.0);
}

// Density of sample_coated per solid angle of wi above the surface.
fn pdf_coated(surface: MetallicRoughness, wo: vec3f, wi: vec3f) -> f32 {
    let specular = specular_probability(surface, wo.z);
    let facet_pdf = pdf_of_facet(surface.roughness * surface.roughness, wo, facet_between(wo, wi));
    return specular * facet_pdf + (1.0 - specular) * (wi.z * FRAC_1_PI);
}

// What a tree of rays makes of it: the share that is mirrored, and the albedo of the rest.
struct CoatedStandIns {
    mirrored: vec3f,
    lit: vec3f,
}

// At this cosine: metal is mirrored however rough it is, the coat where it is polished; else it is left out.
fn coated_stand_ins(surface: MetallicRoughness, cosine: f32) -> CoatedStandIns {
    let rest = grazing(cosine);
    let of_coat = select(0.0, surface.coat + (1.0 - surface.coat) * rest, surface.roughness <= POLISHED);
    let of_metal = surface.base_colour * (1.0 - rest) + rest;
    let mirrored = of_metal * surface.metallic + of_coat * (1.0 - surface.metallic);
    return CoatedStandIns(mirrored, surface.base_colour * ((1.0 - surface.metallic) * (1.0 - of_coat)));
}
