//! What rays are traced through: all shapes at once in each lane while they are few, else one ray at a time through a
//! tree; then, one ray at a time, the large meshes, with what is nearest so far.
//!
//! Twin: `shaders/pathtrace/intersect/aggregate.wgsl`.

use super::attributes::{
    AttributeColumns, EachAttributes, MeshAttributes, RowColumns, SurfaceAttributes, rows_of_tree,
};
use super::coincident::NO_GROUP;
use super::hit::EachIntersection;
use super::ray::BEHIND_THE_END;
use super::shape_list::{Scratch, ShapeList};
use super::{Accel, Hit, Hits, Intersections, NO_INSTANCE, NO_LIGHT, NO_PRIMITIVE, Ray, Rays};
use scene::{Bsdf, Scene};
use simd::{Float, MOST_LANES, Mask, Word};

/// A scene's shapes, ready for rays in lanes.
pub struct Aggregate {
    /// The tree.
    accel: Accel,
    shape_list: Option<ShapeList>,
    /// Which materials are glass.
    clear: Vec<bool>,
    attributes: Option<Attributes>,
}

/// What meshes say of their surfaces, where any says anything.
struct Attributes {
    columns: AttributeColumns,
    of_tree: RowColumns,
    of_list: RowColumns,
}

impl Aggregate {
    /// Builds what the scene asks for; `light_of_shape` is [`crate::light::Lights::light_of_shape`] of it.
    pub fn new(scene: &Scene, light_of_shape: &[u32]) -> Self {
        let clear = scene.materials.iter().map(|material| matches!(material.bsdf, Bsdf::Dielectric { .. }));
        let shape_list = ShapeList::new(scene, light_of_shape);
        Aggregate {
            accel: Accel::new(scene, light_of_shape),
            clear: clear.collect(),
            attributes: MeshAttributes::of(scene).map(|all| Attributes::new(scene, &all, shape_list.as_ref())),
            shape_list,
        }
    }

    /// Whether meshes say anything of their surfaces.
    pub fn has_attributes(&self) -> bool {
        self.attributes.is_some()
    }

    /// What meshes say of the surfaces that were met; `None` where none of the scene's says anything.
    #[inline(always)]
    pub fn attributes<F: Float>(&self, met: &Intersections<F>) -> Option<SurfaceAttributes<F>> {
        let Attributes { columns, of_tree, of_list } = self.attributes.as_ref()?;
        let rows = if self.shape_list.is_some() { of_list } else { of_tree };
        let on_instance = met.on_instance();
        // a mesh of its own has no row here
        let triangle = F::U::select(on_instance, F::U::splat(0), met.triangle);
        let said = columns.of(rows, triangle, met.barycentrics);
        Some(if on_instance.any() { self.or_of_instances(met, on_instance, said) } else { said })
    }

    /// What was said, but on large meshes what those say.
    #[inline(always)]
    fn or_of_instances<F: Float>(
        &self,
        met: &Intersections<F>,
        on_instance: F::M,
        said: SurfaceAttributes<F>,
    ) -> SurfaceAttributes<F> {
        let each = self.attributes_of_each(on_instance.bits(), &met.hits_on_instances().each());
        SurfaceAttributes::select(on_instance, each.in_lanes(), said)
    }

    /// Out of line, and lane by lane: few scenes ask for it.
    #[inline(never)]
    fn attributes_of_each(&self, lanes: u32, hits: &[Hit; MOST_LANES]) -> EachAttributes {
        let mut each = EachAttributes::none();
        for lane in (0..MOST_LANES).filter(|lane| lanes >> lane & 1 != 0) {
            each.set(lane, &self.accel.instances().attributes(&hits[lane]));
        }
        each
    }

    /// The shapes, ready for single rays.
    pub fn accel(&self) -> &Accel {
        &self.accel
    }

