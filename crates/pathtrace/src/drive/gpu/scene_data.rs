//! Mirrors of the structs in `shaders/pathtrace/scene.wgsl`, field for field, and what fills them. A test compares
//! every offset with the shader compiler's. Padding is spelled out as `unused*`.

use super::mesh_data::MeshData;
use super::shape_data::Shapes;
use crate::bsdf::materials::lobe_of;
use crate::bsdf::metallic_roughness::coat_of;
use crate::bsdf::textures::{Places, places};
use crate::caster::Casters;
use crate::caster::cone::{Cones, MOST_CONES};
use crate::integrator::settings::ConesAt;
use crate::intersect::coincident::Groups;
use crate::light::flat::Outline;
use crate::light::{Environment, Light as HostLight, Lights, SunDisc, cone_of};
use crate::sampling::sobol::reversed_point;
use bytemuck::{Pod, Zeroable};
use scene::material::Emission;
use scene::{Alpha, Bsdf, Conductor, Scene, Texture, Vec3};

/// What the whole scene shares.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Header {
    /// Radiance where nothing is hit.
    pub sky: Vec3,
    /// How many triangles, spheres and disks there are in the tree.
    pub primitives: u32,
    /// Unit direction of a sun that has a disc.
    pub sun_towards: Vec3,
    /// Square of the chord that spans the disc's angular radius, 0 without a disc.
    pub sun_chord_squared: f32,
    /// Radiance of the disc.
    pub sun_radiance: Vec3,
    /// Density per solid angle with which the sun's disc is sampled.
    pub sun_pdf: f32,
    /// What is sampled as a light.
    pub lights: u32,
    /// 0, which no compiler knows.
    pub zero: u32,
    /// Width and height of the picture that is the sky.
    pub environment_size: [u32; 2],
    /// By which it is turned about y, in turns.
    pub environment_turn: f32,
    /// Of being chosen among the lights.
    pub environment_probability: f32,
    /// Ways by the spheres that cast caustics; they stand behind the lights.
    pub chains: u32,
    /// 1 if nothing lies inside of any sphere that they go through.
    pub hollow: u32,
    /// Large meshes that stand in the world.
    pub instances: u32,
    /// Contents of the root of the tree over their boxes.
    pub instance_root: u32,
    /// The first of the primitives that hold their maps.
    pub instance_primitives: u32,
    /// The first of their surfaces.
    pub instance_surfaces: u32,
    /// Where attributes of corners begin in `mesh_data`.
    pub attributes: u32,
    /// Where textures begin there.
    pub textures: u32,
    /// Rows in each layer of the texture of all texels.
    pub texel_rows: u32,
    /// With which one of many lights is chosen by the tree.
    pub tree_share: f32,
    /// Of few shapes: where among them quadrilaterals, triangles, spheres and disks end.
    pub seen: [u32; 4],
    /// The same of those that shadow rays may meet, which stand first in each kind.
    pub shading: [u32; 4],
    /// Spheres around the shapes that usually get cones: centre and radius, which is 0 where there are no more.
    pub usual_cones: [[f32; 4]; MOST_CONES],
    /// The same around all shapes of mirror and glass.
    pub all_cones: [[f32; 4]; MOST_CONES],
}

/// Two colours of cells that fill space; `even` alone without a pattern.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Checkerboard {
    /// Colour of cells whose indices add up to an even number.
    pub even: Vec3,
    /// Padding.
    pub unused0: u32,
    /// Colour of the others.
    pub odd: Vec3,
    /// Padding.
    pub unused1: u32,
    /// A corner of cell (0, 0, 0).
    pub origin: Vec3,
    /// Padding.
    pub unused2: u32,
    /// 1 / cell size, 0 along axes without pattern.
    pub cells_per_unit: Vec3,
    /// Padding.
    pub unused3: u32,
}

