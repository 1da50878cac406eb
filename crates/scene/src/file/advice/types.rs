//! Values of another kind than is expected: one number for three, a colour for a table.

use super::numbers::number;
use super::place::{Place, value};

/// Tables that a beginner gives a bare value, and the name that the value has in each.
const OWNERS: [(&str, &str); 7] = [
    ("diffuse", "albedo"),
    ("mirror", "reflectance"),
    ("rough_conductor", "roughness"),
    ("metallic_roughness", "base_colour"),
    ("dielectric", "ior"),
    ("emissive", "radiance"),
    ("sky", "radiance"),
];

/// Names whose value is a point or a direction, which has no usual three numbers.
const PLACES: [&str; 12] = [
    "eye",
    "target",
    "up",
    "center",
    "corner",
    "edge_u",
    "edge_v",
    "normal",
    "origin",
    "position",
    "towards",
    "light_position",
];

const COLOUR: &str = "a colour is three numbers, red, green and blue from 0 to 1, like [0.8, 0.2, 0.1]";

impl Place<'_> {
    /// "invalid type: FOUND, expected EXPECTED", with what was meant.
    pub fn wrong_type(&self, message: &str) -> Option<String> {
        let (found, expected) = message.strip_prefix("invalid type: ")?.split_once(", expected ")?;
        let (key, written) = (self.assignment()?.0, value(self.after()));
        if expected == "a table of names and values" {
            return in_its_table(key, &written);
        }
        if expected.starts_with("a colour") {
            return Some(
                three_times(&written)
                    .map_or(COLOUR.into(), |colour| format!("a colour is three numbers: write {colour}")),
            );
        }
        if expected == "a list of three numbers" {
            return three_numbers(key, &written);
        }
        let inside = written.strip_prefix('[').and_then(|list| list.strip_suffix(']'));
        match (found, inside.and_then(number)) {
            ("sequence", Some(alone)) => Some(format!("a number stands without brackets: write {alone}")),
            ("string \"true\"" | "string \"false\"", _) if expected == "a boolean" => {
                Some(format!("write {}", written.trim_matches('"')))
            }
            _ => None,
        }
    }
}

/// One number as a list of three.
fn three_times(written: &str) -> Option<String> {
    number(written).map(|n| format!("[{n}, {n}, {n}]"))
}

fn three_numbers(key: &str, written: &str) -> Option<String> {
    let unquoted = written.strip_prefix('"').and_then(|text| text.strip_suffix('"'));
    let listed = |text: &str| {
        let words = text.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
        words.map(number).collect::<Option<Vec<_>>>().filter(|numbers| numbers.len() == 3)
    };
    if let Some(numbers) = unquoted.and_then(listed) {
        return Some(format!("a list has no quotes: write [{}]", numbers.join(", ")));
    }
    if matches!(key, "positions" | "triangles") {
        return Some(format!("each is a list of its own, like {key} = [[0, 1, 2], [0, 2, 3]]"));
    }
    match three_times(written) {
        Some(three) if !PLACES.contains(&key) => Some(format!("for the same in all three write {three}")),
        _ if PLACES.contains(&key) => Some(format!("write its x, y and z, like {key} = [0, 1, 0]")),
        _ => None,
    }
}

/// A lobe's value without its name: "emissive = [10, 10, 10]".
fn in_its_table(key: &str, written: &str) -> Option<String> {
    let (owner, name) = OWNERS.iter().find(|(owner, _)| *owner == key)?;
    Some(format!("write {}", table(owner, name, written)))
}

/// `owner = { name = written }`, as far as what is written can be the value of the name.
pub(super) fn table(owner: &str, name: &str, written: &str) -> String {
    let numbers = |text: &str| text.starts_with('[');
    let (one, kept) = (number(written), numbers(written).then(|| written.to_owned()));
    let colour = || kept.clone().or_else(|| three_times(written)).unwrap_or("[0.8, 0.8, 0.8]".into());
    let value = match name {
        "ior" => one.unwrap_or("1.5".into()),
        "roughness" => one.unwrap_or("0.2".into()),
        "metal" => {
            if written.starts_with('"') {
                written.into()
            } else {
                "\"gold\"".into()
            }
        }
        "albedo" | "base_colour" if written.starts_with('{') => written.into(),
        "albedo" | "base_colour" | "reflectance" | "radiance" => colour(),
        _ => written.into(),
    };
    match (owner, name) {
        ("rough_conductor", "roughness") => format!("{owner} = {{ metal = \"gold\", roughness = {value} }}"),
        ("rough_conductor", _) => format!("{owner} = {{ {name} = {value}, roughness = 0.2 }}"),
        ("metallic_roughness", _) => format!("{owner} = {{ {name} = {value}, metallic = 0, roughness = 0.5 }}"),
        _ => format!("{owner} = {{ {name} = {value} }}"),
    }
}
