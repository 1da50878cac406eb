//#import pathtrace/needs.wgsl
//#import pathtrace/scene.wgsl
//#import pathtrace/intersect/surface_point.wgsl
// What rays find, whatever the structure that they are traced through. Twins:
// crates/pathtrace/src/intersect/hit.rs, which has what is found and not the comparison, and
// crates/pathtrace/src/intersect/coincident.rs, which finds the groups that are given here.

// The nearest meeting so far.
struct Nearest {
    t: f32,
    // into the shapes or the tree's primitives, or NOTHING
    index: u32,
    // place in the scene's order, area lights first, which decides ties
    id: u32,
    // of a large mesh, whose triangle `index` then is; else NO_INSTANCE
    instance: u32,
}

// Here alone: lanes have a mask for it.
const NOTHING: u32 = 0xffffffffu;
const NO_INSTANCE: u32 = 0xffffffffu;

struct Hit {
    // where, with the outward normal
    point: SurfacePoint,
    material: u32,
    // index into the lights, or NO_LIGHT
    light: u32,
    // place of its row in mesh_data, 0 if it has none, of an instance its place in the mesh's tree; and the weights of its
    // corners
    triangle: u32,
    barycentrics: vec3f,
    // of a large mesh, or NO_INSTANCE
    instance: u32,
}

// What is asked of the shapes on a ray: the nearest, or of a shadow ray whether any blocks the light.
struct Query {
    shadow: bool,
    // where a shadow ray goes: index into the lights, or NO_LIGHT - 1
    light: u32,
    // of what coincides with that light, or NO_GROUP
    group: u32,
    // where a shadow ray ends
    end: f32,
}

fn nearest_query() -> Query {
    return Query(false, NO_LIGHT - 1u, NO_GROUP, FAR);
}

// Of a shadow ray to a light.
fn shadow_query(light: u32, end: f32) -> Query {
    if COINCIDENT && light < header.lights {
        return Query(true, light, lights[light].group, end);
    }
    return Query(true, light, NO_GROUP, end);
}

// How far to look: what coincides with the light may be met just behind the end.
fn reach(query: Query, tmax: f32) -> f32 {
    return select(tmax, BEHIND_THE_END, COINCIDENT && query.group != NO_GROUP);
}

// Whether what has this entry among the surfaces blocks the light of a shadow ray that meets it at t: not the light
// itself, nor what coincides with it and comes later.
fn blocks(query: Query, surface: u32, t: f32) -> bool {
    if CLEAR_GLASS && materials[surfaces[surface].material].lobe == LOBE_DIELECTRIC {
        return false;
    }
    let light = surfaces[surface].light;
    if light == query.light {
        return false;
    }
    if COINCIDENT && query.group != NO_GROUP && surfaces[surface].group == query.group {
        return light < query.light;
    }
    return t < query.end;
}

// Whether a meeting at t with what has this entry among the surfaces, and this id, comes before the nearest so far, whose
// entry is `other`: it is nearer, or as near and earlier in the scene's order; of surfaces that coincide the earlier,
// however their distances are rounded.
fn comes_first(t: f32, id: u32, surface: u32, nearest: Nearest, other: u32) -> bool {
    if COINCIDENT && nearest.index != NOTHING {
        let group = surfaces[surface].group;
        if group != NO_GROUP && group == surfaces[other].group {
            return id < nearest.id;
        }
    }
    return t < nearest.t || (t == nearest.t && id < nearest.id);
}
