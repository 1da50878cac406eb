//#import pathtrace/intersect/ray.wgsl
// A pinhole camera. Twins: crates/scene/src/camera.rs, and crates/pathtrace/src/drive/lanes.rs, which makes the
// rays.

// A camera's orthonormal axes scaled so that forward + x * right + y * up passes through the point (x, y) of the
// picture, x and y in [-1, 1].
struct PictureFrame {
    eye: vec3f,
    forward: vec3f,
    right: vec3f,
    up: vec3f,
}

// The ray through `point`, in [0, 1]^2 from the picture's top left corner.
fn camera_ray(frame: PictureFrame, point: vec2f) -> Ray {
    let x = 2.0 * point.x - 1.0;
    let y = 1.0 - 2.0 * point.y;
    let direction = frame.forward + frame.right * x + frame.up * y;
    return Ray(frame.eye, direction / sqrt(dot(direction, direction)), FAR);
}
