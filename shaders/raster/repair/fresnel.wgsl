// Fresnel's equations. Twin: crates/raster/src/shading.rs, which has all formulas of the rasteriser.

// The share of unpolarised light that a smooth dielectric reflects; `cosine` of the angle to the normal, on the side that
// light comes from; `ratio` is the index of refraction there over the one behind. 1 beyond the critical angle.
fn dielectric_reflectance(cosine: f32, ratio: f32) -> f32 {
    let square = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    if square <= 0.0 {
        return 1.0;
    }
    let inner = sqrt(square);
    let outer = max(cosine, 0.0);
    let across = (ratio * outer - inner) / (ratio * outer + inner);
    let along = (outer - ratio * inner) / (outer + ratio * inner);
    return 0.5 * (across * across + along * along);
}
