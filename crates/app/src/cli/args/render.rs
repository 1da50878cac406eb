//! The options of `visavis render`: those of every technique, of what is traced and of the fake.

use super::options::{CommandOption, Typed, read, set};
use super::samples;
use super::seen::Seen;
use super::usage;
use super::values::{DEVICES, choice, lanes, number, seconds};
use crate::cli::original::Original;
use crate::cli::{CliError, Command};
use anyhow::Context;
use image_file::{self, Kind};
use lexopt::ValueExt;
use pathtrace::SettingsError;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use technique::settings::{all_of_panes, of_panes, of_scenes};
use technique::{
    DENOISE, Denoiser, DeviceChoice, EARLIER_VIEWS, FILTER, Halves, PaneSettings, Preset, Recorded, SampleRanges,
    Technique, TechniqueName, WEIGHTS, made_from, presets,
};

/// `visavis render SCENE -o OUT ...`; `None` leaves a value to the scene.
#[derive(Debug, Clone, PartialEq)]
#[expect(missing_docs, reason = "each field is the option of its name, described in --help")]
pub struct RenderArgs {
    pub scene: String,
    /// The picture that says so, if it is one.
    pub original: Option<Original>,
    pub out: PathBuf,
    /// Technique and settings; their spp is not read here, but [`RenderArgs::spp`].
    pub pane: PaneSettings,
    pub seen: Seen,
    /// Where rays are traced.
    pub device: DeviceChoice,
    pub spp: Option<u32>,
    pub samples: Option<SampleRanges>,
    pub jobs: Option<u32>,
    pub seconds: Option<f64>,
    pub exposure: f32,
    pub errors: bool,
    pub layers: bool,
    pub json: bool,
    /// Options given that this technique ignores.
    pub without_effect: Vec<String>,
    /// The names of the settings that were given.
    pub given: Vec<String>,
    /// Whether the estimator was chosen; if not it is the one that the scene asks for.
    pub chose_estimator: bool,
}

/// Samples per pixel where neither --spp nor --time says how many.
const DEFAULT_SPP: u32 = 64;

impl RenderArgs {
    /// `u32::MAX` where the time alone decides, which it does not within one of several runs.
    pub fn spp_wanted(&self) -> u32 {
        let the_time_decides = self.seconds.is_some() && self.pane.in_use().runs() == 1;
        self.spp.unwrap_or(if the_time_decides { u32::MAX } else { DEFAULT_SPP })
    }
}

