//! The pictures that other programs have sent, as far as they have come. The one that was begun last is shown.

use super::protocol::{MOST_PIXELS, NewPicture, Packet, Tile};
use film::{Image, Vec3};
use std::time::Instant;

/// How many are kept: a program may go on with an older one.
const MOST_PICTURES: usize = 16;

/// All pictures, those begun last at the end.
#[derive(Debug)]
pub struct Gallery {
    most_pixels: u64,
    pictures: Vec<Canvas>,
    /// Counts what has changed.
    version: u64,
    /// What was last refused, and by what: one line.
    fault: Option<String>,
}

/// A picture on which tiles are put.
#[derive(Debug)]
struct Canvas {
    name: String,
    size: (u32, u32),
    channels: Vec<(String, Colours)>,
    radiances: Vec<Vec3>,
    begun: Instant,
    changed: Instant,
    changes: u64,
}

/// Which of red, green and blue a channel is.
type Colours = [bool; 3];

/// The state of the picture that is shown.
#[derive(Debug)]
pub struct Snapshot {
    /// Counts what has changed.
    pub version: u64,
    /// The picture with its name; `None` while there is none.
    pub picture: Option<(String, Image)>,
    /// Seconds from its beginning to its last change.
    pub seconds: f64,
    /// How many tiles have come.
    pub changes: u64,
    /// What was last refused, and by what: one line.
    pub fault: Option<String>,
}

impl Default for Gallery {
    fn default() -> Self {
        Gallery::with_room_for(MOST_PIXELS)
    }
}

impl Gallery {
    /// One whose pictures have at most so many pixels together.
    pub fn with_room_for(most_pixels: u64) -> Self {
        Gallery { most_pixels, pictures: Vec::new(), version: 0, fault: None }
    }

    /// Does what a packet asks for.
    ///
    /// # Errors
    /// If it does not fit to what came before it: one line.
    pub fn take(&mut self, packet: Packet) -> Result<(), String> {
        match packet {
            Packet::Create(new) => self.begin(new)?,
            Packet::Update(tile) => {
                let tile = self.fitting(tile)?;
                self.put(&tile)?;
                self.note(&tile);
            }
            Packet::Close(name) => self.pictures.retain(|canvas| canvas.name != name),
            Packet::Open(file) => self.fault = Some(not_opened(&file)),
            Packet::Graphics => return Ok(()),
        }
        self.version += 1;
        Ok(())
    }

    /// Keeps why a connection was closed.
    pub fn refuse(&mut self, fault: String) {
        (self.fault, self.version) = (Some(fault), self.version + 1);
    }

    /// Begins a picture in the place of one of its name. The oldest go where there is no room.
    fn begin(&mut self, new: NewPicture) -> Result<(), String> {
        let (width, height) = new.size;
        let pixels = |(width, height): (u32, u32)| u64::from(width) * u64::from(height);
        if pixels(new.size) > self.most_pixels {
            return Err(format!("{width}x{height} pixels, where {} are the most", self.most_pixels));
        }
        let channels = colours_of(&new.channels)?;
        self.pictures.retain(|canvas| canvas.name != new.name);
        let total = |pictures: &[Canvas]| pictures.iter().map(|canvas| pixels(canvas.size)).sum::<u64>();
        while self.pictures.len() >= MOST_PICTURES || total(&self.pictures) + pixels(new.size) > self.most_pixels {
            self.pictures.remove(0);
        }
        let (now, radiances) = (Instant::now(), vec![Vec3::ZERO; pixels(new.size) as usize]);
        let NewPicture { name, size, .. } = new;
        self.pictures.push(Canvas { name, size, channels, radiances, begun: now, changed: now, changes: 0 });
        self.fault = None;
        Ok(())
    }