    /// The shapes, ready for all lanes at once, if they are few.
    pub fn shape_list(&self) -> Option<&ShapeList> {
        self.shape_list.as_ref()
    }

    /// Traces single rays from now on.
    pub fn forget_shape_list(&mut self) {
        self.shape_list = None;
    }

    /// The nearest hits of the `wanted` rays before `rays.tmax`; of several at one distance an area light, else the
    /// shape that comes first in the scene, large meshes after all others.
    #[inline(always)]
    pub fn closest<F: Float>(&self, rays: &Rays<F>, wanted: F::M, scratch: &mut Scratch<F>) -> Hits<F> {
        let hits = match &self.shape_list {
            Some(shape_list) => shape_list.closest(rays, scratch),
            None => self.closest_one_by_one(rays, wanted),
        };
        if self.accel.instances().is_empty() { hits } else { self.or_instances(rays, wanted, hits) }
    }

    /// Indices into the scene's shapes of what was met, of each lane; `None` where nothing was.
    #[inline(never)]
    pub fn shapes(&self, lanes: u32, hits: &[Hit; MOST_LANES]) -> [Option<u32>; MOST_LANES] {
        std::array::from_fn(|lane| (lanes >> lane & 1 != 0).then(|| self.shape(&hits[lane])))
    }

    fn shape(&self, hit: &Hit) -> u32 {
        match &self.shape_list {
            Some(shape_list) if hit.instance == NO_INSTANCE => shape_list.shape(hit),
            _ => self.accel.shape(hit),
        }
    }

    /// What the rays have met that have these hits.
    #[inline(always)]
    pub fn intersections<F: Float>(&self, rays: &Rays<F>, hits: &Hits<F>) -> Intersections<F> {
        let met = match &self.shape_list {
            Some(shape_list) => shape_list.intersections(rays, hits),
            None => self.intersections_one_by_one(rays, hits),
        };
        if self.accel.instances().is_empty() { met } else { self.or_on_instances(hits, met) }
    }

    /// Where anything lies on the `wanted` shadow rays before `rays.tmax`; if `opaque`, glass does not count. A ray to a
    /// point of an area light is not stopped by the light itself, nor by what coincides with it and comes later; what
    /// comes earlier covers it.
    #[inline(always)]
    pub fn occluded<F: Float>(
        &self,
        rays: &Rays<F>,
        to_light: F::U,
        wanted: F::M,
        opaque: bool,
        scratch: &mut Scratch<F>,
    ) -> F::M {
        let occluded = match &self.shape_list {
            Some(shape_list) => shape_list.occluded(rays, to_light, wanted, opaque, scratch),
            None => self.occluded_one_by_one(rays, to_light, wanted, opaque),
        };
        if self.accel.instances().is_empty() {
            return occluded;
        }
        occluded | self.occluded_by_instances(rays, wanted & !occluded, opaque)
    }

    #[inline(always)]
    fn closest_one_by_one<F: Float>(&self, rays: &Rays<F>, wanted: F::M) -> Hits<F> {
        let rays = rays.each();
        let (mut t, mut primitive) = ([0.0; MOST_LANES], [NO_PRIMITIVE; MOST_LANES]);
        let [mut u, mut v, mut w] = [[0.0; MOST_LANES]; 3];
        for lane in lanes_of(wanted) {
            if let Some(hit) = self.accel.closest_beside_instances(&rays[lane]) {
                (t[lane], primitive[lane]) = (hit.t, hit.primitive);
                [u[lane], v[lane], w[lane]] = hit.barycentrics;
            }
        }
        let barycentrics = [F::load(&u), F::load(&v), F::load(&w)];
        Hits { t: F::load(&t), primitive: F::U::load(&primitive), instance: F::U::splat(NO_INSTANCE), barycentrics }
    }

