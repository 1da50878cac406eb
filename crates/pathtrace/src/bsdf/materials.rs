//! A scene's materials by columns, as lanes look them up: the table of lobes.
//!
//! Twins: `shaders/pathtrace/prepared.wgsl` and `shaders/shared/checkerboard.wgsl`.

use super::Interactions;
use super::metallic_roughness::{MetallicRoughnesses, SMOOTHEST, coat_of};
use super::microfacets::Microfacets;
use super::rough_conductor::RoughConductors;
use super::textures::ImageTextures;
use crate::intersect::SurfacePoints;
use crate::vectors::VectorColumn;
use scene::{Bsdf, Conductor, Material, MetallicRoughness, Texture, Vec3};
use simd::{Column, Float, Vector, Word, WordColumn};

/// All materials.
#[derive(Debug, Clone, Default)]
pub struct Materials {
    /// Albedo of diffuse ones, of a checkerboard's even cells; reflectance of mirrors.
    colour: VectorColumn,
    odd: VectorColumn,
    board_origin: VectorColumn,
    cells_per_unit: VectorColumn,
    ior: Column,
    alpha: Column,
    eta: VectorColumn,
    k: VectorColumn,
    /// Of metallic-roughness: share of metal ...
    metallic: Column,
    /// ... the roughness of its facets ...
    roughness: Column,
    /// ... and what its coat reflects at normal incidence.
    coat: Column,
    radiance: VectorColumn,
    kind: WordColumn,
    has: Has,
    textures: ImageTextures,
}

/// What occurs among them.
#[derive(Debug, Clone, Copy, Default)]
pub struct Has {
    /// Any that shine.
    pub area_lights: bool,
    /// Any mirror.
    pub mirrors: bool,
    /// Any glass.
    pub glass: bool,
    /// Any rough metal.
    pub rough_conductors: bool,
    /// Any surface of glTF's metallic-roughness model.
    pub metallic_roughness: bool,
    checkerboards: bool,
    /// Any surface that is shaded by other normals than its own.
    pub shading_normals: bool,
}

/// What the materials in the lanes are, as bits.
#[derive(Debug, Clone, Copy)]
pub struct Kinds<U>(U);

/// Codes of lobes and of what varies them, bits of one word; the graphics device has the same.
pub const LOBE_LAMBERT: u32 = 1;
/// See [`LOBE_LAMBERT`].
pub const LOBE_MIRROR: u32 = 2;
/// See [`LOBE_LAMBERT`].
pub const LOBE_DIELECTRIC: u32 = 4;
/// See [`LOBE_LAMBERT`].
pub const LOBE_ROUGH_CONDUCTOR: u32 = 8;
/// One of the lobes, see [`LOBE_LAMBERT`].
pub const LOBE_METALLIC_ROUGHNESS: u32 = 16;
/// Of a Lambert lobe or metallic-roughness: its colour is a checkerboard.
pub const CHECKERED: u32 = 1 << 8;
/// Of a conductor: it reflects by Fresnel's equations.
pub const HAS_INDEX: u32 = 1 << 9;

const AREA_LIGHT: u32 = 1 << 16;
const TWO_SIDED: u32 = 1 << 17;

/// Lobes that leave no choice of direction but among few.
const DELTA: u32 = LOBE_MIRROR | LOBE_DIELECTRIC;

impl<U: Word> Kinds<U> {
    #[inline(always)]
    fn has(self, bit: u32) -> U::M {
        !(self.0 & U::splat(bit)).eq(U::splat(0))
    }

    /// Scatters by Lambert's law.
    #[inline(always)]
    pub fn diffuse(self) -> U::M {
        self.has(LOBE_LAMBERT)
    }

    /// Sends light on in one direction, or in one of few.
    #[inline(always)]
    pub fn delta(self) -> U::M {
        self.has(DELTA)
    }

    /// Of no material: none of the bits is set.
    #[inline(always)]
    pub fn none() -> Self {
        Kinds(U::splat(0))
    }

    /// `mask ? yes : no`.
    #[inline(always)]
    pub fn select(mask: U::M, yes: Self, no: Self) -> Self {
        Kinds(U::select(mask, yes.0, no.0))
    }

    /// Scatters by Lambert's law instead where `here` says so.
    #[inline(always)]
    pub fn or_diffuse(self, here: U::M) -> Self {
        Kinds(U::select(here, U::splat(LOBE_LAMBERT), self.0))
    }

    /// Is a mirror.
    #[inline(always)]
    pub fn mirror(self) -> U::M {
        self.has(LOBE_MIRROR)
    }

    /// Is glass.
    #[inline(always)]
    pub fn glass(self) -> U::M {
        self.has(LOBE_DIELECTRIC)
    }

    /// Is rough metal.
    #[inline(always)]
    pub fn rough_conductor(self) -> U::M {
        self.has(LOBE_ROUGH_CONDUCTOR)
    }

