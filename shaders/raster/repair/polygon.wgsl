//#import raster/repair/spheres.wgsl
// How much of what a point sees a parallelogram covers, in closed form. Twin: crates/raster/src/shading.rs, which has
// all formulas of the rasteriser.

// What an edge from a to b adds to twice the irradiance of a polygon of radiance 1: its angle times the cosine between n and the
// normal of the plane through both and the point, at the origin.
fn edge_light(n: vec3f, a: vec3f, b: vec3f) -> f32 {
    let across = cross(a, b - a);
    let sine = length(across);
    return dot(n, across) / max(sine, 1e-30) * atan2(sine, dot(a, b));
}

// The share of the cosine-weighted hemisphere about unit normal n that a parallelogram covers (Lambert 1760), what of it lies
// below the horizon cut off. Its corner is seen from the point; negative where that sees the back of cross(edge_u, edge_v).
fn covered_by_quad(n: vec3f, corner: vec3f, edge_u: vec3f, edge_v: vec3f) -> f32 {
    // lengths near 1, whatever the scene has
    let unit = 1.0 / max(length(corner + 0.5 * (edge_u + edge_v)), 1e-30);
    var corners = array<vec3f, 4>(corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v);
    var sum = 0.0;
    // where its border goes below the horizon, and where it comes up again
    var goes = vec3f(0.0);
    var comes = vec3f(0.0);
    for (var i = 0u; i < 4u; i++) {
        let a = unit * corners[i];
        let b = unit * corners[(i + 1u) % 4u];
        let above = vec2f(dot(n, a), dot(n, b));
        let difference = above.x - above.y;
        let cut = mix(a, b, saturate(above.x / select(1.0, difference, difference != 0.0)));
        let from_above = above.x >= 0.0;
        let to_above = above.y >= 0.0;
        let light = edge_light(n, select(cut, a, from_above), select(cut, b, to_above));
        sum += select(0.0, light, from_above | to_above);
        goes = select(goes, cut, from_above & !to_above);
        comes = select(comes, cut, !from_above & to_above);
    }
    sum += edge_light(n, goes, comes);
    return -sum / (2.0 * PI);
}
