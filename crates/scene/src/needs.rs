//! What a scene asks for, so that techniques, controls and reports leave out what it does not.
//!
//! Twin: `shaders/pathtrace/needs.wgsl`.

use crate::{Alpha, Bsdf, Geometry, Scene, Shape, SurfaceDetail, Texture};

/// Which features occur in a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Needs {
    /// Analytic spheres.
    pub spheres: bool,
    /// Disks.
    pub disks: bool,
    /// Rectangles, boxes or meshes.
    pub triangles: bool,
    /// A checkerboard.
    pub checkerboard: bool,
    /// A mirror.
    pub mirror: bool,
    /// Rough metal.
    pub rough_conductor: bool,
    /// A surface of glTF's metallic-roughness model.
    pub metallic_roughness: bool,
    /// Glass.
    pub dielectric: bool,
    /// A sphere of glass, denser than what is around it, or of a perfect mirror: what casts caustics that can be aimed at.
    pub casters: bool,
    /// Glass or a mirror that is none of these.
    pub other_speculars: bool,
    /// A picture on a surface: its colour, its normals, its alpha or what it sends out.
    pub image_textures: bool,
    /// A mesh with shading normals of its own, or a material with a normal map.
    pub shading_normals: bool,
    /// A surface that is there in part only.
    pub alpha_masks: bool,
    /// A large mesh, which keeps a tree of its own.
    pub large_meshes: bool,
    /// A shape that shines.
    pub area_lights: bool,
    /// A point light.
    pub point_lights: bool,
    /// A sun.
    pub sun: bool,
    /// A sky that is not black.
    pub sky: bool,
}

impl Scene {
    /// What this scene asks for; materials that no shape wears do not count.
    pub fn needs(&self) -> Needs {
        let mut needs = Needs {
            sun: self.sun.is_some(),
            sky: self.sky.max_element() > 0.0,
            point_lights: !self.point_lights.is_empty(),
            ..Needs::default()
        };
        for shape in self.shapes.iter() {
            let sphere = matches!(shape.geometry, Geometry::Sphere { .. });
            let disk = matches!(shape.geometry, Geometry::Disk { .. });
            needs.spheres |= sphere;
            needs.disks |= disk;
            needs.triangles |= !sphere && !disk;
            let material = self.material_of(shape);
            needs.area_lights |= material.emission.is_some();
            let SurfaceDetail { normal_map, alpha, emission: _ } = &material.surface;
            needs.alpha_masks |= *alpha != Alpha::Opaque;
            needs.image_textures |= material.has_images();
            let mesh = shape.geometry.mesh_of();
            needs.shading_normals |= normal_map.is_some() || mesh.is_some_and(|mesh| !mesh.normals().is_empty());
            needs.large_meshes |= mesh.is_some_and(|mesh| mesh.is_large());
            match &material.bsdf {
                Bsdf::Diffuse { albedo } => needs.checkerboard |= matches!(albedo, Texture::Checkerboard(_)),
                Bsdf::MetallicRoughness(model) => {
                    needs.metallic_roughness = true;
                    needs.checkerboard |= matches!(model.base_colour, Texture::Checkerboard(_));
                }
                Bsdf::Mirror { .. } => {
                    needs.mirror = true;
                    needs.other_speculars |= !self.is_caster(shape);
                }
                Bsdf::RoughConductor { .. } => needs.rough_conductor = true,
                Bsdf::Dielectric { .. } => {
                    needs.dielectric = true;
                    needs.other_speculars |= !self.is_caster(shape);
                }
            }
            needs.casters |= self.is_caster(shape);
        }
        needs
    }

    /// Whether light can be aimed by way of this shape: a sphere of glass that is denser than what is around it, or of a
    /// perfect mirror.
    pub fn is_caster(&self, shape: &Shape) -> bool {
        let sphere = matches!(shape.geometry, Geometry::Sphere { .. });
        sphere
            && match self.material_of(shape).bsdf {
                Bsdf::Mirror { .. } => true,
                Bsdf::Dielectric { ior } => ior > 1.0,
                Bsdf::Diffuse { .. } | Bsdf::RoughConductor { .. } | Bsdf::MetallicRoughness(_) => false,
            }
    }
}
