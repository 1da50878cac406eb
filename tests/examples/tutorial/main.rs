//! Walks the tutorial point by point as a lecturer does, with real mouse and keys in a real window under Xvfb, and prints what each
//! point takes: clicks, keys, turns of the wheel, and seconds from the last of them to the picture.
//!
//! cargo run --release -p visavis-tests --example tutorial -- PATH_TO_VISAVIS [PART OF A POINT'S NAME] [--pictures DIR]
//!
//! The points are a table (`table.rs`), each with one or more ways: the first way whose controls this program has is taken, so that one
//! table is for programs before and after a change. `--pictures` keeps what the screen shows at each point, as PPM.

mod points;
mod table;

use points::{Point, Step};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};
use table::POINTS;
use visavis_tests::{Frame, Screen, ViewerUnderTest};

/// Pixels of the screen: more than the window, that no control is cut.
const SCREEN: (u32, u32) = (1400, 850);

/// How long a control is waited for before it counts as missing.
const PATIENCE: Duration = Duration::from_secs(3);

/// How long a picture may take.
const PICTURE: Duration = Duration::from_secs(40);

/// What it took to show a point.
#[derive(Default)]
struct Effort {
    clicks: usize,
    keys: usize,
    turns: usize,
    seconds: f64,
}

fn main() -> ExitCode {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    let pictures = words.iter().position(|word| word == "--pictures").map(|at| words.split_off(at));
    let pictures = pictures.and_then(|words| words.get(1).map(PathBuf::from));
    let Some(binary) = words.first().map(PathBuf::from).filter(|path| path.is_file()) else {
        eprintln!("tutorial: expected the path of a visavis, and perhaps a part of a point's name");
        return ExitCode::from(2);
    };
    let wished = words.get(1).map_or("", String::as_str);
    println!("| point | way | clicks | keys | wheel | s to the picture |\n|---|---|---|---|---|---|");
    let points: Vec<&Point> = POINTS.iter().filter(|point| point.name.contains(wished)).collect();
    let shown = points.iter().filter(|point| walk(&binary, point, pictures.as_deref())).count();
    println!("\n{shown} of {} points are shown", points.len());
    if shown == points.len() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Shows a point by the first way that can be gone, and tells what it took; whether there was one.
fn walk(binary: &Path, point: &Point, pictures: Option<&Path>) -> bool {
    let mut missing = Vec::new();
    for way in point.ways {
        match shown_by(binary, point, way.steps, pictures) {
            Ok(Effort { clicks, keys, turns, seconds }) => {
                println!("| {} | {} | {clicks} | {keys} | {turns} | {seconds:.1} |", point.name, way.name);
                return true;
            }
            Err(what) => missing.push(format!("{}: {what}", way.name)),
        }
    }
    println!("| {} | not shown ({}) | | | | |", point.name, missing.join("; "));
    false
}

fn shown_by(binary: &Path, point: &Point, steps: &[Step], pictures: Option<&Path>) -> Result<Effort, String> {
    let screen = Screen::start(SCREEN.0, SCREEN.1);
    let mut viewer = ViewerUnderTest::start(binary, &screen, &[]);
    viewer.wait_at_most(PICTURE, "both pictures", both_whole).map_err(|_| "no first pictures")?;
    screen.focus("Visavis");
    let mut hand = Hand { screen: &screen, viewer: &mut viewer, effort: Effort::default(), since: Instant::now() };
    steps.iter().try_for_each(|step| hand.does(step))?;
    let shows = |frame: &Frame| both_whole(frame) && point.shows.iter().all(|sign| sign.is_in(frame));
    let found = hand.viewer.wait_at_most(PICTURE, point.name, shows);
    hand.effort.seconds = hand.since.elapsed().as_secs_f64();
    let effort = hand.effort;
    if let Some(folder) = pictures {
        keep_picture(&screen, &folder.join(format!("{}.ppm", point.file_name())));
    }
    found.map(|_| effort).map_err(|last| {
        let signs = point.shows.iter().filter(|sign| last.as_ref().is_none_or(|frame| !sign.is_in(frame)));
        format!("no picture of {:?}", signs.collect::<Vec<_>>())
    })
}

fn both_whole(frame: &Frame) -> bool {
    ["a", "b"].iter().all(|pane| frame.state(pane)["ready"] == true && frame.state(pane)["rough"] == false)
}

fn keep_picture(screen: &Screen, file: &Path) {
    let (width, height) = SCREEN;
    let pixels = screen.pixels(0, 0, width, height).concat();
    let bytes = [format!("P6 {width} {height} 255\n").into_bytes(), pixels].concat();
    if let Err(why) = std::fs::write(file, bytes) {
        eprintln!("tutorial: no picture ({why}): {}", file.display());
    }
}

/// A user's hand, and what it has done.
struct Hand<'a> {
    screen: &'a Screen,
    viewer: &'a mut ViewerUnderTest,
    effort: Effort,
    /// When it did the last thing.
    since: Instant,
}

