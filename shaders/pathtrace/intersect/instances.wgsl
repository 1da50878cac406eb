//#import pathtrace/intersect/bvh2.wgsl
//#import pathtrace/intersect/cwbvh.wgsl
//#import pathtrace/intersect/attributes.wgsl
// Large meshes, put into the world by maps: a tree over their boxes, and below it each mesh's own, into whose space the
// ray goes unnormalised, so that distances are the same. Twin: crates/pathtrace/src/intersect/instances.rs. Mirror:
// crates/pathtrace/src/drive/gpu/instance_data.rs, which lays them out.

// Rows of a linear map.
struct Rows {
    x: vec3f,
    y: vec3f,
    z: vec3f,
}

// The bit of a mesh's place that says that it stands in the world as it is.
const UNMOVED: u32 = 0x80000000u;

struct Instance {
    unmoved: bool,
    // from the mesh's space, then moved
    forward: Rows,
    backward: Rows,
    moved_by: vec3f,
    mesh: MeshPlace,
}

fn instance_at(index: u32) -> Instance {
    let backward = primitives[header.instance_primitives + 2u * index];
    let forward = primitives[header.instance_primitives + 2u * index + 1u];
    return Instance(
        (backward.tag & UNMOVED) != 0u,
        Rows(forward.a, forward.b, forward.c),
        Rows(backward.a, backward.b, backward.c),
        backward.normal_low,
        mesh_place(backward.tag & ~UNMOVED),
    );
}

// Fused where it says so: a hit's point is found with the ray that found the hit.
fn mapped(rows: Rows, v: vec3f) -> vec3f {
    return vec3f(
        fma(rows.x.x, v.x, fma(rows.x.y, v.y, rows.x.z * v.z)),
        fma(rows.y.x, v.x, fma(rows.y.y, v.y, rows.y.z * v.z)),
        fma(rows.z.x, v.x, fma(rows.z.y, v.y, rows.z.z * v.z)),
    );
}

// How far the map takes what is off by so much along each axis.
fn mapped_bound(rows: Rows, bound: vec3f) -> vec3f {
    return vec3f(dot(abs(rows.x), bound), dot(abs(rows.y), bound), dot(abs(rows.z), bound));
}

// The ray in the mesh's space. First moved, then turned: what is rounded is as small as the instance, wherever it stands.
fn ray_of_instance(instance: Instance, ray: Ray) -> Ray {
    if instance.unmoved {
        return ray;
    }
    let origin = mapped(instance.backward, ray.origin - instance.moved_by);
    return Ray(origin, mapped(instance.backward, ray.direction), ray.tmax);
}

// The nearest of what was met before and what the ray meets of the instances; or of a shadow ray whichever blocks the
// light.
fn meet_instances(ray: Ray, query: Query, before: Nearest) -> Nearest {
    var nearest = before;
    if header.instances == 0u {
        return nearest;
    }
    let inverse = safe_inverse(ray.direction);
    var count = 1u;
    waiting_nodes[0] = header.instance_root;
    while count > 0u {
        count -= 1u;
        let contents = waiting_nodes[count];
        if contents >> COUNT_SHIFT > 0u {
            nearest = meet_instance(contents & FIRST_MASK, ray, query, nearest);
            if query.shadow && nearest.instance != NO_INSTANCE {
                return nearest;
            }
            continue;
        }
        let left_t = box_distance(nodes[contents], ray.origin, inverse, nearest.t);
        let right_t = box_distance(nodes[contents + 1u], ray.origin, inverse, nearest.t);
        let left = nodes[contents].contents;
        let right = nodes[contents + 1u].contents;
        let left_is_near = left_t <= right_t;
        if max(left_t, right_t) < FAR {
            waiting_nodes[count] = select(left, right, left_is_near);
            count += 1u;
        }
        if min(left_t, right_t) < FAR {
            waiting_nodes[count] = select(right, left, left_is_near);
            count += 1u;
        }
    }
    return nearest;
}

