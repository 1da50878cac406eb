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

// Of the square of a radius. Here alone: the processor's roots are exact.
const AN_ULP_OUTSIDE: f32 = 1.0000001;

// The point at the distance t of sphere_distance, relative to the centre. From the point of the ray nearest to the
// centre, not along the ray: what a long t rounds does not turn the normal. A device's roots and quotients are off by
// some ulp, always to the same side. Where that draws each meeting a little inwards, a ray that came into a glass ball at
// a grazing angle is beyond the critical one after some ten reflections and never leaves; so a step of Newton's along
// the ray ends an ulp outside, from where rounding lets it leave a little sooner.
fn sphere_meeting(center: vec3f, radius: f32, ray: Ray, t: f32) -> vec3f {
    let f = ray.origin - center;
    let d = ray.direction;
    let a = dot(d, d);
    let middle = -dot(f, d) / a;
    let off_axis = f + d * middle;
    let half_chord = sqrt(max(radius * radius - dot(off_axis, off_axis), 0.0) / a);
    let along = copysign(half_chord, t - middle);
    let rough = off_axis + d * along;
    let missing = radius * radius * AN_ULP_OUTSIDE - dot(rough, rough);
    let cuts_deep = half_chord * half_chord * a > 0.01 * radius * radius;
    return rough + d * select(0.0, missing / (2.0 * along * a), cuts_deep);
}
