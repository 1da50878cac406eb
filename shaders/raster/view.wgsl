// A camera of any pass: the picture's, a cube map's face, a light. Mirror:
// crates/raster/src/gpu_data.rs, which has the structs of all passes.

struct View {
    clip_from_world: mat4x4f,
    // plane whose value at a point is the depth that a shadow map keeps: 0 at the light's near plane, 1 at its far one
    depth_from_world: vec4f,
    eye: vec3f,
    // whether glass may look up its cube map: not while cube maps are drawn
    sees_cube_maps: u32,
    // size of a shadow map's texel in units of depth: x + y * depth; of the picture's pixels as light of the second bounce is
    // gathered for them; of a reflective shadow map's texels, see patches.wgsl
    texel: vec2f,
    // distance of the near plane, of a perspective view
    near: f32,
    // what distances are multiplied by that a cube map keeps
    per_distance: f32,
}
