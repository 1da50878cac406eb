//! What casts caustics and can be aimed through: spheres of glass, which send light on off their outside and through, and
//! perfectly mirroring ones. A *chain* is one of these ways by one of these spheres. Vertices choose one at random and
//! connect to the light by it, see [`sphere_chain`]; light that chance finds on a chain is weighed against that.
//!
//! The probability of a chain is a matter of the sphere's material alone, so that chance need not know which of the
//! spheres it has met. A caster may shine as well: it is then met and sampled like any light, and what it sends by way of
//! itself does not leave the sphere.
//!
//! Shapes of mirror and glass that connections do not go by have [`cone`]s, which a part of the directions goes into.
//!
//! Twin: `shaders/pathtrace/caster/caster.wgsl`.

pub mod cone;
pub mod connect;
pub mod sphere_chain;

use crate::intersect::pairs::{Bounds, for_each_pair};
use crate::sampling::discrete::Discrete;
use crate::vectors::{VectorColumn, glam_vector};
use film::colour;
use scene::{Bsdf, Geometry, Scene, Shape, Vec3};
use simd::{Column, Float, Vector, Word, WordColumn};
use sphere_chain::{Incidence, Ratio};

/// How much of diffuse light glass of the usual indices reflects, about: .09 at 1.5.
const REFLECTED_BY_GLASS: f64 = 0.1;

/// Of a chain's code beside its material: it goes through the sphere.
pub(crate) const THROUGH: u32 = 1 << 31;

/// The chains of a scene.
#[derive(Debug, Clone, Default)]
pub struct Casters {
    center: VectorColumn,
    radius: Column,
    /// Index of the material, and [`THROUGH`].
    code: WordColumn,
    choice: Discrete,
    materials: CasterMaterials,
    /// Whether nothing lies inside of any sphere that light goes through.
    hollow: bool,
}

/// What spheres of each of the scene's materials do to chains.
#[derive(Debug, Clone, Default)]
pub struct CasterMaterials {
    /// Of the sine inside to that of the incidence, see [`Ratio`]: 0 for mirrors.
    sine: Column,
    rest: Column,
    /// Of what is reflected.
    colour: VectorColumn,
    /// With which a chain off such a sphere is chosen; 0 if none is.
    off: Column,
    /// The same through it.
    through: Column,
}

/// A chain in each lane.
#[derive(Debug, Clone, Copy)]
pub struct Chains<F: Float> {
    /// Centre of the sphere.
    pub center: Vector<F>,
    /// Radius of the sphere, above 0, in world units.
    pub radius: F,
    /// What it is made of.
    pub surface: ChainSurfaces<F>,
    /// Through it; else off its outside.
    pub through: F::M,
}

/// What a sphere does to a chain, in each lane.
#[derive(Debug, Clone, Copy)]
pub struct ChainSurfaces<F: Float> {
    /// Inside the sphere; 0 for mirrors.
    pub inside: Ratio<F>,
    /// Of what is reflected.
    pub colour: Vector<F>,
    /// With which the chain is chosen; 0 if there is none.
    pub probability: F,
}

impl Casters {
    /// Collects the chains of all spheres of glass and mirror, with the probability of choosing each.
    pub fn new(scene: &Scene) -> Self {
        let spheres = scene.shapes.iter().filter_map(|shape| Some((sphere(shape)?, shape.material as u32)));
        let mut rows = Vec::new();
        for (sphere, material) in spheres {
            let [off, through] = weights(&scene.materials[material as usize].bsdf);
            rows.extend((through > 0.0).then_some((sphere, material | THROUGH, through)));
            rows.extend((off > 0.0).then_some((sphere, material, off)));
        }
        if rows.is_empty() {
            return Casters::default();
        }
        let total = rows.iter().map(|row| row.2).sum();
        Casters {
            center: VectorColumn::new(rows.iter().map(|row| row.0.0)),
            radius: Column::new(rows.iter().map(|row| row.0.1)),
            code: WordColumn::new(rows.iter().map(|row| row.1)),
            choice: Discrete::new(rows.iter().map(|row| row.2 / total)),
            materials: CasterMaterials::new(scene, total),
            hollow: are_hollow(scene),
        }
    }

