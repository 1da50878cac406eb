//! The words after `sweep`.

use super::options::{CommandOption, Typed, read, set_in_the_scene};
use super::seen::{self, Seen};
use super::usage;
use super::values::{DEVICES, choice, number, seconds, shown, text};
use crate::cli::{CliError, Command};
use crate::model::{Axis, SWEEPS, SweepMeasure, SweepPlan, SweepPreset};
use image_file::Kind;
use lexopt::ValueExt;
use scene::Scene;
use std::ffi::OsString;
use std::path::PathBuf;
use technique::settings::of_panes;
use technique::{DeviceChoice, PaneSettings, PaneSetup, Technique, TechniqueName};

/// `visavis sweep SCENE NAME=V1,V2,... -o OUT.png ...`.
#[derive(Debug, Clone, PartialEq)]
#[expect(missing_docs, reason = "each field is the option of its name, described in --help")]
pub struct SweepArgs {
    pub scene: String,
    /// What is varied from column to column, and from row to row.
    pub axes: [Axis; 2],
    /// What all tiles are set to.
    pub of: PaneSetup,
    pub out: PathBuf,
    pub csv: Option<PathBuf>,
    pub seen: Seen,
    pub device: DeviceChoice,
    pub seconds: Option<f32>,
    pub exposure: f32,
    pub errors: Option<SweepMeasure>,
    pub json: bool,
    pub jobs: bool,
}

/// The words on their way.
pub struct Reading {
    args: SweepArgs,
    of: Option<PaneSetup>,
    spp: Option<u32>,
    out: Option<PathBuf>,
    preset: Option<&'static SweepPreset>,
}

impl AsMut<Seen> for Reading {
    fn as_mut(&mut self) -> &mut Seen {
        &mut self.args.seen
    }
}

pub fn options() -> Vec<CommandOption<Reading>> {
    let mut options = of_tiles();
    options.extend(seen::options());
    options.extend(of_files());
    options
}

