//#import pathtrace/intersect/attributes.wgsl
//#import pathtrace/bsdf/textures.wgsl
// Holes in surfaces: where a material's alpha is below its cutoff there is nothing, and rays go on. Twin:
// crates/pathtrace/src/intersect/cutouts.rs.

// Whether there is no surface where a ray meets what has this entry among the surfaces.
fn is_hole(surface: u32, barycentrics: vec3f) -> bool {
    let row = surfaces[surface].triangle;
    var uv = vec2f(0.0);
    if row != 0u {
        let corners = vec3u(mesh_data[row], mesh_data[row + 1u], mesh_data[row + 2u]);
        uv = uv_of_corner(corners.x) * barycentrics.x + uv_of_corner(corners.y) * barycentrics.y
            + uv_of_corner(corners.z) * barycentrics.z;
    }
    return !is_there(surfaces[surface].material, uv);
}

// Whether a surface is there at a place in textures.
fn is_there(material: u32, uv: vec2f) -> bool {
    var alpha = materials[material].alpha_factor;
    if materials[material].alpha_texture != 0u {
        alpha *= texture_at(materials[material].alpha_texture, uv).w;
    }
    return alpha >= materials[material].alpha_cutoff;
}
