//! The picture of an EXR: over its display window, in the colours of Rec. 709.

use super::channels::{self, Choice, Colours, listed};
use super::{COLOUR, DEPTH, DIRECTION, NUMBER, exr, text};
use crate::primaries::{Primaries, REC_709, converted};
use crate::{ImageFileError, Loaded, MOST_PIXELS, check_pixels, image_of};
use ::exr::image::read::layers::ReadChannels;
use ::exr::meta::Headers;
use ::exr::meta::attribute::Chromaticities;
use ::exr::meta::header::Header;
use film::glam::DVec3;
use film::{LayerValues, Vec3};
use std::path::Path;
use std::sync::Arc;

/// Whole pixels of a plane: a data or a display window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Window {
    corner: [i64; 2],
    size: [usize; 2],
}

impl Window {
    fn new(corner: exr::Vec2<i32>, size: exr::Vec2<usize>) -> Self {
        Window { corner: [corner.x().into(), corner.y().into()], size: [size.width(), size.height()] }
    }

    fn holds(&self, other: &Window) -> bool {
        (0..2).all(|axis| self.corner[axis] <= other.corner[axis] && self.end(axis) >= other.end(axis))
    }

    fn end(&self, axis: usize) -> i64 {
        self.corner[axis] + self.size[axis] as i64
    }
}

/// Pixels as they lie in the file.
struct Stored {
    window: Window,
    colours: Vec<Vec3>,
    /// Whether any of it lets through what is behind.
    translucent: bool,
}

/// The layer of this name, if it is of this size: colours, directions, depths or numbers, as its channels are called.
pub fn layer(path: &Path, name: &str, size: (u32, u32)) -> Result<Option<LayerValues>, ImageFileError> {
    use exr::{ReadChannels as _, ReadLayers as _};
    headers(path)?;
    let reader = exr::read().no_deep_data().largest_resolution_level().all_channels().all_layers().all_attributes();
    let image = reader.from_file(path).map_err(|e| ImageFileError::read(path, e))?;
    let named =
        |layer: &&exr::Layer<exr::AnyChannels<exr::FlatSamples>>| layer.attributes.layer_name == Some(text(name));
    let Some(layer) = image.layer_data.iter().find(named) else { return Ok(None) };
    if layer.size != exr::Vec2(size.0 as usize, size.1 as usize) {
        return Ok(None);
    }
    let of_three = |names| three(&layer.channel_data, names);
    let of_one = |name| channel(&layer.channel_data, name).map(Iterator::collect);
    let colours = || of_three(COLOUR).map(LayerValues::Rgb);
    let directions = || of_three(DIRECTION).map(LayerValues::Directions);
    let depths = || of_one(DEPTH).map(LayerValues::Depths);
    let numbers = || of_one(NUMBER).map(LayerValues::Numbers);
    Ok(colours().or_else(directions).or_else(depths).or_else(numbers))
}

/// What the channel of this name holds.
fn channel<'a>(channels: &'a exr::AnyChannels<exr::FlatSamples>, name: &str) -> Option<impl Iterator<Item = f32> + 'a> {
    let found = channels.list.iter().find(|channel| channel.name.eq(name))?;
    Some(found.sample_data.values_as_f32())
}

fn three(channels: &exr::AnyChannels<exr::FlatSamples>, names: [&str; 3]) -> Option<Arc<[Vec3]>> {
    let [x, y, z] = names.map(|name| channel(channels, name));
    Some(x?.zip(y?).zip(z?).map(|((x, y), z)| Vec3::new(x, y, z)).collect())
}

/// Refuses a file before memory is taken for any of its layers.
pub(super) fn headers(path: &Path) -> Result<Headers, ImageFileError> {
    let meta = exr::MetaData::read_from_file(path, false).map_err(|e| ImageFileError::read(path, e))?;
    for header in &meta.headers {
        for size in [header.layer_size, header.shared_attributes.display_window.size] {
            check_pixels(size.width(), size.height(), MOST_PIXELS, path)?;
        }
    }
    Ok(meta.headers)
}

/// The picture of the file, as [`channels::choose`] says which that is.
pub fn load(path: &Path) -> Result<Loaded, ImageFileError> {
    let headers = headers(path)?;
    let (choice, found) = channels::choose(&headers).map_err(|why| ImageFileError::read(path, why))?;
    let mut notes = Vec::new();
    let is_ours = || super::records_of(&headers).next().is_some();
    if found.len() > 1 && !is_ours() {
        notes.push(format!("of its layers {} this is {choice}", listed(&found)));
    }
    let part = headers.get(choice.part).ok_or_else(|| ImageFileError::read(path, "it is empty"))?;
    let shared = &part.shared_attributes;
    let mut stored = stored(path, part, &choice, shared.chromaticities.and_then(|c| primaries(&c).luminance()))?;
    if stored.translucent {
        notes.push("its alpha is left out: what it lets through is black".into());
    }
    if let Some(chromaticities) = &shared.chromaticities {
        notes.extend(to_rec_709(&mut stored.colours, primaries(chromaticities)));
    }
    notes.extend(crate::oblong(shared.pixel_aspect.into()));
    let display = Window::new(shared.display_window.position, shared.display_window.size);
    notes.extend(difference(&stored.window, &display));
    let colours = if stored.window == display { stored.colours } else { placed(&stored, &display) };
    let image = image_of((display.size[0] as u32, display.size[1] as u32), colours, path)?;
    Ok(Loaded { image, notes })
}

