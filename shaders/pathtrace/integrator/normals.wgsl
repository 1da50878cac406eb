//#import pathtrace/intersect/aggregate.wgsl
//#import pathtrace/drive/pixels.wgsl
// The normal at the first surface that a camera ray meets, as a colour: -1 to 1 along each axis as 0 to 1. Twin:
// crates/pathtrace/src/integrator/normals.rs.

// whether the axes are the camera's: x to the right, y up, z towards the viewer; the scene's if not
override CAMERA_SPACE: bool = false;

var<private> camera: Ray;

fn begin(ray: Ray) {
    camera = ray;
}

// The sample is complete after one segment. Where nothing is met it is black.
fn step_on() -> bool {
    outcome.rays += 1u;
    let nearest = closest(camera);
    if nearest.index == NOTHING {
        return false;
    }
    let normal = hit_of(nearest, camera).point.normal;
    var along = normal;
    if CAMERA_SPACE {
        let right = normalize(params.frame.right);
        let up = normalize(params.frame.up);
        along = vec3f(dot(right, normal), dot(up, normal), -dot(params.frame.forward, normal));
    }
    outcome.radiance = 0.5 * (along + 1.0);
    return false;
}
