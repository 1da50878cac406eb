//! Which channels of an EXR are its picture. Their names are `layer.channel`, of layers within layers; what is outside of
//! any layer comes first.

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
    /// The layer's name with a dot behind it; empty outside of layers.
    prefix: String,
    pub colours: Colours,
}

impl Choice {
    /// The full name of a channel.
    pub fn channel(&self, name: &str) -> exr::Text {
        super::text(&format!("{}{name}", self.prefix))
    }

    fn is_named_as_a_picture(&self) -> bool {
        let last = self.prefix.trim_end_matches('.').rsplit('.').next().unwrap_or_default();
        PICTURES.contains(&last.to_ascii_lowercase().as_str())
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self.colours {
            Colours::Rgb if self.prefix.is_empty() => "R, G, B",
            Colours::Luminance if self.prefix.is_empty() => "Y",
            _ => self.prefix.trim_end_matches('.'),
        })
    }
}

/// The picture among all of a file's channels, and all that it might have been; or why none is.
///
/// Colours outside of layers come first, then those of a layer that is named as a renderer's picture, then those of the only
/// layer that has colours, then luminance.
pub fn choose(headers: &[Header]) -> Result<(Choice, Vec<Choice>), String> {
    let found = pictures(headers);
    let colours: Vec<&Choice> = found.iter().filter(|choice| choice.colours == Colours::Rgb).collect();
    let outside = |choices: &[&Choice]| choices.iter().find(|choice| choice.prefix.is_empty()).copied().cloned();
    let named = || colours.iter().find(|choice| choice.is_named_as_a_picture()).copied().cloned();
    let only = |choices: &[&Choice]| if let [one] = choices { Some((*one).clone()) } else { None };
    let luminance: Vec<&Choice> = found.iter().filter(|choice| choice.colours == Colours::Luminance).collect();
    let grey = || if colours.is_empty() { outside(&luminance).or_else(|| only(&luminance)) } else { None };
    let chosen = outside(&colours).or_else(named).or_else(|| only(&colours)).or_else(grey);
    match chosen {
        Some(chosen) => Ok((chosen, found)),
        None if found.is_empty() => Err(format!(
            "it has no channels R, G, B and no Y, nor a layer of such; its channels are {}",
            names(headers)
        )),
        None => Err(format!("it has several pictures and no R, G, B outside of them; keep one of {}", listed(&found))),
    }
}

/// Names in a row, not too many.
pub fn listed(names: &[impl fmt::Display]) -> String {
    let mut words: Vec<String> = names.iter().take(12).map(ToString::to_string).collect();
    if names.len() > words.len() {
        words.push(format!("{} more", names.len() - words.len()));
    }
    words.join(", ")
}

/// All pictures of flat parts, in the order of the file; of parts with the same names the first.
fn pictures(headers: &[Header]) -> Vec<Choice> {
    let mut found = Vec::new();
    for header in headers.iter().filter(|header| !header.deep) {
        let names: Vec<String> = header.channels.list.iter().map(|channel| channel.name.to_string()).collect();
        for name in &names {
            let (prefix, channel) = name.rfind('.').map_or(("", name.as_str()), |dot| name.split_at(dot + 1));
            let has = |other: &str| names.iter().any(|name| *name == format!("{prefix}{other}"));
            let colours = match channel {
                "R" if has("G") && has("B") => Colours::Rgb,
                // beside an X it is a place or a direction
                "Y" if !has("X") => Colours::Luminance,
                _ => continue,
            };
            let choice = Choice { prefix: prefix.to_owned(), colours };
            if !found.contains(&choice) {
                found.push(choice);
            }
        }
    }
    found
}

fn names(headers: &[Header]) -> String {
    let names: Vec<String> =
        headers.iter().flat_map(|header| &header.channels.list).map(|channel| channel.name.to_string()).collect();
    listed(&names)
}