    /// The hits, but those of large meshes where these are nearer.
    #[inline(always)]
    fn or_instances<F: Float>(&self, rays: &Rays<F>, wanted: F::M, hits: Hits<F>) -> Hits<F> {
        let until = Rays { tmax: F::select(hits.met(), hits.t, rays.tmax), ..*rays }.each();
        let mut found = [None; MOST_LANES];
        for lane in lanes_of(wanted) {
            found[lane] = self.accel.instances().closest(&until[lane]);
        }
        hits.replaced(&found)
    }

    /// What has been met, but on large meshes what was met of them.
    #[inline(always)]
    fn or_on_instances<F: Float>(&self, hits: &Hits<F>, met: Intersections<F>) -> Intersections<F> {
        let on_instance = hits.on_instance();
        if !on_instance.any() {
            return met;
        }
        let each = hits.each();
        let mut found = EachIntersection::none();
        for lane in lanes_of(on_instance) {
            found.set(lane, &self.accel.instances().intersection(&each[lane]));
            found.set_triangle(lane, each[lane].primitive);
        }
        Intersections::select(on_instance, found.in_lanes(hits, on_instance), met)
    }

    #[inline(always)]
    fn occluded_by_instances<F: Float>(&self, rays: &Rays<F>, wanted: F::M, opaque: bool) -> F::M {
        let rays = rays.each();
        let blocks = |material: u32| !(opaque && self.clear[material as usize]);
        let occluded = lanes_of(wanted).filter(|&lane| self.accel.instances().occluded(&rays[lane], blocks));
        F::M::from_bits(occluded.fold(0, |bits, lane| bits | 1 << lane))
    }

    #[inline(always)]
    fn intersections_one_by_one<F: Float>(&self, rays: &Rays<F>, hits: &Hits<F>) -> Intersections<F> {
        let rays = rays.each();
        let each = hits.each();
        let mut found = EachIntersection::none();
        for lane in lanes_of(hits.met() & !hits.on_instance()) {
            found.set(lane, &self.accel.intersection(&rays[lane], &each[lane]));
            if self.attributes.is_some() {
                found.set_triangle(lane, self.accel.id(&each[lane]));
            }
        }
        found.in_lanes(hits, hits.met())
    }

    #[inline(always)]
    fn occluded_one_by_one<F: Float>(&self, rays: &Rays<F>, to_light: F::U, wanted: F::M, opaque: bool) -> F::M {
        let rays = rays.each();
        let mut lights = [NO_LIGHT; MOST_LANES];
        to_light.store(&mut lights);
        let occluded = lanes_of(wanted).filter(|&lane| self.is_occluded(&rays[lane], lights[lane], opaque));
        F::M::from_bits(occluded.fold(0, |bits, lane| bits | 1 << lane))
    }

    fn is_occluded(&self, ray: &Ray, to_light: u32, opaque: bool) -> bool {
        let groups = self.accel.groups();
        let group = groups.of_light(to_light);
        // what coincides with the light may be met just behind the end
        let reach = if group == NO_GROUP { ray.tmax } else { BEHIND_THE_END };
        self.accel.occluded_by(&Ray { tmax: reach, ..*ray }, |met| {
            if (opaque && self.clear[met.material as usize]) || met.light == to_light {
                return false;
            }
            if group != NO_GROUP && groups.of_surface(met.id) == group {
                return met.light < to_light;
            }
            met.t < ray.tmax
        })
    }
}

impl Attributes {
    fn new(scene: &Scene, all: &MeshAttributes, shape_list: Option<&ShapeList>) -> Self {
        let of_list = shape_list.map_or(Vec::new(), |list| list.rows(all));
        Attributes {
            columns: AttributeColumns::new(all),
            of_tree: RowColumns::new(&rows_of_tree(scene, all), all),
            of_list: RowColumns::new(&of_list, all),
        }
    }
}

/// The lanes where a mask is true.
#[inline(always)]
pub fn lanes_of(mask: impl Mask) -> impl Iterator<Item = usize> {
    let mut bits = mask.bits();
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (lane < 32).then_some(lane)
    })
}
