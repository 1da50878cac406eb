//! From words to commands.

mod bench;
mod reference;
mod render;
mod seen;
mod values;

pub use bench::BenchArgs;
pub use reference::ReferenceArgs;
pub use render::{RenderArgs, made_by};
pub use seen::Seen;

use super::{CliError, Command, help};
use crate::model::{Theme, ViewArgs};
use crate::ui::Workspaces;
use compare::ErrorMetric;
use image_file::Kind;
use lexopt::prelude::*;
use std::ffi::OsString;
use std::path::PathBuf;
use technique::DeviceChoice;
use values::{DEVICES, choice, lanes, number};

fn usage<T>(line: impl Into<String>) -> Result<T, CliError> {
    Err(CliError::Usage(line.into()))
}

impl From<lexopt::Error> for CliError {
    fn from(error: lexopt::Error) -> Self {
        CliError::Usage(error.to_string())
    }
}

impl Command {
    /// Reads the arguments (without the program's name).
    ///
    /// # Errors
    /// [`CliError::Usage`] names the word that is wrong and what was expected.
    pub fn parse(args: impl IntoIterator<Item = OsString>) -> Result<Self, CliError> {
        let words: Vec<OsString> = args.into_iter().collect();
        let command = words.first().and_then(|word| word.to_str()).unwrap_or_default().to_owned();
        let mut parser = lexopt::Parser::from_args(words);
        let named: fn(lexopt::Parser) -> Result<Self, CliError> = match command.as_str() {
            "render" => render::parse,
            "compare" => parse_compare,
            "bench" => bench::parse,
            "info" => |parser| nothing_more(parser, Command::Info),
            "check" => parse_check,
            "reference" => reference::parse,
            _ => return parse_view(parser),
        };
        parser.next()?;
        named(parser)
    }
}

fn nothing_more(mut parser: lexopt::Parser, command: Command) -> Result<Command, CliError> {
    match parser.next()? {
        None => Ok(command),
        Some(Long("help")) => Ok(Command::Print(help::HELP)),
        Some(other) => Err(other.unexpected().into()),
    }
}

fn parse_view(mut parser: lexopt::Parser) -> Result<Command, CliError> {
    let (mut scene, mut ui_dump, mut theme, mut frame_stats) = (None, None, Theme::default(), false);
    let (mut device, mut workspace) = (DeviceChoice::default(), None);
    while let Some(arg) = parser.next()? {
        match arg {
            Value(word) if scene.is_none() => scene = Some(word.string()?),
            Long("ui-dump") => ui_dump = Some(PathBuf::from(parser.value()?)),
            Long("theme") => theme = choice(&mut parser, "--theme", Theme::named, "dark or projector")?,
            Long("device") => device = choice(&mut parser, "--device", DeviceChoice::named, DEVICES)?,
            // hidden: there is one workspace to use today
            Long("workspace") => workspace = Some(a_workspace(&mut parser)?),
            Long("frame-stats") => frame_stats = true,
            Long("help") | Short('h') => return Ok(Command::Print(help::HELP)),
            Long("version") | Short('V') => return Ok(Command::Print(help::VERSION)),
            other => return Err(other.unexpected().into()),
        }
    }
    let scene = scene.unwrap_or_else(|| "whitted".into());
    Ok(Command::View(ViewArgs { scene, ui_dump, theme, device, workspace, frame_stats }))
}

fn a_workspace(parser: &mut lexopt::Parser) -> Result<String, CliError> {
    let known = Workspaces::names();
    let named = |name: &str| known.contains(&name).then(|| name.to_owned());
    choice(parser, "--workspace", named, &known.join(" or "))
}

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
    /// Stops added before FLIP looks.
    pub exposure: f32,
    /// One JSON object on stdout instead of a table.
    pub json: bool,
}

/// What `--map` may be.
const MAPS: &str = "signed, absolute, relative, squared-relative or flip";

fn parse_compare(mut parser: lexopt::Parser) -> Result<Command, CliError> {
    let mut files = Vec::<PathBuf>::new();
    let (mut heatmap, mut map, mut scale, mut exposure, mut json) = (None, ErrorMetric::default(), None, 0.0, false);
    while let Some(arg) = parser.next()? {
        match arg {
            Value(file) if files.len() < 2 => files.push(file.into()),
            Long("heatmap") => heatmap = Some(PathBuf::from(parser.value()?)),
            Long("map") => map = choice(&mut parser, "--map", ErrorMetric::named, MAPS)?,
            Long("scale") => scale = Some(number(&mut parser, "--scale", "a number above 0", |v| v > 0.0)?),
            Long("exposure") => {
                exposure = number(&mut parser, "--exposure", "stops from -30 to 30", |v| v.abs() <= 30.0)?;
            }
            Long("json") => json = true,
            Long("help") => return Ok(Command::Print(help::HELP)),
            other => return Err(other.unexpected().into()),
        }
    }
    let mut files = files.into_iter();
    let (Some(film), reference) = (files.next(), files.next()) else {
        return usage("compare takes two pictures, visavis compare A B, or one to compare with its reference");
    };
    if let Some(out) = heatmap.as_ref().filter(|out| Kind::of(out).is_none()) {
        return usage(format!("--heatmap must end in .png or .exr: {}", out.display()));
    }
    Ok(Command::Compare(CompareArgs { film, reference, heatmap, map, scale, exposure, json }))
}

/// `visavis check`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CheckArgs {
    /// Whether to look coarsely.
    pub quick: bool,
    /// Whether the graphics device is checked, in those of the cases that it renders.
    pub on_gpu: bool,
    /// Numbers of the cases to run; empty for all.
    pub cases: Vec<u32>,
    /// One JSON object on stdout instead of a table.
    pub json: bool,
}

fn parse_check(mut parser: lexopt::Parser) -> Result<Command, CliError> {
    let mut args = CheckArgs { quick: false, on_gpu: false, cases: Vec::new(), json: false };
    while let Some(arg) = parser.next()? {
        match arg {
            Long("quick") => args.quick = true,
            Long("json") => args.json = true,
            Long("device") => {
                let device = |name: &str| ["auto", "cpu", "gpu"].contains(&name).then_some(name == "gpu");
                args.on_gpu = choice(&mut parser, "--device", device, "auto, cpu or gpu")?;
            }
            Long("lanes") => lanes(&mut parser)?,
            Long("case") => args.cases = cases(&parser.value()?.string()?)?,
            Long("help") => return Ok(Command::Print(help::HELP)),
            other => return Err(other.unexpected().into()),
        }
    }
    Ok(Command::Check(args))
}

fn cases(word: &str) -> Result<Vec<u32>, CliError> {
    let known = |number: &u32| check::CASES.iter().any(|case| case.number == *number);
    let numbers: Option<Vec<u32>> = word.split(',').map(|n| n.trim().parse().ok().filter(known)).collect();
    let most = check::CASES.len();
    numbers.map_or_else(|| usage(format!("--case {word}: expected numbers from 1 to {most}, like 4 or 4,5")), Ok)
}
