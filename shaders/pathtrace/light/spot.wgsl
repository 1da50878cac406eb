//#import pathtrace/scene.wgsl
// The cones that point lights shine into. Twin: crates/pathtrace/src/light/spot.rs.

// Share of a point light's intensity in a unit direction away from it; 1 without a cone. Its axis stands where others have
// a normal, and the cosine of its edge and the edge's slope where they have a side.
fn spot_share(light: u32, direction: vec3f) -> f32 {
    let way = clamp((dot(direction, lights[light].normal) - lights[light].u.x) * lights[light].u.y, 0.0, 1.0);
    return way * way;
}
