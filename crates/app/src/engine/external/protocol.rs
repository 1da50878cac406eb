//! The packets by which renderers show their pictures in tev, as tev's `Ipc.cpp` reads them: the length of the packet as four
//! bytes, itself among them, a byte that says its kind, and what belongs to that. All numbers are little-endian; texts end in
//! a zero. Nothing of a packet is believed before it was looked at, and nothing is kept for it that has not come.

/// The longest side of a picture: what every graphics device can show.
pub const MOST_SIDE: u32 = 8192;
/// Pixels that a picture has at most, and all received ones together: 4096 x 2048. More would hold a frame up while they
/// are put on the screen, and take gigabytes where they are measured.
pub const MOST_PIXELS: u64 = 1 << 23;
/// Bytes that a packet has at most: whole pictures of four channels up to 2896 x 2896. Larger ones come in tiles.
pub const MOST_BYTES: usize = 1 << 27;
/// Bytes that all packets together have at most which are not whole yet.
pub const MOST_BEGUN: usize = 1 << 28;
/// Channels that a picture or a packet has at most.
pub const MOST_CHANNELS: usize = 64;
/// Bytes that a name has at most.
pub const LONGEST_NAME: usize = 4096;

/// The length and the kind.
const LEAST_BYTES: usize = 5;

/// What a packet asks for.
#[derive(Debug, Clone, PartialEq)]
pub enum Packet<'a> {
    /// A black picture, of which tiles will come.
    Create(NewPicture),
    /// A part of a picture.
    Update(Tile<'a>),
    /// A picture is no longer wanted.
    Close(String),
    /// A file of this machine is to be shown, or read again.
    Open(String),
    /// Lines drawn over a picture, which stand for nothing here.
    Graphics,
}

/// A picture that is begun.
#[derive(Debug, Clone, PartialEq)]
pub struct NewPicture {
    /// What its maker calls it.
    pub name: String,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// The names of its channels.
    pub channels: Vec<String>,
}

/// Pixels of a rectangle.
#[derive(Debug, Clone, PartialEq)]
pub struct Tile<'a> {
    /// The picture that it is a part of.
    pub name: String,
    /// What of its pixels it has.
    pub channels: Vec<TileChannel>,
    /// Column and row of its first pixel.
    pub corner: (u32, u32),
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Numbers of four bytes.
    values: &'a [u8],
}

/// Where the numbers of a channel stand in a packet.
#[derive(Debug, Clone, PartialEq)]
pub struct TileChannel {
    /// As the picture calls it.
    pub name: String,
    offset: usize,
    stride: usize,
}

impl<'a> Tile<'a> {
    /// The same in parts of whole rows, each of a row or of at most so many pixels.
    pub fn parts(&self, most_pixels: usize) -> impl Iterator<Item = Tile<'a>> {
        let ((x, y), (width, height)) = (self.corner, self.size);
        let rows = u32::try_from(most_pixels / width as usize).unwrap_or(u32::MAX).max(1);
        (0..height).step_by(rows as usize).map(move |row| {
            let mut part = self.clone();
            (part.corner, part.size) = ((x, y + row), (width, rows.min(height - row)));
            for channel in &mut part.channels {
                channel.offset += row as usize * width as usize * channel.stride;
            }
            part
        })
    }

    /// A channel's numbers, rows from the top.
    pub fn values(&self, channel: &TileChannel) -> impl Iterator<Item = f32> {
        let numbers = self.values.chunks_exact(4).skip(channel.offset).step_by(channel.stride.max(1));
        let numbers = numbers.map(|bytes| bytes.try_into().map_or(f32::NAN, f32::from_le_bytes));
        numbers.take(self.size.0 as usize * self.size.1 as usize)
    }
}

/// How many bytes a packet has that begins so; `None` while that is not known.
///
/// # Errors
/// If no packet has so many.
pub fn length(begun: &[u8]) -> Result<Option<usize>, String> {
    let Some(length) = begun.first_chunk().map(|head| u32::from_le_bytes(*head) as usize) else { return Ok(None) };
    match length {
        LEAST_BYTES..=MOST_BYTES => Ok(Some(length)),
        ..LEAST_BYTES => {
            Err(format!("a packet of {length} bytes, where the shortest has {LEAST_BYTES}: this is not tev's protocol"))
        }
        _ => Err(format!(
            "a packet of {length} bytes, where the longest has {MOST_BYTES}: send the picture in tiles, if this is tev's protocol"
        )),
    }
}

/// Reads a whole packet.
///
/// # Errors
/// What is wrong with it, in one line.
pub fn parse(packet: &[u8]) -> Result<Packet<'_>, String> {
    let mut rest = Rest(packet.get(4..).unwrap_or_default());
    let kind = rest.byte()?;
    match kind {
        0 | 1 | 7 => {
            rest.byte()?;
            rest.name().map(Packet::Open)
        }
        2 => rest.name().map(Packet::Close),
        3 | 5 | 6 => tile(rest, kind).map(Packet::Update),
        4 => new_picture(rest).map(Packet::Create),
        8 => Ok(Packet::Graphics),
        other => Err(format!("a packet of kind {other}, which tev's protocol has not: its kinds are 0 to 8")),
    }
}

fn new_picture(mut rest: Rest) -> Result<NewPicture, String> {
    rest.byte()?;
    let name = rest.name()?;
    let size = size([rest.whole()?, rest.whole()?])?;
    let count = rest.whole()?;
    let channels = rest.channels(count)?;
    Ok(NewPicture { name, size, channels })
}