fn of_tiles() -> Vec<CommandOption<Reading>> {
    vec![
        CommandOption {
            names: &["-o"],
            value: "OUT.png",
            help: "the picture of all tiles, each pixel for pixel, with captions; its records say how each is made",
            read: |reading, parser| {
                reading.out = Some(PathBuf::from(parser.value()?));
                Ok(())
            },
        },
        CommandOption {
            names: &["--of"],
            value: "SPEC",
            help: "what all tiles are set to, as --b of the window: a technique or a preset, its choices and NAME=VALUE \
                   (default path)",
            read: |reading, parser| {
                let words = text(parser)?;
                match PaneSetup::parse(&words, TechniqueName::Path) {
                    Ok(setup) => reading.of = Some(setup),
                    Err(fault) => return usage(format!("--of {}: {fault}", shown(&words))),
                }
                Ok(())
            },
        },
        CommandOption {
            names: &["--ready"],
            value: "NAME",
            help: "what is varied, and of what, as the window has it ready: bounces (0, 1, 2 at 20 spp), spp (1, 4, 16), estimators, \
                   samplers, roulettes, integrators, denoisers or mis (light sampling, BSDF sampling and both)",
            read: |reading, parser| {
                let names: Vec<_> = SWEEPS.iter().map(|preset| preset.name).collect();
                reading.preset = Some(choice(parser, "--ready", SweepPreset::named, &names.join(", "))?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--spp"],
            value: "N",
            help: "samples per pixel of every tile (default what --of says)",
            read: |reading, parser| {
                let word = text(parser)?;
                match word.parse() {
                    Ok(spp) if spp > 0 => reading.spp = Some(spp),
                    _ => return usage(format!("--spp {}: expected a whole number from 1", shown(&word))),
                }
                Ok(())
            },
        },
        CommandOption {
            names: &["--time"],
            value: "SECONDS",
            help: "rendering time of every tile, in place of a number of samples; not of several runs, which end with their samples",
            read: |reading, parser| {
                reading.args.seconds = Some(seconds(parser)? as f32);
                Ok(())
            },
        },
        CommandOption {
            names: &["--device"],
            value: "auto|cpu|gpu",
            help: "where rays are traced, as of render (default auto)",
            read: |reading, parser| {
                reading.args.device = choice(parser, "--device", DeviceChoice::named, DEVICES)?;
                Ok(())
            },
        },
    ]
}

fn of_files() -> Vec<CommandOption<Reading>> {
    vec![
        CommandOption {
            names: &["--exposure"],
            value: "EV",
            help: "stops added before display (default 0)",
            read: |reading, parser| {
                reading.args.exposure = number(parser, "--exposure", "stops from -30 to 30", |v| v.abs() <= 30.0)?;
                Ok(())
            },
        },
        CommandOption {
            names: &["--errors"],
            value: "relMSE|RMSE|FLIP",
            help: "measure every tile against the scene's reference, which is made if it is not there; captions tell this figure, and \
                   the best is marked where the reference's noise is small enough to tell",
            read: |reading, parser| {
                let named = |name: &str| SweepMeasure::ALL.into_iter().find(|measure| measure.name() == name);
                reading.args.errors = Some(choice(parser, "--errors", named, "relMSE, RMSE or FLIP")?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--csv"],
            value: "FILE",
            help: "write the captions with all errors as a table too",
            read: |reading, parser| {
                reading.args.csv = Some(PathBuf::from(parser.value()?));
                Ok(())
            },
        },
        CommandOption {
            names: &["--jobs"],
            value: "",
            help: "render nothing, but print for each tile the line of render that makes it, for as many machines or jobs: of \
                   OUT.png they make OUT.1.png and so on (docs/many-machines.md)",
            read: |reading, _| {
                reading.args.jobs = true;
                Ok(())
            },
        },
        CommandOption {
            names: &["--json"],
            value: "",
            help: "print one JSON object about the tiles on stdout",
            read: |reading, _| {
                reading.args.json = true;
                Ok(())
            },
        },
    ]
}

/// A scene and two axes.
const MOST_WORDS: usize = 3;

pub fn parse(parser: lexopt::Parser) -> Result<Command, CliError> {
    let blank = SweepArgs {
        scene: String::new(),
        axes: Default::default(),
        of: PaneSetup::of(TechniqueName::Path),
        out: PathBuf::new(),
        csv: None,
        seen: Seen::default(),
        device: DeviceChoice::Auto,
        seconds: None,
        exposure: 0.0,
        errors: None,
        json: false,
        jobs: false,
    };
    let reading = Reading { args: blank, of: None, spp: None, out: None, preset: None };
    let in_the_scene = |reading: &mut Reading, name: &str, parser: &mut lexopt::Parser| {
        set_in_the_scene(&mut reading.args.seen, name, parser)
    };
    let (mut reading, words) = match read(parser, reading, &options(), MOST_WORDS, in_the_scene)? {
        Typed::Words(reading, words) => (reading, words),
        Typed::Print(text) => return Ok(Command::Print(text)),
    };
    let mut words = words.into_iter().map(OsString::string);
    let Some(scene) = words.next().transpose()? else {
        return usage("sweep needs a scene: visavis sweep SCENE NAME=V1,V2,... -o OUT.png");
    };
    if scene.contains('=') && Axis::parse(&scene).is_ok() {
        return usage(format!("sweep needs a scene before what is varied: visavis sweep SCENE {scene} -o OUT.png"));
    }
    for (axis, word) in reading.args.axes.iter_mut().zip(words) {
        *axis = Axis::parse(&word?).or_else(usage)?;
    }
    take_preset(&mut reading)?;
    if reading.args.axes[0].is_empty() {
        return usage(
            "sweep needs what is varied, NAME=V1,V2,... with a setting of render or technique, or --ready NAME",
        );
    }
    let Some(out) = reading.out.take() else { return usage("sweep needs a file to write: -o OUT.png") };
    if Kind::of(&out) != Some(Kind::Png) {
        return usage(format!("-o must end in .png: {}", image_file::shown(&out)));
    }
    take_spp(&mut reading)?;
    let args = SweepArgs { scene, out, of: reading.of.unwrap_or(reading.args.of), ..reading.args };
    args.check()?;
    Ok(Command::Sweep(Box::new(args)))
}

/// What is ready, but for what is said beside it.
fn take_preset(reading: &mut Reading) -> Result<(), CliError> {
    let Some(preset) = reading.preset else { return Ok(()) };
    if !reading.args.axes[0].is_empty() {
        let (name, axis) = (preset.name, reading.args.axes[0].text());
        return usage(format!("--ready {name} and {axis} both say what is varied: leave one out"));
    }
    reading.args.axes = [Axis::new(preset.columns.0, preset.columns.1), preset.rows()];
    reading.of.get_or_insert_with(|| preset.base());
    if reading.spp.is_none() {
        reading.args.seconds = reading.args.seconds.or(preset.seconds);
    }
    Ok(())
}

fn take_spp(reading: &mut Reading) -> Result<(), CliError> {
    let Some(spp) = reading.spp else { return Ok(()) };
    if reading.args.axes.iter().any(|axis| axis.setting == "spp") {
        return usage(format!("--spp {spp}: spp is what is varied"));
    }
    if let Some(seconds) = reading.args.seconds {
        return usage(format!("--spp {spp} and --time {seconds} both say when a tile is done: leave one out"));
    }
    let of = reading.of.get_or_insert(PaneSetup::of(TechniqueName::Path));
    of.set("spp", &spp.to_string()).or_else(|why| usage(format!("--spp {spp}: {why}")))
}

impl SweepArgs {
    /// The tiles, in this scene or as far as they are the same in all.
    ///
    /// # Errors
    /// What cannot be made: one line.
    pub fn plan(&self, scene: Option<&Scene>) -> Result<SweepPlan, String> {
        SweepPlan::of(&self.base(scene), [&self.axes[0], &self.axes[1]], self.seconds)
    }

    /// What all tiles are set to, but for what is varied.
    pub fn base(&self, scene: Option<&Scene>) -> PaneSettings {
        let mut base = PaneSettings::of(TechniqueName::Path);
        // other techniques too have what the scene asks for
        scene.into_iter().for_each(|scene| base.take_usual_estimator(scene));
        self.of.add_to(&mut base);
        base.device = self.device;
        base
    }

    /// An option that a list of jobs has no use for.
    fn beside_jobs(&self) -> Option<&'static str> {
        let given = [("--errors", self.errors.is_some()), ("--csv", self.csv.is_some()), ("--json", self.json)];
        given.into_iter().find(|(_, given)| *given).map(|(option, _)| option)
    }

    /// What no scene would mend.
    fn check(&self) -> Result<(), CliError> {
        let plan = self.plan(None).or_else(usage)?;
        for tile in &plan.tiles {
            match tile.pane.in_use() {
                Technique::Fake(_) if self.device == DeviceChoice::Cpu => {
                    return usage("--device cpu: the fake is drawn by the gpu only");
                }
                Technique::Traced(traced) if self.device == DeviceChoice::Gpu => {
                    if let Some(why) = traced.needs_the_processor() {
                        return usage(format!("--device gpu: {}: {why}", tile.name()));
                    }
                }
                Technique::Fake(_) | Technique::Traced(_) => {}
            }
        }
        if self.jobs && self.seconds.is_some() {
            return usage("--jobs: equal time is told apart on one machine alone; say --spp N in place of --time");
        }
        if let Some(option) = self.beside_jobs().filter(|_| self.jobs) {
            return usage(format!("--jobs renders nothing, and {option} speaks of what is rendered: leave one out"));
        }
        let spp = of_panes("spp").filter(|row| plan.tiles.iter().any(|tile| row.is_of(tile.pane.technique)));
        if self.seconds.is_some() && spp.is_none() {
            return usage("--time: the fake takes the time that it takes");
        }
        Ok(())
    }
}