/// How a surface looks.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Material {
    /// Albedo or reflectance, 1 for glass.
    pub colour: Checkerboard,
    /// Radiance sent out.
    pub emission: Vec3,
    /// 0 none, 1 the one that the normal points away from, 2 both.
    pub emitting_sides: u32,
    /// One of `LOBE_*`, see [`lobe_of`].
    pub lobe: u32,
    /// Index of refraction of the inside over the outside.
    pub ior: f32,
    /// Root of |ior^2 - 1|.
    pub root: f32,
    /// What a float could not hold of it.
    pub root_low: f32,
    /// Of a rough conductor: index of refraction.
    pub eta: Vec3,
    /// Width of the distribution of its slopes.
    pub alpha: f32,
    /// Extinction coefficient.
    pub k: Vec3,
    /// With which a chain off such a sphere is chosen, 0 if none is.
    pub off: f32,
    /// The same through it.
    pub through: f32,
    /// Of metallic-roughness: share of metal.
    pub metallic: f32,
    /// The root of its facets' alpha.
    pub roughness: f32,
    /// What its coat reflects at normal incidence.
    pub coat: f32,
    /// Place among the textures of what the colour is multiplied by, 1 for the first; 0 for none.
    pub colour_texture: u32,
    /// The same of what is sent out.
    pub emission_texture: u32,
    /// The same of the normals.
    pub normal_texture: u32,
    /// The same of the alpha.
    pub alpha_texture: u32,
    /// By which x and y of normals are multiplied.
    pub normal_scale: f32,
    /// By which alpha is multiplied.
    pub alpha_factor: f32,
    /// Least alpha that is a surface; 0 where there is one everywhere.
    pub alpha_cutoff: f32,
    /// Place among the textures of what multiplies the share of metal and the roughness.
    pub metallic_roughness_texture: u32,
}

/// Codes of [`Light::outline`].
pub(crate) const LIGHT_RECTANGLE: u32 = 0;
pub(crate) const LIGHT_TRIANGLE: u32 = 1;
pub(crate) const LIGHT_DISK: u32 = 2;
pub(crate) const LIGHT_BALL: u32 = 3;
pub(crate) const LIGHT_POINT: u32 = 4;
pub(crate) const LIGHT_SUN: u32 = 5;
pub(crate) const LIGHT_ENVIRONMENT: u32 = 6;
/// Chains by spheres, which are aimed at in their own way.
pub(crate) const CHAIN_OFF: u32 = 7;
pub(crate) const CHAIN_THROUGH: u32 = 8;

/// What is sampled as a light; or a chain by a sphere, of which there is a centre, a radius and a material.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Light {
    /// Corner of a flat area light, centre of a disk, ball or caster, a point light, the direction to the sun.
    pub position: Vec3,
    /// One of `LIGHT_*`.
    pub outline: u32,
    /// First edge of a flat area light, a radius of a disk; of a point light the cosine of its cone's edge,
    /// and the edge's slope.
    pub u: Vec3,
    /// Area of a flat area light, radius of a ball or caster, 1 - cos of the sun's angular radius.
    pub area: f32,
    /// Second edge of a flat area light, another radius of a disk.
    pub v: Vec3,
    /// 1 if a parallelogram's edges are at right angles.
    pub square: u32,
    /// Unit normal of a flat area light, axis of a point light's cone.
    pub normal: Vec3,
    /// 1 if both sides shine.
    pub two_sided: u32,
    /// Radiance; intensity of a point, irradiance of a delta sun.
    pub radiance: Vec3,
    /// Of being chosen.
    pub probability: f32,
    /// Running sum of the probabilities.
    pub cumulative: f32,
    /// Of what its surface coincides with, or [`NO_GROUP`](crate::intersect::coincident::NO_GROUP).
    pub group: u32,
    /// Of a chain: index of its sphere's material. Of what wears textures its own.
    pub material: u32,
    /// Where the places of its corners in textures begin in `mesh_data`, 0 if it wears none.
    pub corners: u32,
    /// The way to it in the tree over many lights.
    pub trail: u32,
    /// Padding.
    pub unused: [u32; 3],
}

