//! The text of `--help`, made from the tables of options and of settings: what is in none of them is no option.

use super::options::CommandOption;
use super::{bench, check, compare, denoise, device_report, ladder, merge, reference, render, report, sweep, view};
use technique::TechniqueName;
use technique::settings::{OF_SCENES, Setting, all_of_panes};

/// Columns of the text, and where descriptions begin.
const COLUMNS: usize = 127;
const DESCRIPTIONS: usize = 33;

/// What `visavis --version` prints.
pub const VERSION: &str = concat!("visavis ", env!("CARGO_PKG_VERSION"), "\n");

const TITLE: &str = "Visavis: the rasterised fake of a scene face to face with its path-traced truth.";

const MORE: &str = "\
References lie in the system's folder for caches, or in VISAVIS_CACHE; VISAVIS_CACHE_MIB limits their size (default 1024).
Trees of large meshes lie beside them; VISAVIS_TREES_MIB limits their size (default 4096), and 0 keeps none.
Exit code: 0 done, 1 failed (one line on stderr), 2 wrong usage. What a signal has ended ends by it: shells say 130
after Ctrl-C, 143 after SIGTERM.
Ctrl-C ends render and reference soon and saves what there is by then; a second one ends them at once.
In the window: drag the line to wipe, drag the picture to orbit (Shift: pan, wheel: dolly, Ctrl+wheel: zoom), T swaps A
and B, 1 2 3 4 5 show A, B, wipe, side by side, error map, P pauses, R restarts, C resets the camera, H hides the panel,
L the labels, F11 fills the screen, Ctrl+Z undoes, Ctrl+S saves and Ctrl+C copies the picture as seen, Ctrl+Shift+S saves
the session, Ctrl+P a lab report, Ctrl+R reads the scene's file again, Ctrl+Q quits, ? shows all keys. A file that is dropped
onto the window is opened.
";

/// What `visavis --help` prints.
pub fn text() -> String {
    let blocks: String = commands().iter().map(Block::text).collect();
    format!("{TITLE}\n\n{blocks}\n{MORE}")
}

/// A command: how it is typed, what it does, and its options.
struct Block {
    usage: &'static str,
    about: &'static str,
    rows: Vec<Row>,
}

enum Row {
    /// An option and what it does.
    Option(String, String),
    /// Whose the options below are.
    Heading(String),
}

impl Block {
    fn new<A>(usage: &'static str, about: &'static str, options: &[CommandOption<A>]) -> Self {
        let listed = options.iter().filter(|option| !option.help.is_empty());
        let typed = |option: &CommandOption<A>| format!("{} {}", option.names.join(", "), option.value);
        Block { usage, about, rows: listed.map(|option| Row::Option(typed(option), option.help.into())).collect() }
    }

    /// Lists these options too, below those that stand there already.
    fn with<A>(mut self, options: &[CommandOption<A>]) -> Self {
        self.rows.extend(Block::new("", "", options).rows);
        self
    }

    /// What may be changed in the scene.
    fn with_scene_settings(mut self) -> Self {
        self.rows.extend(OF_SCENES.iter().map(row));
        self
    }

    /// What may be changed in the scene and in the technique, by the techniques that it changes.
    fn with_settings(mut self) -> Self {
        let of_all = |of: &[TechniqueName]| of.len() == TechniqueName::ALL.len();
        self.rows.extend(OF_SCENES.iter().filter(|setting| of_all(setting.of)).map(row));
        let mut groups: Vec<&[TechniqueName]> = Vec::new();
        let limited = render::options_of_some().map(|(of, _)| of);
        for of in limited.chain(all_of_panes().map(|setting| setting.of)) {
            if !groups.contains(&of) {
                groups.push(of);
            }
        }
        for of in groups {
            self.rows.push(Row::Heading(of.iter().map(|name| called(*name)).collect::<Vec<_>>().join(" and ")));
            let of_group = render::options_of_some().filter(|(owners, _)| *owners == of);
            self.rows.extend(of_group.flat_map(|(_, option)| Block::new("", "", &[option]).rows));
            self.rows.extend(OF_SCENES.iter().filter(|setting| setting.of == of).map(row));
            self.rows.extend(all_of_panes().filter(|setting| setting.of == of).map(row));
        }
        self
    }

    fn text(&self) -> String {
        let rows = self.rows.iter().map(|row| match row {
            Row::Option(typed, help) => two_columns(&format!("    {}", typed.trim_end()), help),
            Row::Heading(whose) => format!("  {whose}:\n"),
        });
        two_columns(self.usage, self.about) + &rows.collect::<String>()
    }
}

fn row<T>(setting: &Setting<T>) -> Row {
    Row::Option(setting.usage(), setting.description())
}

fn called(technique: TechniqueName) -> &'static str {
    match technique {
        TechniqueName::Raster => "the fake",
        other => other.name(),
    }
}

/// A description beside what it describes, or below where there is no room.
fn two_columns(left: &str, right: &str) -> String {
    let mut lines: Vec<String> = vec![String::new()];
    for word in right.split_whitespace() {
        match lines.last_mut() {
            Some(line) if DESCRIPTIONS + line.len() + word.len() < COLUMNS => {
                *line += if line.is_empty() { "" } else { " " };
                *line += word;
            }
            _ => lines.push(word.into()),
        }
    }
    let mut text = String::new();
    let beside = left.len() < DESCRIPTIONS;
    if !beside {
        text += &format!("{left}\n");
    }
    for (i, line) in lines.iter().enumerate() {
        let left = if i == 0 && beside { left } else { "" };
        text += &format!("{left:DESCRIPTIONS$}{line}\n");
    }
    text
}