/// Colours as they are filled in: the width, the pixels, and whether any of them lets something through.
type Pixels = (usize, Vec<Vec3>, bool);

/// Reads channels of one part alone: others may have channels of the same names.
struct OfPart<'a, C> {
    part: &'a Header,
    channels: C,
}

impl<'s, C: ReadChannels<'s>> ReadChannels<'s> for OfPart<'_, C> {
    type Reader = C::Reader;

    fn create_channels_reader(&'s self, header: &Header) -> exr::Result<C::Reader> {
        let identity = |header: &Header| (header.own_attributes.layer_name.clone(), header.channels.clone());
        if identity(header) != identity(self.part) {
            return Err(exr::Error::Invalid("another part".into()));
        }
        self.channels.create_channels_reader(header)
    }
}

/// The channels of this choice, which is of this part. What reads three channels that must be there is of another type than
/// what reads one and two that may be.
fn stored(path: &Path, part: &Header, choice: &Choice, luminance: Option<DVec3>) -> Result<Stored, ImageFileError> {
    use exr::{ReadLayers as _, ReadSpecificChannel as _};
    macro_rules! part_with {
        ($channels:expr, $colour:expr) => {{
            let channels = $channels.optional(choice.channel("A"), 1.0_f32).collect_pixels(
                |size, _| (size.width(), vec![Vec3::ZERO; size.area()], false),
                move |(width, colours, translucent): &mut Pixels, at, (a, b, c, alpha): (f32, f32, f32, f32)| {
                    colours[at.y() * *width + at.x()] = $colour([a, b, c]);
                    *translucent |= alpha < 1.0;
                },
            );
            OfPart { part, channels }.first_valid_layer().all_attributes().from_file(path).map(|image| {
                let layer = image.layer_data;
                (Window::new(layer.attributes.layer_position, layer.size), layer.channel_data.pixels)
            })
        }};
    }
    let shares = luminance.or(REC_709.luminance()).unwrap_or(DVec3::ONE);
    let channels = exr::read().no_deep_data().largest_resolution_level().specific_channels();
    let [r, g, b] = ["R", "G", "B"].map(|name| choice.channel(name));
    let [y, ry, by] = ["Y", "RY", "BY"].map(|name| choice.channel(name));
    let read = match choice.colours {
        Colours::Rgb => part_with!(channels.required(r).required(g).required(b), Vec3::from_array),
        Colours::Luminance => {
            let with_chroma = channels.required(y).optional(ry, 0.0_f32).optional(by, 0.0_f32);
            part_with!(with_chroma, |channels| of_chroma(channels, shares))
        }
    };
    let (window, (_, colours, translucent)) = read.map_err(|e| ImageFileError::read(path, e))?;
    Ok(Stored { window, colours, translucent })
}

/// RY and BY are (R - Y) / Y and (B - Y) / Y: OpenEXR, "Luminance/Chroma Images". Grey has none.
fn of_chroma([y, ry, by]: [f32; 3], shares: DVec3) -> Vec3 {
    if (ry, by) == (0.0, 0.0) {
        return Vec3::splat(y);
    }
    let [y, r, b] = [y, (1.0 + ry) * y, (1.0 + by) * y].map(f64::from);
    DVec3::new(r, (y - shares.x * r - shares.z * b) / shares.y, b).as_vec3()
}

fn primaries(c: &Chromaticities) -> Primaries {
    Primaries([c.red, c.green, c.blue, c.white].map(|place| [place.x().into(), place.y().into()]))
}

/// What is to be said of it.
fn to_rec_709(colours: &mut [Vec3], primaries: Primaries) -> Option<String> {
    if primaries.are_rec_709() {
        return None;
    }
    let Some(matrix) = primaries.to_rec_709() else {
        return Some("its chromaticities span no colours: it is taken as Rec. 709".into());
    };
    colours.iter_mut().for_each(|colour| *colour = converted(&matrix, *colour));
    Some("its colours have other primaries than Rec. 709, and are converted".into())
}

/// What is to be said of a data window that is not the display window.
fn difference(data: &Window, display: &Window) -> Option<String> {
    let words = |w: &Window| format!("{}x{} pixels at ({}, {})", w.size[0], w.size[1], w.corner[0], w.corner[1]);
    let black = if data.holds(display) { "" } else { ", black where there is no data" };
    let cut = if display.holds(data) { "" } else { ", without the data outside of it" };
    (data != display).then(|| {
        format!(
            "its data window is {}, and it is read over its display window, {}{black}{cut}",
            words(data),
            words(display)
        )
    })
}

/// What the display window shows: outside of the data window a picture is black (OpenEXR, "Technical Introduction").
fn placed(stored: &Stored, display: &Window) -> Vec<Vec3> {
    let data = &stored.window;
    let mut colours = vec![Vec3::ZERO; display.size[0] * display.size[1]];
    let [left, top] = [0, 1].map(|axis| data.corner[axis].max(display.corner[axis]));
    let [right, bottom] = [0, 1].map(|axis| data.end(axis).min(display.end(axis)));
    if right <= left {
        return colours;
    }
    for y in top..bottom {
        let row = |window: &Window| {
            let [x, y] = [left - window.corner[0], y - window.corner[1]];
            let start = y as usize * window.size[0] + x as usize;
            start..start + (right - left) as usize
        };
        colours[row(display)].copy_from_slice(&stored.colours[row(data)]);
    }
    colours
}