/// The header of a scene.
pub(crate) fn header(
    scene: &Scene,
    shapes: &Shapes,
    lights: &Lights,
    casters: &Casters,
    mesh_data: &MeshData,
) -> Header {
    let disc = scene.sun.as_ref().and_then(SunDisc::new);
    let environment = lights.environment();
    Header {
        sky: if scene.environment.is_some() { Vec3::ZERO } else { scene.sky },
        primitives: shapes.primitives.len() as u32,
        sun_towards: disc.map_or(Vec3::Y, |d| d.towards),
        sun_chord_squared: disc.map_or(0.0, |d| d.chord_squared),
        sun_radiance: disc.map_or(Vec3::ZERO, |d| d.radiance),
        // a delta sun is never met
        sun_pdf: disc.map_or(0.0, |_| lights.sun_pdf()),
        lights: lights.len() as u32,
        zero: 0,
        environment_size: environment.map_or([1, 1], Environment::size),
        environment_turn: environment.map_or(0.0, Environment::turn),
        environment_probability: environment.map_or(0.0, Environment::probability),
        chains: casters.len() as u32,
        hollow: u32::from(casters.are_hollow()),
        instances: 0,
        instance_root: 0,
        instance_primitives: 0,
        instance_surfaces: 0,
        attributes: mesh_data.attributes,
        textures: mesh_data.textures,
        texel_rows: mesh_data.texel_rows(),
        tree_share: lights.table().tree().map_or(0.0, |(_, share)| share),
        seen: shapes.seen,
        shading: shapes.shading,
        usual_cones: Cones::new(ConesAt::Usual, scene, lights).spheres(),
        all_cones: Cones::new(ConesAt::Everything, scene, lights).spheres(),
    }
}

/// The scene's materials.
pub fn materials(scene: &Scene, casters: &Casters) -> Vec<Material> {
    let (_, places) = places(&scene.materials);
    let one = |(from, index): (&scene::Material, u32)| {
        let chosen = |through| casters.materials().of::<f32>(index, through).probability;
        let casts = !casters.is_empty();
        let [off, through] = [false, true].map(|through| if casts { chosen(through) } else { 0.0 });
        with_textures(Material { off, through, ..material(from) }, from, &places[index as usize])
    };
    scene.materials.iter().zip(0..).map(one).collect()
}

fn with_textures(to: Material, from: &scene::Material, places: &Places) -> Material {
    let (alpha_cutoff, alpha_factor) = match from.surface.alpha {
        Alpha::Opaque => (0.0, 1.0),
        Alpha::Mask { cutoff, factor, .. } => (cutoff, factor),
    };
    Material {
        colour_texture: places.colour,
        emission_texture: places.emission,
        normal_texture: places.normals,
        alpha_texture: places.alpha,
        metallic_roughness_texture: places.metallic_roughness,
        normal_scale: from.surface.normal_map.as_ref().map_or(1.0, |map| map.scale),
        alpha_factor,
        alpha_cutoff,
        ..to
    }
}

fn material(from: &scene::Material) -> Material {
    let mut to = Material::zeroed();
    to.lobe = lobe_of(&from.bsdf);
    match &from.bsdf {
        Bsdf::Diffuse { albedo } => to.colour = colours(albedo),
        Bsdf::MetallicRoughness(model) => {
            to.colour = colours(&model.base_colour);
            (to.metallic, to.roughness, to.coat) = (model.metallic, model.roughness, coat_of(model.ior));
        }
        Bsdf::Mirror { reflectance } => to.colour.even = *reflectance,
        Bsdf::RoughConductor { conductor, roughness } => {
            to.colour.even = conductor.at_normal_incidence();
            to.alpha = roughness * roughness;
            if let Conductor::Fresnel { eta, k } = conductor {
                (to.eta, to.k) = (*eta, *k);
            }
        }
        Bsdf::Dielectric { ior } => {
            let n = f64::from(*ior);
            let root = ((n - 1.0) * (n + 1.0)).abs().sqrt();
            to.colour.even = Vec3::ONE;
            to.ior = *ior;
            to.root = root as f32;
            to.root_low = (root - f64::from(to.root)) as f32;
        }
    }
    if let Some(emission) = from.emission {
        to.emission = emission.radiance;
        to.emitting_sides = 1 + u32::from(emission.two_sided);
    }
    to
}

