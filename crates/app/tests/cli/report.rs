//! Lab reports and slides without a window.

use super::{assert_refused, json, program, visavis};
use std::path::Path;
use std::process::Output;
use visavis_tests::TestFolder;

/// With references kept in a folder of the test, for all commands of it to judge by.
fn beside(folder: &TestFolder, arguments: &[&str]) -> Output {
    program().env("VISAVIS_CACHE", folder.file("cache")).args(arguments).output().expect("the program")
}

fn assert_done(output: &Output) {
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && output.stdout.is_empty(), "{told}");
}

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

/// The first number behind each `name` in a JSON object, as pages write it.
fn six_decimals(errors: &serde_json::Value, names: &[&str]) -> Vec<String> {
    names.iter().map(|name| format!("{:.6}", errors[name].as_f64().expect("a number"))).collect()
}

#[test]
fn a_report_tells_the_figures_of_compare() {
    let folder = TestFolder::new();
    let [page, a, b] = ["report.html", "a.exr", "b.exr"].map(|name| folder.file(name));
    let arguments = ["report", "cornell", "--a", "path,cosine,spp=4", "--b", "path,spp=4", "--size", "16x12"];
    assert_done(&beside(&folder, &[&arguments[..], &["-o", text(&page)]].concat()));
    let html = std::fs::read_to_string(&page).expect("the page");
    for (out, estimator) in [(&a, "cosine"), (&b, "light")] {
        let render = ["render", "cornell", "--size", "16x12", "--spp", "4", "--estimator", estimator, "-o", text(out)];
        assert!(beside(&folder, &render).status.success());
    }
    let compared = json(&beside(&folder, &["compare", text(&a), "--json"]));
    let [rel_mse, rmse, mae, flip] = &six_decimals(&compared, &["relmse", "rmse", "mae", "flip"])[..] else { panic!() };
    let row = format!("<td class=\"n\">{rel_mse}</td><td class=\"n\">{rmse}</td><td class=\"n\">{mae}</td>");
    assert!(html.contains(&row) && html.contains(&format!("{flip}</td></tr>")), "{row} {flip}");
    let other = json(&beside(&folder, &["compare", text(&a), text(&b), "--json"]));
    let rmse_of_both = &six_decimals(&other, &["rmse"])[0];
    assert!(html.contains(&format!("<td class=\"n\">{rmse_of_both}</td>")), "A against B: {rmse_of_both}");
    assert!(html.contains("--estimator cosine") && html.contains("visavis reference cornell -o reference.exr"));
    assert_eq!(html.matches("<svg ").count(), 2, "over samples and over seconds");
}

#[test]
fn a_session_makes_a_report_and_its_scenes_name_stays_text() {
    let folder = TestFolder::new();
    let scene = folder.file("<b>room & 'lamp'.toml");
    let copied = scene::builtin::text("cornell").expect("a built-in scene");
    std::fs::write(&scene, copied).expect("a file");
    let session = folder.file("lecture.toml");
    let words = "session = 1\nscene = \"<b>room & 'lamp'.toml\"\n[panes.A]\ntechnique = \"path\"\nbounces = 0\nspp = 2\n\
                 [panes.B]\nspp = 2\n";
    std::fs::write(&session, words).expect("a file");
    let page = folder.file("report.html");
    assert_done(&beside(&folder, &["report", text(&session), "--size", "12x12", "-o", text(&page)]));
    let html = std::fs::read_to_string(&page).expect("the page");
    assert!(!html.contains("<b>room") && html.contains("&lt;b&gt;room &amp; &#39;lamp&#39;"), "escaped");
    assert!(html.contains("A: Path tracing, 0 bounces"), "what the session says");
    // what stands on the page makes it again, from the same folder
    let (_, behind) = html.split_once("<summary>The session</summary>").expect("the session");
    let (_, behind) = behind.split_once("<pre><code>").expect("its text");
    let kept = behind.split("</code>").next().expect("its end");
    let entities = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&#39;", "'"), ("&amp;", "&")];
    let kept = entities.iter().fold(kept.to_owned(), |text, (entity, c)| text.replace(entity, c));
    std::fs::write(&session, kept).expect("a file");
    let again = folder.file("again.html");
    assert_done(&beside(&folder, &["report", text(&session), "--size", "12x12", "-o", text(&again)]));
    let errors = |html: &str| {
        let (_, behind) = html.split_once("<h2>Errors</h2>").expect("errors");
        behind.split("</section>").next().map(str::to_owned)
    };
    assert_eq!(errors(&std::fs::read_to_string(&again).expect("the page")), errors(&html));
}

