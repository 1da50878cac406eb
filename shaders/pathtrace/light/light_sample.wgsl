// Light that arrives at a point from one sampled direction, if nothing stands between. Twin:
// crates/pathtrace/src/light/light_samples.rs, in lanes.

struct LightSample {
    // unit direction towards the light
    wi: vec3f,
    // per solid angle; INFINITE_PDF for a point and a delta sun, 0 where the light does not shine
    pdf: f32,
    // radiance divided by pdf; for a point or a delta sun its irradiance
    radiance_over_pdf: vec3f,
    // whether the shadow ray has no end
    endless: bool,
    // where it ends, off the area light
    end: vec3f,
    // which light, by its index; the light itself does not know
    light: u32,
}

// Of a single direction. Here alone: lanes have infinity, which shaders may take away.
const INFINITE_PDF: f32 = 1e30;

fn no_light() -> LightSample {
    return LightSample(vec3f(0.0), 0.0, vec3f(0.0), false, vec3f(0.0), 0u);
}