fn colours(texture: &Texture) -> Checkerboard {
    match texture {
        Texture::Constant(colour) | Texture::Image { factor: colour, .. } => {
            Checkerboard { even: *colour, ..Checkerboard::zeroed() }
        }
        Texture::Checkerboard(board) => Checkerboard {
            even: board.even,
            odd: board.odd,
            origin: board.origin,
            cells_per_unit: board.cells_per_unit(),
            ..Checkerboard::zeroed()
        },
    }
}

/// What is sampled as a light, and which of its surfaces coincide.
pub(crate) fn lights(lights: &Lights, groups: &Groups, mesh_data: &MeshData) -> Vec<Light> {
    let trails = lights.table().tree().map_or(&[][..], |(tree, _)| tree.trails());
    let chances = lights.probabilities.iter().zip(lights.table().running_sums());
    let one = |((from, (&probability, &cumulative)), index)| Light {
        probability,
        cumulative,
        group: groups.of_light(index),
        corners: mesh_data.light_corners[index as usize][0],
        material: mesh_data.light_corners[index as usize][1],
        trail: trails.get(index as usize).copied().unwrap_or(0),
        ..light(from)
    };
    lights.lights.iter().zip(chances).zip(0u32..).map(one).collect()
}

fn light(from: &HostLight) -> Light {
    let none = Light::zeroed();
    let area_light =
        |emission: &Emission| Light { radiance: emission.radiance, two_sided: u32::from(emission.two_sided), ..none };
    match from {
        HostLight::Flat(flat, emission) => {
            let (outline, square) = match flat.outline {
                Outline::Rectangle => (LIGHT_RECTANGLE, 1),
                Outline::Parallelogram => (LIGHT_RECTANGLE, 0),
                Outline::Triangle => (LIGHT_TRIANGLE, 0),
                Outline::Disk => (LIGHT_DISK, 0),
            };
            let (position, u, v) = (flat.corner, flat.edge_u, flat.edge_v);
            Light { position, u, v, outline, square, area: flat.area, normal: flat.normal, ..area_light(emission) }
        }
        HostLight::Sphere(sphere, emission) => {
            Light { position: sphere.center, area: sphere.radius, outline: LIGHT_BALL, ..area_light(emission) }
        }
        HostLight::Point(point) => {
            let (normal, [outer, slope]) = cone_of(point);
            let u = Vec3::new(outer, slope, 0.0);
            Light { position: point.position, radiance: point.intensity, outline: LIGHT_POINT, u, normal, ..none }
        }
        HostLight::Sun(sun) => {
            let area = sun.one_minus_cos();
            let radiance = if area > 0.0 { sun.radiance() } else { sun.irradiance };
            Light { position: sun.towards, area, radiance, outline: LIGHT_SUN, ..none }
        }
        HostLight::Environment(_) => Light { outline: LIGHT_ENVIRONMENT, ..none },
    }
}

/// What each byte of an index adds to dimensions 1 to 3 of a Sobol point: four tables of 256.
pub fn sobol_bytes() -> Vec<[u32; 4]> {
    let entry = |i: u32| {
        let index = (i & 255) << (8 * (i >> 8));
        [reversed_point(index, 1), reversed_point(index, 2), reversed_point(index, 3), 0]
    };
    (0..1024).map(entry).collect()
}
