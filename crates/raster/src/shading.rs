//! The fake's formulas on the CPU: twins, by name and parameters, of the functions in `shaders/raster/shading.wgsl`,
//! `refraction.wgsl` and `shadow.wgsl`. Tests hold the two against each other, and closed forms are computed with them.
//!
//! `n` unit normal, `l` unit direction to the light, `v` unit direction to the viewer, `incident` the light that a
//! white Lambert surface facing the light would send back. Ambient light, `colour * ambient`, is the caller's.

use scene::Vec3;
use scene::material::Checkerboard;

/// See the same name in `shaders/raster/shading.wgsl`.
pub(crate) const SMALLEST: f32 = 1e-37;

/// See the same name in `shaders/raster/shading.wgsl`.
pub(crate) const LEAST_WIDTH: f32 = 1e-4;

/// See the same name in `shaders/raster/shading.wgsl`.
pub(crate) const LEAST_COSINE: f32 = 1e-4;

fn power(base: f32, exponent: f32) -> f32 {
    base.max(SMALLEST).powf(exponent)
}

fn half_vector(l: Vec3, v: Vec3) -> Vec3 {
    let h = l + v;
    h / h.dot(h).max(SMALLEST).sqrt()
}

/// Phong 1975 as on the slides: `kd max(0, N.L) + ks max(0, R.V)^p`, dark where the light is behind the surface. The
/// lobe's integral `2 pi / (p + 2)` shrinks with `p`: this model is not energy-conserving.
pub fn phong(n: Vec3, l: Vec3, v: Vec3, kd: Vec3, ks: f32, p: f32, incident: Vec3) -> Vec3 {
    let cosine = n.dot(l);
    if cosine <= 0.0 {
        return Vec3::ZERO;
    }
    let r = 2.0 * cosine * n - l;
    incident * (kd * cosine + ks * power(r.dot(v).max(0.0), p))
}

/// Blinn 1977 as on the slides: `kd max(0, N.L) + ks max(0, N.H)^p`, dark where the light is behind the surface.
pub fn blinn_phong(n: Vec3, l: Vec3, v: Vec3, kd: Vec3, ks: f32, p: f32, incident: Vec3) -> Vec3 {
    let cosine = n.dot(l);
    if cosine <= 0.0 {
        return Vec3::ZERO;
    }
    incident * (kd * cosine + ks * power(n.dot(half_vector(l, v)).max(0.0), p))
}

/// What three.js r115 calls MeshPhong: `max(0, N.L) (kd + F .25 (s/2 + 1) (N.H)^s)`, F Schlick's term about L.H in
/// Lagarde's spherical Gaussian form, as that version computes it. `f0` is the specular colour, `s` the shininess.
pub fn three_blinn_phong(n: Vec3, l: Vec3, v: Vec3, kd: Vec3, f0: f32, s: f32, incident: Vec3) -> Vec3 {
    let h = half_vector(l, v);
    let l_dot_h = l.dot(h).clamp(0.0, 1.0);
    let fresnel = f0 + (1.0 - f0) * ((-5.55473 * l_dot_h - 6.98316) * l_dot_h).exp2();
    let lobe = 0.25 * (0.5 * s + 1.0) * power(n.dot(h).clamp(0.0, 1.0), s);
    incident * n.dot(l).max(0.0) * (kd + fresnel * lobe)
}

/// pi times the distribution of microfacets by Trowbridge and Reitz 1975, GGX.
fn ggx_times_pi(n: Vec3, h: Vec3, width: f32) -> f32 {
    let cosine = n.dot(h).max(0.0);
    let spread = width * width * cosine * cosine + n.cross(h).length_squared();
    width * width / (spread * spread)
}

/// Smith's masking and shadowing, height-correlated, over four times both cosines (Heitz 2014).
fn smith_visibility(n_dot_l: f32, n_dot_v: f32, width: f32) -> f32 {
    let square = width * width;
    let masked = n_dot_l * (n_dot_v * n_dot_v * (1.0 - square) + square).sqrt();
    let shadowed = n_dot_v * (n_dot_l * n_dot_l * (1.0 - square) + square).sqrt();
    0.5 / (masked + shadowed)
}

/// What the facets of a surface reflect, for [`cook_torrance`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facets {
    /// Share of metal, in [0, 1].
    pub metallic: f32,
    /// Its square is the width of the facets' distribution.
    pub roughness: f32,
    /// What the coat of the rest reflects head-on.
    pub f0: f32,
}

/// Cook and Torrance 1982 with the terms of glTF 2.0, appendix B: a matt body `kd` under a coat, mixed with metal that
/// reflects `colour` head-on; F by Schlick 1994, D is GGX, G Smith's. Dark where the light is behind the surface.
pub fn cook_torrance([n, l, v]: [Vec3; 3], kd: Vec3, colour: Vec3, facets: Facets, incident: Vec3) -> Vec3 {
    let n_dot_l = n.dot(l);
    if n_dot_l <= 0.0 {
        return Vec3::ZERO;
    }
    let h = half_vector(l, v);
    let width = (facets.roughness * facets.roughness).max(LEAST_WIDTH);
    let lobe = ggx_times_pi(n, h, width) * smith_visibility(n_dot_l, n.dot(v).max(LEAST_COSINE), width);
    let grazing = (1.0 - v.dot(h).clamp(0.0, 1.0)).powi(5);
    let coat = facets.f0 + (1.0 - facets.f0) * grazing;
    let dielectric = (1.0 - coat) * kd + coat * lobe;
    let metal = lobe * (colour + (Vec3::ONE - colour) * grazing);
    incident * n_dot_l * dielectric.lerp(metal, facets.metallic)
}

