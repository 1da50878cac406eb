//! The words after `report`.

use super::options::{CommandOption, Typed, read, set_in_the_scene};
use super::seen::{self, Seen};
use super::values::{DEVICES, choice, seconds, text};
use super::{usage, view};
use crate::cli::{CliError, Command};
use crate::model::{SlideSize, Theme, ViewArgs};
use lexopt::ValueExt;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use technique::DeviceChoice;
use technique::settings::of_panes;

/// `visavis report SCENE -o OUT ...`; `None` leaves a value to the scene, the session or the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportArgs {
    /// What is shown, as the window's options say.
    pub view: ViewArgs,
    /// The page or the slide to write.
    pub out: PathBuf,
    /// Which of them it is.
    pub kind: ReportKind,
    /// Samples per pixel of what is traced, in place of what each pane says.
    pub spp: Option<u32>,
    /// When each picture is to stop, if it is not done by then.
    pub seconds: Option<f64>,
}

/// What is made of the pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReportKind {
    /// A page with pictures of this size.
    Page((u32, u32)),
    /// A slide as large as this, as a picture.
    Slide(SlideSize),
}

impl ReportKind {
    /// Whether a name ends as that of a slide.
    fn is_slide(out: &Path) -> Option<bool> {
        let kind = out.extension()?.to_str()?.to_lowercase();
        match kind.as_str() {
            "html" | "htm" => Some(false),
            "png" => Some(true),
            _ => None,
        }
    }
}

/// The words on their way.
pub struct Reading {
    view: ViewArgs,
    seen: Seen,
    size: Option<(u32, u32)>,
    slide: Option<SlideSize>,
    out: Option<PathBuf>,
    spp: Option<u32>,
    seconds: Option<f64>,
}

impl AsMut<ViewArgs> for Reading {
    fn as_mut(&mut self) -> &mut ViewArgs {
        &mut self.view
    }
}

impl AsMut<Seen> for Reading {
    fn as_mut(&mut self) -> &mut Seen {
        &mut self.seen
    }
}

/// Those that are not the window's too.
pub fn own_options() -> Vec<CommandOption<Reading>> {
    vec![
        CommandOption {
            names: &["-o"],
            value: "OUT",
            help: "the file to write: a page (.html) or a slide (.png)",
            read: |reading, parser| {
                reading.out = Some(PathBuf::from(parser.value()?));
                Ok(())
            },
        },
        CommandOption {
            names: &["--size"],
            value: "WxH",
            help: "pixels of the page's pictures (default 1280x720)",
            read: |reading, parser| {
                reading.size = Some(super::values::size(&text(parser)?)?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--slide-size"],
            value: "1920x1080|3840x2160",
            help: "pixels of the slide (default 1920x1080), whose pictures are rendered as large as they are seen there",
            read: |reading, parser| {
                let size = choice(parser, "--slide-size", SlideSize::named, "1920x1080 or 3840x2160")?;
                reading.slide = Some(size);
                Ok(())
            },
        },
        CommandOption {
            names: &["--theme"],
            value: "dark|light|projector",
            help: "the slide's colours: light type on dark, or black on white (default the session's, or dark)",
            read: |reading, parser| {
                reading.view.theme = Some(choice(parser, "--theme", Theme::named, "dark, light or projector")?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--spp"],
            value: "N",
            help: "samples per pixel of all that is traced, in place of what A and B say",
            read: |reading, parser| {
                reading.spp = Some(samples(&text(parser)?)?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--time"],
            value: "SECONDS",
            help: "stop each picture after this long, where it is not done by then",
            read: |reading, parser| {
                reading.seconds = Some(seconds(parser)?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--device"],
            value: "auto|cpu|gpu",
            help: "where rays are traced, in place of what A and B say",
            read: |reading, parser| {
                reading.view.device = Some(choice(parser, "--device", DeviceChoice::named, DEVICES)?);
                Ok(())
            },
        },
    ]
}

/// As many as a pane's own setting may ask for.
fn samples(word: &str) -> Result<u32, CliError> {
    match of_panes("spp").map(|row| row.kind.parse(word)) {
        Some(Ok(technique::settings::Value::Whole(spp))) => Ok(spp),
        Some(Err(expected)) => usage(format!("--spp {word}: expected {expected}")),
        _ => usage(format!("--spp {word}: expected a whole number")),
    }
}

fn options() -> Vec<CommandOption<Reading>> {
    let mut options = own_options();
    let is_new = |option: &CommandOption<Reading>| !option.names.contains(&"--size");
    options.extend(view::of_a_lecture().into_iter().chain(seen::options()).filter(is_new));
    options
}

/// Reads the words after `report`.
pub fn parse(parser: lexopt::Parser) -> Result<Command, CliError> {
    let blank = Reading {
        view: view::blank(),
        seen: Seen::default(),
        size: None,
        slide: None,
        out: None,
        spp: None,
        seconds: None,
    };
    let read =
        read(parser, blank, &options(), 1, |reading, name, parser| set_in_the_scene(&mut reading.seen, name, parser))?;
    let (Reading { view, seen, size, slide, out, spp, seconds }, words) = match read {
        Typed::Words(reading, words) => (reading, words),
        Typed::Print(text) => return Ok(Command::Print(text)),
    };
    let scene = words.into_iter().next().map(OsString::string).transpose()?;
    if scene.is_none() && view.slide.is_none() {
        return usage("report needs a scene or a session: visavis report SCENE -o OUT.html");
    }
    let Some(out) = out else { return usage("report needs a file to write: -o OUT.html, or -o OUT.png for a slide") };
    let kind = match (ReportKind::is_slide(&out), size, slide) {
        (None, ..) => {
            return usage(format!("-o must end in .html, or in .png for a slide: {}", image_file::shown(&out)));
        }
        (Some(false), _, Some(_)) => return usage("--slide-size is of slides: -o OUT.png"),
        (Some(true), Some(_), _) => return usage("--size is of a page's pictures; a slide has --slide-size"),
        (Some(false), size, None) => ReportKind::Page(size.unwrap_or(Seen::default().size)),
        (Some(true), None, slide) => ReportKind::Slide(slide.unwrap_or_default()),
    };
    let view = view::of_scene(view, seen, scene)?;
    Ok(Command::Report(Box::new(ReportArgs { view, out, kind, spp, seconds })))
}