    /// A tile that is a part of a picture, with those of its channels alone that are colours there.
    ///
    /// # Errors
    /// If it is none, in one line.
    pub fn fitting<'a>(&mut self, mut tile: Tile<'a>) -> Result<Tile<'a>, String> {
        let canvas = self.canvas(&tile.name)?;
        canvas.holds(&tile)?;
        let colours = tile.channels.iter().map(|channel| canvas.colours(&channel.name));
        let mut colours = colours.collect::<Result<Vec<_>, _>>()?.into_iter();
        tile.channels.retain(|_| colours.next().is_some_and(|colours| colours.contains(&true)));
        Ok(tile)
    }

    /// Puts a tile in its place, or nothing of it.
    ///
    /// # Errors
    /// The faults of [`Gallery::fitting`], in the same words.
    pub fn put(&mut self, tile: &Tile) -> Result<(), String> {
        self.canvas(&tile.name)?.put(tile)
    }

    /// Counts a tile that was put in its place.
    pub fn note(&mut self, tile: &Tile) {
        if let Ok(canvas) = self.canvas(&tile.name) {
            (canvas.changed, canvas.changes) = (Instant::now(), canvas.changes + 1);
        }
        self.version += 1;
    }

    fn canvas(&mut self, name: &str) -> Result<&mut Canvas, String> {
        let canvas = self.pictures.iter_mut().find(|canvas| canvas.name == name);
        canvas.ok_or_else(|| {
            let name = image_file::escaped(name);
            format!("a tile of {name}, which was not begun, or {MOST_PICTURES} pictures ago")
        })
    }

    /// The picture that was begun last, if something has changed since a version.
    pub fn since(&self, version: Option<u64>) -> Option<Snapshot> {
        if version == Some(self.version) {
            return None;
        }
        let shown = self.pictures.last();
        let image = |canvas: &Canvas| Image::new(canvas.size.0, canvas.size.1, canvas.radiances.as_slice());
        Some(Snapshot {
            version: self.version,
            picture: shown.and_then(|canvas| Some((canvas.name.clone(), image(canvas)?))),
            seconds: shown.map_or(0.0, |canvas| (canvas.changed - canvas.begun).as_secs_f64()),
            changes: shown.map_or(0, |canvas| canvas.changes),
            fault: self.fault.clone(),
        })
    }

    /// Pixels of all pictures.
    #[cfg(test)]
    pub fn pixels(&self) -> usize {
        self.pictures.iter().map(|canvas| canvas.radiances.capacity()).sum()
    }
}

impl Canvas {
    fn holds(&self, tile: &Tile) -> Result<(), String> {
        let ((x, y), (width, height), (w, h)) = (tile.corner, tile.size, self.size);
        if x + width <= w && y + height <= h {
            return Ok(());
        }
        Err(format!("a tile of {width}x{height} pixels at {x}, {y} of a picture of {w}x{h}"))
    }

    fn put(&mut self, tile: &Tile) -> Result<(), String> {
        self.holds(tile)?;
        let ((x, y), (width, height)) = (tile.corner, tile.size);
        let channels = tile.channels.iter().map(|channel| Ok((channel, self.colours(&channel.name)?)));
        for (channel, colours) in channels.collect::<Result<Vec<_>, String>>()? {
            let stride = self.size.0 as usize;
            let rows = self.radiances.chunks_exact_mut(stride).skip(y as usize).take(height as usize);
            let pixels = rows.flat_map(|row| &mut row[x as usize..(x + width) as usize]);
            for (pixel, value) in pixels.zip(tile.values(channel)) {
                (0..3).filter(|colour| colours[*colour]).for_each(|colour| pixel[colour] = value);
            }
        }
        Ok(())
    }

    fn colours(&self, channel: &str) -> Result<Colours, String> {
        let known = self.channels.iter().find(|(name, _)| name == channel);
        known.map(|(_, colours)| *colours).ok_or_else(|| {
            let names: Vec<_> = self.channels.iter().map(|(name, _)| image_file::escaped(name)).collect();
            format!("a tile of channel {}, where the picture has {}", image_file::escaped(channel), names.join(", "))
        })
    }
}

/// Which colours channels are: R, G and B, else those of the first layer that has all three, else Y or the only one as grey.
/// What else there is, as alpha, is left out.
fn colours_of(names: &[String]) -> Result<Vec<(String, Colours)>, String> {
    const RGB: [&str; 3] = ["R", "G", "B"];
    let has = |name: &str| names.iter().any(|other| other == name);
    let of_layer = |layer: &str| RGB.map(|colour| format!("{layer}{colour}"));
    let layers = std::iter::once("").chain(names.iter().filter_map(|name| name.strip_suffix('R')));
    let layer = layers.into_iter().find(|layer| of_layer(layer).iter().all(|name| has(name)));
    let grey = if names.len() == 1 { names[0].as_str() } else { "Y" };
    let colours = |name: &String| match layer {
        Some(layer) => of_layer(layer).map(|colour| colour == *name),
        None => [name == grey; 3],
    };
    if layer.is_none() && !has(grey) {
        let names: Vec<_> = names.iter().map(|name| image_file::escaped(name)).collect();
        return Err(format!("a picture of channels {}, where R, G and B, or Y, are needed", names.join(", ")));
    }
    Ok(names.iter().map(|name| (name.clone(), colours(name))).collect())
}

fn not_opened(file: &str) -> String {
    let file = image_file::escaped(file);
    format!("another program asks to open {file}: choose it as the pane's picture file instead, if you want that")
}

#[cfg(test)]
#[path = "gallery_tests.rs"]
mod tests;
