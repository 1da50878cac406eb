//#import pathtrace/scene.wgsl
//#import pathtrace/intersect/nearest.wgsl
//#import pathtrace/intersect/triangle.wgsl
// The tree of one large mesh, in the mesh's own space: eight boxes a node, kept in a byte a plane. Ylitie, Karras and
// Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs" (HPG 2017), as obvhs lays it out.
// Twin: crates/pathtrace/src/intersect/mesh_tree.rs, which builds it.

// Groups of nodes that can wait, one a level; the host refuses deeper trees.
const MOST_LEVELS: u32 = 32u;

// A group of nodes: index of the first, and a word of which the upper byte says which are met, in the order in which
// the ray comes to them, and the lowest which of the parent's children are nodes.
var<private> waiting_groups: array<vec2u, MOST_LEVELS>;

// Of a group's word. Here alone: the processor shares the layout and not the code.
const MET_NODES: u32 = 0xff000000u;
const MET_TRIANGLES: u32 = 0x00ffffffu;

// 80 bytes.
const VECTORS_OF_A_NODE: u32 = 5u;

// The bit of a triangle's first index that says that sorting its corners has turned its winding over.
const WINDING_TURNED: u32 = 0x80000000u;

// Where a mesh stands in the tables: its nodes in vectors, the others in words.
struct MeshPlace {
    nodes: u32,
    triangles: u32,
    positions: u32,
    // 0 where it has none
    normals: u32,
    uvs: u32,
}

// `at` is in vectors.
fn mesh_place(at: u32) -> MeshPlace {
    return MeshPlace(at + 1u, tables[at].x, tables[at].y, tables[at].z, tables[at].w);
}

fn table_word(at: u32) -> u32 {
    return tables[at >> 2u][at & 3u];
}

// A ray in the mesh's space, ready for boxes and triangles.
struct MeshRay {
    ray: Ray,
    sheared: ShearedRay,
    inverse: vec3f,
    // for each axis along which it goes upwards a bit, the same in each byte
    octant: u32,
}

fn mesh_ray(ray: Ray) -> MeshRay {
    let upwards = select(vec3u(0x04040404u, 0x02020202u, 0x01010101u), vec3u(0u), ray.direction < vec3f(0.0));
    let octant = upwards.x | upwards.y | upwards.z;
    return MeshRay(ray, sheared_ray(ray.direction), steep_inverse(ray.direction), octant);
}

// Inverts a direction, at least 2^-40 of its largest component along each axis: boxes are padded by the mesh's size, and
// the ray may come from far away.
fn steep_inverse(direction: vec3f) -> vec3f {
    let size = abs(direction);
    let smallest = vec3f(9.094947e-13 * max(size.x, max(size.y, size.z)));
    let at_least = select(smallest, -smallest, direction < vec3f(0.0));
    return 1.0 / select(direction, at_least, size <= smallest);
}

// What the ray meets of a mesh before `before`: the nearest, and of several at one distance the one whose triangle comes
// first in the tree's order; or of a shadow ray whichever is found first.
fn walk_mesh(place: MeshPlace, ray: MeshRay, query: Query, instance: u32, before: Nearest) -> Nearest {
    var nearest = before;
    var count = 0u;
    // the root, as if it were the only child
    var group = vec2u(0u, 0x80000000u);
    loop {
        var triangles = vec2u(0u);
        while triangles.y == 0u {
            if (group.y & MET_NODES) == 0u {
                if count == 0u {
                    return nearest;
                }
                count -= 1u;
                group = waiting_groups[count];
            }
            let child = firstLeadingBit(group.y);
            let others = group.y & ~(1u << child);
            if (others & MET_NODES) != 0u {
                waiting_groups[count] = vec2u(group.x, others);
                count += 1u;
            }
            let slot = (child - 24u) ^ (ray.octant & 7u);
            let node = place.nodes + VECTORS_OF_A_NODE * (group.x + countOneBits(group.y & ~(0xffffffffu << slot)));
            let met = children_met(node, ray, nearest.t);
            group = vec2u(tables[node + 1u].x, (met & MET_NODES) | (tables[node].w >> 24u));
            triangles = vec2u(tables[node + 1u].y, met & MET_TRIANGLES);
        }
        while triangles.y != 0u {
            let bit = firstTrailingBit(triangles.y);
            triangles.y &= triangles.y - 1u;
            let index = triangles.x + bit;
            let t = mesh_triangle_distance(mesh_triangle(place, index).corners, ray);
            if query.shadow {
                if t > 0.0 && t < query.end {
                    return Nearest(t, index, NOTHING, instance);
                }
            } else if t > 0.0 && comes_before(t, instance, index, nearest) {
                nearest = Nearest(t, index, NOTHING, instance);
            }
        }
    }
    return nearest;
}

// Whether a meeting with a mesh comes before the nearest so far: it is nearer, or as near and earlier in the scene's
// order, where instances come after all other shapes.
fn comes_before(t: f32, instance: u32, triangle: u32, nearest: Nearest) -> bool {
    if t != nearest.t || nearest.instance == NO_INSTANCE {
        return t < nearest.t;
    }
    return instance < nearest.instance || (instance == nearest.instance && triangle < nearest.index);
}

