//! The words of `visavis [SCENE]`.

use super::help;
use super::options::{CommandOption, Typed, no_more, read};
use super::values::{DEVICES, choice};
use crate::cli::{CliError, Command};
use crate::model::{Theme, ViewArgs};
use crate::ui::Workspaces;
use lexopt::ValueExt;
use std::ffi::OsString;
use std::path::PathBuf;
use technique::DeviceChoice;

/// The words on their way.
pub struct Reading {
    args: ViewArgs,
    /// A text to print instead.
    print: Option<String>,
}

pub fn options() -> Vec<CommandOption<Reading>> {
    vec![
        CommandOption {
            names: &["--theme"],
            value: "dark|light|projector",
            help: "light, or projector: black on white with large type (default dark)",
            read: |reading, parser| {
                reading.args.theme = choice(parser, "--theme", Theme::named, "dark, light or projector")?;
                Ok(())
            },
        },
        CommandOption {
            names: &["--device"],
            value: "auto|cpu|gpu",
            help: "where rays are traced at first; auto is the gpu, but the cpu where the adapter is software",
            read: |reading, parser| {
                reading.args.device = choice(parser, "--device", DeviceChoice::named, DEVICES)?;
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
        // there is one workspace to use today
        CommandOption {
            names: &["--workspace"],
            value: "NAME",
            help: "",
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
    let args = ViewArgs {
        scene: String::new(),
        ui_dump: None,
        theme: Theme::default(),
        device: DeviceChoice::default(),
        workspace: None,
        frame_stats: false,
    };
    match read(parser, Reading { args, print: None }, &options(), 1, no_more)? {
        Typed::Print(text) | Typed::Words(Reading { print: Some(text), .. }, _) => Ok(Command::Print(text)),
        Typed::Words(Reading { args, .. }, words) => {
            let scene = words.into_iter().next().map(OsString::string).transpose()?;
            Ok(Command::View(ViewArgs { scene: scene.unwrap_or_else(|| "whitted".into()), ..args }))
        }
    }
}

fn a_workspace(parser: &mut lexopt::Parser) -> Result<String, CliError> {
    let known = Workspaces::names();
    let named = |name: &str| known.contains(&name).then(|| name.to_owned());
    choice(parser, "--workspace", named, &known.join(" or "))
}
