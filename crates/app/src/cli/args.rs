//! From words to commands.

use super::{CliError, Command, help};
use crate::picture_file::Kind;
use crate::technique::{PaneSettings, SceneChanges, Technique};
use crate::ui::Theme;
use lexopt::prelude::*;
use pathtrace::{Estimator, Roulette};
use raster::{Fake, Shading};
use scene::Vec3;
use std::ffi::OsString;
use std::path::PathBuf;
use std::str::FromStr;

/// `visavis [SCENE]`.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewArgs {
    /// A built-in name or a file.
    pub scene: String,
    /// Where to write the names, rectangles and states of the widgets, each frame, for tests.
    pub ui_dump: Option<PathBuf>,
    /// How the window looks at first.
    pub theme: Theme,
    /// Whether to print at the end what frames cost the UI thread.
    pub frame_stats: bool,
}

/// `visavis render SCENE -o OUT ...`; `None` leaves a value to the scene.
#[derive(Debug, Clone, PartialEq)]
#[expect(missing_docs, reason = "each field is the option of its name, described in --help")]
pub struct RenderArgs {
    pub scene: String,
    pub out: PathBuf,
    /// Technique and settings; their spp is not read here, but [`RenderArgs::spp`].
    pub pane: PaneSettings,
    pub changes: SceneChanges,
    pub size: (u32, u32),
    pub spp: Option<u32>,
    pub seconds: Option<f64>,
    pub eye: Option<Vec3>,
    pub target: Option<Vec3>,
    pub fov: Option<f32>,
    pub exposure: f32,
    pub json: bool,
    /// Options given that this technique ignores.
    pub without_effect: Vec<&'static str>,
}

/// Pixels that a picture may have at most: a film of them takes 8 GiB.
const MOST_PIXELS: u64 = 1 << 27;

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
            "render" => parse_render,
            "compare" => parse_compare,
            "bench" => parse_bench,
            "info" => |parser| nothing_more(parser, Command::Info),
            "check" => |_| usage("check is not built yet"),
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
    while let Some(arg) = parser.next()? {
        match arg {
            Value(word) if scene.is_none() => scene = Some(word.string()?),
            Long("ui-dump") => ui_dump = Some(PathBuf::from(parser.value()?)),
            Long("theme") => theme = choice(&mut parser, "--theme", Theme::named, "dark or projector")?,
            Long("frame-stats") => frame_stats = true,
            Long("help") | Short('h') => return Ok(Command::Print(help::HELP)),
            Long("version") | Short('V') => return Ok(Command::Print(help::VERSION)),
            other => return Err(other.unexpected().into()),
        }
    }
    let scene = scene.unwrap_or_else(|| "whitted".into());
    Ok(Command::View(ViewArgs { scene, ui_dump, theme, frame_stats }))
}

fn parse_compare(mut parser: lexopt::Parser) -> Result<Command, CliError> {
    let (mut files, mut json) = (Vec::<PathBuf>::new(), false);
    while let Some(arg) = parser.next()? {
        match arg {
            Value(file) if files.len() < 2 => files.push(file.into()),
            Long("json") => json = true,
            Long("help") => return Ok(Command::Print(help::HELP)),
            other => return Err(other.unexpected().into()),
        }
    }
    let Ok([film, reference]) = <[PathBuf; 2]>::try_from(files) else {
        return usage("compare takes two pictures: visavis compare A B");
    };
    Ok(Command::Compare { film, reference, json })
}

fn parse_bench(mut parser: lexopt::Parser) -> Result<Command, CliError> {
    let (mut folder, mut quick) = (None, false);
    while let Some(arg) = parser.next()? {
        match arg {
            Short('o') => folder = Some(PathBuf::from(parser.value()?)),
            Long("quick") => quick = true,
            Long("help") => return Ok(Command::Print(help::HELP)),
            other => return Err(other.unexpected().into()),
        }
    }
    match folder {
        Some(folder) if quick => Ok(Command::Bench { folder }),
        Some(_) => usage("only the quick bench is built so far: visavis bench --quick -o DIR"),
        None => usage("bench needs a folder for its results: visavis bench --quick -o DIR"),
    }
}

