//#import pathtrace/intersect/triangle.wgsl
// Watertight ray/quadrilateral intersection: rectangles and the sides of boxes, whose two halves are one shape of four
// edges. Twin: crates/pathtrace/src/intersect/shape_list/mod.rs, which takes the corners into the rays' frames once for
// all shapes.

struct Quadrilateral {
    // around it: a comes before b and d in lexicographic order, and c after them
    a: vec3f,
    b: vec3f,
    c: vec3f,
    d: vec3f,
}

// Twice the signed areas of the ray and the edges ab, bc, cd and da, of one sign if it meets the quadrilateral.
fn quadrilateral_areas(shape: Quadrilateral, origin: vec3f, ray: ShearedRay) -> vec4f {
    let a = across(ray, shape.a - origin);
    let b = across(ray, shape.b - origin);
    let c = across(ray, shape.c - origin);
    let d = across(ray, shape.d - origin);
    return vec4f(edge(a, b), edge(b, c), -edge(d, c), -edge(a, d));
}

// Distance to the quadrilateral in lengths of the ray's direction, 0 where it is not met. From either side, edges
// included.
fn quadrilateral_distance(shape: Quadrilateral, plane: Plane, ray: Ray, sheared: ShearedRay) -> f32 {
    let areas = quadrilateral_areas(shape, ray.origin, sheared);
    if any(areas < vec4f(0.0)) && any(areas > vec4f(0.0)) {
        return 0.0;
    }
    if areas.x + areas.y + areas.z + areas.w == 0.0 {
        return 0.0;
    }
    let found = plane_distance(plane, ray);
    if !found.edge_on {
        return found.t;
    }
    let depths = vec4f(
        depth(sheared, shape.a, ray),
        depth(sheared, shape.b, ray),
        depth(sheared, shape.c, ray),
        depth(sheared, shape.d, ray),
    );
    let near = min(min(depths.x, depths.y), min(depths.z, depths.w));
    let far = max(max(depths.x, depths.y), max(depths.z, depths.w));
    return held(found.t, near, far);
}
