//! What one shape looks like, in numbers.

use crate::casting::Casting;
use crate::gpu_data::Object;
use crate::settings::RasterSettings;
use crate::spheres;
use bytemuck::Zeroable;
use scene::glam::{Affine3A, Mat3A, Vec4};
use scene::{Bsdf, Geometry, Material, Scene, Texture};

/// The numbers of a shape.
pub fn object(scene: &Scene, index: usize, casting: Casting, settings: &RasterSettings) -> Object {
    let shape = &scene.shapes[index];
    let material = scene.material_of(shape);
    let own_lit_side = casting == Casting::BothSides;
    let mut object = Object {
        reflectivity: material.fake.reflectivity,
        specular: material.fake.specular,
        shininess: material.fake.shininess,
        diffuse: settings.knobs.diffuse.unwrap_or(1.0),
        slack: if own_lit_side { settings.knobs.filter.reach() } else { 0.0 },
        ..Object::zeroed()
    };
    scatter(&mut object, material);
    facets(&mut object, material, settings);
    if let Some(emission) = material.emission {
        object.emission = emission.radiance;
        object.emitting_sides = if emission.two_sided { 2 } else { 1 };
    }
    if settings.repairs().count() > 0 {
        known_in_closed_form(&mut object, scene, index);
    }
    if let Geometry::Instance(instance) = &shape.geometry {
        put(&mut object, &instance.to_world);
    }
    object
}

/// What repairs are told of the shape and of its cube map.
fn known_in_closed_form(object: &mut Object, scene: &Scene, index: usize) {
    let geometry = &scene.shapes[index].geometry;
    if let Geometry::Sphere { center, radius } = geometry {
        object.sphere = center.extend(*radius);
    }
    object.cube_middle = geometry.center().extend(spheres::per_distance(scene));
    object.proxy_radius = spheres::proxy_radius(scene, index);
}

/// The colours, which pictures are multiplied by.
fn scatter(object: &mut Object, material: &Material) {
    match &material.bsdf {
        Bsdf::Diffuse { albedo } => paint(object, albedo),
        Bsdf::MetallicRoughness(model) => paint(object, &model.base_colour),
        Bsdf::Mirror { reflectance } => (object.even, object.odd) = (*reflectance, *reflectance),
        // as a mirror, whose highlight is as wide as the metal's lobe
        Bsdf::RoughConductor { conductor, .. } => {
            (object.even, object.odd) = (conductor.at_normal_incidence(), conductor.at_normal_incidence());
        }
        Bsdf::Dielectric { ior } => {
            object.kind = 1;
            object.refraction_ratio = material.fake.refraction_ratio.unwrap_or(1.0 / ior);
        }
    }
}

fn paint(object: &mut Object, colour: &Texture) {
    match colour {
        Texture::Constant(colour) | Texture::Image { factor: colour, .. } => {
            (object.even, object.odd) = (*colour, *colour);
        }
        Texture::Checkerboard(board) => {
            (object.even, object.odd) = (board.even, board.odd);
            (object.origin, object.cells_per_unit) = (board.origin, board.cells_per_unit());
        }
    }
}

/// The numbers of Cook and Torrance's highlight. Where a material has none of its own, or a knob takes their place, it is as
/// wide as Blinn's of the same exponent and reflects head-on what three.js' does.
fn facets(object: &mut Object, material: &Material, settings: &RasterSettings) {
    let from_shininess = (2.0 / (material.fake.shininess + 2.0)).powf(0.25);
    let own = |roughness: f32| if settings.knobs.shininess.is_some() { from_shininess } else { roughness };
    (object.metallic, object.roughness, object.coat) = match &material.bsdf {
        Bsdf::MetallicRoughness(model) => {
            let coat = ((model.ior - 1.0) / (model.ior + 1.0)).powi(2);
            (model.metallic, own(model.roughness), settings.knobs.specular.unwrap_or(coat))
        }
        Bsdf::RoughConductor { roughness, .. } => (1.0, own(*roughness), 0.0),
        Bsdf::Mirror { .. } => (1.0, from_shininess, 0.0),
        Bsdf::Diffuse { .. } | Bsdf::Dielectric { .. } => (0.0, from_shininess, material.fake.specular),
    };
}

fn put(object: &mut Object, to_world: &Affine3A) {
    object.to_world = rows(to_world.matrix3, to_world.translation.into());
    object.normal_to_world = rows(normals_map(to_world.matrix3), scene::Vec3::ZERO);
}

/// Takes normals along: the inverse's transpose, made a map of lengths about 1, so that none is lost at any scale.
fn normals_map(matrix: Mat3A) -> Mat3A {
    let turned = scene::glam::DMat3::from_cols(
        scene::glam::Vec3::from(matrix.x_axis).as_dvec3(),
        scene::glam::Vec3::from(matrix.y_axis).as_dvec3(),
        scene::glam::Vec3::from(matrix.z_axis).as_dvec3(),
    )
    .inverse()
    .transpose();
    let largest = turned.to_cols_array().into_iter().fold(0.0, |largest: f64, number| largest.max(number.abs()));
    (turned * largest.recip()).as_mat3().into()
}

fn rows(matrix: Mat3A, added: scene::Vec3) -> [Vec4; 3] {
    let rows = matrix.transpose();
    [rows.x_axis.extend(added.x), rows.y_axis.extend(added.y), rows.z_axis.extend(added.z)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::Vec3;
    use scene::glam::Quat;

    #[test]
    fn normals_stay_across_what_is_squeezed_turned_and_mirrored_at_any_scale() {
        for scale in [1e-12, 1.0, 1e12] {
            let squeeze = Affine3A::from_scale(scale * Vec3::new(-1.0, 3.0, 0.2));
            let map = squeeze * Affine3A::from_quat(Quat::from_rotation_x(0.7));
            let mut object = Object::zeroed();
            put(&mut object, &map);
            let applied = |rows: [Vec4; 3], v: Vec4| Vec3::from_array(rows.map(|row| row.dot(v))).normalize();
            let [u, v] = [Vec3::X, Vec3::Y].map(|edge| applied(object.to_world, edge.extend(0.0)));
            let normal = applied(object.normal_to_world, Vec3::Z.extend(0.0));
            assert!(normal.dot(u).abs() < 1e-6 && normal.dot(v).abs() < 1e-6, "{normal} at {scale}");
            // outside stays outside: the mirrored edges span the other side
            assert!(normal.dot(u.cross(v)) < -0.1, "{normal} at {scale}");
        }
    }
}
