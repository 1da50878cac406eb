//#import pathtrace/bsdf/lambert.wgsl
//#import pathtrace/bsdf/mirror.wgsl
//#import pathtrace/bsdf/dielectric.wgsl
//#import pathtrace/bsdf/rough_conductor.wgsl
//#import pathtrace/bsdf/shading.wgsl
//#import pathtrace/bsdf/metallic_roughness.wgsl
//#import pathtrace/bsdf/two_normals.wgsl
// How surfaces scatter light: what integrators ask of whatever lobe a surface has. Directions point away from the
// surface; wo is where the path came from, wi where it goes on. Twin: crates/pathtrace/src/bsdf/mod.rs.

// Draws a direction, from two random numbers for the direction and one for the choice among several.
fn sample_bsdf(at: Interaction, u: vec3f) -> BsdfSample {
    if has_two_normals(at) {
        return sample_two_normals(two_normals_of(at), u);
    }
    var sample = sample_lobe(at, u);
    if SHADING_NORMALS {
        sample.weight *= kept(at, sample.wi);
    }
    return sample;
}

// Draws the direction in which a photon goes on that came from wo, as sample_bsdf does for paths.
fn sample_adjoint(at: Interaction, u: vec3f) -> BsdfSample {
    if !SHADING_NORMALS {
        return sample_bsdf(at, u);
    }
    if has_two_normals(at) {
        return sample_adjoint_of_two(two_normals_of(at), u);
    }
    let left = as_left(at);
    var sample = sample_lobe(left, u);
    sample.weight *= kept(left, sample.wi) * adjoint(at, sample.wi);
    return sample;
}

// Whether body and facets may be shaded by different normals.
fn has_two_normals(at: Interaction) -> bool {
    return SHADING_NORMALS && METALLIC_ROUGHNESS && (at.lobe & LOBE_METALLIC_ROUGHNESS) != 0u;
}

fn sample_lobe(at: Interaction, u: vec3f) -> BsdfSample {
    if MIRROR && at.lobe == LOBE_MIRROR {
        return sample_mirror(at);
    }
    if DIELECTRIC && at.lobe == LOBE_DIELECTRIC {
        return sample_dielectric(at, u.z);
    }
    if ROUGH_CONDUCTOR && (at.lobe & LOBE_ROUGH_CONDUCTOR) != 0u {
        return sample_rough_conductor(at, u.xy);
    }
    if METALLIC_ROUGHNESS && (at.lobe & LOBE_METALLIC_ROUGHNESS) != 0u {
        return sample_metallic_roughness(at, u);
    }
    return sample_lambert(at, u.xy);
}

// The BSDF for light from the unit direction wi, on the side of wo, of which cosine_of is the cosine. Not of lobes that leave
// no choice.
fn eval_bsdf(at: Interaction, wi: vec3f) -> ScaledColour {
    if has_two_normals(at) {
        return eval_two_normals(two_normals_of(at), wi);
    }
    let value = eval_lobe(at, wi);
    return ScaledColour(value.colour, shadowed(at.normal, at.point.normal, wi, value.factor));
}

// The cosine of light from wi to the normal, and where there are two to the one that it is nearer to.
fn cosine_of(at: Interaction, wi: vec3f) -> f32 {
    let cosine = dot(at.normal, wi);
    if has_two_normals(at) {
        return max(cosine, dot(mirroring_normal(at), wi));
    }
    return cosine;
}

// The normal that mirrors, or that facets do.
fn mirroring_of(at: Interaction) -> vec3f {
    if has_two_normals(at) {
        return mirroring_normal(at);
    }
    return at.normal;
}

fn eval_lobe(at: Interaction, wi: vec3f) -> ScaledColour {
    if ROUGH_CONDUCTOR && (at.lobe & LOBE_ROUGH_CONDUCTOR) != 0u {
        return eval_rough_conductor(at, wi);
    }
    if METALLIC_ROUGHNESS && (at.lobe & LOBE_METALLIC_ROUGHNESS) != 0u {
        return eval_metallic_roughness(at, wi);
    }
    return eval_lambert(at);
}

// Density per solid angle of sample_bsdf at wi, whose cosine_of is above 0. Not of lobes that leave no choice.
fn bsdf_pdf(at: Interaction, wi: vec3f, cosine: f32) -> f32 {
    if has_two_normals(at) {
        return pdf_two_normals(two_normals_of(at), wi);
    }
    if ROUGH_CONDUCTOR && (at.lobe & LOBE_ROUGH_CONDUCTOR) != 0u {
        return pdf_rough_conductor(at, wi);
    }
    if METALLIC_ROUGHNESS && (at.lobe & LOBE_METALLIC_ROUGHNESS) != 0u {
        return pdf_metallic_roughness(at, wi);
    }
    return pdf_lambert(cosine);
}

// Where a surface sends all light on in one or two directions.
struct Specular {
    reflects: bool,
    refracts: bool,
    reflected: vec3f,
    refracted: vec3f,
    reflectance: ScaledColour,
    transmittance: f32,
}

// Both directions in which a mirror or glass sends light on. Rough metal is taken for a mirror that reflects as much,
// and so is the metal of metallic-roughness, and a polished coat.
fn specular_of(at: Interaction) -> Specular {
    var specular = specular_of_lobe(at);
    if SHADING_NORMALS {
        let g = facing(at.point.normal, at.normal);
        specular.reflects = specular.reflects && dot(g, specular.reflected) > 0.0;
        specular.refracts = specular.refracts && dot(g, specular.refracted) < 0.0;
    }
    return specular;
}

fn specular_of_lobe(at: Interaction) -> Specular {
    let normal = mirroring_of(at);
    let mirrored = reflect(at.wo, normal);
    if DIELECTRIC && at.lobe == LOBE_DIELECTRIC {
        let boundary = interface_of(at);
        let share = fresnel(boundary, dot(at.normal, at.wo));
        var refracted = mirrored;
        if share < 1.0 {
            let wi = refract(boundary, at.wo, at.normal);
            refracted = unit_vector(wi);
        }
        return Specular(share > 0.0, share < 1.0, mirrored, refracted, ScaledColour(at.colour, share), 1.0 - share);
    }
    if ROUGH_CONDUCTOR && (at.lobe & LOBE_ROUGH_CONDUCTOR) != 0u {
        let share = conductor_fresnel(rough_conductor_of(at), dot(at.normal, at.wo));
        return Specular(any(share != vec3f(0.0)), false, mirrored, mirrored, ScaledColour(share, 1.0), 0.0);
    }
    if METALLIC_ROUGHNESS && (at.lobe & LOBE_METALLIC_ROUGHNESS) != 0u {
        let share = coated_stand_ins(metallic_roughness_of(at), dot(normal, at.wo)).mirrored;
        return Specular(any(share != vec3f(0.0)), false, mirrored, mirrored, ScaledColour(share, 1.0), 0.0);
    }
    return Specular(any(at.colour != vec3f(0.0)), false, mirrored, mirrored, ScaledColour(at.colour, 1.0), 0.0);
}

// The albedo by which a tree of rays lights the surface directly, beside what specular_of sends on; black if it does not.
fn lit_albedo(at: Interaction) -> vec3f {
    if METALLIC_ROUGHNESS && (at.lobe & LOBE_METALLIC_ROUGHNESS) != 0u {
        return coated_stand_ins(metallic_roughness_of(at), dot(mirroring_of(at), at.wo)).lit;
    }
    return select(vec3f(0.0), at.colour, is_diffuse(at));
}