fn meet_instance(index: u32, ray: Ray, query: Query, before: Nearest) -> Nearest {
    if query.shadow && !blocks(query, header.instance_surfaces + index, 0.0) {
        return before;
    }
    let instance = instance_at(index);
    return walk_mesh(instance.mesh, mesh_ray(ray_of_instance(instance, ray)), query, index, before);
}

// What the ray met.
fn hit_of_instance(nearest: Nearest, ray: Ray) -> Hit {
    let instance = instance_at(nearest.instance);
    let own = ray_of_instance(instance, ray);
    let triangle = mesh_triangle(instance.mesh, nearest.index);
    let corners = triangle.corners;
    let areas = triangle_areas(corners, own.origin, sheared_ray(own.direction));
    let barycentrics = areas / (areas.x + areas.y + areas.z);
    let sorted_normal = plane_of(corners).normal;
    let normal = select(sorted_normal, -sorted_normal, triangle.winding_turned);
    let point = in_world(on_triangle(corners.a, corners.b, corners.c, barycentrics, normal), instance);
    let surface = surfaces[header.instance_surfaces + nearest.instance];
    return Hit(point, surface.material, surface.light, nearest.index, barycentrics, nearest.instance);
}

// A point of the mesh in the world. The next ray's way back into the mesh's space rounds too, and counts here, so that it
// starts on its side of the surface.
fn in_world(point: SurfacePoint, instance: Instance) -> SurfacePoint {
    if instance.unmoved {
        return SurfacePoint(point.position, point.error, unit_vector(point.normal), 0.0);
    }
    let turned = mapped(instance.forward, point.position);
    let position = turned + instance.moved_by;
    let way_back = mapped_bound(instance.backward, abs(position - instance.moved_by));
    let own = mapped_bound(instance.forward, point.error + gamma(5.0) * way_back);
    let error = own + gamma(4.0) * (mapped_bound(instance.forward, abs(point.position)) + abs(instance.moved_by));
    return SurfacePoint(position, error, normal_in_world(point.normal, instance), 0.0);
}

// By the inverse transpose, so that outside stays outside, also in a mirror. Of any length but 0.
fn normal_in_world(normal: vec3f, instance: Instance) -> vec3f {
    let n = normal / max_size(normal);
    let rows = instance.backward;
    let largest = max(max_size(rows.x), max(max_size(rows.y), max_size(rows.z)));
    return unit_vector((n.x * rows.x + n.y * rows.y + n.z * rows.z) / largest);
}

// What a large mesh says of its surface, in the world.
fn attributes_of_instance(hit: Hit) -> SurfaceAttributes {
    let instance = instance_at(hit.instance);
    let place = instance.mesh;
    let corners = mesh_corners(place, hit.triangle);
    let weights = hit.barycentrics;
    var found = SurfaceAttributes(vec3f(0.0), vec2f(0.0));
    if place.normals != 0u {
        let normal = table_vector(place.normals + 3u * corners.x) * weights.x
            + table_vector(place.normals + 3u * corners.y) * weights.y
            + table_vector(place.normals + 3u * corners.z) * weights.z;
        if max_size(normal) > 0.0 {
            found.normal = normal_in_world(normal, instance);
        }
    }
    if place.uvs != 0u {
        found.uv = mesh_uv(place, corners.x) * weights.x + mesh_uv(place, corners.y) * weights.y
            + mesh_uv(place, corners.z) * weights.z;
    }
    return found;
}

// The tangent of a large mesh's triangle, and its handedness.
fn tangent_of_instance(hit: Hit) -> vec4f {
    let instance = instance_at(hit.instance);
    let place = instance.mesh;
    if place.uvs == 0u {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    let corners = mesh_corners(place, hit.triangle);
    let a = mesh_position(place, corners.x);
    let to_b = mapped(instance.forward, mesh_position(place, corners.y) - a);
    let to_c = mapped(instance.forward, mesh_position(place, corners.z) - a);
    let uv = mesh_uv(place, corners.x);
    let b = mesh_uv(place, corners.y) - uv;
    return tangent_between(hit.point.normal, to_b, to_c, b, mesh_uv(place, corners.z) - uv);
}

fn max_size(v: vec3f) -> f32 {
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}
