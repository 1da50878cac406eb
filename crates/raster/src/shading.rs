//! The fake's formulas on the CPU: twins, by name and parameters, of the functions in `shaders/raster/shading.wgsl`,
//! `refraction.wgsl`, `shadow.wgsl`, `shaders/raster/repair/fresnel.wgsl`, `shaders/raster/repair/polygon.wgsl` and
//! `shaders/raster/repair/spheres.wgsl`. Tests hold the two against each other, and closed forms are computed with them.
//!
//! `n` unit normal, `l` unit direction to the light, `v` unit direction to the viewer, `incident` the light that a
//! white Lambert surface facing the light would send back. Ambient light, `colour * ambient`, is the caller's.

use scene::Vec3;
use scene::material::Checkerboard;
use std::f32::consts::FRAC_1_PI;

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

/// Lambert's law alone: `kd max(0, N.L)`.
pub fn lambert(n: Vec3, l: Vec3, kd: Vec3, incident: Vec3) -> Vec3 {
    incident * (kd * n.dot(l).max(0.0))
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

/// How far Schlick's approximation has gone from the reflectance head-on to 1.
fn schlick(l: Vec3, v: Vec3) -> f32 {
    (1.0 - v.dot(half_vector(l, v)).clamp(0.0, 1.0)).powi(5)
}

/// What the coat and the metal of [`cook_torrance`] leave of the matt body `kd`.
pub fn below_coat(l: Vec3, v: Vec3, kd: Vec3, facets: Facets) -> Vec3 {
    (1.0 - facets.metallic) * (1.0 - (facets.f0 + (1.0 - facets.f0) * schlick(l, v))) * kd
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

/// The share of unpolarised light that a smooth dielectric reflects: Fresnel's equations. `cosine` of the angle to the normal,
/// on the side that light comes from; `ratio` is the index of refraction there over the one behind.
pub fn dielectric_reflectance(cosine: f32, ratio: f32) -> f32 {
    let square = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    if square <= 0.0 {
        return 1.0;
    }
    let inner = square.sqrt();
    let outer = cosine.max(0.0);
    let across = (ratio * outer - inner) / (ratio * outer + inner);
    let along = (outer - ratio * inner) / (outer + ratio * inner);
    0.5 * (across * across + along * along)
}

/// The share of the cosine-weighted hemisphere about unit normal `n` that a sphere covers, seen from outside of it; `towards` is
/// the way to its middle. Where the horizon cuts it: Naraghi and Chung, "Radiation configuration factors between disks and a
/// class of axisymmetric bodies", 1982.
pub fn covered_sky(n: Vec3, towards: Vec3, radius: f32) -> f32 {
    let distance = towards.length().max(radius * 1.000_001);
    let cosine = n.dot(towards) / distance;
    let square = distance * distance / (radius * radius);
    let beyond = 1.0 - square * cosine * cosine;
    if beyond <= 0.0 {
        return cosine.max(0.0) / square;
    }
    let tangent = (square - 1.0).max(1e-12).sqrt();
    let sine = (1.0 - cosine * cosine).max(1e-12).sqrt();
    let horizon = (-cosine * tangent / sine).clamp(-1.0, 1.0);
    let share = cosine * horizon.acos() - beyond.sqrt() * tangent;
    ((share / square + (beyond.sqrt() / tangent).atan()) * FRAC_1_PI).max(0.0)
}

/// The share of the sun's disc that a sphere covers, its edge taken to be straight there, and how far from the sphere's middle
/// light passes, in radii, at most 1; `l` unit direction to the sun, `spread` the tangent of its angular radius.
pub fn covered_sun(towards: Vec3, radius: f32, l: Vec3, spread: f32) -> [f32; 2] {
    let along = towards.dot(l);
    let aside = (towards - along * l).length();
    let x = ((radius - aside) / (along * spread).max(1e-6 * radius)).clamp(-1.0, 1.0);
    let share = 0.5 + (x.asin() + x * (1.0 - x * x).sqrt()) * FRAC_1_PI;
    [if along > 0.0 { share } else { 0.0 }, (aside / radius).min(1.0)]
}

/// What of light goes straight through a sphere of glass that it meets at this distance from its middle, in radii.
pub fn let_through(aside: f32, ratio: f32) -> f32 {
    let passed = 1.0 - dielectric_reflectance((1.0 - aside * aside).max(0.0).sqrt(), ratio);
    passed * passed
}

/// What an edge from `a` to `b` adds to twice the irradiance of a polygon of radiance 1, seen from the origin.
fn edge_light(n: Vec3, a: Vec3, b: Vec3) -> f32 {
    let across = a.cross(b - a);
    let sine = across.length();
    n.dot(across) / sine.max(1e-30) * sine.atan2(a.dot(b))
}

/// The share of the cosine-weighted hemisphere about unit normal `n` that a parallelogram covers (Lambert 1760), what of it lies
/// below the horizon cut off. Its corner is seen from the point; negative where that sees the back of `edge_u x edge_v`.
pub fn covered_by_quad(n: Vec3, corner: Vec3, edge_u: Vec3, edge_v: Vec3) -> f32 {
    let unit = (corner + 0.5 * (edge_u + edge_v)).length().max(1e-30).recip();
    let corners = [corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v].map(|corner| unit * corner);
    let mut sum = 0.0;
    let (mut goes, mut comes) = (Vec3::ZERO, Vec3::ZERO);
    for (a, b) in (0..4).map(|i| (corners[i], corners[(i + 1) % 4])) {
        let above = [n.dot(a), n.dot(b)];
        let difference = above[0] - above[1];
        let cut = a.lerp(b, (above[0] / if difference != 0.0 { difference } else { 1.0 }).clamp(0.0, 1.0));
        match above.map(|height| height >= 0.0) {
            [true, true] => sum += edge_light(n, a, b),
            [true, false] => {
                sum += edge_light(n, a, cut);
                goes = cut;
            }
            [false, true] => {
                sum += edge_light(n, cut, b);
                comes = cut;
            }
            [false, false] => {}
        }
    }
    sum += edge_light(n, goes, comes);
    -0.5 * sum * FRAC_1_PI
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the midpoint rule over the hemisphere, in f64.
    fn covered_sky_by_counting(towards: Vec3, radius: f32) -> f64 {
        const SIDE: usize = 1000;
        let c = towards.as_dvec3();
        let least = (1.0 - f64::from(radius).powi(2) / c.length_squared()).sqrt();
        let covered = |index: usize| {
            // cosine-weighted directions about z
            let (u, v) = ((index % SIDE) as f64 + 0.5, (index / SIDE) as f64 + 0.5);
            let (sine, angle) = ((u / SIDE as f64).sqrt(), std::f64::consts::TAU * v / SIDE as f64);
            let d = scene::glam::DVec3::new(sine * angle.cos(), sine * angle.sin(), (1.0 - sine * sine).sqrt());
            d.dot(c.normalize()) > least
        };
        (0..SIDE * SIDE).filter(|index| covered(*index)).count() as f64 / (SIDE * SIDE) as f64
    }

    #[test]
    fn a_sphere_covers_as_much_of_the_sky_as_is_counted_above_below_and_across_the_horizon() {
        let places =
            [(0.0, 2.0), (1.5, 1.5), (2.0, 0.5), (2.0, 0.0), (2.0, -0.5), (1.2, 0.3), (3.0, -2.0), (0.0, -3.0)];
        for (aside, above) in places {
            let towards = Vec3::new(0.6 * aside, 0.8 * aside, above);
            let (formula, counted) = (covered_sky(Vec3::Z, towards, 1.0), covered_sky_by_counting(towards, 1.0));
            // cells that the sphere's rim cuts
            assert!((f64::from(formula) - counted).abs() < 1e-3, "{towards}: {formula} is not {counted}");
        }
    }

    /// By the midpoint rule over the parallelogram, in f64.
    fn covered_by_quad_by_counting(n: Vec3, [corner, u, v]: [Vec3; 3]) -> f64 {
        const SIDE: usize = 400;
        let [n, corner, u, v] = [n, corner, u, v].map(|x| x.as_dvec3());
        let light = |index: usize| {
            let at = |i: usize| (i as f64 + 0.5) / SIDE as f64;
            let d = corner + u * at(index % SIDE) + v * at(index / SIDE);
            n.dot(d).max(0.0) * -u.cross(v).dot(d) / d.length_squared().powi(2)
        };
        (0..SIDE * SIDE).map(light).sum::<f64>() / (SIDE * SIDE) as f64 / std::f64::consts::PI
    }

    #[test]
    fn a_parallelogram_covers_as_much_as_is_counted_above_below_and_across_the_horizon_and_far_away() {
        let (u, v) = (Vec3::new(2.0, 0.0, 0.3), Vec3::new(0.4, 1.5, 0.0));
        let at = |corner: Vec3| [corner, u, v];
        let quads = [
            at(Vec3::new(-1.0, -1.0, 1.0)),
            at(Vec3::new(-1.0, -1.0, -1.0)),
            at(Vec3::new(0.5, 2.0, -0.1)),
            [Vec3::new(1.0, -1.0, -0.5), Vec3::new(0.0, 2.0, 0.0), Vec3::new(0.1, 0.0, 1.3)],
            [Vec3::new(1.0, -1.0, -0.5), Vec3::new(0.1, 0.0, 1.3), Vec3::new(0.0, 2.0, 0.0)],
            [Vec3::new(0.2, 3.0, 0.0), Vec3::X, Vec3::Z],
            at(Vec3::new(30.0, -20.0, 40.0)),
        ];
        for quad in quads {
            let formula = f64::from(covered_by_quad(Vec3::Z, quad[0], quad[1], quad[2]));
            let counted = covered_by_quad_by_counting(Vec3::Z, quad);
            assert!((formula - counted).abs() < 2e-5 + 2e-3 * counted.abs(), "{quad:?}: {formula} is not {counted}");
        }
        // a scene's own scale is of no account
        let scaled = |s: f32| covered_by_quad(Vec3::Z, s * Vec3::new(-1.0, -1.0, 1.0), s * u, s * v);
        assert!([1e-12, 1e12].into_iter().all(|s| (scaled(s) - scaled(1.0)).abs() < 1e-6));
    }

    #[test]
    fn glass_reflects_what_fresnel_says_at_normal_incidence_brewsters_angle_and_beyond_the_critical_one() {
        assert!((dielectric_reflectance(1.0, 1.0 / 1.5) - 0.04).abs() < 1e-6);
        // where the part in the plane of incidence vanishes: half of the other part is left
        let brewster = (1.5f32).atan().cos();
        let across = ((1.5f32 * 1.5 - 1.0) / (1.5 * 1.5 + 1.0)).powi(2);
        assert!((dielectric_reflectance(brewster, 1.0 / 1.5) - 0.5 * across).abs() < 1e-6);
        assert_eq!(dielectric_reflectance(0.7, 1.5), 1.0, "the critical angle's cosine is .745");
        assert!(dielectric_reflectance(0.0, 1.0 / 1.5) > 0.999_999);
    }

    #[test]
    fn a_sphere_covers_half_of_a_sun_behind_its_edge_and_all_of_one_behind_its_middle() {
        let share = |x: f32| covered_sun(Vec3::new(x, 0.0, 10.0), 1.0, Vec3::Z, 0.01)[0];
        assert_eq!([share(0.0), share(0.8), share(1.2)], [1.0, 1.0, 0.0]);
        assert!((share(1.0) - 0.5).abs() < 1e-5);
        // a chord at half the sun's radius cuts off 1/3 - sqrt(3)/(4 pi)
        assert!((share(1.05) - 0.195_5).abs() < 1e-3, "{}", share(1.05));
        assert_eq!(covered_sun(Vec3::new(0.0, 0.0, -10.0), 1.0, Vec3::Z, 0.01)[0], 0.0, "behind the point");
    }

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
