//! Names that there are not, and those that were probably meant.

use super::numbers::number;
use super::place::{Place, value};
use super::types::table;
use crate::nearest;

/// A shape wears a material that there is not.
pub fn unknown_material(name: &str, known: &[&str]) -> String {
    let there = match (nearest(name, known.iter().copied()), known) {
        (_, []) => format!("the file has none; add [material.{name}] with diffuse = {{ albedo = [0.5, 0.5, 0.5] }}"),
        (Some(near), _) => format!("the file has {}; did you mean '{near}'?", known.join(", ")),
        (None, _) => format!("the file has {}", known.join(", ")),
    };
    format!("no material is called '{name}': {there}")
}

/// An instance is of a mesh that there is not.
pub fn unknown_mesh(name: &str, known: &[&str]) -> String {
    let there = match (nearest(name, known.iter().copied()), known) {
        (_, []) => format!("none has a name; write name = \"{name}\" below its [[mesh]] or [[statue]]"),
        (Some(near), _) => format!("the file has {}; did you mean '{near}'?", known.join(", ")),
        (None, _) => format!("the file has {}", known.join(", ")),
    };
    format!("no mesh and no statue is called '{name}': {there}")
}

/// Words of other programs and formats, and what they are called here: the first that is known where they stand.
const ELSEWHERE: [(&str, &[&str]); 38] = [
    ("spheres", &["sphere"]),
    ("ball", &["sphere"]),
    ("quad", &["rectangle"]),
    ("plane", &["rectangle"]),
    ("cube", &["box"]),
    ("triangles", &["mesh"]),
    ("light", &["point_light"]),
    ("lights", &["point_light"]),
    ("environment", &["sky"]),
    ("background", &["sky"]),
    ("color", COLOURS),
    ("colour", COLOURS),
    ("rgb", COLOURS),
    ("albedo", COLOURS),
    ("emission", COLOURS),
    ("strength", COLOURS),
    ("power", COLOURS),
    ("intensity", COLOURS),
    ("radiance", COLOURS),
    ("light_color", COLOURS),
    ("lambert", &["diffuse"]),
    ("glass", &["dielectric"]),
    ("metal", &["rough_conductor"]),
    ("index", &["ior"]),
    ("eta", &["ior"]),
    ("refraction", &["ior"]),
    ("refractive_index", &["ior"]),
    ("pos", POINTS),
    ("position", POINTS),
    ("location", POINTS),
    ("origin", POINTS),
    ("look_at", &["target"]),
    ("lookat", &["target"]),
    ("fov", &["fov_y"]),
    ("rotation", &["turn_y", "rotate"]),
    ("label", &["name"]),
    ("id", &["name"]),
    ("direction", &["towards", "normal", "target"]),
];

const COLOURS: &[&str] = &["albedo", "radiance", "irradiance", "intensity", "reflectance"];
const POINTS: &[&str] = &["center", "eye", "position", "corner", "translate"];

/// What belongs into a table of a material: its name there, and the table.
const OF_LOBES: [(&str, &str, &str); 16] = [
    ("albedo", "albedo", "diffuse"),
    ("color", "albedo", "diffuse"),
    ("colour", "albedo", "diffuse"),
    ("rgb", "albedo", "diffuse"),
    ("reflectance", "reflectance", "mirror"),
    ("roughness", "roughness", "rough_conductor"),
    ("metal", "metal", "rough_conductor"),
    ("ior", "ior", "dielectric"),
    ("index", "ior", "dielectric"),
    ("radiance", "radiance", "emissive"),
    ("emission", "radiance", "emissive"),
    ("light_color", "radiance", "emissive"),
    ("refraction_ratio", "refraction_ratio", "fake"),
    ("reflectivity", "reflectivity", "fake"),
    ("specular", "specular", "fake"),
    ("shininess", "shininess", "fake"),
];

/// "unknown field `a`, expected one of `b`, `c`": what was meant.
pub(super) fn unknown_field(place: &Place, message: &str) -> Option<String> {
    let (word, expected) = message.strip_prefix("unknown field `")?.split_once("`, expected ")?;
    let known: Vec<&str> = expected.split('`').skip(1).step_by(2).collect();
    let is_known = |name: &str| known.contains(&name);
    if is_known("diffuse") && is_known("dielectric") {
        return in_a_material(place, word, &known);
    }
    if word == "diameter" && is_known("radius") {
        return Some(radius_of_diameter(place));
    }
    if let Some(line) = of_a_changed_scene(word, is_known("base"), is_known("material") && is_known("camera")) {
        return Some(line);
    }
    // the scene itself: a material that stands among its tables
    let material =
        (is_known("material") && is_known("camera")).then(|| format!("a material of this name is [material.{word}]"));
    meant(word, &known).map(|name| format!("did you mean `{name}`?")).or(material)
}

/// What stands in a changed scene alone, and what in others.
fn of_a_changed_scene(word: &str, is_changed: bool, is_scene: bool) -> Option<String> {
    match word {
        "base" | "edit" if is_scene => {
            Some("a changed scene begins with base = \"NAME\", before its first table".into())
        }
        "material" | "sun" | "sky" if is_changed => {
            Some(format!("what is changed in the base's stands in [edit.{word}]"))
        }
        "sphere" | "rectangle" | "disk" | "box" | "mesh" | "statue" | "instance" | "point_light" if is_changed => Some(
            "a changed scene has its base's: what is changed in one stands in [edit.shape.NAME] or [edit.light.NAME]"
                .into(),
        ),
        _ => None,
    }
}

fn meant<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let elsewhere = ELSEWHERE.iter().filter(|(name, _)| name.eq_ignore_ascii_case(word)).flat_map(|(_, here)| *here);
    let here = || elsewhere.into_iter().find_map(|name| known.iter().find(|known| *known == name).copied());
    nearest(word, known.iter().copied()).or_else(here)
}

fn in_a_material(place: &Place, word: &str, known: &[&str]) -> Option<String> {
    if place.header() == Some("material") {
        return Some("a material has its name in its header: write [material.NAME]".into());
    }
    let lower = word.to_lowercase();
    let Some((_, name, owner)) = OF_LOBES.iter().find(|(word, ..)| *word == lower) else {
        return meant(word, known).map(|name| format!("did you mean `{name}`?"));
    };
    let written = written_after(place);
    Some(format!("write {}", table(owner, name, &written)))
}

fn radius_of_diameter(place: &Place) -> String {
    let diameter = number(&written_after(place)).and_then(|number| number.parse::<f32>().ok());
    let radius = diameter.map_or(String::new(), |diameter| format!(": write radius = {}", 0.5 * diameter));
    format!("`radius` is half of it{radius}")
}

/// The value of the name that stands here.
fn written_after(place: &Place) -> String {
    place.after().split_once('=').map_or(String::new(), |(_, text)| value(text))
}