#[test]
fn a_slide_is_exactly_as_large_as_it_says_and_opens_as_what_it_shows() {
    let folder = TestFolder::new();
    let arguments = |slide: &Path, more: &[&str]| {
        let panes = ["report", "cornell", "--a", "path,bounces=0,spp=1", "--b", "path,spp=1", "--against", "other"];
        beside(&folder, &[&panes[..], more, &["-o", text(slide)]].concat())
    };
    for (name, more, size) in
        [("small.png", &[][..], (1920, 1080)), ("large.png", &["--slide-size", "3840x2160"], (3840, 2160))]
    {
        let slide = folder.file(name);
        assert_done(&arguments(&slide, more));
        assert_eq!(image_file::load(&slide).expect("a picture").size(), size);
        let records = image_file::records(&slide).expect("records");
        let record = |name: &str| records.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str());
        assert!(record("A").is_some_and(|command| command.contains("--bounces 0")), "{records:?}");
        assert!(record("B").is_some_and(|command| command.contains("--spp 1")) && record("session").is_some());
    }
    let page = folder.file("of-a-slide.html");
    let slide = folder.file("small.png");
    assert_done(&beside(
        &folder,
        &["report", text(&slide), "--size", "12x12", "--against", "other", "-o", text(&page)],
    ));
    let html = std::fs::read_to_string(page).expect("the page");
    assert!(html.contains("A: Path tracing, 0 bounces"), "what the slide shows");
}

/// More samples than a tenth of a second has room for.
#[test]
fn a_page_says_what_a_limit_of_time_has_left() {
    let folder = TestFolder::new();
    let page = folder.file("report.html");
    let panes =
        ["report", "cornell", "--a", "path,spp=1", "--b", "path,spp=65536,denoise=atrous", "--against", "other"];
    let made = beside(&folder, &[&panes[..], &["--size", "64x64", "--time", "0.1", "-o", text(&page)]].concat());
    assert_done(&made);
    let html = std::fs::read_to_string(page).expect("the page");
    assert_eq!(
        html.matches(" of 65536 samples per pixel").count(),
        2,
        "under B, and in the words for who cannot see it"
    );
    assert!(!html.contains(" of 1 samples"), "A is whole");
}

#[test]
fn what_makes_no_report_is_refused_in_a_line_and_nothing_is_left() {
    let folder = TestFolder::new();
    let page = folder.file("report.html");
    let out = text(&page);
    assert_refused(&["report"], 2, &["needs a scene", "visavis report SCENE"]);
    assert_refused(&["report", "cornell"], 2, &["needs a file to write"]);
    assert_refused(&["report", "cornell", "-o", "a.pdf"], 2, &["-o must end in .html", "a.pdf"]);
    assert_refused(&["report", "cornell", "--slide-size", "3840x2160", "-o", out], 2, &["--slide-size is of slides"]);
    assert_refused(&["report", "cornell", "--size", "9x9", "-o", "a.png"], 2, &["--size", "--slide-size"]);
    assert_refused(&["report", "cornell", "--slide-size", "800x600", "-o", "a.png"], 2, &["1920x1080 or 3840x2160"]);
    assert_refused(&["report", "cornell", "--spp", "0", "-o", out], 2, &["--spp 0", "expected"]);
    assert_refused(&["report", "cornell", "--slide", "2c", "-o", out], 2, &["leave one of the two"]);
    assert_refused(&["report", "nowhere.toml", "-o", out], 1, &["nowhere.toml"]);
    assert_refused(&["report", "cornell", "--eye", "0,0,0", "--target", "0,0,0", "-o", out], 1, &["sees nothing"]);
    let unwritable = folder.file("missing/report.html");
    assert_refused(&["report", "cornell", "-o", text(&unwritable)], 1, &["missing"]);
    let session = folder.file("faulty.toml");
    std::fs::write(&session, "session = 1\nscene = \"cornell\"\n[view]\nshow = \"all\"\n").expect("a file");
    assert_refused(&["report", text(&session), "-o", out], 1, &["faulty.toml:4:", "show"]);
    let guided = ["report", "cornell", "--a", "path,guided", "--device", "gpu", "-o", out];
    assert_refused(&guided, 1, &["A cannot be made by the gpu"]);
    let picture = folder.file("seen.png");
    let render = ["render", "cornell", "--size", "4x4", "--spp", "1", "-o", text(&picture)];
    assert!(visavis(&render).status.success());
    let before = std::fs::read(&picture).expect("the picture");
    assert_refused(&["report", text(&picture), "-o", text(&picture)], 1, &["overwrite", "seen.png"]);
    assert!(std::fs::read(&picture).expect("the picture") == before);
    std::fs::remove_file(picture).expect("gone");
    assert!(!page.exists());
    let left: Vec<_> =
        std::fs::read_dir(folder.file("")).expect("the folder").flatten().map(|f| f.file_name()).collect();
    assert_eq!(left, ["faulty.toml"], "nothing half-written");
    let help = visavis(&["report", "--help"]);
    assert!(String::from_utf8_lossy(&help.stdout).contains("visavis report SCENE -o OUT"));
}
