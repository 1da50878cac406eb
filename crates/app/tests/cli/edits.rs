//! Scenes that are changed part by part: pictures of them are made again from their records, and what cannot be changed is
//! told.

use super::{assert_refused, visavis};
use std::path::PathBuf;
use visavis_tests::TestFolder;

const EDIT: &str = "{ material.white = { colour = [0.1, 0.6, 0.2] }, shape.\"box 1\".hidden = true }";

struct Pictures(TestFolder);

impl Pictures {
    fn path(&self, name: &str) -> PathBuf {
        self.0.file(name)
    }

    fn file(&self, name: &str) -> String {
        self.path(name).to_str().expect("a plain path").to_owned()
    }

    /// What is said on stderr.
    fn render(&self, out: &str, words: &[&str]) -> String {
        let common = ["--size", "20x16", "--spp", "2", "--device", "cpu", "-o", &self.file(out)];
        let output = visavis(&[&["render"], words, &common].concat());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{words:?}: {said}");
        said
    }

    fn film(&self, name: &str) -> film::Image {
        image_file::load(&self.path(name)).expect("a picture")
    }

    fn record(&self, picture: &str, name: &str) -> Option<String> {
        let records = image_file::records(&self.path(picture)).expect("records");
        records.into_iter().find(|(known, _)| known == name).map(|(_, value)| value)
    }
}

/// The name of a shape that can be left out: whatever the scene calls its second one.
fn edit() -> String {
    let scene = scene::builtin::named("cornell").expect("a built-in scene");
    EDIT.replace("box 1", &scene.shape_name(1))
}

#[test]
fn a_picture_of_a_changed_scene_is_made_again_from_its_records() {
    let pictures = Pictures(TestFolder::new());
    let edit = edit();
    pictures.render("plain.exr", &["cornell"]);
    pictures.render("edited.exr", &["cornell", "--edit", &edit]);
    let read = edit.parse::<scene::edit::Edits>().expect("changes");
    assert_eq!(pictures.record("edited.exr", "edit"), Some(read.to_string()));
    assert_eq!(pictures.record("plain.exr", "edit"), None);
    pictures.render("again.exr", &["--from", &pictures.file("edited.exr")]);
    assert!(pictures.film("again.exr") == pictures.film("edited.exr"));
    assert!(pictures.film("plain.exr") != pictures.film("edited.exr"));
    // what is said twice is as said last, of a picture's records too
    let back = "{ material.white.colour = [1, 1, 1] }";
    pictures.render("one.exr", &["cornell", "--edit", &edit, "--edit", back]);
    pictures.render("two.exr", &["--from", &pictures.file("edited.exr"), "--edit", back]);
    assert!(pictures.film("one.exr") == pictures.film("two.exr"));
    assert!(pictures.film("one.exr") != pictures.film("edited.exr"));
}

#[cfg(unix)]
#[test]
fn a_shell_makes_it_again_from_the_command_in_its_records() {
    let pictures = Pictures(TestFolder::new());
    pictures.render("edited.png", &["cornell", "--edit", &edit(), "--technique", "whitted"]);
    let command = pictures.record("edited.png", "command").expect("a command");
    let (before, after) = command.split_once(" -o picture.png ").expect("a command with an output");
    let line = format!("{before} -o '{}' {after}", pictures.file("again.png"));
    let binary = PathBuf::from(env!("CARGO_BIN_EXE_visavis"));
    let path = std::env::join_paths([binary.parent().expect("a folder")]).expect("a path");
    let done = super::program()
        .get_envs()
        .fold(&mut std::process::Command::new("/bin/sh"), |shell, (name, value)| match value {
            Some(value) => shell.env(name, value),
            None => shell.env_remove(name),
        })
        .args(["-c", &line])
        .env("PATH", path)
        .output()
        .expect("a shell");
    assert!(done.status.success(), "{line}: {}", String::from_utf8_lossy(&done.stderr));
    assert!(pictures.film("again.png") == pictures.film("edited.png"), "{line}");
}

