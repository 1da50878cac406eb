//#import pathtrace/needs.wgsl
//#import pathtrace/light/light_sample.wgsl
//#import pathtrace/light/spherical_rectangle.wgsl
//#import pathtrace/light/textured.wgsl
//#import pathtrace/sampling/warp.wgsl
//#import pathtrace/intersect/surface_point.wgsl
// A flat area light: the tutorial's L cos' S / |x - x'|^2. From nearby that weight has no bound; a rectangle is then
// sampled uniformly in solid angle instead. Twin: crates/pathtrace/src/light/flat.rs.

// Solid angle from which on a rectangle may be sampled by it: below, single precision knows the angle too badly.
const SMALLEST_SOLID_ANGLE: f32 = 0.05;

// The point of the area light for two numbers in [0, 1): uniform on it, but for rectangles that are seen from nearby.
fn flat_point(area_light: Light, u: vec2f) -> SurfacePoint {
    let place = flat_place(area_light, u);
    return on_plane(area_light.position, area_light.u * place.x, area_light.v * place.y, area_light.normal);
}

// How far along its edges that point lies.
fn flat_place(area_light: Light, u: vec2f) -> vec2f {
    if DISK_LIGHTS && area_light.outline == LIGHT_DISK {
        return disk(u).xy;
    }
    if TRIANGLE_LIGHTS && area_light.outline == LIGHT_TRIANGLE {
        return triangle(u).yz;
    }
    return u;
}

// Light from the area light at x.
fn flat_sample(area_light: Light, x: vec3f, u: vec2f) -> LightSample {
    var place = u;
    var solid_angle = 0.0;
    if is_seen_from_nearby(area_light, x) {
        let seen = spherical_rectangle(x, area_light.position, area_light.u, area_light.v);
        if seen.solid_angle > SMALLEST_SOLID_ANGLE {
            solid_angle = seen.solid_angle;
            place = sample_spherical_rectangle(seen, u);
        }
    }
    let point = flat_point(area_light, place);
    let to_light = point.position - x;
    let distance_squared = dot(to_light, to_light);
    if distance_squared == 0.0 {
        return no_light();
    }
    let wi = to_light / sqrt(distance_squared);
    let cos_light = flat_cosine(area_light, wi);
    if cos_light <= 0.0 {
        return no_light();
    }
    let inverse_pdf = select(cos_light * area_light.area / distance_squared, solid_angle, solid_angle > 0.0);
    if inverse_pdf <= SMALLEST_POSITIVE {
        return no_light();
    }
    let radiance = area_light.radiance * worn_at(area_light, flat_place(area_light, place));
    return LightSample(wi, 1.0 / inverse_pdf, radiance * inverse_pdf, false, leaving_towards(point, -wi), 0u);
}

// Density per solid angle of the direction from x to `met` on the area light; INFINITE_PDF for an edge that no sample
// sees.
fn flat_pdf(area_light: Light, x: vec3f, met: vec3f) -> f32 {
    if is_seen_from_nearby(area_light, x) {
        let seen = spherical_rectangle(x, area_light.position, area_light.u, area_light.v);
        if seen.solid_angle > SMALLEST_SOLID_ANGLE {
            return 1.0 / seen.solid_angle;
        }
    }
    let to_light = met - x;
    let distance_squared = dot(to_light, to_light);
    let cos_light = flat_cosine(area_light, to_light / sqrt(max(distance_squared, SMALLEST_POSITIVE)));
    if cos_light * area_light.area <= SMALLEST_POSITIVE {
        return INFINITE_PDF;
    }
    return distance_squared / (cos_light * area_light.area);
}

fn flat_cosine(area_light: Light, wi: vec3f) -> f32 {
    let cosine = -dot(area_light.normal, wi);
    return select(cosine, abs(cosine), area_light.two_sided == 1u);
}

// Whether this is a rectangle whose middle is nearer than the root of its area: there its solid angle is worth its
// price.
fn is_seen_from_nearby(area_light: Light, x: vec3f) -> bool {
    if !RECTANGLE_LIGHTS || area_light.outline != LIGHT_RECTANGLE || area_light.square == 0u {
        return false;
    }
    let to_middle = area_light.position + 0.5 * (area_light.u + area_light.v) - x;
    return dot(to_middle, to_middle) <= area_light.area;
}