    /// Whether there is none.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.choice.is_empty()
    }

    /// Number of chains: two of each sphere of glass, one of each mirroring one.
    pub fn len(&self) -> usize {
        self.choice.len()
    }

    /// Each chain's centre, radius and code, with the running sum of the probabilities of being chosen.
    pub(crate) fn rows(&self) -> impl Iterator<Item = (Vec3, f32, u32, f32)> {
        let row = |(chain, &cumulative): (u32, &f32)| {
            let center = glam_vector(self.center.look_up(chain));
            (center, chain.look_up(&self.radius), chain.look_up_word(&self.code), cumulative)
        };
        (0..).zip(self.choice.running_sums()).map(row)
    }

    /// Whether nothing lies inside of any sphere that light goes through.
    #[inline(always)]
    pub fn are_hollow(&self) -> bool {
        self.hollow
    }

    /// What spheres of each material do to chains.
    #[inline(always)]
    pub fn materials(&self) -> &CasterMaterials {
        &self.materials
    }

    /// The chains that `u` in [0, 1) chooses; there must be one.
    #[inline(always)]
    pub fn choose<F: Float>(&self, u: F) -> Chains<F> {
        let chain = self.choice.choose(u);
        let code = chain.look_up_word(&self.code);
        let through = !(code & F::U::splat(THROUGH)).eq(F::U::splat(0));
        Chains {
            center: self.center.look_up(chain),
            radius: chain.look_up(&self.radius),
            surface: self.materials.of(code & F::U::splat(!THROUGH), through),
            through,
        }
    }
}

impl CasterMaterials {
    fn new(scene: &Scene, total: f64) -> Self {
        let all = || scene.materials.iter().map(|material| &material.bsdf);
        let inverse = |bsdf: &Bsdf| match bsdf {
            Bsdf::Dielectric { ior } => 1.0 / f64::from(*ior),
            _ => 0.0,
        };
        let probability = |chain: usize| Column::new(all().map(|bsdf| (weights(bsdf)[chain] / total) as f32));
        CasterMaterials {
            sine: Column::new(all().map(|bsdf| inverse(bsdf) as f32)),
            rest: Column::new(all().map(|bsdf| (1.0 - inverse(bsdf) * inverse(bsdf)) as f32)),
            colour: VectorColumn::new(all().map(|bsdf| match bsdf {
                Bsdf::Mirror { reflectance } => *reflectance,
                _ => Vec3::ONE,
            })),
            off: probability(0),
            through: probability(1),
        }
    }

    /// Of spheres of these materials, and chains through or off them.
    #[inline(always)]
    pub fn of<F: Float>(&self, material: F::U, through: F::M) -> ChainSurfaces<F> {
        ChainSurfaces {
            inside: Ratio::new(material.look_up(&self.sine), material.look_up(&self.rest)),
            colour: self.colour.look_up(material),
            probability: F::select(through, material.look_up(&self.through), material.look_up(&self.off)),
        }
    }
}

impl<F: Float> ChainSurfaces<F> {
    /// Share of light that the surface reflects, and with which chance does: Fresnel's equations, which come to 1 for a
    /// mirror as for glass of infinite index.
    #[inline(always)]
    pub fn reflectance(&self, cos: F) -> F {
        // a mirror's equations are 0 / 0 at grazing incidence
        let cos = cos.max(F::splat(f32::MIN_POSITIVE));
        let (ratio, inner) = (self.inside.times(F::splat(1.0)), self.inside.cosine(cos));
        let parallel = (cos - ratio * inner) / (cos + ratio * inner);
        let perpendicular = (ratio * cos - inner) / (ratio * cos + inner);
        (parallel * parallel + perpendicular * perpendicular) * 0.5
    }

    /// Share of light that passes the chain, and with which chance goes that way, but for the colour.
    #[inline(always)]
    pub fn passes(&self, through: F::M, Incidence { cos, .. }: Incidence<F>) -> F {
        let reflected = self.reflectance(cos);
        let refracted = F::splat(1.0) - reflected;
        F::select(through, refracted * refracted, reflected)
    }
}

fn sphere(shape: &Shape) -> Option<(Vec3, f32)> {
    match shape.geometry {
        Geometry::Sphere { center, radius } => Some((center, radius)),
        _ => None,
    }
}

/// What chains off and through a sphere of this are worth. A bubble, whose index is below 1, has none.
fn weights(bsdf: &Bsdf) -> [f64; 2] {
    match bsdf {
        Bsdf::Dielectric { ior } if *ior > 1.0 => [REFLECTED_BY_GLASS, 1.0 - REFLECTED_BY_GLASS],
        Bsdf::Mirror { reflectance } => [f64::from(colour::luminance(*reflectance)), 0.0],
        _ => [0.0; 2],
    }
}

