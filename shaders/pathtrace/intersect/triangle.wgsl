//#import pathtrace/exact.wgsl
//#import pathtrace/intersect/ray.wgsl
// Watertight ray/triangle intersection: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection" (JCGT 2(1),
// 2013).
// Twin: crates/pathtrace/src/intersect/triangle.rs.

// A ray turned so that its largest direction component is z, and the shear that takes it onto the z axis: rows of the
// matrix that does both. Each holds at most a one and one rounded number, so that fusing changes one rounding at most.
struct ShearedRay {
    x: vec3f,
    y: vec3f,
    main_axis: vec3f,
}

fn sheared_ray(direction: vec3f) -> ShearedRay {
    let size = abs(direction);
    if size.x > size.y && size.x > size.z {
        let shear = direction.yz / direction.x;
        return ShearedRay(vec3f(-shear.x, 1.0, 0.0), vec3f(-shear.y, 0.0, 1.0), vec3f(1.0, 0.0, 0.0));
    }
    if size.y > size.z {
        let shear = direction.zx / direction.y;
        return ShearedRay(vec3f(0.0, -shear.x, 1.0), vec3f(1.0, -shear.y, 0.0), vec3f(0.0, 1.0, 0.0));
    }
    let shear = direction.xy / direction.z;
    return ShearedRay(vec3f(1.0, 0.0, -shear.x), vec3f(0.0, 1.0, -shear.y), vec3f(0.0, 0.0, 1.0));
}

// The point in the plane across the ray. Fused where it says so: a corner is one and the same point for all of its
// shapes only if no compiler chooses.
fn across(ray: ShearedRay, point: vec3f) -> vec2f {
    return vec2f(
        fma(ray.x.x, point.x, fma(ray.x.y, point.y, ray.x.z * point.z)),
        fma(ray.y.x, point.x, fma(ray.y.y, point.y, ray.y.z * point.z)),
    );
}

// Twice the signed area of (ray, p, q). The corners of a shape are sorted, so that the neighbours of an edge evaluate
// one and the same expression for it.
fn edge(p: vec2f, q: vec2f) -> f32 {
    return fma(p.x, q.y, -(p.y * q.x));
}

struct Triangle {
    // in lexicographic order
    a: vec3f,
    b: vec3f,
    c: vec3f,
}

// Areas opposite to the corners, of one sign if the ray meets the triangle.
fn triangle_areas(triangle: Triangle, origin: vec3f, ray: ShearedRay) -> vec3f {
    let a = across(ray, triangle.a - origin);
    let b = across(ray, triangle.b - origin);
    let c = across(ray, triangle.c - origin);
    return vec3f(edge(b, c), -edge(a, c), edge(a, b));
}

// Distance to the triangle in lengths of the ray's direction, 0 where it is not met. From either side, edges included.
fn triangle_distance(triangle: Triangle, plane: Plane, ray: Ray, sheared: ShearedRay) -> f32 {
    if !are_met(triangle_areas(triangle, ray.origin, sheared)) {
        return 0.0;
    }
    let found = plane_distance(plane, ray);
    if !found.edge_on {
        return found.t;
    }
    return held_between_corners(found.t, triangle, ray, sheared);
}

// Whether areas opposite to the corners are of one sign.
fn are_met(areas: vec3f) -> bool {
    let differ = any(areas < vec3f(0.0)) && any(areas > vec3f(0.0));
    return !differ && areas.x + areas.y + areas.z != 0.0;
}

// A distance to a triangle's plane, held between the distances to its corners.
fn held_between_corners(t: f32, triangle: Triangle, ray: Ray, sheared: ShearedRay) -> f32 {
    let depths = vec3f(
        depth(sheared, triangle.a, ray),
        depth(sheared, triangle.b, ray),
        depth(sheared, triangle.c, ray),
    );
    return held(t, min(depths.x, min(depths.y, depths.z)), max(depths.x, max(depths.y, depths.z)));
}

// Distance to where the ray comes nearest to a point.
fn depth(sheared: ShearedRay, point: vec3f, ray: Ray) -> f32 {
    return dot(sheared.main_axis, point - ray.origin) / dot(sheared.main_axis, ray.direction);
}

// Areas of one sign make a meeting a mean of the corners: nearly edge-on, where the plane says little, it still is.
fn held(t: f32, near: f32, far: f32) -> f32 {
    return select(0.0, clamp(t, near, far), t > 0.0);
}

// A plane through a point.
struct Plane {
    point: vec3f,
    // largest component 1, as a sum of two floats
    normal: vec3f,
    normal_low: vec3f,
}

// The plane of a triangle of which nothing was prepared; without a normal where it has no area. Edges are taken to a
// largest component from 1 to 2: no product is too small for a float.
fn plane_of(triangle: Triangle) -> Plane {
    let u = scaled(two_sum(triangle.b, -triangle.a));
    let v = scaled(two_sum(triangle.c, -triangle.a));
    let normal = exact_cross(u, v);
    return Plane(triangle.a, normal.sum, normal.rest);
}

// Times a power of two.
fn scaled(v: TwoSum) -> TwoSum {
    let size = abs(v.sum);
    let exponent = bitcast<u32>(max(size.x, max(size.y, size.z))) >> 23u;
    let factor = bitcast<f32>((254u - min(exponent, 253u)) << 23u);
    return TwoSum(v.sum * factor, v.rest * factor);
}

struct PlaneDistance {
    t: f32,
    // whether the ray runs almost within the plane
    edge_on: bool,
}

// Distance to a plane, with more bits than a float has wherever floats cancel: from a point just above a
// wall 500 units wide these cannot tell above from below, and the wall would shadow itself. 0 where there is none.
fn plane_distance(plane: Plane, ray: Ray) -> PlaneDistance {
    let normal = plane.normal;
    let to_plane = plane.point - ray.origin;
    var above = dot(normal, to_plane);
    if abs(above) < CANCELLED * dot(abs(normal), abs(to_plane)) {
        let exactly = two_sum(plane.point, -ray.origin);
        above = exact_dot(normal, plane.normal_low, exactly.sum, exactly.rest);
    }
    var along = dot(normal, ray.direction);
    let edge_on = abs(along) < CANCELLED * dot(abs(normal), abs(ray.direction));
    if edge_on {
        along = exact_dot(normal, plane.normal_low, ray.direction, vec3f(0.0));
    }
    // also where the quotient would be too large for a float
    if along == 0.0 || abs(above) >= FAR * min(abs(along), 1.0) {
        return PlaneDistance(0.0, edge_on);
    }
    return PlaneDistance(above / along, edge_on);
}
