//#import pathtrace/needs.wgsl
//#import pathtrace/exact.wgsl
//#import pathtrace/intersect/ray.wgsl
// A point on a surface with a bound on its rounding error, and the step off the surface that the bound asks for (pbrt,
// section 6.8). Twin: crates/pathtrace/src/intersect/surface_point.rs.

struct SurfacePoint {
    // world space
    position: vec3f,
    // the true point lies within this distance along each axis
    error: vec3f,
    // unit geometric normal
    normal: vec3f,
    // of a sphere; 0 if the surface is flat
    radius: f32,
}

// The point of a triangle with these barycentrics. Far more exact than origin + t * direction.
fn on_triangle(a: vec3f, b: vec3f, c: vec3f, barycentrics: vec3f, normal: vec3f) -> SurfacePoint {
    let pa = a * barycentrics.x;
    let pb = b * barycentrics.y;
    let pc = c * barycentrics.z;
    return SurfacePoint(pa + pb + pc, gamma(7.0) * (abs(pa) + abs(pb) + abs(pc)), normal, 0.0);
}

// The point of a flat surface that is along_u and along_v from its corner.
fn on_plane(corner: vec3f, along_u: vec3f, along_v: vec3f, normal: vec3f) -> SurfacePoint {
    let error = gamma(5.0) * (abs(corner) + abs(along_u) + abs(along_v));
    return SurfacePoint(corner + along_u + along_v, error, normal, 0.0);
}

// The point of a sphere in a direction from its centre, of any length but 0.
fn on_sphere(center: vec3f, radius: f32, from_center: vec3f) -> SurfacePoint {
    let normal = unit_vector(from_center);
    let out = normal * radius;
    return SurfacePoint(center + out, gamma(5.0) * (abs(center) + abs(out)), normal, radius);
}

// The point of the plane through `center` that is nearest to `near`.
fn on_disk(center: vec3f, near: vec3f, normal: vec3f) -> SurfacePoint {
    let from_center = near - center;
    let out = from_center - normal * dot(normal, from_center);
    // what is left of the normal in `out` is a rounding error of its length, along all axes
    let error = gamma(8.0) * (abs(center) + vec3f(sqrt(dot(out, out))));
    return SurfacePoint(center + out, error, normal, 0.0);
}

// The start of a ray that leaves on the side of the unit vector `direction`: a step along the normal, but into a sphere
// along the ray, where that stays within a quarter of the chord. Steps along the normal would draw the ray of a
// whispering gallery inwards with each reflection.
fn leaving_towards(point: SurfacePoint, direction: vec3f) -> vec3f {
    // the step itself is rounded too
    let error = point.error + abs(point.position) * gamma(2.0);
    let along = dot(abs(point.normal), error);
    let cosine = dot(direction, point.normal);
    if SPHERES && cosine < 0.0 && point.radius * cosine * cosine >= 2.0 * along {
        return point.position + direction * (along / -cosine);
    }
    return point.position + point.normal * copysign(along, cosine);
}