    /// Scatters by glTF's metallic-roughness model.
    #[inline(always)]
    pub fn metallic_roughness(self) -> U::M {
        self.has(LOBE_METALLIC_ROUGHNESS)
    }

    /// Scatters in lobes of facets, which are no delta but may be narrow.
    #[inline(always)]
    pub fn glossy(self) -> U::M {
        self.has(LOBE_ROUGH_CONDUCTOR | LOBE_METALLIC_ROUGHNESS)
    }

    /// Does nothing but mirror or refract, by facets or as a whole.
    #[inline(always)]
    pub fn only_mirrors(self) -> U::M {
        self.has(DELTA | LOBE_ROUGH_CONDUCTOR)
    }

    /// Shines.
    #[inline(always)]
    pub fn area_light(self) -> U::M {
        self.has(AREA_LIGHT)
    }
}

impl Materials {
    /// The scene's materials in their order.
    pub fn new(materials: &[Material]) -> Self {
        let vectors = |of: fn(&Material) -> Vec3| VectorColumn::new(materials.iter().map(of));
        let kinds = materials.iter().map(kind_of);
        let any = |bit: u32| kinds.clone().any(|kind| kind & bit != 0);
        Materials {
            colour: vectors(|material| match &material.bsdf {
                Bsdf::Diffuse { albedo: colour }
                | Bsdf::MetallicRoughness(MetallicRoughness { base_colour: colour, .. }) => match colour {
                    Texture::Constant(colour) | Texture::Image { factor: colour, .. } => *colour,
                    Texture::Checkerboard(board) => board.even,
                },
                Bsdf::Mirror { reflectance } => *reflectance,
                Bsdf::RoughConductor { conductor, .. } => conductor.at_normal_incidence(),
                Bsdf::Dielectric { .. } => Vec3::ONE,
            }),
            odd: vectors(|material| board_of(material).map_or(Vec3::ZERO, |board| board.odd)),
            board_origin: vectors(|material| board_of(material).map_or(Vec3::ZERO, |board| board.origin)),
            cells_per_unit: vectors(|material| board_of(material).map_or(Vec3::ZERO, |board| board.cells_per_unit())),
            ior: Column::new(materials.iter().map(|material| match material.bsdf {
                Bsdf::Dielectric { ior } => ior,
                _ => 1.0,
            })),
            alpha: Column::new(materials.iter().map(|material| match material.bsdf {
                Bsdf::RoughConductor { roughness, .. } => roughness * roughness,
                _ => 1.0,
            })),
            metallic: Column::new(models(materials).map(|model| model.map_or(0.0, |model| model.metallic))),
            roughness: Column::new(models(materials).map(|model| model.map_or(1.0, |model| model.roughness))),
            coat: Column::new(models(materials).map(|model| model.map_or(0.0, |model| coat_of(model.ior)))),
            eta: vectors(|material| index_of(material).0),
            k: vectors(|material| index_of(material).1),
            radiance: vectors(|material| material.emission.map_or(Vec3::ZERO, |emission| emission.radiance)),
            has: Has {
                area_lights: any(AREA_LIGHT),
                mirrors: any(LOBE_MIRROR),
                glass: any(LOBE_DIELECTRIC),
                rough_conductors: any(LOBE_ROUGH_CONDUCTOR),
                metallic_roughness: any(LOBE_METALLIC_ROUGHNESS),
                checkerboards: any(CHECKERED),
                shading_normals: false,
            },
            textures: ImageTextures::new(materials),
            kind: WordColumn::new(kinds),
        }
    }

    /// Looks for every kind of material from now on.
    pub fn expect_everything(&mut self) {
        let shading_normals = self.has.shading_normals;
        self.has = Has {
            area_lights: true,
            mirrors: true,
            glass: true,
            rough_conductors: true,
            metallic_roughness: true,
            checkerboards: true,
            shading_normals,
        };
    }

    /// Those of a scene whose meshes, or whose textures, say anything of normals.
    pub fn with_shading_normals(mut self, there: bool) -> Self {
        self.has.shading_normals = there;
        self
    }

    /// What they are made of beside numbers.
    #[inline(always)]
    pub fn textures(&self) -> &ImageTextures {
        &self.textures
    }

    /// What occurs among them.
    #[inline(always)]
    pub fn has(&self) -> Has {
        self.has
    }

    /// Which kind of material each lane holds.
    #[inline(always)]
    pub fn kinds<U: Word>(&self, material: U) -> Kinds<U> {
        Kinds(material.look_up_word(&self.kind))
    }

