//! The words of `visavis [SCENE]`.

use super::options::{CommandOption, Typed, read, set_in_the_scene};
use super::seen::{self, Seen};
use super::values::{DEVICES, choice, number, shown, text};
use super::{help, usage};
use crate::cli::{CliError, Command};
use crate::model::{CompareWith, PaneId, PaneSource, SLIDES, Session, Setup, Slide, Theme, View, ViewArgs};
use crate::ui::Workspaces;
use lexopt::ValueExt;
use std::ffi::OsString;
use std::path::PathBuf;
use technique::{DeviceChoice, PaneSetup};

/// The words on their way.
pub struct Reading {
    args: ViewArgs,
    /// Camera and changes of the scene; its size is the window's.
    seen: Seen,
    /// A text to print instead.
    print: Option<String>,
}

impl AsMut<ViewArgs> for Reading {
    fn as_mut(&mut self) -> &mut ViewArgs {
        &mut self.args
    }
}

impl AsMut<Seen> for Reading {
    fn as_mut(&mut self) -> &mut Seen {
        &mut self.seen
    }
}

pub fn options() -> Vec<CommandOption<Reading>> {
    of_what_is_seen().into_iter().chain(of_the_window()).collect()
}

/// Beside which --help lists what may be changed in the scene.
pub fn of_what_is_seen() -> Vec<CommandOption<Reading>> {
    let of_the_camera = seen::options().into_iter().filter(|option| !option.names.contains(&"--size"));
    of_a_lecture::<Reading>().into_iter().chain(of_the_camera).collect()
}

