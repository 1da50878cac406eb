//! Values of options: read, checked, or refused with what was expected.

use super::usage;
use crate::cli::CliError;
use image_file::MOST_PIXELS;
use lexopt::ValueExt;
use scene::Vec3;
use std::str::FromStr;

/// What `--device` may be.
pub const DEVICES: &str = "auto, cpu or gpu";

pub fn text(parser: &mut lexopt::Parser) -> Result<String, CliError> {
    Ok(parser.value()?.string()?)
}

pub fn choice<T>(
    parser: &mut lexopt::Parser,
    option: &str,
    named: impl Fn(&str) -> Option<T>,
    expected: &str,
) -> Result<T, CliError> {
    let word = text(parser)?;
    let known = expected.split([',', ' ']).filter(|word| named(word).is_some());
    match named(&word) {
        Some(value) => Ok(value),
        None => usage(format!("{option} {}: expected {expected}{}", shown(&word), did_you_mean(&word, known))),
    }
}

/// A word as a message shows it: one of no letters is seen too.
pub fn shown(word: &str) -> &str {
    if word.is_empty() { "''" } else { word }
}

fn did_you_mean<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    scene::nearest_or_begun(word, known).map_or(String::new(), |name| format!("; did you mean {name}?"))
}

pub fn number(
    parser: &mut lexopt::Parser,
    option: &str,
    expected: &str,
    holds: impl Fn(f32) -> bool,
) -> Result<f32, CliError> {
    let word = text(parser)?;
    let number = parse_finite(&word).filter(|v| holds(*v));
    number.map_or_else(|| usage(format!("{option} {}: expected {expected}{}", shown(&word), decimal_comma(&word))), Ok)
}

/// What to write instead of a number with a comma: "0,6" is 0.6.
pub fn decimal_comma(word: &str) -> String {
    let point = word.trim().replacen(',', ".", 1);
    let is_meant = word.contains(',') && parse_finite(&point).is_some();
    if is_meant { format!("; numbers have a decimal point: write {point}") } else { String::new() }
}

/// What `--time` may be.
pub fn seconds(parser: &mut lexopt::Parser) -> Result<f64, CliError> {
    number(parser, "--time", "seconds above 0 and at most 1e9", |v| v > 0.0 && v <= 1e9).map(f64::from)
}

/// As a scene file has it, -0 is 0.
pub fn parse_finite(word: &str) -> Option<f32> {
    f32::from_str(word.trim()).ok().filter(|v| v.is_finite()).map(|v| v + 0.0)
}

pub fn size(word: &str) -> Result<(u32, u32), CliError> {
    let sides = word.split_once('x').and_then(|(w, h)| Some((w.parse::<u32>().ok()?, h.parse::<u32>().ok()?)));
    match sides {
        Some((width, height)) if width > 0 && height > 0 => {
            let pixels = u64::from(width) * u64::from(height);
            if pixels > MOST_PIXELS {
                return usage(format!("--size {word}: {pixels} pixels, but a picture has at most {MOST_PIXELS}"));
            }
            Ok((width, height))
        }
        _ => usage(format!("--size {word}: expected WIDTHxHEIGHT in pixels, both at least 1, like 1280x720")),
    }
}

pub fn point(parser: &mut lexopt::Parser, option: &str) -> Result<Vec3, CliError> {
    let word = text(parser)?;
    let numbers: Option<Vec<f32>> = word.split(',').map(parse_finite).collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) => Ok(Vec3::new(x, y, z)),
        Some([_, _, _, _, ..]) => usage(format!(
            "{option} {word}: expected three finite numbers with decimal points, the commas between them, like 7.5,2.3,-4.2"
        )),
        _ => usage(format!("{option} {word}: expected three finite numbers, like 7.5,2.3,-4.2")),
    }
}

/// The lanes that every tracer of this process shall use, see [`pathtrace::Lanes::prefer`].
pub fn lanes(parser: &mut lexopt::Parser) -> Result<(), CliError> {
    let available = || pathtrace::Lanes::available();
    let names: Vec<_> = available().map(pathtrace::Lanes::name).collect();
    let named = |name: &str| available().find(|lanes| lanes.name() == name);
    choice(parser, "--lanes", named, &format!("{} on this machine", names.join(", "))).map(pathtrace::Lanes::prefer)
}