    /// Albedo of diffuse ones at a point, reflectance of mirrors, 1 for glass. A surface that lies in the side between
    /// two cells belongs to the upper one, wherever its points are rounded to: along its normal, what is not known to lie
    /// below the side lies above.
    #[inline(always)]
    pub fn colour<F: Float>(&self, material: F::U, kinds: Kinds<F::U>, at: &SurfacePoints<F>, uv: [F; 2]) -> Vector<F> {
        let mut colour = self.colour.look_up(material);
        if !self.textures.is_empty() {
            colour = colour * self.textures.colour(material, uv);
        }
        if !self.has.checkerboards {
            return colour;
        }
        let from_origin = at.position + at.error * at.normal.abs() - self.board_origin.look_up(material);
        let index = from_origin * self.cells_per_unit.look_up(material);
        let sum = index.x.floor() + index.y.floor() + index.z.floor();
        let odd = !(sum - (sum * 0.5).floor() * 2.0).lt(F::splat(0.5));
        Vector::select(odd & kinds.has(CHECKERED), self.odd.look_up(material), colour)
    }

    /// Index of refraction of the inside over the outside.
    #[inline(always)]
    pub fn ior<F: Float>(&self, material: F::U) -> F {
        material.look_up(&self.ior)
    }

    /// The rough metals among these.
    #[inline(always)]
    pub fn rough_conductor<F: Float>(&self, at: &Interactions<F>) -> RoughConductors<F> {
        RoughConductors {
            facets: Microfacets { alpha: at.material.look_up(&self.alpha) },
            reflectance: at.colour,
            has_index: at.kinds.has(HAS_INDEX),
            eta: self.eta.look_up(at.material),
            k: self.k.look_up(at.material),
        }
    }

    /// The metallic-roughness among these: here alone is asked what pictures may vary from place to place.
    #[inline(always)]
    pub fn metallic_roughness<F: Float>(&self, at: &Interactions<F>) -> MetallicRoughnesses<F> {
        let mut metallic: F = at.material.look_up(&self.metallic);
        let mut roughness: F = at.material.look_up(&self.roughness);
        if self.textures.has_metallic_roughness() {
            let [metal, rough] = self.textures.metallic_roughness(at.material, at.uv);
            (metallic, roughness) = (metallic * metal, roughness * rough);
        }
        MetallicRoughnesses {
            base_colour: at.colour,
            metallic,
            roughness: roughness.max(F::splat(SMOOTHEST)),
            coat: at.material.look_up(&self.coat),
        }
    }

    /// What surfaces send out in a direction at this cosine to their outward normal.
    #[inline(always)]
    pub fn emitted<F: Float>(&self, material: F::U, cosine: F) -> Vector<F> {
        let shines = self.kinds(material).has(TWO_SIDED) | cosine.gt(F::splat(0.0));
        Vector::select(shines, self.radiance.look_up(material), Vector::zero())
    }
}

fn board_of(material: &Material) -> Option<scene::material::Checkerboard> {
    match material.bsdf {
        Bsdf::Diffuse { albedo: Texture::Checkerboard(board) }
        | Bsdf::MetallicRoughness(MetallicRoughness { base_colour: Texture::Checkerboard(board), .. }) => Some(board),
        _ => None,
    }
}

fn models(materials: &[Material]) -> impl Iterator<Item = Option<&MetallicRoughness>> {
    materials.iter().map(|material| match &material.bsdf {
        Bsdf::MetallicRoughness(model) => Some(model),
        _ => None,
    })
}

/// Index of refraction and extinction coefficient of metals.
fn index_of(material: &Material) -> (Vec3, Vec3) {
    match material.bsdf {
        Bsdf::RoughConductor { conductor: Conductor::Fresnel { eta, k }, .. } => (eta, k),
        _ => (Vec3::ONE, Vec3::ZERO),
    }
}

/// The code of a lobe, and of what varies it.
pub fn lobe_of(bsdf: &Bsdf) -> u32 {
    match bsdf {
        Bsdf::Diffuse { albedo } => LOBE_LAMBERT | checkered(albedo),
        Bsdf::MetallicRoughness(model) => LOBE_METALLIC_ROUGHNESS | checkered(&model.base_colour),
        Bsdf::Mirror { .. } => LOBE_MIRROR,
        Bsdf::RoughConductor { conductor: Conductor::Constant(_), .. } => LOBE_ROUGH_CONDUCTOR,
        Bsdf::RoughConductor { conductor: Conductor::Fresnel { .. }, .. } => LOBE_ROUGH_CONDUCTOR | HAS_INDEX,
        Bsdf::Dielectric { .. } => LOBE_DIELECTRIC,
    }
}

fn checkered(colour: &Texture) -> u32 {
    if matches!(colour, Texture::Checkerboard(_)) { CHECKERED } else { 0 }
}

fn kind_of(material: &Material) -> u32 {
    let bsdf = lobe_of(&material.bsdf);
    let emission =
        material.emission.map_or(0, |emission| if emission.two_sided { AREA_LIGHT | TWO_SIDED } else { AREA_LIGHT });
    bsdf | emission
}
