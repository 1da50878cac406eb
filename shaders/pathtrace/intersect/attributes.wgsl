//#import pathtrace/scene.wgsl
//#import pathtrace/intersect/nearest.wgsl
// What meshes say of their surfaces beside where they lie: shading normals and places in textures. Twin:
// crates/pathtrace/src/intersect/attributes.rs.

// Words of a corner: its normal, and its place in textures.
const ATTRIBUTE_WORDS: u32 = 5u;

// What a surface has of its mesh.
struct SurfaceAttributes {
    // not unit; zero where the mesh has none
    normal: vec3f,
    // place in textures
    uv: vec2f,
}

fn attributes_of_row(hit: Hit) -> SurfaceAttributes {
    if hit.triangle == 0u {
        return SurfaceAttributes(vec3f(0.0), vec2f(0.0));
    }
    let row = hit.triangle;
    return attributes_at(vec3u(mesh_data[row], mesh_data[row + 1u], mesh_data[row + 2u]), hit.barycentrics);
}

// Between three entries.
fn attributes_at(corners: vec3u, barycentrics: vec3f) -> SurfaceAttributes {
    let normal = normal_of_corner(corners.x) * barycentrics.x + normal_of_corner(corners.y) * barycentrics.y
        + normal_of_corner(corners.z) * barycentrics.z;
    let uv = uv_of_corner(corners.x) * barycentrics.x + uv_of_corner(corners.y) * barycentrics.y
        + uv_of_corner(corners.z) * barycentrics.z;
    return SurfaceAttributes(normal, uv);
}

fn normal_of_corner(corner: u32) -> vec3f {
    return vector_at(header.attributes + ATTRIBUTE_WORDS * corner);
}

fn uv_of_corner(corner: u32) -> vec2f {
    let place = header.attributes + ATTRIBUTE_WORDS * corner + 3u;
    return vec2f(bitcast<f32>(mesh_data[place]), bitcast<f32>(mesh_data[place + 1u]));
}

// The tangent of a triangle in a scene with normal maps, and its handedness.
fn tangent_of_row(hit: Hit) -> vec4f {
    if hit.triangle == 0u {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    return vec4f(vector_at(hit.triangle + 3u), bitcast<f32>(mesh_data[hit.triangle + 6u]));
}

fn vector_at(place: u32) -> vec3f {
    return bitcast<vec3f>(vec3u(mesh_data[place], mesh_data[place + 1u], mesh_data[place + 2u]));
}

// The direction in which u grows on a triangle with this outward normal, by its edges and theirs in textures, and its
// handedness; no direction where u or v does not grow.
fn tangent_between(normal: vec3f, to_b: vec3f, to_c: vec3f, b: vec2f, c: vec2f) -> vec4f {
    let area = b.x * c.y - b.y * c.x;
    let along_u = (to_b * c.y - to_c * b.y) * sign(area);
    let along_v = (to_c * b.x - to_b * c.x) * sign(area);
    let handedness = select(1.0, -1.0, dot(cross(normal, along_u), along_v) > 0.0);
    if area == 0.0 || dot(along_u, along_u) <= SMALLEST_POSITIVE {
        return vec4f(0.0, 0.0, 0.0, handedness);
    }
    return vec4f(unit_vector(along_u), handedness);
}
