//! The options of `visavis render`: those of every technique, of the truth and of the fake.

use super::usage;
use super::values::{choice, number, parse_finite, parse_whole, point, size, text, whole, within};
use crate::cli::{CliError, Command, help};
use crate::picture_file::Kind;
use crate::technique::{FakeSettings, PaneSettings, SceneChanges, Technique};
use lexopt::prelude::*;
use pathtrace::{Estimator, Roulette};
use raster::{Fake, FakeKnobs, Shading, ShadowFilter, Show};
use scene::Vec3;
use std::path::PathBuf;

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

/// What `--estimator` may be.
const ESTIMATORS: &str = "uniform, cosine, light, mis, uniform-light or uniform-mis";

pub fn parse(mut parser: lexopt::Parser) -> Result<Command, CliError> {
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
            Long("help") => return Ok(Command::Print(help::HELP)),
            Long("device") => device = choice(&mut parser, "--device", Device::named, "auto, cpu or gpu")?,
            Long(option) => {
                let option = option.to_owned();
                if let Some(option) = of_the_truth(&option, &mut parser, &mut r)? {
                    of_path.push(option);
                } else if let Some(option) = of_the_fake(&option, &mut parser, &mut r.pane.fake)? {
                    of_raster.push(option);
                } else if !of_all(&option, &mut parser, &mut r)? {
                    return Err(Long(&option).unexpected().into());
                }
            }
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

/// Reads an option of every technique; `false` if it is none.
fn of_all(option: &str, parser: &mut lexopt::Parser, r: &mut RenderArgs) -> Result<bool, CliError> {
    match option {
        "technique" => r.pane.technique = choice(parser, "--technique", Technique::named, "raster or path")?,
        "size" => r.size = size(&text(parser)?)?,
        "eye" => r.eye = Some(point(parser, "--eye")?),
        "target" => r.target = Some(point(parser, "--target")?),
        "fov" => r.fov = Some(number(parser, "--fov", "degrees between 0 and 180", |v| v > 0.0 && v < 180.0)?),
        "refraction-ratio" => {
            r.changes.refraction_ratio = Some(number(parser, "--refraction-ratio", "a number above 0", |v| v > 0.0)?);
        }
        "exposure" => r.exposure = number(parser, "--exposure", "stops from -30 to 30", |v| v.abs() <= 30.0)?,
        "json" => r.json = true,
        _ => return Ok(false),
    }
    Ok(true)
}

/// Reads an option of the path tracer and returns its name; `None` if it is none.
fn of_the_truth(
    option: &str,
    parser: &mut lexopt::Parser,
    r: &mut RenderArgs,
) -> Result<Option<&'static str>, CliError> {
    let path = &mut r.pane.truth.path;
    let name = match option {
        "spp" => {
            r.spp = Some(whole(parser, "--spp", 1)?);
            "--spp"
        }
        "time" => {
            let seconds = number(parser, "--time", "seconds above 0 and at most 1e9", |v| v > 0.0 && v <= 1e9)?;
            r.seconds = Some(f64::from(seconds));
            "--time"
        }
        "bounces" => {
            let word = text(parser)?;
            path.bounces = if word == "inf" { None } else { Some(parse_whole(&word, "--bounces", 0, " or inf")?) };
            "--bounces"
        }
        "roulette" => {
            path.roulette = roulette(&text(parser)?)?;
            "--roulette"
        }
        "estimator" => {
            path.estimator = choice(parser, "--estimator", Estimator::named, ESTIMATORS)?;
            "--estimator"
        }
        "sun-radius" => {
            let below_90 = |v| (0.0..90.0).contains(&v);
            r.changes.sun_radius = Some(number(parser, "--sun-radius", "degrees from 0 to below 90", below_90)?);
            "--sun-radius"
        }
        "seed" => {
            path.seed = whole(parser, "--seed", 0)?;
            "--seed"
        }
        _ => return Ok(None),
    };
    Ok(Some(name))
}

/// Reads an option of the fake and returns its name; `None` if it is none.
fn of_the_fake(
    option: &str,
    parser: &mut lexopt::Parser,
    fake: &mut FakeSettings,
) -> Result<Option<&'static str>, CliError> {
    let knobs = &mut fake.knobs;
    let name = match option {
        "fake" => {
            fake.fake = choice(parser, "--fake", Fake::named, "fair or as-taught")?;
            "--fake"
        }
        "shading" => {
            fake.shading = choice(parser, "--shading", Shading::named, "three, phong or blinn-phong")?;
            "--shading"
        }
        "reflectivity" => {
            fake.reflectivity = Some(within(parser, "--reflectivity", &(0.0..=1.0))?);
            "--reflectivity"
        }
        "shininess" => {
            knobs.shininess = Some(within(parser, "--shininess", &FakeKnobs::SHININESS)?);
            "--shininess"
        }
        "ambient" => {
            knobs.ambient = Some(within(parser, "--ambient", &FakeKnobs::AMBIENT)?);
            "--ambient"
        }
        "cube-map" => {
            knobs.cube_map = Some(within(parser, "--cube-map", &FakeKnobs::CUBE_MAP)?);
            "--cube-map"
        }
        "shadow-map" => {
            knobs.shadow_map = Some(within(parser, "--shadow-map", &FakeKnobs::SHADOW_MAP)?);
            "--shadow-map"
        }
        "shadow-filter" => {
            knobs.filter = choice(parser, "--shadow-filter", ShadowFilter::named, "hard, pcf or pcf-soft")?;
            "--shadow-filter"
        }
        "shadow-bias" => {
            knobs.bias = within(parser, "--shadow-bias", &FakeKnobs::BIAS)?;
            "--shadow-bias"
        }
        "segments" => {
            knobs.segments = Some(within(parser, "--segments", &FakeKnobs::SEGMENTS)?);
            "--segments"
        }
        "show" => {
            fake.show = choice(parser, "--show", Show::named, "picture, cube-faces or shadow-map")?;
            "--show"
        }
        _ => return Ok(None),
    };
    Ok(Some(name))
}

/// "off", "throughput", a probability, or both as "0.8+throughput".
fn roulette(word: &str) -> Result<Roulette, CliError> {
    let probability = |word: &str| parse_finite(word).filter(|p| *p > 0.0 && *p <= 1.0);
    let (first, both) = word.strip_suffix("+throughput").map_or((word, false), |first| (first, true));
    match (word, probability(first)) {
        ("off", _) => Ok(Roulette::OFF),
        ("throughput", _) => Ok(Roulette::THROUGHPUT),
        (_, Some(p)) => Ok(Roulette { probability: Some(p), throughput: both }),
        _ => usage(format!(
            "--roulette {word}: expected a probability above 0 and at most 1, throughput, both as P+throughput, or off"
        )),
    }
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