#[test]
fn what_cannot_be_changed_is_told_in_a_line_and_nothing_is_written() {
    let folder = TestFolder::new();
    let out = folder.file("out.png");
    let out = out.to_str().expect("a plain path");
    let refused = |edit: &str, code: i32, words: &[&str]| {
        assert_refused(&["render", "cornell", "-o", out, "--edit", edit], code, words);
    };
    refused("white", 2, &["--edit white: expected changes of a scene as {"]);
    refused("{ material.white.colour = [1, 2, 0] }", 2, &["colour of material 'white': expected a colour"]);
    refused("{ material.white.color = [1, 1, 0] }", 2, &["did you mean colour?"]);
    refused("{ material.whit.colour = [1, 1, 0] }", 1, &["cornell has no material 'whit'; did you mean 'white'?"]);
    refused("{ sun.elevation = 3 }", 1, &["cornell has no sun"]);
    refused("{ material.white.lobe = \"mirrour\" }", 1, &["did you mean 'mirror'?"]);
    assert_refused(&["render", "cornell", "-o", out, "--variant", "beach"], 1, &["no variant of cornell", "'beach'"]);
    let page = folder.file("report.html");
    let report = ["report", "cornell", "-o", page.to_str().expect("a plain path")];
    assert_refused(&[&report[..], &["--variant", "beach"]].concat(), 1, &["'beach'"]);
    assert_eq!(folder.names(), [""; 0]);
}

#[test]
fn what_changes_nothing_leaves_a_note() {
    let pictures = Pictures(TestFolder::new());
    let said = pictures.render("a.exr", &["cornell", "--edit", "{ material.white.ior = 2 }"]);
    assert!(said.contains("note: ior of material 'white' has no effect: it has none"), "{said}");
}

#[test]
fn ranges_of_two_changed_scenes_are_not_merged() {
    let pictures = Pictures(TestFolder::new());
    let part = |out: &str, samples: &str, words: &[&str]| {
        let common = ["render", "cornell", "--size", "8x6", "--device", "cpu", "--samples", samples, "-o"];
        let output = visavis(&[&common[..], &[&pictures.file(out)], words].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    let edit = edit();
    part("a.exr", "0..1", &["--edit", &edit]);
    part("b.exr", "1..2", &["--edit", &edit]);
    part("other.exr", "1..2", &["--edit", "{ material.white.colour = [1, 0, 0] }"]);
    part("plain.exr", "1..2", &[]);
    let [a, b, other, plain, out] =
        ["a.exr", "b.exr", "other.exr", "plain.exr", "all.exr"].map(|name| pictures.file(name));
    assert_refused(&["merge", &a, &other, "-o", &out], 1, &["its edit is", "a.exr"]);
    assert_refused(&["merge", &a, &plain, "-o", &out], 1, &["its edit is", "not said"]);
    assert!(visavis(&["merge", &a, &b, "-o", &out]).status.success());
    assert!(pictures.record("all.exr", "command").is_some_and(|command| command.contains("--edit '{ material.white")));
}

#[test]
fn reports_and_lists_of_jobs_say_that_the_scene_is_a_changed_one() {
    let pictures = Pictures(TestFolder::new());
    let (edit, page) = (edit(), pictures.file("report.html"));
    let panes =
        ["--a", "whitted,spp=1", "--b", "path,spp=1", "--against", "other", "--size", "16x12", "--device", "cpu"];
    let made = visavis(&[&["report", "cornell", "-o", &page, "--edit", &edit], &panes[..]].concat());
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let html = std::fs::read_to_string(&page).expect("a page");
    for said in
        ["<h1>cornell, edited: 2 parts: lab report</h1>", "<th scope=\"row\">edit</th>", "--edit &#39;{", "edit = {"]
    {
        assert!(html.contains(said) || html.contains(&said.replace("&#39;", "'")), "{said}");
    }
    let sheet = pictures.file("sheet.png");
    let jobs = visavis(&["sweep", "cornell", "bounces=0,1", "-o", &sheet, "--jobs", "--edit", &edit]);
    let lines = String::from_utf8_lossy(&jobs.stdout).into_owned();
    assert!(
        lines.lines().count() == 2 && lines.lines().all(|line| line.contains(" --edit '{ material.white")),
        "{lines}"
    );
}
