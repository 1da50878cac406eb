//! Layers beside an EXR's picture, by the names under which renderers write them for denoisers: `albedo.R`, `normal.X`,
//! `depth.Z`; Blender's `ViewLayer.Denoising Albedo.R`; a part called `albedo` with a channel `R`.

use super::exr;
use crate::ImageFileError;
use film::Vec3;
use std::path::Path;

/// Three channels of a colour or of a direction.
const TRIPLES: [[&str; 3]; 2] = [["r", "g", "b"], ["x", "y", "z"]];
/// The channel of a depth in a layer of its own.
const DEPTHS: [&str; 4] = ["z", "v", "y", "r"];
/// What Blender writes before the names.
const PREFIX: &str = "denoising ";

/// All channels that are as large as a file's picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Layers {
    channels: Vec<Channel>,
}

#[derive(Debug, Clone, PartialEq)]
struct Channel {
    /// The last part of the layer's name, in small letters; empty outside of layers.
    layer: String,
    name: String,
    values: Vec<f32>,
}

impl Layers {
    /// Three numbers a pixel, rows from the top; `None` if there is no layer of this name that has them.
    pub fn triples(&self, layer: &str) -> Option<Vec<Vec3>> {
        let [a, b, c] = TRIPLES.into_iter().find_map(|names| {
            let [a, b, c] = names.map(|name| self.channel(layer, name));
            Some([a?, b?, c?])
        })?;
        Some(a.iter().zip(b).zip(c).map(|((a, b), c)| Vec3::new(*a, *b, *c)).collect())
    }

    /// How far each pixel is away, rows from the top: of the layer depth, else a channel Z outside of layers.
    pub fn depth(&self) -> Option<Vec<f32>> {
        let of_layer = DEPTHS.into_iter().find_map(|name| self.channel("depth", name));
        of_layer.or_else(|| self.channel("", "z")).map(<[f32]>::to_vec)
    }

    fn channel(&self, layer: &str, name: &str) -> Option<&[f32]> {
        let found = self.channels.iter().find(|channel| channel.layer == layer && channel.name == name)?;
        Some(&found.values)
    }
}

/// The layers of a file whose picture is of this size.
pub fn layers(path: &Path, size: (u32, u32)) -> Result<Layers, ImageFileError> {
    use exr::{ReadChannels as _, ReadLayers as _};
    super::read::headers(path)?;
    let reader = exr::read().no_deep_data().largest_resolution_level().all_channels().all_layers().all_attributes();
    let image = reader.from_file(path).map_err(|e| ImageFileError::read(path, e))?;
    let size = exr::Vec2(size.0 as usize, size.1 as usize);
    let mut channels = Vec::new();
    for layer in image.layer_data.iter().filter(|layer| layer.size == size) {
        // the name of the only part is that of the whole file
        let named = layer.attributes.layer_name.as_ref().filter(|_| image.layer_data.len() > 1);
        let part = named.map(ToString::to_string).unwrap_or_default();
        for channel in layer.channel_data.list.iter().filter(|channel| channel.sampling == exr::Vec2(1, 1)) {
            let (layer, name) = names(&part, &channel.name.to_string());
            channels.push(Channel { layer, name, values: channel.sample_data.values_as_f32().collect() });
        }
    }
    Ok(Layers { channels })
}

/// A channel's layer and what it is called there: the part's name counts as a layer's.
fn names(part: &str, channel: &str) -> (String, String) {
    let full = if channel.contains('.') {
        channel.to_ascii_lowercase()
    } else {
        format!("{part}.{channel}").to_ascii_lowercase()
    };
    let (layers, name) = full.rsplit_once('.').unwrap_or(("", &full));
    let layer = layers.rsplit('.').next().unwrap_or_default();
    (layer.strip_prefix(PREFIX).unwrap_or(layer).to_owned(), name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_found_by_the_names_that_renderers_give_them() {
        for (part, channel) in [
            ("", "albedo.R"),
            ("", "Albedo.R"),
            ("albedo", "R"),
            ("ViewLayer", "ViewLayer.Denoising Albedo.R"),
            ("rgba", "albedo.r"),
        ] {
            assert_eq!(names(part, channel), ("albedo".into(), "r".into()), "{part} {channel}");
        }
        assert_eq!(names("", "Z"), (String::new(), "z".into()));
    }
}
