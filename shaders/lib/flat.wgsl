//#import lib/needs.wgsl
//#import lib/light_sample.wgsl
//#import lib/spherical_rectangle.wgsl
//#import lib/sampling.wgsl
//#import lib/surface_point.wgsl
// A flat lamp: the tutorial's L cos' S / |x - x'|^2. From nearby that weight has no bound; a rectangle is then sampled uniformly
// in solid angle instead. Twin: crates/pathtrace/src/light/flat.rs.

// Solid angle from which on a rectangle may be sampled by it: below, single precision knows the angle too badly.
const SMALLEST_SOLID_ANGLE: f32 = 0.05;

// The point of the lamp for two numbers in [0, 1): uniform on it, but for rectangles that are seen from nearby.
fn flat_point(lamp: Light, u: vec2f) -> SurfacePoint {
    var place = u;
    if DISK_LAMPS && lamp.outline == LIGHT_DISK {
        place = disk(u).xy;
    } else if TRIANGLE_LAMPS && lamp.outline == LIGHT_TRIANGLE {
        place = triangle(u).yz;
    }
    return on_plane(lamp.position, lamp.u * place.x, lamp.v * place.y, lamp.normal);
}

// Light from the lamp at x.
fn flat_sample(lamp: Light, x: vec3f, u: vec2f) -> LightSample {
    var place = u;
    var solid_angle = 0.0;
    if is_seen_from_nearby(lamp, x) {
        let seen = spherical_rectangle(x, lamp.position, lamp.u, lamp.v);
        if seen.solid_angle > SMALLEST_SOLID_ANGLE {
            solid_angle = seen.solid_angle;
            place = sample_spherical_rectangle(seen, u);
        }
    }
    let point = flat_point(lamp, place);
    let to_light = point.position - x;
    let distance_squared = dot(to_light, to_light);
    if distance_squared == 0.0 {
        return no_light();
    }
    let wi = to_light / sqrt(distance_squared);
    let cos_light = flat_cosine(lamp, wi);
    if cos_light <= 0.0 {
        return no_light();
    }
    let inverse_pdf = select(cos_light * lamp.area / distance_squared, solid_angle, solid_angle > 0.0);
    if inverse_pdf <= SMALLEST_POSITIVE {
        return no_light();
    }
    return LightSample(wi, 1.0 / inverse_pdf, lamp.radiance * inverse_pdf, false, leaving_towards(point, -wi));
}

// Density per solid angle of the direction from x to `met` on the lamp; INFINITE_PDF for an edge that no sample sees.
fn flat_pdf(lamp: Light, x: vec3f, met: vec3f) -> f32 {
    if is_seen_from_nearby(lamp, x) {
        let seen = spherical_rectangle(x, lamp.position, lamp.u, lamp.v);
        if seen.solid_angle > SMALLEST_SOLID_ANGLE {
            return 1.0 / seen.solid_angle;
        }
    }
    let to_light = met - x;
    let distance_squared = dot(to_light, to_light);
    let cos_light = flat_cosine(lamp, to_light / sqrt(max(distance_squared, SMALLEST_POSITIVE)));
    if cos_light * lamp.area <= SMALLEST_POSITIVE {
        return INFINITE_PDF;
    }
    return distance_squared / (cos_light * lamp.area);
}

fn flat_cosine(lamp: Light, wi: vec3f) -> f32 {
    let cosine = -dot(lamp.normal, wi);
    return select(cosine, abs(cosine), lamp.two_sided == 1u);
}

// Whether this is a rectangle whose middle is nearer than the root of its area: there its solid angle is worth its price.
fn is_seen_from_nearby(lamp: Light, x: vec3f) -> bool {
    if !RECTANGLE_LAMPS || lamp.outline != LIGHT_RECTANGLE || lamp.square == 0u {
        return false;
    }
    let to_middle = lamp.position + 0.5 * (lamp.u + lamp.v) - x;
    return dot(to_middle, to_middle) <= lamp.area;
}