impl Hand<'_> {
    fn does(&mut self, step: &Step) -> Result<(), String> {
        match *step {
            Step::Click(name) => self.clicks(name, 0.5),
            Step::Key(key) => {
                self.effort.keys += 1;
                self.screen.key(key, false);
                self.lets_go()
            }
            Step::Type(name, text) => self.types(name, text),
            Step::Wipe(to) => {
                let frame = self.sees("picture")?;
                let at = frame.state("wipe").as_f64().unwrap_or(0.5) as f32;
                let on_the_line = |share| match frame.state("line") == "horizontal" {
                    true => frame.point("picture", 0.5, share),
                    false => frame.point("picture", share, 0.5),
                };
                self.drags(on_the_line(at), on_the_line(to))
            }
            Step::Orbit => {
                let frame = self.sees("picture")?;
                self.drags(frame.point("picture", 0.8, 0.7), frame.point("picture", 0.85, 0.65))
            }
        }
    }

    /// A widget that is on the screen, whole and at rest, the panel scrolled as far as it takes.
    fn sees(&mut self, name: &str) -> Result<Frame, String> {
        let missing = |_| format!("no '{name}'");
        let mut seen = self.viewer.wait_at_most(PATIENCE, name, |frame| frame.shows(name)).map_err(missing)?;
        for _ in 0..30 {
            self.rests();
            let again = self.viewer.wait_at_most(PATIENCE, name, |frame| frame.shows(name)).map_err(missing)?;
            let ([_, top, _, bottom], [_, seen_top, _, seen_bottom]) = (again.rect(name), again.visible(name));
            let (rests, whole) = (again.rect(name) == seen.rect(name), seen_bottom - seen_top > 0.9 * (bottom - top));
            if rests && whole {
                return Ok(again);
            }
            if rests && again.shows("controls") && top > 30.0 {
                self.effort.turns += 1;
                let panel = [SCREEN.0 as f32 * 0.05, 400.0];
                self.screen.wheel_down(self.panel(&again).unwrap_or(panel));
            }
            seen = again;
        }
        Err(format!("'{name}' is not to be seen"))
    }

    /// A point over the panel of controls: beside a control that is in it.
    fn panel(&self, frame: &Frame) -> Option<[f32; 2]> {
        let there = ["group A", "group B", "A raster", "exposure"].into_iter().find(|name| frame.shows(name))?;
        Some([frame.point(there, 0.5, 0.5)[0], 400.0])
    }

    fn clicks(&mut self, name: &str, share: f32) -> Result<(), String> {
        let frame = self.sees(name)?;
        self.effort.clicks += 1;
        self.screen.click(frame.point(name, share, 0.5));
        self.lets_go()?;
        // another scene moves the controls
        let Some(scene) = name.strip_prefix("scene ") else { return Ok(()) };
        let opened =
            self.viewer.wait_at_most(PICTURE, name, |frame| frame.state("scene") == scene && both_whole(frame));
        opened.map(drop).map_err(|_| format!("no picture of {scene}"))
    }

    /// Into the number beside a slider: by itself, or the right end of the slider's place.
    fn types(&mut self, name: &str, text: &str) -> Result<(), String> {
        let number = format!("{name} value");
        let frame = self.sees(name)?;
        if frame.shows(&number) {
            self.clicks(&number, 0.5)?
        } else {
            self.clicks(name, 0.94)?
        }
        self.screen.key('a', true);
        self.screen.type_text(text);
        self.screen.press(Screen::ENTER);
        self.effort.keys += text.len() + 1;
        self.lets_go()
    }

    fn drags(&mut self, from: [f32; 2], to: [f32; 2]) -> Result<(), String> {
        self.effort.clicks += 1;
        self.screen.drag(from, to);
        self.lets_go()
    }

    /// What was done is done once some frames have seen it; a window at rest may need fewer.
    fn lets_go(&mut self) -> Result<(), String> {
        self.since = Instant::now();
        let frames = |frame: &Frame| frame.state("frames").as_u64();
        let now = self.viewer.wait_at_most(PATIENCE, "a frame", |_| true).map_err(|_| "no frame")?;
        let later = frames(&now).map(|count| count + 3);
        // a window at rest draws none
        let _ = self.viewer.wait_at_most(Duration::from_secs(1), "some frames", |frame| frames(frame) >= later);
        Ok(())
    }

    fn rests(&self) {
        std::thread::sleep(Duration::from_millis(150));
    }
}