// Which children of the node at this vector the ray meets before tmax: nodes in the upper byte, in the order in which the
// ray comes to them, triangles below.
fn children_met(node: u32, ray: MeshRay, tmax: f32) -> u32 {
    let head = tables[node];
    let kinds = tables[node + 1u];
    let x = tables[node + 2u];
    let y = tables[node + 3u];
    let z = tables[node + 4u];
    let exponents = vec3u(head.w, head.w >> 8u, head.w >> 16u) & vec3u(0xffu);
    let scale = bitcast<vec3f>(exponents << vec3u(23u)) * ray.inverse;
    let start = (bitcast<vec3f>(head.xyz) - ray.ray.origin) * ray.inverse;
    let turned = ray.inverse < vec3f(0.0);
    let near_x = select(x.xy, x.zw, turned.x);
    let far_x = select(x.zw, x.xy, turned.x);
    let near_y = select(y.xy, y.zw, turned.y);
    let far_y = select(y.zw, y.xy, turned.y);
    let near_z = select(z.xy, z.zw, turned.z);
    let far_z = select(z.zw, z.xy, turned.z);
    let lower = boxes_met(vec3u(near_x.x, near_y.x, near_z.x), vec3u(far_x.x, far_y.x, far_z.x), start, scale, tmax);
    let upper = boxes_met(vec3u(near_x.y, near_y.y, near_z.y), vec3u(far_x.y, far_y.y, far_z.y), start, scale, tmax);
    return bits_of(kinds.z, ray.octant, lower) | bits_of(kinds.w, ray.octant, upper);
}

// Which of four boxes the ray meets before tmax; a byte of each word is a plane of each.
fn boxes_met(near: vec3u, far: vec3u, start: vec3f, scale: vec3f, tmax: f32) -> vec4<bool> {
    let near_x = bytes_of(near.x) * scale.x + start.x;
    let near_y = bytes_of(near.y) * scale.y + start.y;
    let near_z = bytes_of(near.z) * scale.z + start.z;
    let far_x = bytes_of(far.x) * scale.x + start.x;
    let far_y = bytes_of(far.y) * scale.y + start.y;
    let far_z = bytes_of(far.z) * scale.z + start.z;
    let enters = max(max(near_x, near_y), max(near_z, vec4f(0.0)));
    let leaves = min(min(far_x, far_y), far_z);
    // also what is met at tmax itself, where the order decides
    return (leaves * BOX_SLACK >= enters) & (enters * (1.0 / BOX_SLACK) <= vec4f(tmax));
}

fn bytes_of(word: u32) -> vec4f {
    return vec4f((vec4u(word) >> vec4u(0u, 8u, 16u, 24u)) & vec4u(0xffu));
}

// The bits of four children that are met: of a node one by its place in the order of the ray's octant, of a leaf one a
// triangle.
fn bits_of(kinds: u32, octant: u32, met: vec4<bool>) -> u32 {
    let are_nodes = ((kinds & (kinds << 1u)) & 0x10101010u) >> 4u;
    let places = (kinds ^ (octant & (are_nodes * 0xffu))) & 0x1f1f1f1fu;
    let bits = (kinds >> 5u) & 0x07070707u;
    let bytes = vec4u(0u, 8u, 16u, 24u);
    let all = ((vec4u(bits) >> bytes) & vec4u(0xffu)) << ((vec4u(places) >> bytes) & vec4u(0xffu));
    let those = select(vec4u(0u), all, met);
    return (those.x | those.y) | (those.z | those.w);
}

struct MeshTriangle {
    corners: Triangle,
    winding_turned: bool,
}

// The triangle at this place in the tree's order. The host has sorted its indices, so that corners are in
// lexicographic order.
fn mesh_triangle(place: MeshPlace, index: u32) -> MeshTriangle {
    let corners = mesh_corners(place, index);
    let a = mesh_position(place, corners.x);
    let b = mesh_position(place, corners.y);
    let c = mesh_position(place, corners.z);
    let is_turned = (table_word(place.triangles + 3u * index) & WINDING_TURNED) != 0u;
    return MeshTriangle(Triangle(a, b, c), is_turned);
}

fn mesh_position(place: MeshPlace, index: u32) -> vec3f {
    return table_vector(place.positions + 3u * index);
}

fn table_vector(at: u32) -> vec3f {
    return bitcast<vec3f>(vec3u(table_word(at), table_word(at + 1u), table_word(at + 2u)));
}

// The indices of a triangle's sorted corners.
fn mesh_corners(place: MeshPlace, index: u32) -> vec3u {
    let at = place.triangles + 3u * index;
    return vec3u(table_word(at) & ~WINDING_TURNED, table_word(at + 1u), table_word(at + 2u));
}

fn mesh_uv(place: MeshPlace, corner: u32) -> vec2f {
    let at = place.uvs + 2u * corner;
    return bitcast<vec2f>(vec2u(table_word(at), table_word(at + 1u)));
}

// Distance to a triangle whose plane is not known beforehand, 0 where it is not met.
fn mesh_triangle_distance(triangle: Triangle, ray: MeshRay) -> f32 {
    if !are_met(triangle_areas(triangle, ray.ray.origin, ray.sheared)) {
        return 0.0;
    }
    let found = plane_distance(plane_of(triangle), ray.ray);
    return held_between_corners(found.t, triangle, ray.ray, ray.sheared);
}
