//! What parts are, in words and colours.

use crate::model::grouped;
use egui::{Color32, Rgba};
use scene::edit::Subject;
use scene::{Bsdf, Conductor, Geometry, Material, Scene, Texture, Vec3};

/// The title of a part's card.
pub fn title(part: &Subject) -> String {
    match part {
        Subject::Material(name) => format!("Material: {name}"),
        Subject::Shape(name) => format!("Part: {name}"),
        Subject::Light(name) => format!("Light: {name}"),
        Subject::Sun => "Sun".into(),
        Subject::Sky => "Sky".into(),
    }
}

/// What begins the names of its controls.
pub fn kind(part: &Subject) -> &'static str {
    match part {
        Subject::Material(_) => "material",
        Subject::Shape(_) => "shape",
        Subject::Light(_) => "light",
        Subject::Sun => "sun",
        Subject::Sky => "sky",
    }
}

/// What a part is, line by line.
pub fn lines(scene: &Scene, part: &Subject, index: usize) -> Vec<String> {
    match part {
        Subject::Material(_) => vec![surface(&scene.materials[index])],
        Subject::Shape(_) => {
            let shape = &scene.shapes[index];
            let (low, high) = shape.geometry.bounds();
            let [x, y, z] = (high - low).max(Vec3::ZERO).to_array().map(short);
            let size = format!("{x} x {y} x {z} large");
            vec![form(&shape.geometry), surface(scene.material_of(shape)), size]
        }
        Subject::Light(_) => {
            let spot = scene.point_lights[index].spot.is_some();
            vec![if spot { "a point that shines into a cone".into() } else { "a point that shines all around".into() }]
        }
        Subject::Sun => vec!["a disc of light, far away".into()],
        Subject::Sky if scene.environment.is_some() => vec!["a picture, seen wherever nothing is".into()],
        Subject::Sky => vec!["one colour, seen wherever nothing is".into()],
    }
}

fn form(geometry: &Geometry) -> String {
    match geometry {
        Geometry::Sphere { radius, .. } => format!("sphere, radius {}", short(*radius)),
        Geometry::Disk { radius, .. } => format!("disk, radius {}", short(*radius)),
        other => match other.mesh_of() {
            Some(mesh) => {
                let count = mesh.triangles().len();
                format!("mesh, {} triangle{}", grouped(count as u64), if count == 1 { "" } else { "s" })
            }
            None => other.kind().into(),
        },
    }
}

/// "glass, n = 1.5", "gold, roughness 0.2, shines".
pub fn surface(material: &Material) -> String {
    let how = match &material.bsdf {
        Bsdf::Diffuse { albedo } => format!("matt{}", pattern(albedo)),
        Bsdf::Mirror { .. } => "mirror".into(),
        Bsdf::RoughConductor { conductor, roughness } => {
            let known = Conductor::names().find(|name| Conductor::named(name) == Some(*conductor));
            format!("{}, roughness {}", known.unwrap_or("metal"), short(*roughness))
        }
        Bsdf::MetallicRoughness(model) => {
            let body = match model.metallic {
                0.0 => "coated".into(),
                1.0 => "metal".into(),
                share => format!("{} metal", short(share)),
            };
            format!("{body}{}, roughness {}", pattern(&model.base_colour), short(model.roughness))
        }
        Bsdf::Dielectric { ior } => format!("glass, n = {}", short(*ior)),
    };
    if material.shines() { format!("{how}, shines") } else { how }
}

fn pattern(texture: &Texture) -> &'static str {
    match texture {
        Texture::Constant(_) => "",
        Texture::Checkerboard(_) => ", a checkerboard",
        Texture::Image { .. } => ", with a picture",
    }
}

/// A number in three digits at most.
pub fn short(value: f32) -> String {
    let value = f64::from(value);
    let digits = if value == 0.0 { 0.0 } else { 2.0 - value.abs().log10().floor() };
    if !(-6.0..=6.0).contains(&digits) {
        return format!("{value:.2e}");
    }
    let text = format!("{value:.*}", digits.max(0.0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// The colours of a material as screens show them: one, two of a checkerboard, none of what is clear.
pub fn swatch(material: &Material) -> Vec<Color32> {
    if let Some(emission) = material.emission.filter(|_| material.shines()) {
        return vec![shown(emission.radiance / emission.radiance.max_element())];
    }
    match &material.bsdf {
        Bsdf::Diffuse { albedo } => of_texture(albedo),
        Bsdf::Mirror { reflectance } => vec![shown(*reflectance)],
        Bsdf::RoughConductor { conductor, .. } => vec![shown(conductor.at_normal_incidence())],
        Bsdf::MetallicRoughness(model) => of_texture(&model.base_colour),
        Bsdf::Dielectric { .. } => Vec::new(),
    }
}

fn of_texture(texture: &Texture) -> Vec<Color32> {
    match texture {
        Texture::Constant(colour) | Texture::Image { factor: colour, .. } => vec![shown(*colour)],
        Texture::Checkerboard(board) => vec![shown(board.even), shown(board.odd)],
    }
}

fn shown(colour: Vec3) -> Color32 {
    let [r, g, b] = colour.clamp(Vec3::ZERO, Vec3::ONE).to_array();
    Rgba::from_rgb(r, g, b).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        let shorts = [0.0, 1.5, 0.333_333, 12.345, 123_456.0, 1e-9, -2.0, 1e12].map(short);
        assert_eq!(shorts, ["0", "1.5", "0.333", "12.3", "123456", "1.00e-9", "-2", "1.00e12"]);
    }
}
