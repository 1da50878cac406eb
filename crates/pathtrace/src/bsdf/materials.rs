//! A scene's materials by columns, as lanes look them up.
//!
//! Twins: `shaders/pathtrace/prepared.wgsl` and `shaders/shared/checkerboard.wgsl`.

use crate::vectors::VectorColumn;
use scene::{Bsdf, Material, Texture, Vec3};
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
    radiance: VectorColumn,
    kind: WordColumn,
    has: Has,
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
    checkerboards: bool,
}

/// What the materials in the lanes are, as bits.
#[derive(Debug, Clone, Copy)]
pub struct Kinds<U>(U);

const DIFFUSE: u32 = 1;
const MIRROR: u32 = 2;
const GLASS: u32 = 4;
const CHECKERBOARD: u32 = 8;
const AREA_LIGHT: u32 = 16;
const TWO_SIDED: u32 = 32;

impl<U: Word> Kinds<U> {
    #[inline(always)]
    fn has(self, bit: u32) -> U::M {
        !(self.0 & U::splat(bit)).eq(U::splat(0))
    }

    /// Scatters by Lambert's law.
    #[inline(always)]
    pub fn diffuse(self) -> U::M {
        self.has(DIFFUSE)
    }

    /// Is a mirror.
    #[inline(always)]
    pub fn mirror(self) -> U::M {
        self.has(MIRROR)
    }

    /// Is glass.
    #[inline(always)]
    pub fn glass(self) -> U::M {
        self.has(GLASS)
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
            colour: vectors(|material| match material.bsdf {
                Bsdf::Diffuse { albedo: Texture::Constant(colour) } => colour,
                Bsdf::Diffuse { albedo: Texture::Checkerboard(board) } => board.even,
                Bsdf::Mirror { reflectance } => reflectance,
                Bsdf::Dielectric { .. } => Vec3::ONE,
            }),
            odd: vectors(|material| board_of(material).map_or(Vec3::ZERO, |board| board.odd)),
            board_origin: vectors(|material| board_of(material).map_or(Vec3::ZERO, |board| board.origin)),
            cells_per_unit: vectors(|material| board_of(material).map_or(Vec3::ZERO, |board| board.cells_per_unit())),
            ior: Column::new(materials.iter().map(|material| match material.bsdf {
                Bsdf::Dielectric { ior } => ior,
                Bsdf::Diffuse { .. } | Bsdf::Mirror { .. } => 1.0,
            })),
            radiance: vectors(|material| material.emission.map_or(Vec3::ZERO, |emission| emission.radiance)),
            has: Has {
                area_lights: any(AREA_LIGHT),
                mirrors: any(MIRROR),
                glass: any(GLASS),
                checkerboards: any(CHECKERBOARD),
            },
            kind: WordColumn::new(kinds),
        }
    }

    /// Looks for every kind of material from now on.
    pub fn expect_everything(&mut self) {
        self.has = Has { area_lights: true, mirrors: true, glass: true, checkerboards: true };
    }

    /// What occurs among them.
    #[inline(always)]
    pub fn has(&self) -> Has {
        self.has
    }

    /// What these are.
    #[inline(always)]
    pub fn kinds<U: Word>(&self, material: U) -> Kinds<U> {
        Kinds(material.look_up_word(&self.kind))
    }

    /// Albedo of diffuse ones at a point of world space, reflectance of mirrors, 1 for glass.
    #[inline(always)]
    pub fn colour<F: Float>(&self, material: F::U, kinds: Kinds<F::U>, at: Vector<F>) -> Vector<F> {
        let colour = self.colour.look_up(material);
        if !self.has.checkerboards {
            return colour;
        }
        let index = (at - self.board_origin.look_up(material)) * self.cells_per_unit.look_up(material);
        let sum = index.x.floor() + index.y.floor() + index.z.floor();
        let odd = !(sum - (sum * 0.5).floor() * 2.0).lt(F::splat(0.5));
        Vector::select(odd & kinds.has(CHECKERBOARD), self.odd.look_up(material), colour)
    }

    /// Index of refraction of the inside over the outside.
    #[inline(always)]
    pub fn ior<F: Float>(&self, material: F::U) -> F {
        material.look_up(&self.ior)
    }

    /// What surfaces of outward `normal` send out against rays of this direction.
    #[inline(always)]
    pub fn emitted<F: Float>(
        &self,
        material: F::U,
        kinds: Kinds<F::U>,
        normal: Vector<F>,
        ray_direction: Vector<F>,
    ) -> Vector<F> {
        let shines = kinds.has(TWO_SIDED) | normal.dot(ray_direction).lt(F::splat(0.0));
        Vector::select(shines, self.radiance.look_up(material), Vector::zero())
    }
}

fn board_of(material: &Material) -> Option<scene::material::Checkerboard> {
    match material.bsdf {
        Bsdf::Diffuse { albedo: Texture::Checkerboard(board) } => Some(board),
        Bsdf::Diffuse { .. } | Bsdf::Mirror { .. } | Bsdf::Dielectric { .. } => None,
    }
}

fn kind_of(material: &Material) -> u32 {
    let bsdf = match material.bsdf {
        Bsdf::Diffuse { albedo: Texture::Constant(_) } => DIFFUSE,
        Bsdf::Diffuse { albedo: Texture::Checkerboard(_) } => DIFFUSE | CHECKERBOARD,
        Bsdf::Mirror { .. } => MIRROR,
        Bsdf::Dielectric { .. } => GLASS,
    };
    let emission =
        material.emission.map_or(0, |emission| if emission.two_sided { AREA_LIGHT | TWO_SIDED } else { AREA_LIGHT });
    bsdf | emission
}