fn commands() -> Vec<Block> {
    vec![
        Block::new(
            "visavis [SCENE]",
            "open the viewer; SCENE is whitted, cornell, phong, cornell-balls, veach, caustic, door-ajar, statues, hard/NAME, the \
             .toml file of a scene or a session, a model (.glb, .gltf, .ply, .obj), or a picture of this program (.png, \
             .exr), which is shown again as it was made (default whitted); hard/? lists the hard ones",
            &view::of_what_is_seen(),
        )
        .with_scene_settings()
        .with(&view::of_the_window()),
        Block::new(
            "visavis render SCENE -o OUT",
            "render to OUT, .png (display-transformed) or .exr (linear, settings in the header)",
            &render::options(),
        )
        .with_settings(),
        Block::new(
            "visavis sweep SCENE NAME=V1,V2,... [NAME=V1,V2,...] -o OUT.png",
            "many pictures of one scene as one: a strip of 2 to 8 values of a setting of render, or of technique; a matrix of two \
             settings, 16 tiles at most; each tile is what render makes of the same settings",
            &sweep::options(),
        )
        .with_scene_settings(),
        Block::new(
            "visavis ladder SCENE -o DIR",
            "from the fake as taught to the truth, one repaired defect a rung: for each its picture, the error that is left against the \
             scene's reference, which is made if it is not there, and milliseconds a frame",
            &ladder::options(),
        )
        .with_scene_settings(),
        Block::new(
            "visavis report SCENE -o OUT",
            "make both pictures and their reference, and of them a lab report (.html: one page that needs no other file, with \
             pictures, errors, plots, settings, times, machine and session) or a slide (.png); SCENE is what the window opens, and \
             the window's --a, --b, --slide, --view, --against, --exposure and camera say what is on it; another program's picture \
             (picture=FILE, received) is refused: the window alone shows it, and saves its report",
            &report::own_options(),
        ),
        Block::new(
            "visavis compare A B",
            "how far picture A is from reference B (.exr or .png): RMSE, relMSE, MAE, mean difference, FLIP, HDR-FLIP; B's own noise \
             where it is a reference of this program; without B against the reference of what A's records say that it shows, \
             unless its scene has changed since",
            &compare::options(),
        ),
        Block::new(
            "visavis denoise A -o OUT",
            "take the noise out of A, an .exr with the layers albedo (R, G, B) and normal (X, Y, Z); the result is biased, which \
             its records and compare say, and render --from makes it again where it can",
            &denoise::options(),
        ),
        Block::new(
            "visavis merge A B ... -o OUT",
            "put films of render --samples together, ranges of the samples of one picture: the film of one run that takes them all; \
             ranges may be left out, but none twice, and the order of the files is nothing (docs/many-machines.md)",
            &merge::options(),
        ),
        Block::new(
            "visavis reference SCENE -o OUT",
            "make or fetch the reference of a scene; without SCENE: where references are kept, how many, their size and its \
             limit",
            &reference::options(),
        )
        .with_scene_settings(),
        Block::new(
            "visavis bench -o DIR",
            "speed against error of every technique: one HTML page, its SVG plots, CSV tables; run again after an \
             interruption, it goes on (docs/bench.md says what each number means)",
            &bench::options(),
        ),
        Block::new(
            "visavis check",
            "every hard case: expected, measured, tolerance, verdict; exit code 1 if one fails",
            &check::options(),
        ),
        Block::new::<()>("visavis info", "adapters, limits, what would be used and why", &[]),
        Block::new(
            "visavis device-report",
            "one page on the graphics device: how fast it traces beside the processor, how long a picture takes while a slider \
             moves, what it does at most, whether its pictures are the processor's, what happens where it is lost, and the hard \
             cases; from this program alone, within ten minutes",
            &device_report::options(),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the tables: a row that was forgotten here would not be an option either.
    #[test]
    fn every_setting_is_listed_with_its_default() {
        let text = text();
        for line in all_of_panes().map(Setting::usage).chain(OF_SCENES.iter().map(Setting::usage)) {
            assert!(text.contains(&format!("    {line}")), "{line}");
        }
        for preset in technique::presets::ALL {
            assert!(text.contains(preset.name), "{}", preset.name);
        }
        for sweep in crate::model::SWEEPS {
            assert!(text.contains(sweep.name), "{}", sweep.name);
        }
        for slide in crate::model::SLIDES {
            let (_, listed) = text.split_once("--slide NAME").expect("the option");
            let listed = listed.split("--view a|b").next().expect("what is before the next");
            assert!(listed.split([',', ' ', '\n']).any(|word| word == slide.name), "{}", slide.name);
        }
        assert!(text.lines().all(|line| line.chars().count() <= COLUMNS), "{text}");
    }

    #[test]
    fn what_is_seen_stands_together_and_help_last() {
        let text = text();
        let window = text.split("visavis render SCENE").next().expect("the window's options");
        let options = window.lines().filter_map(|line| line.strip_prefix("    --")?.split([' ', ',']).next());
        let expected = "a b slide view against exposure camera eye target up fov edit variant allow-outside refraction-ratio sun-radius theme device frame-stats \
                        workspace help version";
        assert_eq!(options.collect::<Vec<_>>(), expected.split(' ').collect::<Vec<_>>());
    }
}
