//! What the numbers of a PNG mean: PNG Specification (Third Edition), sections 4.3 and 11.3.2. A chunk that says it better
//! goes before one that says it worse: cICP, iCCP, sRGB, then gAMA with cHRM; sRGB is what pictures mean that do not say.

use crate::primaries::Primaries;
use film::colour;
use film::glam::DMat3;

/// From a number between 0 and 1 to linear light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Transfer {
    /// The curve of sRGB, by IEC 61966-2-1.
    Srgb,
    /// The number to this power.
    Power(f32),
}

impl Transfer {
    pub fn decode(self, code: f32) -> f32 {
        match self {
            Transfer::Srgb => colour::srgb_decode(code),
            Transfer::Power(power) => code.powf(power),
        }
    }
}

/// How the colours of a picture are read.
#[derive(Debug, PartialEq)]
pub struct Colours {
    pub transfer: Transfer,
    /// To Rec. 709, after the transfer; `None` if they are of it.
    pub matrix: Option<DMat3>,
    pub notes: Vec<String>,
}

impl Colours {
    fn srgb(note: Option<&str>) -> Self {
        Colours { transfer: Transfer::Srgb, matrix: None, notes: note.map(String::from).into_iter().collect() }
    }

    /// As a picture's chunks say, of which `names` are all.
    pub fn of(info: &png::Info, names: &[[u8; 4]]) -> Self {
        let mut colours = Colours::said_by(info);
        let read = [
            (b"cICP", info.coding_independent_code_points.is_some()),
            (b"iCCP", info.icc_profile.is_some()),
            (b"sRGB", info.srgb.is_some()),
            (b"gAMA", info.gama_chunk.is_some()),
            (b"cHRM", info.chrm_chunk.is_some()),
        ];
        let damaged = read.iter().filter(|(name, read)| !read && names.contains(name));
        let note = |(name, _): &(&[u8; 4], bool)| {
            format!("its chunk {} is damaged or out of place, and left out", String::from_utf8_lossy(*name))
        };
        colours.notes.extend(damaged.map(note));
        colours
    }

    fn said_by(info: &png::Info) -> Self {
        if let Some(points) = &info.coding_independent_code_points {
            let is_srgb = (points.color_primaries, points.transfer_function) == (1, 13);
            return Colours::srgb(
                (!is_srgb).then_some("its code points (cICP) are not those of sRGB, as which it is taken"),
            );
        }
        if let Some(profile) = &info.icc_profile {
            if is_of_srgb(profile) {
                return Colours::srgb(None);
            }
            // whoever cannot apply the profile takes what stands beside it
            let mut colours = Colours::of_gamma(info);
            colours.notes.push("its colour profile (iCCP) is not applied".into());
            return colours;
        }
        if info.srgb.is_some() { Colours::srgb(None) } else { Colours::of_gamma(info) }
    }

    fn of_gamma(info: &png::Info) -> Self {
        let mut colours = Colours::srgb(None);
        if let Some(gamma) = info.gama_chunk {
            colours.transfer = Transfer::Power(1.0 / gamma.into_value());
        }
        let Some(c) = &info.chrm_chunk else { return colours };
        let primaries =
            Primaries([c.red, c.green, c.blue, c.white].map(|(x, y)| [x, y].map(|c| f64::from(c.into_scaled()) / 1e5)));
        if !primaries.are_rec_709() {
            colours.matrix = primaries.to_rec_709();
            colours.notes.push(match colours.matrix {
                Some(_) => "its colours have other primaries than sRGB, and are converted".into(),
                None => "its primaries (cHRM) span no colours: they are taken as those of sRGB".into(),
            });
        }
        colours
    }
}

/// Whether a profile calls itself one of sRGB, in either encoding of names. That of linear sRGB is another.
fn is_of_srgb(profile: &[u8]) -> bool {
    let wide = |word: &str| word.bytes().flat_map(|byte| [0, byte]).collect::<Vec<u8>>();
    let has = |bytes: &[u8]| profile.windows(bytes.len()).any(|window| window == bytes);
    let says = |word: &str| has(word.as_bytes()) || has(&wide(word));
    says("sRGB") && !says("inear")
}
