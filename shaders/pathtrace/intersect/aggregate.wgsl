//#import pathtrace/intersect/bvh2.wgsl
//#import pathtrace/intersect/shape_list.wgsl
//#import pathtrace/intersect/instances.wgsl
//#import pathtrace/intersect/attributes.wgsl
// What rays are traced through: all shapes one by one while they are few, else a tree; then large meshes, which keep
// trees of their own. Twin:
// crates/pathtrace/src/intersect/aggregate.rs.

// The nearest hit before ray.tmax; of several at one distance an area light, else the shape that comes first in the
// scene.
fn closest(ray: Ray) -> Nearest {
    return meet(ray, header.seen, nearest_query());
}

// What the ray meets of all shapes, of few up to these ends.
fn meet(ray: Ray, ends: vec4u, query: Query) -> Nearest {
    var nearest: Nearest;
    if FEW_SHAPES {
        nearest = meet_all(ray, ends, query);
    } else {
        nearest = traverse(ray, query);
    }
    if LARGE_MESHES && !(query.shadow && nearest.index != NOTHING) {
        return meet_instances(ray, query, nearest);
    }
    return nearest;
}

// Whether anything lies on a shadow ray, which goes between two points of the scene or to the sun, before ray.tmax. A ray
// to a point of an area light is not stopped by the light itself, nor by what coincides with it and comes later; what
// comes earlier covers it.
fn occluded(ray: Ray, to_light: u32) -> bool {
    return meet(ray, header.shading, shadow_query(to_light, ray.tmax)).index != NOTHING;
}

// The same of a ray from anywhere to anywhere.
fn meets_anything(ray: Ray) -> bool {
    return meet(ray, header.seen, shadow_query(NO_LIGHT - 1u, ray.tmax)).index != NOTHING;
}

// What the ray met.
fn hit_of(nearest: Nearest, ray: Ray) -> Hit {
    if LARGE_MESHES && nearest.instance != NO_INSTANCE {
        return hit_of_instance(nearest, ray);
    }
    if FEW_SHAPES {
        return hit_of_shape(nearest, ray);
    }
    return hit_of_primitive(nearest, ray);
}

// What meshes say of the surface that was met.
fn attributes_of(hit: Hit) -> SurfaceAttributes {
    if LARGE_MESHES && hit.instance != NO_INSTANCE {
        return attributes_of_instance(hit);
    }
    return attributes_of_row(hit);
}

// The tangent there in a scene with normal maps, and its handedness.
fn tangent_of(hit: Hit) -> vec4f {
    if LARGE_MESHES && hit.instance != NO_INSTANCE {
        return tangent_of_instance(hit);
    }
    return tangent_of_row(hit);
}