/// Unit direction behind a surface of unit normal `n` (against `d`) for light along the unit direction `d`; `ratio` is
/// the index of refraction in front over the one behind. Beyond the critical angle: the mirrored direction.
pub fn refract(d: Vec3, n: Vec3, ratio: f32) -> Vec3 {
    let cosine = n.dot(d);
    let k = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    if k < 0.0 {
        return d - 2.0 * cosine * n;
    }
    ratio * d - (ratio * cosine + k.sqrt()) * n
}

/// The colour of a checkerboard at `p`: the scene's own function.
pub fn checkerboard(board: &Checkerboard, p: Vec3) -> Vec3 {
    board.at(p)
}

/// Whether the texel of a square shadow map of `size` texels a side that holds `uv` in `[0, 1]^2` is lit, as 0 or 1;
/// `nearest(x, y)` is its depth there. three.js' BasicShadowMap.
pub fn hard(nearest: impl Fn(u32, u32) -> f32, size: u32, uv: [f32; 2], depth: f32) -> f32 {
    let [x, y] = uv.map(|x| ((x * size as f32).floor() as i32).clamp(0, size as i32 - 1) as u32);
    if nearest(x, y) >= depth { 1.0 } else { 0.0 }
}

/// The lit share of 17 texels about `uv`, half a texel and a whole one away. three.js' PCFShadowMap.
pub fn pcf(nearest: impl Fn(u32, u32) -> f32, size: u32, uv: [f32; 2], depth: f32) -> f32 {
    let texel = |x: f32| (x.floor() as i32).clamp(0, size as i32 - 1) as u32;
    let at = uv.map(|x| x * size as f32);
    let lit = |dx: f32, dy: f32| if nearest(texel(at[0] + dx), texel(at[1] + dy)) >= depth { 1.0 } else { 0.0 };
    let ring = |r: f32| {
        lit(-r, -r) + lit(0.0, -r) + lit(r, -r) + lit(-r, 0.0) + lit(r, 0.0) + lit(-r, r) + lit(0.0, r) + lit(r, r)
    };
    (lit(0.0, 0.0) + ring(0.5) + ring(1.0)) / 17.0
}

/// The lit share of 3 x 3 texels about `uv` in `[0, 1]^2` of a square shadow map of `size` texels a side; `nearest(x,
/// y)` is its depth there. The kernel of three.js' PCFSoftShadowMap.
pub fn pcf_soft(nearest: impl Fn(u32, u32) -> f32, size: u32, uv: [f32; 2], depth: f32) -> f32 {
    let at = uv.map(|x| x * size as f32 + 0.5);
    let f = at.map(|x| x - x.floor());
    let t = at.map(|x| x.floor() as i32 - 1);
    let inside = |x: i32| x.clamp(0, size as i32 - 1) as u32;
    let lit = |dx: i32, dy: i32| if nearest(inside(t[0] + dx), inside(t[1] + dy)) >= depth { 1.0 } else { 0.0 };
    let mix = |a: f32, b: f32, t: f32| a * (1.0 - t) + b * t;
    let whole: f32 = lit(0, 0) + lit(1, 0) + lit(0, 1) + lit(1, 1);
    let sides = mix(lit(-1, 0), lit(2, 0), f[0])
        + mix(lit(-1, 1), lit(2, 1), f[0])
        + mix(lit(0, -1), lit(0, 2), f[1])
        + mix(lit(1, -1), lit(1, 2), f[1]);
    let above = mix(lit(-1, -1), lit(2, -1), f[0]);
    let below = mix(lit(-1, 2), lit(2, 2), f[0]);
    (whole + sides + mix(above, below, f[1])) / 9.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beyond_the_critical_angle_refraction_mirrors() {
        let d = Vec3::new(0.8, -0.6, 0.0);
        assert!((refract(d, Vec3::Y, 1.5) - Vec3::new(0.8, 0.6, 0.0)).length() < 1e-6);
        assert!((refract(d, Vec3::Y, 1.0) - d).length() < 1e-6);
    }

    #[test]
    fn an_edge_between_texels_is_blended_linearly_over_three() {
        // the left half of the map is in shadow: the share grows by a third per texel about the edge
        let share = |x: f32| pcf_soft(|x, _| if x < 8 { 0.0 } else { 1.0 }, 16, [x / 16.0, 0.5], 0.5);
        for (x, expected) in [(5.0, 0.0), (6.5, 0.0), (7.25, 0.25), (8.0, 0.5), (8.75, 0.75), (9.5, 1.0)] {
            assert!((share(x) - expected).abs() < 1e-6, "{x}: {} is not {expected}", share(x));
        }
    }
}
