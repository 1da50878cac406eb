//! The words after `denoise`.

use super::options::{CommandOption, Typed, no_more, read};
use super::usage;
use super::values::{choice, number};
use crate::cli::{CliError, Command};
use image_file::Kind;
use std::path::PathBuf;
use technique::Denoiser;

/// `visavis denoise A -o OUT ...`.
#[derive(Debug, Clone, PartialEq)]
pub struct DenoiseArgs {
    /// The noisy picture, an .exr.
    pub picture: PathBuf,
    /// The file to write.
    pub out: PathBuf,
    /// What takes the noise away.
    pub filter: Denoiser,
    /// Stops added where a .png is written.
    pub exposure: f32,
}

/// A filter by its name.
fn named(name: &str) -> Option<Denoiser> {
    Denoiser::named(name).filter(|filter| *filter != Denoiser::Off)
}

/// The words on their way.
pub struct Reading {
    out: Option<PathBuf>,
    filter: Denoiser,
    exposure: f32,
}

pub fn options() -> Vec<CommandOption<Reading>> {
    vec![
        CommandOption {
            names: &["-o"],
            value: "OUT",
            help: "the file to write, .exr or .png, with the records of A, the filter and its weights' hash",
            read: |args, parser| {
                args.out = Some(PathBuf::from(parser.value()?));
                Ok(())
            },
        },
        CommandOption {
            names: &["--filter"],
            value: "unet|unet-base|atrous",
            help: "a network of Open Image Denoise, the small or the larger one (default unet), or a-trous wavelets as in SVGF, \
                   which need the layer depth (Z) too and know the noise by half0 and half1 (R, G, B), if they are there, \
                   and by how many samples those have, if the records say so",
            read: |args, parser| {
                args.filter = choice(parser, "--filter", named, "unet, unet-base or atrous")?;
                Ok(())
            },
        },
        CommandOption {
            names: &["--exposure"],
            value: "EV",
            help: "stops added where OUT is a .png (default 0)",
            read: |args, parser| {
                args.exposure = number(parser, "--exposure", "stops from -30 to 30", |v| v.abs() <= 30.0)?;
                Ok(())
            },
        },
    ]
}

pub fn parse(parser: lexopt::Parser) -> Result<Command, CliError> {
    let usual = Reading { out: None, filter: Denoiser::Unet, exposure: 0.0 };
    let (Reading { out, filter, exposure }, words) = match read(parser, usual, &options(), 1, no_more)? {
        Typed::Words(reading, words) => (reading, words),
        Typed::Print(text) => return Ok(Command::Print(text)),
    };
    let Some(picture) = words.into_iter().next().map(PathBuf::from) else {
        return usage("denoise needs a picture: visavis denoise A.exr -o OUT");
    };
    if Kind::of(&picture) != Some(Kind::Exr) {
        return usage(format!("denoise reads linear radiance, an .exr: {}", image_file::shown(&picture)));
    }
    let Some(out) = out else { return usage("denoise needs a file to write: -o OUT.exr or -o OUT.png") };
    if Kind::of(&out).is_none() {
        return usage(format!("-o must end in .png or .exr: {}", image_file::shown(&out)));
    }
    Ok(Command::Denoise(DenoiseArgs { picture, out, filter, exposure }))
}