/// Whether nothing lies inside of any sphere that light goes through: else chords have to be tested as well. Where it is
/// not known of a shape that it lies outside, it counts as inside.
fn are_hollow(scene: &Scene) -> bool {
    let bounds: Vec<Bounds> = scene.shapes.iter().map(|shape| shape.geometry.bounds()).collect();
    let mut hollow = true;
    for_each_pair(&bounds, |a, b| {
        for (caster, other) in [(a, b), (b, a)] {
            let shape = &scene.shapes[caster];
            if let Some(ball) = sphere(shape).filter(|_| weights(&scene.material_of(shape).bsdf)[1] > 0.0) {
                hollow &= !reaches_into(&scene.shapes[other].geometry, ball);
            }
        }
    });
    hollow
}

fn reaches_into(other: &Geometry, (center, radius): (Vec3, f32)) -> bool {
    if let Geometry::Sphere { center: middle, radius: r } = *other {
        let apart = center.as_dvec3().distance(middle.as_dvec3());
        let (own, r) = (f64::from(radius), f64::from(r));
        return apart < own + r && apart + own > r;
    }
    let (low, high) = other.bounds();
    center.as_dvec3().distance(center.clamp(low, high).as_dvec3()) < f64::from(radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::builtin;

    fn whitted_and(geometry: Geometry, index: f32) -> Casters {
        let mut scene = builtin::named("whitted").unwrap();
        scene.set_refraction_ratio(1.0 / index);
        let floor = scene.shapes.iter().find(|shape| sphere(shape).is_none());
        let material = floor.unwrap().material;
        scene.shapes = scene.shapes.iter().cloned().chain([Shape { geometry, material }]).collect();
        Casters::new(&scene)
    }

    fn ball(center: [f32; 3], radius: f32) -> Geometry {
        Geometry::Sphere { center: center.into(), radius }
    }

    #[test]
    fn casters_are_spheres_of_glass_and_mirrors() {
        let beside = ball([8.0, 1.0, 2.0], 0.5);
        assert_eq!(whitted_and(beside.clone(), 1.5).len(), 3);
        assert_eq!(whitted_and(beside, 0.8).len(), 1, "of a bubble nothing");
        assert!(Casters::new(&builtin::named("cornell").unwrap()).is_empty());
    }

    #[test]
    fn what_lies_in_glass_is_seen() {
        assert!(whitted_and(ball([8.0, 1.0, 2.0], 0.5), 1.5).are_hollow());
        assert!(whitted_and(ball([2.0, 1.9, -2.5], 0.5), 1.5).are_hollow(), "in the mirror");
        assert!(!whitted_and(ball([4.2, 2.6, -4.2], 0.5), 1.5).are_hollow(), "in the glass");
        assert!(!whitted_and(ball([4.2, 1.6, -4.2], 0.5), 1.5).are_hollow(), "cut by it");
        assert!(whitted_and(ball([4.2, 2.6, -4.2], 2.0), 1.5).are_hollow(), "around it");
    }

    /// Every chain is chosen as often as its material's row says, and the rows' probabilities add up to 1.
    #[test]
    fn chains_are_chosen_with_their_probabilities() {
        let casters = whitted_and(ball([8.0, 1.0, 2.0], 0.5), 1.5);
        let n = 3000;
        let mut inverse = 0.0;
        for k in 0..n {
            let chain = casters.choose((k as f32 + 0.5) / n as f32);
            assert!(chain.surface.probability > 0.0);
            inverse += f64::from(1.0 / chain.surface.probability);
        }
        assert!((inverse / f64::from(n) - 3.0).abs() < 1e-2, "{inverse}: three chains");
    }

    #[test]
    fn reflectance_is_fresnels() {
        let casters = whitted_and(ball([8.0, 1.0, 2.0], 0.5), 1.5);
        for k in 0..=1000 {
            let cos = k as f32 / 1000.0;
            let of = |u: f32| casters.choose(u).surface.reflectance(cos);
            let exact = crate::bsdf::Interface { ior: 1.5, entering: true }.fresnel(cos);
            assert!((of(0.0) - exact).abs() < 1e-6 && of(0.999) == 1.0, "{cos}: {} {exact}, {}", of(0.0), of(0.999));
        }
    }
}
