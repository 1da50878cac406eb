//#import pathtrace/needs.wgsl
//#import pathtrace/light/light_sample.wgsl
//#import pathtrace/sampling/warp.wgsl
//#import pathtrace/scene.wgsl
// The sun: a cone of directions, or one. Twin: crates/pathtrace/src/light/sun.rs.

fn sun_sample(sun: Light, u: vec2f) -> LightSample {
    if sun.area == 0.0 {
        return LightSample(sun.position, INFINITE_PDF, sun.radiance, true, vec3f(0.0), 0u);
    }
    let wi = to_world(cone(sun.area, u), sun.position);
    let pdf = cone_pdf(sun.area);
    return LightSample(wi, pdf, sun.radiance / pdf, true, vec3f(0.0), 0u);
}

// Radiance that a ray finds where it hits nothing: the sky of one colour, and `sun_weight` times the sun's disc unless it is a delta
// light. Measured by the chord between unit vectors, which stays exact for a small sun where a cosine does not.
fn environment(sun_weight: f32, direction: vec3f) -> vec3f {
    if SUN {
        let chord = direction - header.sun_towards;
        let inside = dot(chord, chord) < header.sun_chord_squared;
        return header.sky + select(vec3f(0.0), header.sun_radiance * sun_weight, inside);
    }
    return header.sky;
}
