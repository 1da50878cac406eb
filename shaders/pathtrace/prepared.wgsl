//#import pathtrace/intersect/aggregate.wgsl
//#import pathtrace/light/light.wgsl
// What a ray meets in the scene. Twins: crates/pathtrace/src/prepared.rs and
// crates/pathtrace/src/bsdf/materials.rs.

// Whether something stands between a point and what shines on it.
fn in_shadow(at: SurfacePoint, sample: LightSample) -> bool {
    let start = leaving_towards(at, sample.wi);
    if sample.endless {
        return occluded(Ray(start, sample.wi, FAR));
    }
    return occluded(Ray(start, sample.end - start, SHADOW_END));
}

// The normal on the side of wo.
fn facing(normal: vec3f, wo: vec3f) -> vec3f {
    return select(normal, -normal, dot(normal, wo) < 0.0);
}

// What a surface of outward `normal` sends out against a ray of this direction.
fn emitted(material: Material, normal: vec3f, ray_direction: vec3f) -> vec3f {
    let shines = material.emitting_sides == 2u || (material.emitting_sides == 1u && dot(normal, ray_direction) < 0.0);
    return select(vec3f(0.0), material.emission, shines);
}

// The colour at a point of world space.
fn colour_at(material: Material, position: vec3f) -> vec3f {
    if CHECKERBOARD && material.bsdf == BSDF_CHECKERBOARD {
        return checkerboard(material.colour, position);
    }
    return material.colour.even;
}
