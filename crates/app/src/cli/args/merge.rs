//! The words after `merge`.

use super::options::{CommandOption, Typed, no_more, read};
use super::usage;
use super::values::number;
use crate::cli::{CliError, Command};
use image_file::Kind;
use std::path::PathBuf;

/// `visavis merge A B ... -o OUT`.
#[derive(Debug, Clone, PartialEq)]
pub struct MergeArgs {
    /// Films of ranges of one picture's samples.
    pub parts: Vec<PathBuf>,
    /// The file to write.
    pub out: PathBuf,
    /// Stops added where a .png is written.
    pub exposure: f32,
    /// One JSON object on stdout in place of a line.
    pub json: bool,
}

/// The words on their way.
pub struct Reading {
    out: Option<PathBuf>,
    exposure: f32,
    json: bool,
}

pub fn options() -> Vec<CommandOption<Reading>> {
    vec![
        CommandOption {
            names: &["-o"],
            value: "OUT",
            help: "the file to write: .exr, with the sums, which can be merged on, or .png",
            read: |args, parser| {
                args.out = Some(PathBuf::from(parser.value()?));
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
        CommandOption {
            names: &["--json"],
            value: "",
            help: "print one JSON object about the result on stdout",
            read: |args, _| {
                args.json = true;
                Ok(())
            },
        },
    ]
}

pub fn parse(parser: lexopt::Parser) -> Result<Command, CliError> {
    let usual = Reading { out: None, exposure: 0.0, json: false };
    let (Reading { out, exposure, json }, words) = match read(parser, usual, &options(), usize::MAX, no_more)? {
        Typed::Words(reading, words) => (reading, words),
        Typed::Print(text) => return Ok(Command::Print(text)),
    };
    let parts: Vec<PathBuf> = words.into_iter().map(PathBuf::from).collect();
    if parts.is_empty() {
        return usage("merge needs films of render --samples: visavis merge A.exr B.exr ... -o OUT");
    }
    if let Some(part) = parts.iter().find(|part| Kind::of(part) != Some(Kind::Exr)) {
        return usage(format!("merge reads sums of samples, which an .exr holds: {}", image_file::shown(part)));
    }
    let Some(out) = out else { return usage("merge needs a file to write: -o OUT.exr or -o OUT.png") };
    if Kind::of(&out).is_none() {
        return usage(format!("-o must end in .png or .exr: {}", image_file::shown(&out)));
    }
    Ok(Command::Merge(MergeArgs { parts, out, exposure, json }))
}
