//#import pathtrace/intersect/bvh2.wgsl
//#import pathtrace/intersect/shape_list.wgsl
// What rays are traced through: all shapes one by one while they are few, else a tree. Twin:
// crates/pathtrace/src/intersect/aggregate.rs.

// The nearest hit before ray.tmax; of several at one distance an area light, else the shape that comes first in the
// scene.
fn closest(ray: Ray) -> Nearest {
    if FEW_SHAPES {
        return meet_all(ray, header.seen, nearest_query());
    }
    return traverse(ray, nearest_query());
}

// Whether anything lies on a shadow ray, which goes between two points of the scene or to the sun, before ray.tmax. A ray
// to a point of an area light is not stopped by the light itself, nor by what coincides with it and comes later; what
// comes earlier covers it.
fn occluded(ray: Ray, to_light: u32) -> bool {
    let query = shadow_query(to_light, ray.tmax);
    if FEW_SHAPES {
        return meet_all(ray, header.shading, query).index != NOTHING;
    }
    return traverse(ray, query).index != NOTHING;
}

// The same of a ray from anywhere to anywhere.
fn meets_anything(ray: Ray) -> bool {
    let query = shadow_query(NO_LIGHT - 1u, ray.tmax);
    if FEW_SHAPES {
        return meet_all(ray, header.seen, query).index != NOTHING;
    }
    return traverse(ray, query).index != NOTHING;
}

// What the ray met.
fn hit_of(nearest: Nearest, ray: Ray) -> Hit {
    if FEW_SHAPES {
        return hit_of_shape(nearest, ray);
    }
    return hit_of_primitive(nearest, ray);
}
