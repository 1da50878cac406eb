//#import pathtrace/exact.wgsl
//#import pathtrace/sampling/angles.wgsl
//#import pathtrace/intersect/sphere.wgsl
// A rectangle sampled uniformly in the solid angle that it fills: Ureña, Fajardo and King, "An Area-Preserving
// Parametrization for Spherical Rectangles" (EGSR 2013). Twin: crates/pathtrace/src/light/spherical_rectangle.rs.

struct SphericalRectangle {
    x0: f32,
    x1: f32,
    y0: f32,
    y1: f32,
    // distance of the plane, negative
    z0: f32,
    // z of the normals of the great circles below and above
    b0: f32,
    b1: f32,
    // 2 pi less two of the inner angles
    k: f32,
    // in [0, 2 pi]; off by about 1e-6
    solid_angle: f32,
}

// The rectangle with this corner and these edges at right angles, seen from `eye`.
fn spherical_rectangle(eye: vec3f, corner: vec3f, edge_u: vec3f, edge_v: vec3f) -> SphericalRectangle {
    let width = sqrt(dot(edge_u, edge_u));
    let height = sqrt(dot(edge_v, edge_v));
    let x = edge_u / width;
    let y = edge_v / height;
    let d = corner - eye;
    var seen: SphericalRectangle;
    seen.z0 = -abs(dot(d, cross(x, y)));
    seen.x0 = dot(d, x);
    seen.y0 = dot(d, y);
    seen.x1 = seen.x0 + width;
    seen.y1 = seen.y0 + height;
    // in its plane an eye sees nothing of it
    if seen.z0 == 0.0 {
        return seen;
    }
    seen.b0 = -seen.y0 / sqrt(seen.z0 * seen.z0 + seen.y0 * seen.y0);
    seen.b1 = seen.y1 / sqrt(seen.z0 * seen.z0 + seen.y1 * seen.y1);
    let g0 = inner_angle(seen.z0, seen.x1, seen.y0, seen.x1 * seen.y0);
    let g1 = inner_angle(seen.z0, seen.x1, seen.y1, -seen.x1 * seen.y1);
    let g2 = inner_angle(seen.z0, seen.x0, seen.y1, seen.x0 * seen.y1);
    let g3 = inner_angle(seen.z0, seen.x0, seen.y0, -seen.x0 * seen.y0);
    seen.k = 6.28318530718 - g2 - g3;
    seen.solid_angle = max(g0 + g1 - seen.k, 0.0);
    return seen;
}

// At a corner: the arc cosine of xy / sqrt((x^2 + z^2) (y^2 + z^2)), as an arc tangent because close to the plane that
// cosine is 1 but for its last bits.
fn inner_angle(z0: f32, x: f32, y: f32, cosine: f32) -> f32 {
    return angle_of(-z0 * sqrt(x * x + y * y + z0 * z0), cosine);
}

// The place on the rectangle, in [0, 1]^2 along its edges, of a direction uniform in its solid angle.
fn sample_spherical_rectangle(seen: SphericalRectangle, u: vec2f) -> vec2f {
    if seen.solid_angle == 0.0 {
        return u;
    }
    let azimuth = sin_cos(u.x * seen.solid_angle + seen.k);
    // a sine of 0 stands for one so small that its quotient is the arc's end, and still has a square
    let sine = copysign(max(abs(azimuth.x), 1e-18), azimuth.x);
    let fu = (azimuth.y * seen.b0 - seen.b1) / sine;
    let cu = clamp(copysign(1.0 / sqrt(max(fu * fu + seen.b0 * seen.b0, 1e-30)), fu), -1.0, 1.0);
    let across_u = -(cu * seen.z0) / sqrt(max(1.0 - cu * cu, SMALLEST_POSITIVE));
    let xu = clamp(across_u, seen.x0, seen.x1);
    let d = sqrt(xu * xu + seen.z0 * seen.z0);
    let h0 = seen.y0 / sqrt(d * d + seen.y0 * seen.y0);
    let h1 = seen.y1 / sqrt(d * d + seen.y1 * seen.y1);
    let hv = h0 + u.y * (h1 - h0);
    let rest = max((1.0 - hv) * (1.0 + hv), SMALLEST_POSITIVE);
    let yv = clamp(hv * d / sqrt(rest), seen.y0, seen.y1);
    let corner = vec2f(seen.x0, seen.y0);
    return clamp((vec2f(xu, yv) - corner) / (vec2f(seen.x1, seen.y1) - corner), vec2f(0.0), vec2f(1.0));
}
