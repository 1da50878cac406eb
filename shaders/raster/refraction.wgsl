// Snell's law, and where the refracted direction is found in a cube map. Twin:
// crates/raster/src/shading.rs, which has all formulas of the rasteriser.

// Unit direction behind a surface of unit normal n (against d) for light along the unit direction d; `ratio` is the
// index of refraction in front over the one behind. Beyond the critical angle nothing is refracted and all of it is
// reflected, where the built-in gives the null vector, which no cube map can look up.
fn refract(d: vec3f, n: vec3f, ratio: f32) -> vec3f {
    let cosine = dot(n, d);
    let k = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    if k < 0.0 {
        return d - 2.0 * cosine * n;
    }
    return ratio * d - (ratio * cosine + sqrt(k)) * n;
}

// Cube maps are left-handed. Their faces are drawn by right-handed cameras of the world mirrored in x, so that no
// triangle changes its winding, and looked up mirrored as well.
fn cube_direction(direction_in_world: vec3f) -> vec3f {
    return vec3f(-direction_in_world.x, direction_in_world.yz);
}
