//#import pathtrace/intersect/aggregate.wgsl
//#import pathtrace/light/light.wgsl
//#import pathtrace/bsdf/interaction.wgsl
//#import pathtrace/bsdf/shading.wgsl
//#import pathtrace/bsdf/textures.wgsl
// What a ray meets in the scene. Twins: crates/pathtrace/src/prepared.rs and
// crates/pathtrace/src/bsdf/materials.rs.

// What stands for the light that a shadow ray goes to, where it goes to none: of no surface, not even of one that is no
// light.
const NOT_A_LIGHT: u32 = 0xfffffffeu;

// Whether something stands between a point and what shines on it.
fn in_shadow(at: SurfacePoint, sample: LightSample) -> bool {
    return occluded(shadow_ray(at, sample), sample.light);
}

// The ray from a point to what shines on it.
fn shadow_ray(at: SurfacePoint, sample: LightSample) -> Ray {
    let start = leaving_towards(at, sample.wi);
    if sample.endless {
        return Ray(start, sample.wi, FAR);
    }
    return Ray(start, sample.end - start, SHADOW_END);
}

// The shadow ray between two points, of which the other lies in this unit direction.
fn ray_between(at: SurfacePoint, to: SurfacePoint, direction: vec3f) -> Ray {
    let start = leaving_towards(at, direction);
    return Ray(start, leaving_towards(to, -direction) - start, SHADOW_END);
}

// The surface that was met, seen from wo.
fn interaction_of(hit: Hit, wo: vec3f) -> Interaction {
    let lobe = materials[hit.material].lobe;
    var colour = materials[hit.material].colour.even;
    if CHECKERBOARD && (lobe & CHECKERED) != 0u {
        // a surface in the side between two cells belongs to the upper one, wherever its points are rounded to
        let upper = hit.point.position + hit.point.error * abs(hit.point.normal);
        colour = checkerboard(materials[hit.material].colour, upper);
    }
    var normal = facing(hit.point.normal, wo);
    var uv = vec2f(0.0);
    if SHADING_NORMALS || IMAGE_TEXTURES {
        let attributes = attributes_of(hit);
        uv = attributes.uv;
        if SHADING_NORMALS {
            normal = shading_normal(hit, attributes, wo);
        }
    }
    if IMAGE_TEXTURES && materials[hit.material].colour_texture != 0u {
        colour *= texture_at(materials[hit.material].colour_texture, uv).xyz;
    }
    return Interaction(hit.point, normal, wo, colour, lobe, hit.material, uv);
}

// What the surface sends out towards wo.
fn emitted(at: Interaction) -> vec3f {
    let sides = materials[at.material].emitting_sides;
    let shines = sides == 2u || (sides == 1u && dot(at.point.normal, at.wo) > 0.0);
    if IMAGE_TEXTURES && shines && materials[at.material].emission_texture != 0u {
        return materials[at.material].emission * texture_at(materials[at.material].emission_texture, at.uv).xyz;
    }
    return select(vec3f(0.0), materials[at.material].emission, shines);
}
