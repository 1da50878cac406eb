//! The viewer as a process on a virtual screen, watched through its dump of widgets.

use crate::{Screen, TestFolder};
use serde_json::Value;
use std::path::Path;
use std::process::{Child, Command, ExitStatus};
use std::time::{Duration, Instant};

/// A running viewer, ended when dropped.
pub struct ViewerUnderTest {
    process: Child,
    folder: TestFolder,
}

/// What the viewer said of one frame.
#[derive(Debug, Clone)]
pub struct Frame(Value);

impl ViewerUnderTest {
    /// Starts `binary` on a screen, with a home folder of its own that is empty.
    ///
    /// # Panics
    /// If it does not start.
    pub fn start(binary: &Path, screen: &Screen, arguments: &[&str]) -> Self {
        Self::start_scaled(binary, screen, 1.0, arguments)
    }

    /// The same with everything `scale` times as large.
    ///
    /// # Panics
    /// If it does not start.
    pub fn start_scaled(binary: &Path, screen: &Screen, scale: f32, arguments: &[&str]) -> Self {
        Self::start_in(binary, screen, &[("WINIT_X11_SCALE_FACTOR", Some(&scale.to_string()))], arguments)
    }

    /// The same with these variables in its environment, or without them.
    ///
    /// # Panics
    /// If it does not start.
    pub fn start_in(binary: &Path, screen: &Screen, variables: &[(&str, Option<&str>)], arguments: &[&str]) -> Self {
        let folder = TestFolder::new();
        let memory = folder.file("state");
        Self::start_with(folder, &memory, binary, screen, variables, arguments)
    }

    /// The same with what windows remember in this folder.
    ///
    /// # Panics
    /// If it does not start.
    pub fn start_keeping(
        binary: &Path,
        screen: &Screen,
        variables: &[(&str, Option<&str>)],
        arguments: &[&str],
        memory: &Path,
    ) -> Self {
        Self::start_with(TestFolder::new(), memory, binary, screen, variables, arguments)
    }

    fn start_with(
        folder: TestFolder,
        memory: &Path,
        binary: &Path,
        screen: &Screen,
        variables: &[(&str, Option<&str>)],
        arguments: &[&str],
    ) -> Self {
        let home = folder.file("home");
        std::fs::create_dir(&home).expect("a home folder");
        let stderr = std::fs::File::create(folder.file("stderr.txt")).expect("a file");
        let mut command = Command::new(binary);
        command.env("WINIT_X11_SCALE_FACTOR", "1");
        for (name, value) in variables {
            match value {
                Some(value) => command.env(name, value),
                None => command.env_remove(name),
            };
        }
        let process = command
            .args(arguments)
            .arg("--ui-dump")
            .arg(folder.file("dump.json"))
            .env("DISPLAY", &screen.display)
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .env("HOME", &home)
            .env("VISAVIS_CACHE", folder.file("cache"))
            .env("XDG_STATE_HOME", memory)
            .stderr(stderr)
            .spawn()
            .expect("the viewer");
        ViewerUnderTest { process, folder }
    }

    /// The home folder that it sees.
    pub fn home(&self) -> std::path::PathBuf {
        self.folder.file("home")
    }

    /// What it has said on stderr.
    pub fn said(&self) -> String {
        std::fs::read_to_string(self.folder.file("stderr.txt")).unwrap_or_default()
    }

    /// Waits for a frame of which `holds` is true.
    ///
    /// # Panics
    /// If none comes within a minute, or the viewer ends.
    pub fn wait_for(&mut self, what: &str, holds: impl Fn(&Frame) -> bool) -> Frame {
        self.wait_at_most(Duration::from_secs(60), what, holds).unwrap_or_else(|last| {
            panic!("waited a minute for: {what}; last seen: {:?}", last.map(|f| f.0["state"].to_string()))
        })
    }

