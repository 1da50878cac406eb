//#import pathtrace/scene.wgsl
//#import pathtrace/needs.wgsl
//#import pathtrace/bsdf/textures.wgsl
//#import pathtrace/intersect/cutouts.wgsl
// Lights whose meshes wear textures. Twin: crates/pathtrace/src/light/textured.rs.

// What a light's radiance is multiplied by at a place along its edges.
fn worn_at(light: Light, place: vec2f) -> vec3f {
    if !(IMAGE_TEXTURES || ALPHA_MASKS) || light.corners == 0u {
        return vec3f(1.0);
    }
    let a = float_at(light.corners, light.corners + 1u);
    let b = float_at(light.corners + 2u, light.corners + 3u);
    let c = float_at(light.corners + 4u, light.corners + 5u);
    let uv = a + (b - a) * place.x + (c - a) * place.y;
    if ALPHA_MASKS && !is_there(light.material, uv) {
        return vec3f(0.0);
    }
    let texture = materials[light.material].emission_texture;
    if IMAGE_TEXTURES && texture != 0u {
        return texture_at(texture, uv).xyz;
    }
    return vec3f(1.0);
}
