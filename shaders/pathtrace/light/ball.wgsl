//#import pathtrace/light/light_sample.wgsl
//#import pathtrace/sampling/warp.wgsl
//#import pathtrace/intersect/surface_point.wgsl
// A sphere as an area light: uniform in the cone that it fills as seen from a point outside; from inside, where only a
// two-sided area light shines, uniform in all directions. Twin: crates/pathtrace/src/light/ball.rs.

// 1 - cos of the cone of all directions.
const ALL_DIRECTIONS: f32 = 2.0;

// 1 - cos of the half angle of the cone that the sphere fills as seen from x; 0 from inside. A point on the sphere
// itself counts as inside.
fn one_minus_cos(x: vec3f, center: vec3f, radius: f32) -> f32 {
    let to_center = center - x;
    let distance = sqrt(dot(to_center, to_center));
    let largest = max(abs(center.x), max(abs(center.y), abs(center.z)));
    if distance <= radius + gamma(8.0) * (largest + radius) {
        return 0.0;
    }
    let cosine = sqrt((distance - radius) * (distance + radius)) / distance;
    let sine = radius / distance;
    return sine * sine / (1.0 + cosine);
}

// Density per solid angle of a direction from x that meets the sphere.
fn ball_pdf(area_light: Light, x: vec3f) -> f32 {
    let outside = one_minus_cos(x, area_light.position, area_light.area);
    return cone_pdf(select(ALL_DIRECTIONS, outside, outside > 0.0));
}

// Whether a sample from x may be a point of the ball on whose outer side x lies, or does not.
fn ball_is_seen(area_light: Light, x: vec3f, on_outer_side: bool) -> bool {
    let outside = one_minus_cos(x, area_light.position, area_light.area) > 0.0;
    return select(area_light.two_sided == 1u, on_outer_side, outside);
}

fn ball_sample(area_light: Light, x: vec3f, u: vec2f) -> LightSample {
    let radius = area_light.area;
    let to_center = area_light.position - x;
    let outside = one_minus_cos(x, area_light.position, radius);
    if outside == 0.0 && area_light.two_sided == 0u {
        return no_light();
    }
    var wi: vec3f;
    var pdf: f32;
    if outside > 0.0 {
        wi = to_world(cone(outside, u), to_center / sqrt(dot(to_center, to_center)));
        pdf = cone_pdf(outside);
    } else {
        wi = cone(ALL_DIRECTIONS, u);
        pdf = cone_pdf(ALL_DIRECTIONS);
    }
    // at the rim, rounding may find no meeting; then the point where the direction comes nearest stands for it
    let along = dot(to_center, wi);
    let off_axis = to_center - wi * along;
    let half_chord = sqrt(max(radius * radius - dot(off_axis, off_axis), 0.0));
    let met = wi * select(along + half_chord, along - half_chord, outside > 0.0) - to_center;
    let point = on_sphere(area_light.position, radius, met);
    return LightSample(wi, pdf, area_light.radiance / pdf, false, leaving_towards(point, -wi), 0u);
}
