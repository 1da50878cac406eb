//! Which channels of an EXR are its picture. Their names are `layer.channel`, of layers within layers; what is outside of
//! any layer comes first. Of several parts each has a name, which tells of its channels what a layer's does.

use super::exr;
use ::exr::meta::header::Header;
use std::fmt;

/// The picture of a renderer's layers, by the last part of their names.
const PICTURES: [&str; 5] = ["combined", "beauty", "rgba", "rgb", "color"];

/// Channels that are one picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colours {
    /// Red, green and blue.
    Rgb,
    /// Luminance alone, or with the two chroma channels RY and BY.
    Luminance,
}

/// A picture in a file: channels of one layer, in one part.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Choice {
    /// The part's place in the file.
    pub part: usize,
    /// Its name, if it is one of several.
    part_name: Option<String>,
    /// The layer's name with a dot behind it; empty outside of layers.
    prefix: String,
    pub colours: Colours,
}

impl Choice {
    /// The full name of a channel.
    pub fn channel(&self, name: &str) -> exr::Text {
        super::text(&format!("{}{name}", self.prefix))
    }

    fn layer(&self) -> &str {
        self.prefix.trim_end_matches('.')
    }

    /// By its layer, else by its part.
    fn is_named_as_a_picture(&self) -> bool {
        let part = self.part_name.as_deref().unwrap_or_default();
        let name = if self.prefix.is_empty() { part } else { self.layer() };
        let last = name.rsplit('.').next().unwrap_or_default();
        PICTURES.contains(&last.to_ascii_lowercase().as_str())
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let layer = match self.colours {
            Colours::Rgb if self.prefix.is_empty() => "R, G, B",
            Colours::Luminance if self.prefix.is_empty() => "Y",
            _ => self.layer(),
        };
        match self.part_name.as_deref() {
            Some(part) if self.prefix.is_empty() || part == layer => f.write_str(part),
            Some(part) => write!(f, "{part}: {layer}"),
            None => f.write_str(layer),
        }
    }
}

/// The picture among all of a file's channels, and all that it might have been; or why none is.
///
/// Colours outside of layers come first, then those of a layer that is named as a renderer's picture, then those of the only
/// layer that has colours, then luminance. Of several parts with colours outside of layers the one that is named as a
/// picture, else the first.
pub fn choose(headers: &[Header]) -> Result<(Choice, Vec<Choice>), String> {
    let found = pictures(headers);
    let of = |colours| found.iter().filter(|choice| choice.colours == colours).collect::<Vec<_>>();
    let (colours, luminance) = (of(Colours::Rgb), of(Colours::Luminance));
    let grey = || if colours.is_empty() { outside(&luminance).or_else(|| only(&luminance)) } else { None };
    let chosen = outside(&colours).or_else(|| named(&colours)).or_else(|| only(&colours)).or_else(grey).cloned();
    match chosen {
        Some(chosen) => Ok((chosen, found)),
        None if found.is_empty() => Err(format!(
            "it has no channels R, G, B and no Y, nor a layer of such; its channels are {}",
            names(headers)
        )),
        None => Err(format!("it has several pictures and no R, G, B outside of them; keep one of {}", listed(&found))),
    }
}

fn outside<'a>(choices: &[&'a Choice]) -> Option<&'a Choice> {
    let outside: Vec<&Choice> = choices.iter().filter(|choice| choice.prefix.is_empty()).copied().collect();
    named(&outside).or(outside.first().copied())
}

fn named<'a>(choices: &[&'a Choice]) -> Option<&'a Choice> {
    choices.iter().find(|choice| choice.is_named_as_a_picture()).copied()
}

fn only<'a>(choices: &[&'a Choice]) -> Option<&'a Choice> {
    if let [one] = choices { Some(one) } else { None }
}

/// Names in a row, not too many.
pub fn listed(names: &[impl fmt::Display]) -> String {
    let mut words: Vec<String> = names.iter().take(12).map(ToString::to_string).collect();
    if names.len() > words.len() {
        words.push(format!("{} more", names.len() - words.len()));
    }
    words.join(", ")
}

/// All pictures of flat parts, in the order of the file.
fn pictures(headers: &[Header]) -> Vec<Choice> {
    let flat = headers.iter().enumerate().filter(|(_, header)| !header.deep);
    flat.flat_map(|(part, header)| {
        let name = header.own_attributes.layer_name.as_ref().map(ToString::to_string);
        let part_name = name.filter(|name| headers.len() > 1 && !name.is_empty());
        let of = move |(prefix, colours)| Choice { part, part_name: part_name.clone(), prefix, colours };
        pictures_of_part(header).into_iter().map(of)
    })
    .collect()
}

/// The layers of a part that have colours or luminance.
fn pictures_of_part(header: &Header) -> Vec<(String, Colours)> {
    let names: Vec<String> = header.channels.list.iter().map(|channel| channel.name.to_string()).collect();
    let picture = |name: &String| {
        let (prefix, channel) = name.rfind('.').map_or(("", name.as_str()), |dot| name.split_at(dot + 1));
        let has = |other: &str| names.iter().any(|name| *name == format!("{prefix}{other}"));
        let colours = match channel {
            "R" if has("G") && has("B") => Colours::Rgb,
            // beside an X it is a place or a direction
            "Y" if !has("X") => Colours::Luminance,
            _ => return None,
        };
        Some((prefix.to_owned(), colours))
    };
    names.iter().filter_map(picture).collect()
}

fn names(headers: &[Header]) -> String {
    let names: Vec<String> =
        headers.iter().flat_map(|header| &header.channels.list).map(|channel| channel.name.to_string()).collect();
    listed(&names)
}
