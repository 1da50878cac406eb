//! Commands that are asked to end: what there is by then is saved, and they end by the signal that asked.

use super::program;
use rustix::process::{Pid, Signal, kill_process};
use std::io::{BufRead, BufReader, Read};
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, ChildStderr, Command, ExitStatus, Stdio};
use visavis_tests::TestFolder;

/// A point light, which the naive estimator cannot find: the program says so when it begins to trace.
pub const UNSEEN_LIGHT: &str = r#"
camera = { eye = [0, 1, 5], target = [0, 1, 0], fov_y = 30 }
point_light = [{ position = [0, 5, 5], intensity = [9, 9, 9] }]
material.grey.diffuse.albedo = [0.5, 0.5, 0.5]
sphere = [{ center = [0, 1, 0], radius = 1, material = "grey" }]
"#;

/// A command that has said its first line.
struct Begun {
    child: Child,
    stderr: BufReader<ChildStderr>,
    first_line: String,
}

impl Begun {
    fn new(command: &mut Command) -> Self {
        let mut child = command.stderr(Stdio::piped()).spawn().expect("the program");
        let mut begun =
            Begun { stderr: BufReader::new(child.stderr.take().expect("its notes")), child, first_line: String::new() };
        begun.first_line = begun.line();
        begun
    }

    fn line(&mut self) -> String {
        let mut line = String::new();
        self.stderr.read_line(&mut line).expect("a line");
        line
    }

    fn send(&self, signal: Signal) {
        kill_process(Pid::from_child(&self.child), signal).expect("a signal");
    }

    /// What else it says, and how it ends.
    fn end(mut self) -> (String, ExitStatus) {
        let mut said = String::new();
        self.stderr.read_to_string(&mut said).expect("its notes");
        (said, self.child.wait().expect("an end"))
    }
}

/// Whether the tests themselves run where this signal is ignored, as behind nohup: so do the programs that they begin.
fn is_ignored(signal: Signal) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).unwrap_or("0");
    u64::from_str_radix(mask.trim(), 16).expect("a mask") >> (signal.as_raw() - 1) & 1 == 1
}

/// More samples than anyone waits for, of a scene in this folder.
fn endless(folder: &TestFolder, mut command: Command) -> Command {
    let scene = folder.file("a.toml");
    std::fs::write(&scene, UNSEEN_LIGHT).expect("the scene");
    command.arg("render").arg(scene).args(["--estimator", "uniform", "--device", "cpu", "--spp", "2000000"]);
    command.arg("-o").arg(folder.file("a.exr"));
    command
}

fn spp_of(file: &Path) -> u32 {
    let records = image_file::records(file).expect("records");
    let spp = records.iter().find(|(name, _)| name == "spp").expect("its samples");
    spp.1.parse().expect("a number")
}

#[test]
fn render_saves_the_samples_that_there_are_and_ends_by_the_signal() {
    let folder = TestFolder::new();
    let out = folder.file("a.exr");
    let cases: [(_, &[&str], _); 4] = [
        (Signal::INT, &[], "spp are saved: "),
        (Signal::TERM, &[], "spp are saved: "),
        (Signal::TERM, &["--errors"], "spp are saved, without their errors: "),
        (Signal::HUP, &[], "spp are saved: "),
    ];
    for (signal, more, words) in cases.into_iter().filter(|(signal, ..)| !is_ignored(*signal)) {
        let render = Begun::new(endless(&folder, program()).args(["--size", "8x8"]).args(more));
        assert!(render.first_line.starts_with("note: "), "{}", render.first_line);
        render.send(signal);
        let (said, end) = render.end();
        assert_eq!(end.signal(), Some(signal.as_raw()), "{said}");
        assert!(said.starts_with("note: ends soon and saves what there is"), "{said}");
        let spp = spp_of(&out);
        assert!((1..2_000_000).contains(&spp));
        let last = said.lines().last().unwrap_or_default();
        assert!(last.starts_with(&format!("visavis: interrupted: {spp} of 2000000 {words}")), "{said}");
        assert_eq!(folder.names(), ["a.exr", "a.toml"]);
        std::fs::remove_file(&out).expect("the picture");
    }
}

