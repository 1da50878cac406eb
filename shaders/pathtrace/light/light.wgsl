//#import pathtrace/light/flat.wgsl
//#import pathtrace/light/ball.wgsl
//#import pathtrace/light/spot.wgsl
//#import pathtrace/light/sun.wgsl
//#import pathtrace/light/tree.wgsl
//#import pathtrace/light/environment.wgsl
// What shines, as light sampling sees it: area lights, point lights, the sun and a sky from a picture. Task 2 c),
// "Sampling Area Light". One light is chosen, then a direction to it. Twin: crates/pathtrace/src/light/table.rs, in
// lanes.

// The light that u in [0, 1) chooses.
fn choose(u: f32) -> u32 {
    return choose_from(0u, header.lights, u);
}

// The light that u in [0, 1) chooses for a point: of many by the tree, or one of the few that have no place.
fn choose_for(x: vec3f, u: f32) -> ChosenLight {
    if MANY_LIGHTS && u < header.tree_share {
        let chosen = choose_in_tree(x, min(u / header.tree_share, BELOW_ONE));
        return ChosenLight(chosen.light, chosen.probability * header.tree_share);
    }
    let light = choose(u);
    return ChosenLight(light, lights[light].probability);
}

// With what probability a light that has a place is chosen for a point.
fn probability_for(light: u32, x: vec3f) -> f32 {
    if MANY_LIGHTS {
        return probability_in_tree(light, x) * header.tree_share;
    }
    return lights[light].probability;
}

// Which of `count` lights from the first one on u in [0, 1) chooses: the first whose running sum exceeds it.
fn choose_from(first: u32, count: u32, u: f32) -> u32 {
    var low = first;
    var high = first + count - 1u;
    while low < high {
        let middle = (low + high) / 2u;
        if lights[middle].cumulative <= u {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

// Samples the light that reaches the point x: one number in [0, 1) to choose a light, two to choose a point on it.
fn sample_light(x: vec3f, u_light: f32, u: vec2f) -> LightSample {
    return dimmed(sample_light_whole(x, u_light, u));
}

// As sample_light, but as if spots shone everywhere: of light that leaves its place in another direction, which is dimmed
// by the share of that one.
fn sample_light_whole(x: vec3f, u_light: f32, u: vec2f) -> LightSample {
    let chosen = choose_for(x, u_light);
    if MANY_LIGHTS && chosen.probability <= 0.0 {
        return no_light();
    }
    var sample = sample_one_whole(chosen.light, x, u);
    sample.radiance_over_pdf /= chosen.probability;
    sample.pdf *= chosen.probability;
    return sample;
}

// As sample_light, but of one light of the caller's choice, whose probability is not in the densities.
fn sample_one(light: u32, x: vec3f, u: vec2f) -> LightSample {
    return dimmed(sample_one_whole(light, x, u));
}

// A sample as far as its light shines there.
fn dimmed(sample: LightSample) -> LightSample {
    if !POINT_LIGHTS || lights[sample.light].outline != LIGHT_POINT {
        return sample;
    }
    let share = spot_share(sample.light, -sample.wi);
    if share <= 0.0 {
        return no_light();
    }
    var seen = sample;
    seen.radiance_over_pdf *= share;
    return seen;
}

fn sample_one_whole(light: u32, x: vec3f, u: vec2f) -> LightSample {
    var sample = sample_of(lights[light], x, u);
    sample.light = light;
    return sample;
}

fn sample_of(area_light: Light, x: vec3f, u: vec2f) -> LightSample {
    if BALL_LIGHTS && area_light.outline == LIGHT_BALL {
        return ball_sample(area_light, x, u);
    }
    if POINT_LIGHTS && area_light.outline == LIGHT_POINT {
        return point_sample(area_light, x);
    }
    if SUN && area_light.outline == LIGHT_SUN {
        return sun_sample(area_light, u);
    }
    if ENVIRONMENT && area_light.outline == LIGHT_ENVIRONMENT {
        return environment_sample(u);
    }
    if RECTANGLE_LIGHTS || TRIANGLE_LIGHTS || DISK_LIGHTS {
        return flat_sample(area_light, x, u);
    }
    return no_light();
}

// Density per solid angle with which sample_light at x draws the direction that met `light` at `met`.
fn light_pdf(light: u32, x: vec3f, met: vec3f) -> f32 {
    let area_light = lights[light];
    let probability = probability_for(light, x);
    if MANY_LIGHTS && probability <= 0.0 {
        // behind a flat light, where the tree leaves it out, its density is infinite
        return 0.0;
    }
    if BALL_LIGHTS && area_light.outline == LIGHT_BALL {
        return ball_pdf(area_light, x) * probability;
    }
    if RECTANGLE_LIGHTS || TRIANGLE_LIGHTS || DISK_LIGHTS {
        return flat_pdf(area_light, x, met) * probability;
    }
    return 0.0;
}

// As light_pdf, but 0 where no sample at x is that point of the light: on its back, or on the far side of a ball.
fn light_pdf_where_sampled(light: u32, x: vec3f, met: SurfacePoint) -> f32 {
    let cosine = dot(met.normal, x - met.position);
    let two_sided = lights[light].two_sided == 1u;
    var sampled = cosine > 0.0 || (two_sided && cosine < 0.0);
    if BALL_LIGHTS && lights[light].outline == LIGHT_BALL {
        sampled = ball_is_seen(lights[light], x, cosine > 0.0);
    }
    return select(0.0, light_pdf(light, x, met.position), sampled);
}

// Intensity over squared distance: the irradiance on a surface that faces the point.
fn point_sample(light: Light, x: vec3f) -> LightSample {
    let to_light = light.position - x;
    let distance_squared = dot(to_light, to_light);
    if distance_squared <= 0.0 {
        return no_light();
    }
    let wi = to_light / sqrt(distance_squared);
    return LightSample(wi, INFINITE_PDF, light.radiance / distance_squared, false, light.position, 0u);
}
