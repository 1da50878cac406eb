//#import pathtrace/intersect/aggregate.wgsl
//#import pathtrace/light/light.wgsl
//#import pathtrace/bsdf/interaction.wgsl
// What a ray meets in the scene. Twins: crates/pathtrace/src/prepared.rs and
// crates/pathtrace/src/bsdf/materials.rs.

// Whether something stands between a point and what shines on it.
fn in_shadow(at: SurfacePoint, sample: LightSample) -> bool {
    let start = leaving_towards(at, sample.wi);
    if sample.endless {
        return occluded(Ray(start, sample.wi, FAR), sample.light);
    }
    return occluded(Ray(start, sample.end - start, SHADOW_END), sample.light);
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
    return Interaction(hit.point, facing(hit.point.normal, wo), wo, colour, lobe, hit.material);
}

// What the surface sends out towards wo.
fn emitted(at: Interaction) -> vec3f {
    let sides = materials[at.material].emitting_sides;
    let shines = sides == 2u || (sides == 1u && dot(at.point.normal, at.wo) > 0.0);
    return select(vec3f(0.0), materials[at.material].emission, shines);
}