/// What is to be said of A is said once it is made, and B has no end.
#[test]
fn a_report_that_was_interrupted_says_so() {
    let folder = TestFolder::new();
    let (scene, page) = (folder.file("a.toml"), folder.file("a.html"));
    std::fs::write(&scene, UNSEEN_LIGHT).expect("the scene");
    let mut command = program();
    let (a, b) = ("path,estimator=uniform,spp=1", "path,estimator=uniform,denoise=atrous,spp=2000000");
    command.arg("report").arg(scene).args(["--a", a, "--b", b, "--against", "other", "--size", "64x64"]);
    command.args(["--device", "cpu", "-o"]).arg(&page);
    let making = Begun::new(&mut command);
    assert!(making.first_line.starts_with("note: "), "{}", making.first_line);
    making.send(Signal::TERM);
    let (said, end) = making.end();
    assert_eq!(end.signal(), Some(Signal::TERM.as_raw()), "{said}");
    let html = std::fs::read_to_string(page).expect("the page");
    assert!(html.contains(" of 2000000 samples per pixel"), "{said}");
    assert!(html.contains("not denoised: stopped before") && !html.contains("denoised by atrous"));
}

/// One sample of every pixel is made in any case: of so many that the second signal comes before.
#[test]
fn the_second_signal_ends_at_once_and_leaves_no_half_a_file() {
    let folder = TestFolder::new();
    let slow = ["--size", "2000x2000", "--bounces", "3", "--branches", "16"];
    let mut render = Begun::new(endless(&folder, program()).args(slow));
    render.send(Signal::TERM);
    assert!(render.line().starts_with("note: ends soon"));
    render.send(Signal::TERM);
    let (said, end) = render.end();
    assert_eq!((said.as_str(), end.signal()), ("", Some(Signal::TERM.as_raw())));
    assert_eq!(folder.names(), ["a.toml"]);
}

/// A shell and the system both tell of a terminal that is closed.
#[test]
fn a_terminal_is_closed_but_once() {
    if is_ignored(Signal::HUP) {
        return;
    }
    let folder = TestFolder::new();
    let mut render = Begun::new(endless(&folder, program()).args(["--size", "800x800"]));
    render.send(Signal::HUP);
    assert!(render.line().starts_with("note: ends soon"));
    render.send(Signal::HUP);
    let (said, end) = render.end();
    assert_eq!(end.signal(), Some(Signal::HUP.as_raw()), "{said}");
    assert_eq!(folder.names(), ["a.exr", "a.toml"]);
}

/// As a shell ignores Ctrl-C for what it runs in the background, and nohup the end of the terminal.
#[test]
#[cfg(target_os = "linux")]
fn signals_that_are_ignored_from_the_beginning_stay_so() {
    let folder = TestFolder::new();
    let mut shell = Command::new("/bin/sh");
    shell.args(["-c", "trap '' INT HUP; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_visavis")]);
    let render = Begun::new(endless(&folder, shell).args(["--size", "8x8"]));
    [Signal::INT, Signal::HUP, Signal::INT, Signal::TERM].into_iter().for_each(|signal| render.send(signal));
    let (said, end) = render.end();
    assert_eq!(end.signal(), Some(Signal::TERM.as_raw()), "{said}");
    assert!((1..2_000_000).contains(&spp_of(&folder.file("a.exr"))));
}

/// It says that it cannot keep the first 32 pictures.
#[test]
fn reference_saves_the_pictures_that_there_are_and_ends_by_the_signal() {
    let folder = TestFolder::new();
    let out = folder.file("a.exr");
    let mut command = program();
    command.args(["reference", "cornell", "--size", "8x8", "--noise", "1e-12", "--time", "1e9", "-o"]).arg(&out);
    let making = Begun::new(&mut command);
    assert!(making.first_line.starts_with("note: cannot keep references"), "{}", making.first_line);
    making.send(Signal::TERM);
    let (said, end) = making.end();
    assert_eq!(end.signal(), Some(Signal::TERM.as_raw()), "{said}");
    let kept = reference::Reference::load(&out).expect("a reference");
    assert!(kept.replicates >= 32);
    let last = said.lines().last().unwrap_or_default();
    assert!(last.starts_with(&format!("visavis: interrupted: {} pictures are saved: ", kept.replicates)), "{said}");
}

/// What has nothing to save ends by the first signal, so that a shell's loop ends as well.
#[test]
fn other_commands_end_at_once_by_the_signal() {
    let mut command = program();
    let mut check = command.args(["check", "--quick"]).stdout(Stdio::piped()).spawn().expect("the program");
    let mut stdout = BufReader::new(check.stdout.take().expect("its table"));
    let mut first_line = String::new();
    stdout.read_line(&mut first_line).expect("a line");
    kill_process(Pid::from_child(&check), Signal::TERM).expect("a signal");
    assert_eq!(check.wait().expect("an end").signal(), Some(Signal::TERM.as_raw()), "{first_line}");
}
