//! The options of `visavis render`: those of every technique, of the truth and of the fake.

use super::seen::{Seen, parse_seen};
use super::usage;
use super::values::{DEVICES, choice, lanes, number, parse_finite, parse_whole, seconds, text, whole, within};
use crate::cli::{CliError, Command, help};
use crate::technique::{DeviceChoice, PaneSettings, Technique, made_from};
use anyhow::Context;
use image_file::{self, Kind};
use lexopt::prelude::*;
use pathtrace::{Estimator, GlassShadows, Roulette, SamplerKind, WhittedSettings};
use raster::{Fake, FakeKnobs, Shading, ShadowFilter, Show};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// `visavis render SCENE -o OUT ...`; `None` leaves a value to the scene.
#[derive(Debug, Clone, PartialEq)]
#[expect(missing_docs, reason = "each field is the option of its name, described in --help")]
pub struct RenderArgs {
    pub scene: String,
    pub out: PathBuf,
    /// Technique and settings; their spp is not read here, but [`RenderArgs::spp`].
    pub pane: PaneSettings,
    pub seen: Seen,
    /// Where rays are traced.
    pub device: DeviceChoice,
    pub spp: Option<u32>,
    pub seconds: Option<f64>,
    pub exposure: f32,
    pub errors: bool,
    pub json: bool,
    /// Options given that this technique ignores.
    pub without_effect: Vec<&'static str>,
    /// Whether the estimator was chosen; if not it is the one that the scene asks for.
    pub chose_estimator: bool,
}

/// What `--estimator` may be.
const ESTIMATORS: &str = "uniform, cosine, light, mis, uniform-light or uniform-mis";

/// The name of an option that was read, and the techniques that it changes.
type Applies = (&'static str, &'static [Technique]);

const RASTER: &[Technique] = &[Technique::Raster];
const WHITTED: &[Technique] = &[Technique::Whitted];
const PATH: &[Technique] = &[Technique::Path];
const RAYS: &[Technique] = &[Technique::Whitted, Technique::Path];
const LOCAL: &[Technique] = &[Technique::Raster, Technique::Whitted];

/// Reads the words after `render`. A picture after `--from` comes first: what else is said changes what it says.
pub fn parse(mut parser: lexopt::Parser) -> Result<Command, CliError> {
    let mut words: Vec<OsString> = parser.raw_args()?.collect();
    let Some(place) = words.iter().position(|word| word.to_string_lossy().split('=').next() == Some("--from")) else {
        return parse_words(words, None);
    };
    let (file, taken) = match (words[place].to_string_lossy().strip_prefix("--from="), words.get(place + 1)) {
        (Some(file), _) => (PathBuf::from(file), 1),
        (None, Some(file)) => (PathBuf::from(file), 2),
        (None, None) => return usage("--from needs a picture: visavis render --from FILE -o OUT"),
    };
    words.drain(place..place + taken);
    let (before, made) = read_records(&file)?;
    words.splice(0..0, made);
    let mut command = parse_words(words, Some(before.scene.clone()))?;
    if let Command::Render(render) = &mut command {
        // what a picture says of itself was not asked for just now
        render.without_effect.retain(|option| !before.without_effect.contains(option));
    }
    Ok(command)
}

/// What a picture was made by, as its records say.
///
/// # Errors
/// If it cannot be read, or does not say.
pub fn made_by(file: &Path) -> anyhow::Result<RenderArgs> {
    Ok(read_records(file)?.0)
}

/// What a picture was made by, read and as words.
fn read_records(file: &Path) -> anyhow::Result<(RenderArgs, Vec<OsString>)> {
    let records = image_file::records(file)?;
    let made = made_from(&records).with_context(|| format!("cannot read how it was made: {}", file.display()))?;
    let Some((scene, words)) = made else {
        anyhow::bail!("this picture does not say how it was made: {}", file.display());
    };
    let words: Vec<OsString> = words.into_iter().map(OsString::from).collect();
    let alone = words.iter().cloned().chain(["-o".into(), "out.png".into()]).collect();
    match parse_words(alone, Some(scene)) {
        Ok(Command::Render(render)) => Ok((*render, words)),
        Ok(_) => anyhow::bail!("its records are no options of render: {}", file.display()),
        Err(fault) => anyhow::bail!("its records make no picture ({}): {}", fault.line(), file.display()),
    }
}