    /// The same for so long; or else the last frame, if there was one.
    ///
    /// # Errors
    /// If no such frame comes.
    ///
    /// # Panics
    /// If the viewer ends.
    pub fn wait_at_most(
        &mut self,
        time: Duration,
        what: &str,
        holds: impl Fn(&Frame) -> bool,
    ) -> Result<Frame, Option<Frame>> {
        let start = Instant::now();
        let mut last = None;
        while start.elapsed() < time {
            if let Some(status) = self.process.try_wait().expect("the process") {
                panic!("the viewer ended with {status} while waiting for: {what}; it said: {}", self.said());
            }
            let text = std::fs::read_to_string(self.folder.file("dump.json")).unwrap_or_default();
            if let Ok(value) = serde_json::from_str(&text) {
                let frame = Frame(value);
                if holds(&frame) {
                    return Ok(frame);
                }
                last = Some(frame);
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        Err(last)
    }

    /// Waits until a widget is on the screen and has stopped moving.
    ///
    /// # Panics
    /// As [`ViewerUnderTest::wait_for`].
    pub fn wait_for_widget(&mut self, name: &str) -> Frame {
        loop {
            let seen = self.wait_for(name, |frame| frame.shows(name));
            std::thread::sleep(Duration::from_millis(200));
            let again = self.wait_for(name, |frame| frame.shows(name));
            if seen.rect(name) == again.rect(name) {
                return again;
            }
        }
    }

    /// The process, for signals.
    pub fn id(&self) -> u32 {
        self.process.id()
    }

    /// Waits for the process to end by itself.
    ///
    /// # Panics
    /// If it does not within ten seconds.
    pub fn wait_for_end(&mut self) -> ExitStatus {
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(10) {
            if let Some(status) = self.process.try_wait().expect("the process") {
                return status;
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        panic!("the viewer did not close within ten seconds");
    }
}

impl Drop for ViewerUnderTest {
    fn drop(&mut self) {
        // it may have ended already
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl Frame {
    /// What a viewer without a window says, in the same words.
    ///
    /// # Panics
    /// If that is not JSON.
    pub fn of(dump: &str) -> Self {
        Frame(serde_json::from_str(dump).expect("what a viewer says of a frame"))
    }

    /// The name of the widget that has the keyboard; empty if none has.
    pub fn focus(&self) -> &str {
        self.0["focus"].as_str().unwrap_or_default()
    }

    /// Names of all widgets on the screen, in drawing order.
    pub fn names(&self) -> Vec<&str> {
        self.0["widgets"].as_array().into_iter().flatten().filter_map(|w| w["name"].as_str()).collect()
    }

    /// What of a widget's rectangle is not clipped away, in pixels.
    ///
    /// # Panics
    /// If it is not on the screen.
    pub fn visible(&self, name: &str) -> [f32; 4] {
        self.corners(name, "visible")
    }

    /// A value of the viewer's state.
    pub fn state(&self, name: &str) -> &Value {
        &self.0["state"][name]
    }

    /// A widget's rectangle in pixels: left, top, right, bottom.
    ///
    /// # Panics
    /// If it is not on the screen.
    pub fn rect(&self, name: &str) -> [f32; 4] {
        self.corners(name, "rect")
    }

    fn corners(&self, name: &str, of: &str) -> [f32; 4] {
        let rect = &self.widget(name).unwrap_or_else(|| panic!("no widget '{name}' on the screen"))[of];
        std::array::from_fn(|i| rect[i].as_f64().expect("a number") as f32)
    }

    /// The point at a share of a widget's width and height.
    pub fn point(&self, name: &str, x: f32, y: f32) -> [f32; 2] {
        let [left, top, right, bottom] = self.rect(name);
        [left + x * (right - left), top + y * (bottom - top)]
    }

    /// A widget's value as text; empty if it is not on the screen.
    pub fn value(&self, name: &str) -> &str {
        self.widget(name).and_then(|w| w["value"].as_str()).unwrap_or_default()
    }

    /// Whether a widget is on the screen.
    pub fn shows(&self, name: &str) -> bool {
        self.widget(name).is_some()
    }

    fn widget(&self, name: &str) -> Option<&Value> {
        self.0["widgets"].as_array()?.iter().find(|w| w["name"] == name)
    }
}