fn parse_render(mut parser: lexopt::Parser) -> Result<Command, CliError> {
    let mut scene = None;
    let mut out = None;
    let mut device = Device::Auto;
    let mut of_path: Vec<&'static str> = Vec::new();
    let mut of_raster: Vec<&'static str> = Vec::new();
    let mut r = RenderArgs {
        scene: String::new(),
        out: PathBuf::new(),
        pane: PaneSettings::of(Technique::Path),
        changes: SceneChanges::default(),
        size: (1280, 720),
        spp: None,
        seconds: None,
        eye: None,
        target: None,
        fov: None,
        exposure: 0.0,
        json: false,
        without_effect: Vec::new(),
    };
    while let Some(arg) = parser.next()? {
        match arg {
            Value(word) if scene.is_none() => scene = Some(word.string()?),
            Short('o') => out = Some(PathBuf::from(parser.value()?)),
            Long("technique") => {
                r.pane.technique = choice(&mut parser, "--technique", Technique::named, "raster or path")?
            }
            Long("device") => device = choice(&mut parser, "--device", Device::named, "auto, cpu or gpu")?,
            Long("size") => r.size = size(&text(&mut parser)?)?,
            Long("eye") => r.eye = Some(point(&mut parser, "--eye")?),
            Long("target") => r.target = Some(point(&mut parser, "--target")?),
            Long("fov") => {
                r.fov = Some(number(&mut parser, "--fov", "degrees between 0 and 180", |v| v > 0.0 && v < 180.0)?)
            }
            Long("refraction-ratio") => {
                r.changes.refraction_ratio =
                    Some(number(&mut parser, "--refraction-ratio", "a number above 0", |v| v > 0.0)?);
            }
            Long("exposure") => {
                r.exposure = number(&mut parser, "--exposure", "stops from -30 to 30", |v| v.abs() <= 30.0)?
            }
            Long("json") => r.json = true,
            Long("spp") => {
                of_path.push("--spp");
                r.spp = Some(whole(&mut parser, "--spp", 1)?);
            }
            Long("time") => {
                of_path.push("--time");
                r.seconds = Some(f64::from(number(&mut parser, "--time", "seconds above 0 and at most 1e9", |v| {
                    v > 0.0 && v <= 1e9
                })?));
            }
            Long("bounces") => {
                of_path.push("--bounces");
                let word = text(&mut parser)?;
                r.pane.truth.path.bounces =
                    if word == "inf" { None } else { Some(parse_whole(&word, "--bounces", 0, " or inf")?) };
            }
            Long("roulette") => {
                of_path.push("--roulette");
                r.pane.truth.path.roulette = roulette(&text(&mut parser)?)?;
            }
            Long("estimator") => {
                of_path.push("--estimator");
                r.pane.truth.path.estimator =
                    choice(&mut parser, "--estimator", Estimator::named, "uniform, cosine or light")?;
            }
            Long("sun-radius") => {
                of_path.push("--sun-radius");
                let radius =
                    number(&mut parser, "--sun-radius", "degrees from 0 to below 90", |v| (0.0..90.0).contains(&v))?;
                r.changes.sun_radius = Some(radius);
            }
            Long("seed") => {
                of_path.push("--seed");
                r.pane.truth.path.seed = whole(&mut parser, "--seed", 0)?;
            }
            Long("fake") => {
                of_raster.push("--fake");
                r.pane.fake.fake = choice(&mut parser, "--fake", Fake::named, "fair or as-taught")?;
            }
            Long("shading") => {
                of_raster.push("--shading");
                r.pane.fake.shading = choice(&mut parser, "--shading", Shading::named, "three, phong or blinn-phong")?;
            }
            Long("reflectivity") => {
                of_raster.push("--reflectivity");
                let share = number(&mut parser, "--reflectivity", "a share from 0 to 1", |v| (0.0..=1.0).contains(&v))?;
                r.pane.fake.reflectivity = Some(share);
            }
            Long("help") => return Ok(Command::Print(help::HELP)),
            other => return Err(other.unexpected().into()),
        }
    }
    let Some(scene) = scene else { return usage("render needs a scene: visavis render SCENE -o OUT") };
    let Some(out) = out else { return usage("render needs a file to write: -o OUT.png or -o OUT.exr") };
    if Kind::of(&out).is_none() {
        return usage(format!("-o must end in .png or .exr: {}", out.display()));
    }
    match (r.pane.technique, device) {
        (Technique::Raster, Device::Cpu) => return usage("--technique raster runs on the gpu only"),
        (Technique::Path, Device::Gpu) => return usage("--technique path runs on the cpu only"),
        _ => {}
    }
    (r.scene, r.out) = (scene, out);
    r.without_effect = if r.pane.technique == Technique::Path { of_raster } else { of_path };
    Ok(Command::Render(Box::new(r)))
}

