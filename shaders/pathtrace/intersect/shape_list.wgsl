//#import pathtrace/intersect/nearest.wgsl
//#import pathtrace/intersect/quadrilateral.wgsl
//#import pathtrace/intersect/sphere.wgsl
//#import pathtrace/intersect/disk.wgsl
// A small scene: every ray meets every shape, without a tree. Threads that go together go through the same shapes
// together, and all read the same at a time. Twins:
// crates/pathtrace/src/intersect/shape_list/mod.rs and surfaces.rs.

// What a ray meets among the shapes of each kind up to these ends: the nearest, or whichever comes first.
fn meet_all(ray: Ray, ends: vec4u, query: Query) -> Nearest {
    let sheared = sheared_ray(ray.direction);
    let starts = header.seen;
    var nearest = Nearest(reach(query, ray.tmax), NOTHING, NOTHING, NO_INSTANCE);
    if QUADRILATERALS {
        for (var i = 0u; i < ends.x; i++) {
            let t = quadrilateral_distance(quadrilateral_at(i), plane_at(i), ray, sheared);
            if consider(&nearest, t, i, query) {
                return nearest;
            }
        }
    }
    if TRIANGLES {
        for (var i = starts.x; i < ends.y; i++) {
            let t = triangle_distance(triangle_at(i), plane_at(i), ray, sheared);
            if consider(&nearest, t, i, query) {
                return nearest;
            }
        }
    }
    if SPHERES {
        for (var i = starts.y; i < ends.z; i++) {
            let t = sphere_distance(shapes[i].a, shapes[i].normal_x, ray);
            if consider(&nearest, t, i, query) {
                return nearest;
            }
        }
    }
    if DISKS {
        for (var i = starts.z; i < ends.w; i++) {
            let t = disk_distance(shapes[i].a, shapes[i].b, shapes[i].normal_x, ray);
            if consider(&nearest, t, i, query) {
                return nearest;
            }
        }
    }
    return nearest;
}

// Takes a meeting if it comes first, or of a shadow ray if it blocks the light; whether there is no need to look on.
fn consider(nearest: ptr<function, Nearest>, t: f32, index: u32, query: Query) -> bool {
    let before = select(t <= (*nearest).t, t < (*nearest).t, query.shadow);
    if !(t > 0.0 && (before || (COINCIDENT && !query.shadow))) {
        return false;
    }
    let id = shapes[index].id;
    let takes = select(comes_first(t, id, id, *nearest, (*nearest).id), blocks(query, id, t), query.shadow);
    if takes {
        *nearest = Nearest(t, index, id, NO_INSTANCE);
    }
    return takes && query.shadow;
}

fn quadrilateral_at(index: u32) -> Quadrilateral {
    return Quadrilateral(shapes[index].a, shapes[index].b, shapes[index].c, shapes[index].d);
}

fn triangle_at(index: u32) -> Triangle {
    return Triangle(shapes[index].a, shapes[index].b, shapes[index].c);
}

fn plane_at(index: u32) -> Plane {
    let normal = vec3f(shapes[index].normal_x, shapes[index].normal_y, shapes[index].normal_z);
    return Plane(shapes[index].plane_point, normal, shapes[index].normal_low);
}

// What the ray met.
fn hit_of_shape(nearest: Nearest, ray: Ray) -> Hit {
    let surface = surfaces[nearest.id];
    let shape = shapes[nearest.index];
    let starts = header.seen;
    var point: SurfacePoint;
    var barycentrics: vec3f;
    if QUADRILATERALS && nearest.index < starts.x {
        // of a parallelogram, the areas beside two neighbouring edges over half of all four
        let areas = quadrilateral_areas(quadrilateral_at(nearest.index), ray.origin, sheared_ray(ray.direction));
        let half = 0.5 * (areas.x + areas.y + areas.z + areas.w);
        let along = clamp(vec2f(areas.w, areas.x) / half, vec2f(0.0), vec2f(1.0));
        point = on_plane(shape.a, (shape.b - shape.a) * along.x, (shape.d - shape.a) * along.y, surface.normal);
        point.error += vec3f(shape.flatness);
    } else if TRIANGLES && nearest.index < starts.y {
        let areas = triangle_areas(triangle_at(nearest.index), ray.origin, sheared_ray(ray.direction));
        barycentrics = areas / (areas.x + areas.y + areas.z);
        point = on_triangle(shape.a, shape.b, shape.c, barycentrics, surface.normal);
        point.error += vec3f(shape.flatness);
    } else if SPHERES && nearest.index < starts.z {
        let from_center = sphere_meeting(shape.a, shape.normal_x, ray, nearest.t);
        point = on_sphere(shape.a, shape.normal_x, from_center);
    } else if DISKS {
        point = on_disk(shape.a, ray.origin + ray.direction * nearest.t, shape.b);
    }
    return Hit(point, surface.material, surface.light, surface.triangle, barycentrics, NO_INSTANCE);
}