/// The words after `render` on their way.
pub struct Reading {
    pub(super) args: RenderArgs,
    out: Option<PathBuf>,
    /// The options that were read, and the techniques that they change.
    pub(super) given: Vec<(String, &'static [TechniqueName])>,
    preset: Option<&'static Preset>,
}

impl AsMut<Seen> for Reading {
    fn as_mut(&mut self) -> &mut Seen {
        &mut self.args.seen
    }
}

pub(super) const TRACED: &[TechniqueName] = &[
    TechniqueName::Whitted,
    TechniqueName::Path,
    TechniqueName::Photon,
    TechniqueName::LightTracing,
    TechniqueName::Metropolis,
    TechniqueName::Normals,
];

/// Options of every technique, beside settings.
pub fn options() -> Vec<CommandOption<Reading>> {
    let mut options: Vec<CommandOption<Reading>> = vec![
        CommandOption {
            names: &["-o"],
            value: "OUT",
            help: "the file to write",
            read: |reading, parser| {
                reading.out = Some(PathBuf::from(parser.value()?));
                Ok(())
            },
        },
        CommandOption {
            names: &["--from"],
            value: "FILE",
            help: "make the picture in FILE (.png or .exr of this program) again, and say so if its scene has changed since; other \
                   options change it",
            // the first was read before
            read: |_, _| usage("--from is given twice: a picture is made from one"),
        },
        CommandOption {
            names: &["--technique"],
            value: "raster|whitted|path|photon|light-tracing|metropolis|normals",
            help: "the fake, Whitted's trees of rays, path tracing, photon mapping, light tracing, Metropolis' chains of paths, or the \
                   normals of what is seen (default path)",
            read: |reading, parser| {
                let expected = "raster, whitted, path, photon, light-tracing, metropolis or normals";
                reading.args.pane.technique = choice(parser, "--technique", TechniqueName::named, expected)?;
                reading.given.push(("--technique".into(), &TechniqueName::ALL));
                Ok(())
            },
        },
        CommandOption {
            names: &["--preset"],
            value: "NAME",
            help: "a technique with the settings of a slide, which other options change: as-taught, fair, phong, blinn-phong, \
                   whitted-1980, 2b-uniform, naive, naive-4, 2c-light, 2e-0-bounces, 2e-1-bounce, 2e-2-bounces, complete, \
                   2f-1-spp, 2f-4-spp, 2f-16-spp, unlimited, 1-spp, denoised-1-spp, 512-spp, denoised-512-spp or denoise-bias",
            read: |reading, parser| {
                let names: Vec<_> = presets::ALL.iter().map(|preset| preset.name).collect();
                let preset = choice(parser, "--preset", Preset::named, &names.join(", "))?;
                reading.preset = Some(preset);
                Ok(())
            },
        },
        CommandOption {
            names: &["--device"],
            value: "auto|cpu|gpu",
            help: "where: the fake needs the gpu; auto traces rays on the gpu if that is no software and there is enough to \
                   do (2^24 samples), else on the cpu (default auto)",
            read: |reading, parser| {
                reading.args.device = choice(parser, "--device", DeviceChoice::named, DEVICES)?;
                Ok(())
            },
        },
    ];
    options.extend(super::seen::options());
    options.extend([
        CommandOption::<Reading> {
            names: &["--exposure"],
            value: "EV",
            help: "stops added before display, PNG only (default 0)",
            read: |reading, parser| {
                reading.args.exposure = number(parser, "--exposure", "stops from -30 to 30", |v| v.abs() <= 30.0)?;
                Ok(())
            },
        },
        CommandOption {
            names: &["--errors"],
            value: "",
            help: "measure the picture against the scene's reference, which is made if it is not there",
            read: |reading, _| {
                reading.args.errors = true;
                Ok(())
            },
        },
        CommandOption {
            names: &["--layers"],
            value: "",
            help: "write albedo, normal and depth of what is seen beside the picture, as layers of these names, and half0 and half1, the \
                   means of either half of the samples of traced light; EXR only",
            read: |reading, _| {
                reading.args.layers = true;
                Ok(())
            },
        },
        CommandOption {
            names: &["--json"],
            value: "",
            help: "print one JSON object about the result on stdout",
            read: |reading, _| {
                reading.args.json = true;
                Ok(())
            },
        },
    ]);
    options
}

/// Options of some techniques that are no settings: how long to trace, and in what.
pub fn options_of_some() -> impl Iterator<Item = (&'static [TechniqueName], CommandOption<Reading>)> {
    let time = CommandOption::<Reading> {
        names: &["--time"],
        value: "SECONDS",
        help: "stop after this long, or at --spp if that is given and comes first",
        read: |reading, parser| {
            reading.args.seconds = Some(seconds(parser)?);
            reading.given.push(("--time".into(), TRACED));
            Ok(())
        },
    };
    let in_lanes = CommandOption::<Reading> {
        names: &["--lanes"],
        value: "avx512|avx2|array|scalar",
        help: "what rays are traced in: the same picture, sooner or later (default the widest)",
        read: |reading, parser| {
            lanes(parser)?;
            reading.given.push(("--lanes".into(), TRACED));
            Ok(())
        },
    };
    [time, in_lanes].into_iter().chain(samples::options()).map(|option| (TRACED, option))
}

/// Reads a setting; `false` if there is none of this name.
fn a_setting(reading: &mut Reading, name: &str, parser: &mut lexopt::Parser) -> Result<bool, CliError> {
    let of = if let Some(setting) = of_panes(name) {
        set(setting, &mut reading.args.pane, parser)?;
        setting.of
    } else if let Some(setting) = of_scenes(name) {
        set(setting, &mut reading.args.seen.changes, parser)?;
        setting.of
    } else {
        return Ok(false);
    };
    reading.given.push((format!("--{name}"), of));
    Ok(true)
}

/// Reads the words after `render`. A picture after `--from` comes first: what else is said changes what it says.
pub fn parse(mut parser: lexopt::Parser) -> Result<Command, CliError> {
    let words: Vec<OsString> = parser.raw_args()?.collect();
    samples::checked(parse_typed(words.clone())?, &words)
}

fn parse_typed(mut words: Vec<OsString>) -> Result<Command, CliError> {
    let Some(place) = words.iter().position(|word| word.to_string_lossy().split('=').next() == Some("--from")) else {
        return parse_words(words, None);
    };
    let (file, taken) = match (words[place].to_string_lossy().strip_prefix("--from="), words.get(place + 1)) {
        (Some(file), _) => (PathBuf::from(file), 1),
        (None, Some(file)) => (PathBuf::from(file), 2),
        (None, None) => return usage("--from needs a picture: visavis render --from FILE -o OUT"),
    };
    words.drain(place..place + taken);
    if words.iter().any(|word| word.to_string_lossy().split('=').next() == Some("--preset")) {
        return usage("--preset and --from both say how a picture is made: leave one out");
    }
    let (before, made) = read_records(&file)?;
    words.splice(0..0, samples::without_other_samples(made, &words));
    let mut command = parse_words(words, Some(before.scene.clone()))?;
    if let Command::Render(render) = &mut command {
        // what a picture says of itself was not asked for just now
        render.without_effect.retain(|option| !before.without_effect.contains(option));
        render.given.retain(|setting| !before.given.contains(setting));
        render.original = before.original;
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
    let made =
        made_from(&records).with_context(|| format!("cannot read how it was made: {}", image_file::shown(file)))?;
    let Some(Recorded { scene, scene_hash, options }) = made else {
        let holds = |name: &str| records.iter().any(|(known, _)| known == name);
        let why = match holds("A") && holds("B") {
            true => {
                "this picture holds two, A and B: open it in the window, or render what its record of one of them says"
            }
            false => "this picture does not say how it was made",
        };
        anyhow::bail!("{why}: {}", image_file::shown(file));
    };
    let record = |of: &str| records.iter().find(|(name, _)| name == of).map(|(_, value)| value.clone());
    let (earlier_views, denoise) = (record(EARLIER_VIEWS), record(DENOISE));
    let weights = denoise.as_deref().and_then(Denoiser::named).zip(record(WEIGHTS));
    let (halves, filter) = (Halves::samples_of(&records), record(FILTER));
    let original = Some(Original { file: file.to_owned(), scene: scene_hash, earlier_views, weights, halves, filter });
    let words: Vec<OsString> = options.into_iter().map(OsString::from).collect();
    let alone = words.iter().cloned().chain(["-o".into(), "out.png".into()]).collect();
    match parse_words(alone, Some(scene)) {
        Ok(Command::Render(render)) => Ok((RenderArgs { original, ..*render }, words)),
        Ok(_) => anyhow::bail!("its records are no options of render: {}", image_file::shown(file)),
        Err(fault) => anyhow::bail!("its records make no picture ({}): {}", fault.line(), image_file::shown(file)),
    }
}

/// A preset with the settings that were given beside it, wherever they stand.
fn beside_what_is_given(preset: &Preset, pane: &PaneSettings, is_given: &impl Fn(&str) -> bool) -> PaneSettings {
    let given = PaneSettings { technique: preset.technique, ..*pane };
    let mut with_preset = *pane;
    preset.apply(&mut with_preset);
    for setting in all_of_panes().filter(|setting| is_given(&format!("--{}", setting.name))) {
        (setting.get)(&given).into_iter().for_each(|value| with_preset.set(setting, value));
    }
    with_preset
}

/// Reads words; `scene` is the one to render, if it is not among them.
fn parse_words(words: Vec<OsString>, scene: Option<String>) -> Result<Command, CliError> {
    let blank = RenderArgs {
        scene: String::new(),
        original: None,
        out: PathBuf::new(),
        pane: PaneSettings::of(TechniqueName::Path),
        seen: Seen::default(),
        device: DeviceChoice::Auto,
        spp: None,
        samples: None,
        jobs: None,
        seconds: None,
        exposure: 0.0,
        errors: false,
        layers: false,
        json: false,
        without_effect: Vec::new(),
        given: Vec::new(),
        chose_estimator: false,
    };
    let mut options = options();
    options.extend(options_of_some().map(|(_, option)| option));
    let reading = Reading { args: blank, out: None, given: Vec::new(), preset: None };
    let most_words = usize::from(scene.is_none());
    let (Reading { mut args, out, given, preset }, words) =
        match read(lexopt::Parser::from_args(words), reading, &options, most_words, a_setting)? {
            Typed::Words(reading, words) => (reading, words),
            Typed::Print(text) => return Ok(Command::Print(text)),
        };
    let typed = words.into_iter().next().map(OsString::string).transpose()?;
    let Some(scene) = typed.or(scene) else {
        return usage("render needs a scene: visavis render SCENE -o OUT");
    };
    let Some(out) = out else { return usage("render needs a file to write: -o OUT.png or -o OUT.exr") };
    if Kind::of(&out).is_none() {
        return usage(format!("-o must end in .png or .exr: {}", image_file::shown(&out)));
    }
    if args.layers && Kind::of(&out) != Some(Kind::Exr) {
        return usage(format!("--layers needs a file that has layers, -o OUT.exr: {}", image_file::shown(&out)));
    }
    let is_given = |option: &str| given.iter().any(|(given, _)| given == option);
    if let Some(preset) = preset {
        if is_given("--technique") && args.pane.technique != preset.technique {
            let (name, technique) = (preset.name, preset.technique.name());
            return usage(format!("--preset {name} is a setting of {technique}: leave --technique out"));
        }
        args.pane = beside_what_is_given(preset, &args.pane, &is_given);
    }
    let states = |name: &str| preset.is_some_and(|preset| preset.values().any(|(setting, _)| setting.name == name));
    let technique = args.pane.technique;
    if technique == TechniqueName::Raster && args.device == DeviceChoice::Cpu {
        return usage(format!("--technique {} runs on the gpu only", technique.name()));
    }
    if let Technique::Traced(traced) = args.pane.in_use()
        && let Some(why) = traced.needs_the_processor()
        && args.device == DeviceChoice::Gpu
    {
        return usage(format!("--device gpu: {why}"));
    }
    if technique != TechniqueName::Raster && args.pane.fake.show.is_map() {
        let (map, technique) = (args.pane.fake.show.name(), technique.name());
        return usage(format!(
            "--show {map}: only the fake has maps; expected picture, albedo, normal, depth or trust with --technique {technique}"
        ));
    }
    if technique == TechniqueName::Raster && args.pane.denoise.shows_trust {
        return usage(
            "--show trust: the fake has no samples to trust; expected picture, albedo, normal, depth, cube-faces or shadow-map",
        );
    }
    // only the processor has lanes
    if args.device == DeviceChoice::Auto && is_given("--lanes") {
        args.device = DeviceChoice::Cpu;
    }
    if let Technique::Traced(traced) = args.pane.in_use()
        && let Err(fault) = traced.integrator.check()
    {
        return usage(match fault {
            SettingsError::GuidedChains(estimator) => format!("--estimator {estimator}: {fault}"),
            fault => fault.to_string(),
        });
    }
    args.chose_estimator = is_given("--estimator") || states("estimator");
    args.spp = if is_given("--spp") || states("spp") { args.pane.wished_spp() } else { None };
    args.spp = args.samples.as_ref().map(SampleRanges::count).or(args.spp);
    args.given = given.iter().filter_map(|(option, _)| Some(option.strip_prefix("--")?.to_owned())).collect();
    let ignored = given.into_iter().filter(|(_, of)| !of.contains(&technique));
    args.without_effect = ignored.map(|(option, _)| option).collect();
    Ok(Command::Render(Box::new(RenderArgs { scene, out, ..args })))
}
