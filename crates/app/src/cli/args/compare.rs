//! The words after `compare`.

use super::options::{CommandOption, Typed, no_more, read};
use super::seen::allow_outside;
use super::usage;
use super::values::{choice, number};
use crate::cli::{CliError, Command};
use ::compare::ErrorMetric;
use image_file::Kind;
use std::path::PathBuf;

/// `visavis compare A B ...`.
#[derive(Debug, Clone, PartialEq)]
pub struct CompareArgs {
    /// The picture to judge.
    pub film: PathBuf,
    /// The picture to judge it by; `None` for the reference of what it shows.
    pub reference: Option<PathBuf>,
    /// Where to draw a map of the errors.
    pub heatmap: Option<PathBuf>,
    /// Which errors it shows.
    pub map: ErrorMetric,
    /// The error at the end of its scale; `None` fits it.
    pub scale: Option<f32>,
    /// Whether to tell which effect of light has how much of the error, and to name them on the map.
    pub effects: bool,
    /// Stops added before FLIP looks.
    pub exposure: f32,
    /// One JSON object on stdout instead of a table.
    pub json: bool,
}

/// What `--map` may be.
const MAPS: &str = "signed, absolute, relative, squared-relative or flip";

pub fn options() -> Vec<CommandOption<CompareArgs>> {
    vec![
        CommandOption {
            names: &["--heatmap"],
            value: "OUT",
            help: "draw the errors to OUT: .png in colour with a colour bar, or .exr with both pictures and every map as \
                   layers",
            read: |args, parser| {
                args.heatmap = Some(PathBuf::from(parser.value()?));
                Ok(())
            },
        },
        CommandOption {
            names: &["--map"],
            value: "signed|absolute|relative|squared-relative|flip",
            help: "which errors the map shows (default absolute)",
            read: |args, parser| {
                args.map = choice(parser, "--map", ErrorMetric::named, MAPS)?;
                Ok(())
            },
        },
        CommandOption {
            names: &["--scale"],
            value: "E",
            help: "error at the end of the map's scale (default fitted to the map)",
            read: |args, parser| {
                args.scale = Some(number(parser, "--scale", "a number above 0", |v| v > 0.0)?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--effects"],
            value: "",
            help: "say what each effect of light (refraction, shadow edge, caustic ...) has of the squared relative error, and name them on \
                   a .png of --heatmap; A has to say how it was made",
            read: |args, _| {
                args.effects = true;
                Ok(())
            },
        },
        CommandOption {
            names: &["--exposure"],
            value: "EV",
            help: "stops added before FLIP looks (default 0)",
            read: |args, parser| {
                args.exposure = number(parser, "--exposure", "stops from -30 to 30", |v| v.abs() <= 30.0)?;
                Ok(())
            },
        },
        CommandOption {
            names: &["--json"],
            value: "",
            help: "as one JSON object",
            read: |args, _| {
                args.json = true;
                Ok(())
            },
        },
        allow_outside(),
    ]
}

pub fn parse(parser: lexopt::Parser) -> Result<Command, CliError> {
    let blank = CompareArgs {
        film: PathBuf::new(),
        reference: None,
        heatmap: None,
        map: ErrorMetric::default(),
        scale: None,
        effects: false,
        exposure: 0.0,
        json: false,
    };
    let (args, words) = match read(parser, blank, &options(), 2, no_more)? {
        Typed::Words(args, words) => (args, words),
        Typed::Print(text) => return Ok(Command::Print(text)),
    };
    let mut files = words.into_iter().map(PathBuf::from);
    let (Some(film), reference) = (files.next(), files.next()) else {
        return usage("compare takes two pictures, visavis compare A B, or one to compare with its reference");
    };
    if let Some(out) = args.heatmap.as_ref().filter(|out| Kind::of(out).is_none()) {
        return usage(format!("--heatmap must end in .png or .exr: {}", image_file::shown(out)));
    }
    Ok(Command::Compare(CompareArgs { film, reference, ..args }))
}
