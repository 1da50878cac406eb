//#import pathtrace/intersect/bvh2.wgsl
//#import pathtrace/intersect/shape_list.wgsl
// What rays are traced through: all shapes one by one while they are few, else a tree. Twin:
// crates/pathtrace/src/intersect/aggregate.rs.

// The nearest hit before ray.tmax; of several at one distance an area light, else the shape that comes first in the
// scene.
fn closest(ray: Ray) -> Nearest {
    if FEW_SHAPES {
        return meet_all(ray, header.seen, false);
    }
    return traverse(ray, false);
}

// Whether anything lies on a shadow ray, which goes between two points of the scene or to the sun, before ray.tmax.
fn occluded(ray: Ray) -> bool {
    if FEW_SHAPES {
        return meet_all(ray, header.shading, true).index != NOTHING;
    }
    return traverse(ray, true).index != NOTHING;
}

// The same of a ray from anywhere to anywhere.
fn meets_anything(ray: Ray) -> bool {
    if FEW_SHAPES {
        return meet_all(ray, header.seen, true).index != NOTHING;
    }
    return traverse(ray, true).index != NOTHING;
}

// What the ray met.
fn hit_of(nearest: Nearest, ray: Ray) -> Hit {
    if FEW_SHAPES {
        return hit_of_shape(nearest, ray);
    }
    return hit_of_primitive(nearest, ray);
}