fn tile(mut rest: Rest<'_>, kind: u8) -> Result<Tile<'_>, String> {
    rest.byte()?;
    let name = rest.name()?;
    let count = if kind == 3 { 1 } else { rest.whole()? };
    let names = rest.channels(count)?;
    let corner = corner([rest.whole()?, rest.whole()?])?;
    let size = size([rest.whole()?, rest.whole()?])?;
    let pixels = size.0 as usize * size.1 as usize;
    let places = if kind == 6 {
        rest.places(names.len())?
    } else {
        (0..names.len()).map(|channel| (channel * pixels, 1)).collect()
    };
    let numbers = rest.0.len() / 4;
    let channel = |(name, (offset, stride)): (String, (usize, usize))| {
        // offsets and strides are below 2^62, but not their sums and products
        let needed = (pixels - 1).checked_mul(stride).and_then(|last| last.checked_add(offset)?.checked_add(1));
        match needed.filter(|needed| *needed <= numbers) {
            Some(_) => Ok(TileChannel { name, offset, stride }),
            None => Err(format!(
                "a tile of {}x{} pixels with {numbers} numbers, too few for its channel {}",
                size.0,
                size.1,
                image_file::escaped(&name)
            )),
        }
    };
    let channels = names.into_iter().zip(places).map(channel).collect::<Result<_, _>>()?;
    Ok(Tile { name, channels, corner, size, values: rest.0 })
}

fn size(sides: [i32; 2]) -> Result<(u32, u32), String> {
    match sides.map(u32::try_from) {
        [Ok(width @ 1..=MOST_SIDE), Ok(height @ 1..=MOST_SIDE)] => Ok((width, height)),
        _ => Err(format!("{}x{} pixels: a side has 1 to {MOST_SIDE}", sides[0], sides[1])),
    }
}

fn corner(place: [i32; 2]) -> Result<(u32, u32), String> {
    match place.map(u32::try_from) {
        [Ok(x @ 0..=MOST_SIDE), Ok(y @ 0..=MOST_SIDE)] => Ok((x, y)),
        _ => Err(format!("a tile at {}, {}, which is in no picture", place[0], place[1])),
    }
}

/// What of a packet was not read yet.
struct Rest<'a>(&'a [u8]);

impl<'a> Rest<'a> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let (bytes, rest) = self.0.split_first_chunk().ok_or("a packet that ends too early")?;
        self.0 = rest;
        Ok(*bytes)
    }

    fn byte(&mut self) -> Result<u8, String> {
        self.take().map(|[byte]| byte)
    }

    fn whole(&mut self) -> Result<i32, String> {
        self.take().map(i32::from_le_bytes)
    }

    fn name(&mut self) -> Result<String, String> {
        let window = &self.0[..self.0.len().min(LONGEST_NAME + 1)];
        match window.iter().position(|byte| *byte == 0) {
            Some(end) => {
                let name = String::from_utf8_lossy(&self.0[..end]).into_owned();
                self.0 = &self.0[end + 1..];
                Ok(name)
            }
            None if window.len() > LONGEST_NAME => Err(format!("a name of more than {LONGEST_NAME} bytes")),
            None => Err("a name that does not end".into()),
        }
    }

    fn channels(&mut self, count: i32) -> Result<Vec<String>, String> {
        match usize::try_from(count) {
            Ok(count @ 1..=MOST_CHANNELS) => {
                let names = (0..count).map(|_| self.name()).collect::<Result<Vec<_>, String>>()?;
                match names.iter().enumerate().find(|(place, name)| names[..*place].contains(name)) {
                    Some((_, twice)) => Err(format!("a packet with two channels {}", image_file::escaped(twice))),
                    None => Ok(names),
                }
            }
            _ => Err(format!("{count} channels, where 1 to {MOST_CHANNELS} are possible")),
        }
    }

    /// Offsets of all channels, and then strides, in numbers.
    fn places(&mut self, channels: usize) -> Result<Vec<(usize, usize)>, String> {
        let mut all = |least: i64, what: &str| {
            let one = |rest: &mut Self| match i64::from_le_bytes(rest.take()?) {
                number if (least..1 << 62).contains(&number) => {
                    usize::try_from(number).map_err(|_| format!("{what} {number}"))
                }
                number => Err(format!("{what} {number}, where at least {least} is possible")),
            };
            (0..channels).map(|_| one(self)).collect::<Result<Vec<_>, String>>()
        };
        let offsets = all(0, "a channel at number")?;
        let strides = all(1, "a channel whose numbers are apart by")?;
        Ok(offsets.into_iter().zip(strides).collect())
    }
}

/// Room for bytes that is kept for the next packet.
const KEPT: usize = 1 << 20;

/// Puts packets together from what comes of them, in pieces of any size.
#[derive(Debug, Default)]
pub struct Assembler {
    begun: Vec<u8>,
}

impl Assembler {
    /// Takes what has come and hands on each packet that is whole by now.
    ///
    /// # Errors
    /// As [`length`], or what `take` says of a packet. Nothing can be made of what comes after that.
    pub fn push(&mut self, bytes: &[u8], mut take: impl FnMut(&[u8]) -> Result<(), String>) -> Result<(), String> {
        self.begun.extend_from_slice(bytes);
        let mut done = 0;
        while let Some(length) = length(&self.begun[done..])? {
            let Some(packet) = self.begun.get(done..done + length) else { break };
            take(packet)?;
            done += length;
        }
        self.begun.drain(..done);
        // a large packet leaves no room behind
        if self.begun.capacity() > KEPT.max(4 * self.begun.len()) {
            self.begun.shrink_to(KEPT);
        }
        Ok(())
    }

    /// How many bytes are kept of a packet that is not whole yet.
    pub fn bytes(&self) -> usize {
        self.begun.len()
    }

    /// Whether a packet has begun and not ended.
    pub fn is_midway(&self) -> bool {
        !self.begun.is_empty()
    }
}

#[cfg(test)]
#[path = "protocol_tests.rs"]
pub mod tests;