/// Reads words; `scene` is the one to render, if it is not among them.
fn parse_words(words: Vec<OsString>, scene: Option<String>) -> Result<Command, CliError> {
    let mut parser = lexopt::Parser::from_args(words);
    let mut scene = scene;
    let mut out = None;
    let mut read: Vec<Applies> = Vec::new();
    let mut r = RenderArgs {
        scene: String::new(),
        out: PathBuf::new(),
        pane: PaneSettings::of(Technique::Path),
        seen: Seen::default(),
        device: DeviceChoice::Auto,
        spp: None,
        seconds: None,
        exposure: 0.0,
        errors: false,
        json: false,
        without_effect: Vec::new(),
        chose_estimator: false,
    };
    while let Some(arg) = parser.next()? {
        match arg {
            Value(word) if scene.is_none() => scene = Some(word.string()?),
            Short('o') => out = Some(PathBuf::from(parser.value()?)),
            Long("help") => return Ok(Command::Print(help::HELP)),
            Long("device") => r.device = choice(&mut parser, "--device", DeviceChoice::named, DEVICES)?,
            Long(option) => {
                let option = option.to_owned();
                if !of_all(&option, &mut parser, &mut r)? {
                    let of_some = match of_rays(&option, &mut parser, &mut r)? {
                        None => of_the_fake(&option, &mut parser, &mut r.pane)?,
                        of_rays => of_rays,
                    };
                    read.push(of_some.ok_or_else(|| Long(&option).unexpected())?);
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
    let technique = r.pane.technique;
    if technique == Technique::Raster && r.device == DeviceChoice::Cpu {
        return usage(format!("--technique {} runs on the gpu only", technique.name()));
    }
    // only the processor has lanes
    if r.device == DeviceChoice::Auto && read.iter().any(|(option, _)| *option == "--lanes") {
        r.device = DeviceChoice::Cpu;
    }
    if let (Technique::Path, Err(fault)) = (technique, r.pane.truth.path.check()) {
        return usage(fault.to_string());
    }
    (r.scene, r.out) = (scene, out);
    r.without_effect = read.into_iter().filter(|(_, of)| !of.contains(&technique)).map(|(name, _)| name).collect();
    Ok(Command::Render(Box::new(r)))
}

/// Reads an option of every technique; `false` if it is none.
fn of_all(option: &str, parser: &mut lexopt::Parser, r: &mut RenderArgs) -> Result<bool, CliError> {
    match option {
        "technique" => r.pane.technique = choice(parser, "--technique", Technique::named, "raster, whitted or path")?,
        "exposure" => r.exposure = number(parser, "--exposure", "stops from -30 to 30", |v| v.abs() <= 30.0)?,
        "errors" => r.errors = true,
        "json" => r.json = true,
        // a size of the sun is no option of the fake
        "sun-radius" => return Ok(false),
        seen => return parse_seen(seen, parser, &mut r.seen),
    }
    Ok(true)
}

/// Reads an option of the path tracer or of Whitted's method; `None` if it is none.
fn of_rays(option: &str, parser: &mut lexopt::Parser, r: &mut RenderArgs) -> Result<Option<Applies>, CliError> {
    let (path, tree) = (&mut r.pane.truth.path, &mut r.pane.whitted.tree);
    let applies: Applies = match option {
        "spp" => {
            r.spp = Some(whole(parser, "--spp", 1)?);
            ("--spp", RAYS)
        }
        "time" => {
            r.seconds = Some(seconds(parser)?);
            ("--time", RAYS)
        }
        "sun-radius" => {
            parse_seen(option, parser, &mut r.seen)?;
            ("--sun-radius", RAYS)
        }
        "lanes" => {
            lanes(parser)?;
            ("--lanes", RAYS)
        }
        "seed" => {
            path.seed = whole(parser, "--seed", 0)?;
            tree.seed = path.seed;
            ("--seed", RAYS)
        }
        "sampler" => {
            path.sampler = choice(parser, "--sampler", SamplerKind::named, "independent or sobol")?;
            tree.sampler = path.sampler;
            ("--sampler", RAYS)
        }
        "bounces" => {
            let word = text(parser)?;
            path.bounces = if word == "inf" { None } else { Some(parse_whole(&word, "--bounces", 0, " or inf")?) };
            ("--bounces", PATH)
        }
        "roulette" => {
            path.roulette = roulette(&text(parser)?)?;
            ("--roulette", PATH)
        }
        "estimator" => {
            path.estimator = choice(parser, "--estimator", Estimator::named, ESTIMATORS)?;
            r.chose_estimator = true;
            ("--estimator", PATH)
        }
        "branches" => {
            path.branches = whole(parser, "--branches", 1)?;
            ("--branches", PATH)
        }
        "depth" => {
            tree.depth = within(parser, "--depth", &(0..=WhittedSettings::MOST_DEPTH))?;
            ("--depth", WHITTED)
        }
        "glass-shadows" => {
            tree.glass_shadows = choice(parser, "--glass-shadows", GlassShadows::named, "opaque or clear")?;
            ("--glass-shadows", WHITTED)
        }
        "shadow-rays" => {
            tree.shadow_rays = within(parser, "--shadow-rays", &(1..=1024))?;
            ("--shadow-rays", WHITTED)
        }
        _ => return Ok(None),
    };
    Ok(Some(applies))
}

/// Reads an option of the fake; `None` if it is none.
fn of_the_fake(
    option: &str,
    parser: &mut lexopt::Parser,
    pane: &mut PaneSettings,
) -> Result<Option<Applies>, CliError> {
    let fake = &mut pane.fake;
    let knobs = &mut fake.knobs;
    let name = match option {
        "ambient" => {
            knobs.ambient = Some(within(parser, "--ambient", &FakeKnobs::AMBIENT)?);
            pane.whitted.tree.ambient = knobs.ambient;
            return Ok(Some(("--ambient", LOCAL)));
        }
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
    Ok(Some((name, RASTER)))
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
