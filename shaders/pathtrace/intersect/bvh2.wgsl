//#import pathtrace/intersect/nearest.wgsl
//#import pathtrace/intersect/cutouts.wgsl
//#import pathtrace/intersect/triangle.wgsl
//#import pathtrace/intersect/sphere.wgsl
//#import pathtrace/intersect/disk.wgsl
// The acceleration structure: obvhs' BVH2 over triangles, spheres and disks. Twin:
// crates/pathtrace/src/intersect/bvh2.rs.

// Inner nodes that can wait; the host refuses deeper trees.
const MOST_WAITING: u32 = 64u;

// A node's contents: primitives of a leaf above, 0 for an inner node; index below.
const COUNT_SHIFT: u32 = 27u;
// Here alone: the host writes these bits, and reads none.
const FIRST_MASK: u32 = 0x7ffffffu;

// Nodes that wait. Not the traversal's own: it would be cleared each time.
var<private> waiting_nodes: array<u32, MOST_WAITING>;

fn traverse(ray: Ray, query: Query) -> Nearest {
    let sheared = sheared_ray(ray.direction);
    let inverse = safe_inverse(ray.direction);
    var nearest = Nearest(reach(query, ray.tmax), NOTHING, NOTHING, NO_INSTANCE);
    if header.primitives == 0u {
        return nearest;
    }
    var count = 0u;
    var contents = 0u;
    // nodes and leaves in loops of their own, after Aila and Laine, "Understanding the Efficiency of Ray Traversal on
    // GPUs" (2009): threads that go together go through one of them
    loop {
        while contents >> COUNT_SHIFT == 0u {
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
                contents = select(right, left, left_is_near);
            } else if count > 0u {
                count -= 1u;
                contents = waiting_nodes[count];
            } else {
                return nearest;
            }
        }
        let first = contents & FIRST_MASK;
        let end = first + (contents >> COUNT_SHIFT);
        for (var index = first; index < end; index++) {
            let primitive = primitives[index];
            let t = primitive_distance(primitive, ray, sheared);
            if t > 0.0 && (t <= nearest.t || COINCIDENT) && !passes(index, primitive, ray, sheared) {
                let id = primitive.tag & ((1u << KIND_SHIFT) - 1u);
                if query.shadow {
                    if t < nearest.t && blocks(query, index, t) {
                        return Nearest(t, index, id, NO_INSTANCE);
                    }
                } else if comes_first(t, id, index, nearest, nearest.index) {
                    nearest = Nearest(t, index, id, NO_INSTANCE);
                }
            }
        }
        if count == 0u {
            return nearest;
        }
        count -= 1u;
        contents = waiting_nodes[count];
    }
    return nearest;
}

// Inverts a direction, at least 2^-23 of its largest component along each axis: shadow rays may be short, but not
// slower.
fn safe_inverse(direction: vec3f) -> vec3f {
    let size = abs(direction);
    let smallest = vec3f(1.1920929e-7 * max(size.x, max(size.y, size.z)));
    let at_least = select(smallest, -smallest, direction < vec3f(0.0));
    return 1.0 / select(direction, at_least, size <= smallest);
}

// Where a ray enters a box before tmax; FAR if it does not.
fn box_distance(node: Node, origin: vec3f, inverse: vec3f, tmax: f32) -> f32 {
    let t1 = (node.low - origin) * inverse;
    let t2 = (node.high - origin) * inverse;
    let near = min(t1, t2);
    let far = max(t1, t2);
    let enters = max(near.x, max(near.y, near.z));
    let leaves = min(far.x, min(far.y, far.z));
    return select(FAR, enters, leaves * BOX_SLACK >= max(enters, 0.0) && enters / BOX_SLACK < tmax);
}

// Whether a ray that meets a primitive goes through a hole in it.
fn passes(index: u32, primitive: Primitive, ray: Ray, sheared: ShearedRay) -> bool {
    if !ALPHA_MASKS || materials[surfaces[index].material].alpha_cutoff <= 0.0 {
        return false;
    }
    let areas = triangle_areas(Triangle(primitive.a, primitive.b, primitive.c), ray.origin, sheared);
    return is_hole(index, areas / (areas.x + areas.y + areas.z));
}

fn primitive_distance(primitive: Primitive, ray: Ray, sheared: ShearedRay) -> f32 {
    let kind = primitive.tag >> KIND_SHIFT;
    if TRIANGLES && (kind == KIND_TRIANGLE || !(SPHERES || DISKS)) {
        let normal = vec3f(primitive.normal_x, primitive.normal_y, primitive.normal_z);
        let plane = Plane(primitive.a, normal, primitive.normal_low);
        return triangle_distance(Triangle(primitive.a, primitive.b, primitive.c), plane, ray, sheared);
    }
    if SPHERES && (kind == KIND_SPHERE || !DISKS) {
        return sphere_distance(primitive.a, primitive.normal_x, ray);
    }
    if DISKS {
        return disk_distance(primitive.a, primitive.b, primitive.normal_x, ray);
    }
    return 0.0;
}

// What the ray met.
fn hit_of_primitive(nearest: Nearest, ray: Ray) -> Hit {
    let primitive = primitives[nearest.index];
    let surface = surfaces[nearest.index];
    let kind = primitive.tag >> KIND_SHIFT;
    var point: SurfacePoint;
    var barycentrics: vec3f;
    if TRIANGLES && (kind == KIND_TRIANGLE || !(SPHERES || DISKS)) {
        let triangle = Triangle(primitive.a, primitive.b, primitive.c);
        let areas = triangle_areas(triangle, ray.origin, sheared_ray(ray.direction));
        barycentrics = areas / (areas.x + areas.y + areas.z);
        point = on_triangle(primitive.a, primitive.b, primitive.c, barycentrics, surface.normal);
    } else if SPHERES && (kind == KIND_SPHERE || !DISKS) {
        let from_center = sphere_meeting(primitive.a, primitive.normal_x, ray, nearest.t);
        point = on_sphere(primitive.a, primitive.normal_x, from_center);
    } else if DISKS {
        point = on_disk(primitive.a, ray.origin + ray.direction * nearest.t, primitive.b);
    }
    return Hit(point, surface.material, surface.light, surface.triangle, barycentrics, NO_INSTANCE);
}
