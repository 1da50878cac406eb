// Unit vectors in 32 bits: on an octahedron, unfolded to a square (Cigolle et al. 2014). No twin: the rasteriser runs on devices
// alone.

fn folded(v: vec2f) -> vec2f {
    return (1.0 - abs(v.yx)) * select(vec2f(-1.0), vec2f(1.0), v >= vec2f(0.0));
}

fn packed_direction(n: vec3f) -> u32 {
    let flat = n.xy / max(abs(n.x) + abs(n.y) + abs(n.z), 1e-30);
    return pack2x16snorm(select(flat, folded(flat), n.z < 0.0));
}

fn unpacked_direction(bits: u32) -> vec3f {
    let flat = unpack2x16snorm(bits);
    let z = 1.0 - abs(flat.x) - abs(flat.y);
    return normalize(vec3f(select(flat, folded(flat), z < 0.0), z));
}
