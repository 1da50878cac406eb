//#import pathtrace/intersect/triangle.wgsl
// Ray/disk intersection. Twin: crates/pathtrace/src/intersect/disk.rs.

// Distance to the disk in lengths of the ray's direction, from either side; 0 where it is not met.
fn disk_distance(center: vec3f, normal: vec3f, radius: f32, ray: Ray) -> f32 {
    let t = plane_distance(Plane(center, normal, vec3f(0.0)), ray).t;
    // from its middle outwards, without the square of a distance that does not count
    let off_center = ray.direction * t - (center - ray.origin);
    return select(0.0, t, t > 0.0 && dot(off_center, off_center) <= radius * radius);
}
