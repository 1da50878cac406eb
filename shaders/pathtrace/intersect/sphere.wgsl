//#import pathtrace/exact.wgsl
//#import pathtrace/intersect/ray.wgsl
// Ray/sphere intersection that survives distance and size: Haines, Günther and Akenine-Möller, "Precision Improvements
// for Ray/Sphere Intersection" (Ray Tracing Gems, chapter 7). Twin: crates/pathtrace/src/intersect/sphere.rs.

// Distance to the nearest meeting in lengths of the ray's direction, 0 without one.
fn sphere_distance(center: vec3f, radius: f32, ray: Ray) -> f32 {
    let f = ray.origin - center;
    let d = ray.direction;
    let a = dot(d, d);
    let b = -dot(f, d);
    // squared distance of the centre from the line, without the cancellation of b^2 - a c
    let off_axis = f + d * (b / a);
    let discriminant = radius * radius - dot(off_axis, off_axis);
    if discriminant < 0.0 {
        return 0.0;
    }
    let q = b + copysign(sqrt(a * discriminant), b);
    if q == 0.0 {
        return 0.0;
    }
    let c = dot(f, f) - radius * radius;
    let t0 = c / q;
    let t1 = q / a;
    let near = min(t0, t1);
    return max(select(max(t0, t1), near, near > 0.0), 0.0);
}

// The point at the distance t of sphere_distance, relative to the centre. From the point of the ray nearest to the
// centre, not along the ray: what a long t rounds does not turn the normal.
fn sphere_meeting(center: vec3f, radius: f32, ray: Ray, t: f32) -> vec3f {
    let f = ray.origin - center;
    let d = ray.direction;
    let a = dot(d, d);
    let middle = -dot(f, d) / a;
    let off_axis = f + d * middle;
    let half_chord = sqrt(max(radius * radius - dot(off_axis, off_axis), 0.0) / a);
    return off_axis + d * copysign(half_chord, t - middle);
}