/// What is shown, and how it is made.
pub fn of_a_lecture<A: AsMut<ViewArgs>>() -> Vec<CommandOption<A>> {
    vec![
        CommandOption {
            names: &["--a"],
            value: "SPEC",
            help: "how A is made: a technique or a preset of render, its choices and NAME=VALUE of the settings of render, with \
                   commas between (default raster), like raster,as-taught,segments=40 or 2e-0-bounces,spp=64; or picture=FILE, another \
                   program's picture, read again whenever it changes; or received, what another program sends to \
                   127.0.0.1:14158 as to tev, or received=PORT",
            read: |reading, parser| a_pane(reading.as_mut(), PaneId::A, "--a", parser),
        },
        CommandOption {
            names: &["--b"],
            value: "SPEC",
            help: "the same of B (default path), like path,spp=64,bounces=2,mis",
            read: |reading, parser| a_pane(reading.as_mut(), PaneId::B, "--b", parser),
        },
        CommandOption {
            names: &["--slide"],
            value: "NAME",
            help: "a slide of the tutorial with its scene, A, B and view, of which --a, --b and --view change their part: phong, \
                   whitted, 1a, 1b, 1d, 1d-whitted, 2b, naive-n, 2c, 2e-0-1, 2e-1-2, roulette, 2f-1-4, 2f-4-16, 2f-1-16, \
                   denoise-1, denoise-512 or denoise-bias",
            read: |reading, parser| {
                let names: Vec<_> = SLIDES.iter().map(|slide| slide.name).collect();
                let slide = choice(parser, "--slide", Slide::named, &names.join(", "))?;
                match reading.as_mut().slide.replace(slide) {
                    Some(other) => usage(format!("--slide {}: --slide {} stands before it", slide.name, other.name)),
                    None => Ok(()),
                }
            },
        },
        CommandOption {
            names: &["--view"],
            value: "a|b|wipe|side|map",
            help: "what is shown: one of them, both, or where they differ (default wipe)",
            read: |reading, parser| {
                reading.as_mut().setup.view = Some(choice(parser, "--view", a_view, "a, b, wipe, side or map")?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--against"],
            value: "other|reference",
            help: "what A and B are held against: each the other, or the reference (default other)",
            read: |reading, parser| {
                reading.as_mut().setup.with = Some(choice(parser, "--against", a_judge, "other or reference")?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--exposure"],
            value: "EV",
            help: "stops added before display (default 0)",
            read: |reading, parser| {
                let stops = number(parser, "--exposure", "stops from -30 to 30", |v| v.abs() <= 30.0)?;
                reading.as_mut().setup.exposure = Some(stops);
                Ok(())
            },
        },
    ]
}

/// How the window looks, and what it tells.
pub fn of_the_window() -> Vec<CommandOption<Reading>> {
    vec![
        CommandOption {
            names: &["--theme"],
            value: "dark|light|projector",
            help: "light, or projector: black on white with large type (default dark)",
            read: |reading, parser| {
                reading.args.theme = Some(choice(parser, "--theme", Theme::named, "dark, light or projector")?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--device"],
            value: "auto|cpu|gpu",
            help: "where rays are traced at first; auto is the gpu, but the cpu where the adapter is software",
            read: |reading, parser| {
                reading.args.device = Some(choice(parser, "--device", DeviceChoice::named, DEVICES)?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--frame-stats"],
            value: "",
            help: "print at the end what a frame cost the window's thread (egui, tessellation, uploads) and how long it \
                   was from frame to frame while dragging",
            read: |reading, _| {
                reading.args.frame_stats = true;
                Ok(())
            },
        },
        // for tests
        CommandOption {
            names: &["--ui-dump"],
            value: "FILE",
            help: "",
            read: |reading, parser| {
                reading.args.ui_dump = Some(PathBuf::from(parser.value()?));
                Ok(())
            },
        },
        CommandOption {
            names: &["--workspace"],
            value: "compare|sweep|ladder|trees|cases",
            help: "what the window is used for at first: A against B, many pictures at once, one defect of the fake after the other, what a \
                   tree saves, or cases whose answers are known (default compare)",
            read: |reading, parser| {
                reading.args.workspace = Some(a_workspace(parser)?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--help", "-h"],
            value: "",
            help: "this text",
            read: |reading, _| {
                reading.print = Some(help::text());
                Ok(())
            },
        },
        CommandOption {
            names: &["--version", "-V"],
            value: "",
            help: "the version",
            read: |reading, _| {
                reading.print = Some(help::VERSION.into());
                Ok(())
            },
        },
    ]
}

pub fn parse(parser: lexopt::Parser) -> Result<Command, CliError> {
    let reading = Reading { args: blank(), seen: Seen::default(), print: None };
    match read(parser, reading, &options(), 1, |reading, name, parser| {
        set_in_the_scene(&mut reading.seen, name, parser)
    })? {
        Typed::Print(text) | Typed::Words(Reading { print: Some(text), .. }, _) => Ok(Command::Print(text)),
        Typed::Words(Reading { args, seen, .. }, words) => {
            let scene = words.into_iter().next().map(OsString::string).transpose()?;
            Ok(Command::View(Box::new(of_scene(args, seen, scene)?)))
        }
    }
}

/// What is shown before anything is asked for.
pub fn blank() -> ViewArgs {
    ViewArgs {
        scene: String::new(),
        setup: Setup::default(),
        slide: None,
        ui_dump: None,
        theme: None,
        device: None,
        workspace: None,
        frame_stats: false,
    }
}

/// The same of the scene that was named, or of the slide's, or of the usual one, as it is seen.
pub fn of_scene(args: ViewArgs, seen: Seen, scene: Option<String>) -> Result<ViewArgs, CliError> {
    let Seen { changes, camera, eye, target, up, fov, size: _ } = seen;
    let setup = Setup { changes, camera, eye, target, up, fov, ..args.setup };
    let scene = match (scene, args.slide) {
        (Some(scene), Some(slide)) => {
            let (slide, of) = (slide.name, slide.scene);
            return usage(format!("{scene} --slide {slide}: the scene of this slide is {of}; leave one of the two"));
        }
        (Some(scene), None) => scene,
        (None, slide) => slide.map_or("whitted", |slide| slide.scene).into(),
    };
    Ok(ViewArgs { scene, setup, ..args })
}

fn a_pane(args: &mut ViewArgs, pane: PaneId, option: &str, parser: &mut lexopt::Parser) -> Result<(), CliError> {
    let words = text(parser)?;
    let setup = &mut args.setup;
    if setup.panes.get(pane).is_some() || setup.sources.get(pane).is_some() {
        return usage(format!("{option} {words}: {option} is given twice"));
    }
    let usual = Session::default().panes[pane].technique;
    let taken = match PaneSource::parse(&words) {
        Some(source) => source.map(|source| drop(setup.sources.insert(pane, source))),
        None => PaneSetup::parse(&words, usual)
            .map(|made| drop(setup.panes.insert(pane, made)))
            .map_err(|fault| beside_sources(&fault)),
    };
    taken.or_else(|fault| usage(format!("{option} {}: {fault}", shown(&words))))
}

/// What is expected in the place of a pane's first word may be another program's picture too, of which its
/// settings do not know.
fn beside_sources(fault: &str) -> String {
    fault.replacen(", a preset (", ", another program's picture (picture=FILE, received, received=PORT), a preset (", 1)
}

fn a_view(name: &str) -> Option<View> {
    View::ALL.into_iter().find(|view| view.word() == name)
}

fn a_judge(name: &str) -> Option<CompareWith> {
    CompareWith::ALL.into_iter().find(|with| with.word() == name)
}

fn a_workspace(parser: &mut lexopt::Parser) -> Result<String, CliError> {
    let known = Workspaces::names();
    let named = |name: &str| known.contains(&name).then(|| name.to_owned());
    choice(parser, "--workspace", named, &known.join(" or "))
}
