// Rays. Twin: crates/pathtrace/src/intersect/ray.rs.

struct Ray {
    // where it starts, world space
    origin: vec3f,
    // where it goes; unit length but for shadow rays to a point
    direction: vec3f,
    // hits must lie before this
    tmax: f32,
}

// Farther than anything. Here alone: lanes have infinity, which shaders may take away.
const FAR: f32 = 3.4028234e38;

// A shadow ray ends at 1, which is rounded with its direction: what lies as near to the end, 8 roundings, is not known to
// lie before it.
const SHADOW_END: f32 = 1.0 - 4.7683716e-7;

// A distance along a shadow ray that is certainly behind its end.
const BEHIND_THE_END: f32 = 2.0;

// What rounds in the distances to a box's planes, seen from far away: Ize, "Robust BVH Ray Traversal" (JCGT 2(2),
// 2013). Here alone: the processor's traversals have their own.
const BOX_SLACK: f32 = 1.0 + 1e-6;

// Higham's bound on the relative error of n roundings in a row, f32.
fn gamma(n: f32) -> f32 {
    let error = n * 5.9604645e-8;
    return error / (1.0 - error);
}