#[derive(Clone, Copy)]
enum Device {
    Auto,
    Cpu,
    Gpu,
}

impl Device {
    fn named(name: &str) -> Option<Self> {
        match name {
            "auto" => Some(Device::Auto),
            "cpu" => Some(Device::Cpu),
            "gpu" => Some(Device::Gpu),
            _ => None,
        }
    }
}

fn text(parser: &mut lexopt::Parser) -> Result<String, CliError> {
    Ok(parser.value()?.string()?)
}

fn choice<T>(
    parser: &mut lexopt::Parser,
    option: &str,
    named: impl Fn(&str) -> Option<T>,
    expected: &str,
) -> Result<T, CliError> {
    let word = text(parser)?;
    named(&word).map_or_else(|| usage(format!("{option} {word}: expected {expected}")), Ok)
}

fn number(
    parser: &mut lexopt::Parser,
    option: &str,
    expected: &str,
    holds: impl Fn(f32) -> bool,
) -> Result<f32, CliError> {
    let word = text(parser)?;
    parse_finite(&word).filter(|v| holds(*v)).map_or_else(|| usage(format!("{option} {word}: expected {expected}")), Ok)
}

fn parse_finite(word: &str) -> Option<f32> {
    f32::from_str(word.trim()).ok().filter(|v| v.is_finite())
}

fn whole(parser: &mut lexopt::Parser, option: &str, least: u32) -> Result<u32, CliError> {
    parse_whole(&text(parser)?, option, least, "")
}

fn parse_whole(word: &str, option: &str, least: u32, or: &str) -> Result<u32, CliError> {
    let value = word.parse().ok().filter(|v| *v >= least);
    value
        .map_or_else(|| usage(format!("{option} {word}: expected a whole number from {least} to {}{or}", u32::MAX)), Ok)
}

fn roulette(word: &str) -> Result<Roulette, CliError> {
    match word {
        "off" => Ok(Roulette::Off),
        "throughput" => Ok(Roulette::Throughput),
        _ => match parse_finite(word).filter(|p| *p > 0.0 && *p <= 1.0) {
            Some(probability) => Ok(Roulette::Probability(probability)),
            None => {
                usage(format!("--roulette {word}: expected a probability above 0 and at most 1, throughput or off"))
            }
        },
    }
}

fn size(word: &str) -> Result<(u32, u32), CliError> {
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

fn point(parser: &mut lexopt::Parser, option: &str) -> Result<Vec3, CliError> {
    let word = text(parser)?;
    let numbers: Option<Vec<f32>> = word.split(',').map(parse_finite).collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) => Ok(Vec3::new(x, y, z)),
        _ => usage(format!("{option} {word}: expected three finite numbers, like 7.5,2.3,-4.2")),
    }
}
