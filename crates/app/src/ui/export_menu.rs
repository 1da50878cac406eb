//! The export menu: the picture as seen or one pane, to a file or the clipboard, or as a command to type; the session,
//! which makes all of it again; the changed scene; and a report or a slide of it.

use super::widgets::{Explained, framed, menu};
use super::{UiCommand, UiContext, dialogue_button};
use crate::model::{
    Destination, ExportRequest, ExportSubject, FilePurpose, FileWish, LADDER, Model, PaneId, PaneSource, PaneView,
    PlotFile, SWEEP, SlideSize, SweepFile, TREES,
};
use egui::Ui;
use image_file::{self, Kind};
use scene::builtin;
use std::path::{Path, PathBuf};

/// The file for the picture as seen: in the folder that was typed, or the default one.
pub fn seen_file(model: &Model) -> PathBuf {
    folder(model).join(format!("{}.png", stem(model, seen_subject(model))))
}

/// What is seen as a whole: the picture area, or all tiles of a sweep.
pub fn seen_subject(model: &Model) -> ExportSubject {
    if model.session.is_in(SWEEP) { ExportSubject::Sweep(SweepFile::Picture) } else { ExportSubject::AsSeen }
}

/// The file for a sweep, in the same folder.
pub fn sweep_file(model: &Model, file: SweepFile) -> PathBuf {
    folder(model).join(format!("{}.{}", stem(model, ExportSubject::Sweep(file)), file.name().to_lowercase()))
}

/// The folder for a ladder, in the same folder.
pub fn ladder_folder(model: &Model) -> PathBuf {
    folder(model).join(stem(model, ExportSubject::Ladder))
}

/// The file for the plot of errors, in the same folder.
pub fn plot_file(model: &Model, kind: PlotFile) -> PathBuf {
    folder(model).join(format!("{}.{}", stem(model, ExportSubject::Plot(kind)), kind.name().to_lowercase()))
}

/// The file for the lab report, in the same folder.
pub fn report_file(model: &Model) -> PathBuf {
    folder(model).join(format!("{}.html", stem(model, ExportSubject::Report)))
}

/// The file for the session, in the same folder.
pub fn session_file(model: &Model) -> PathBuf {
    folder(model).join(format!("{}.toml", stem(model, ExportSubject::Session)))
}

/// The file for the samples of a pixel, in the same folder.
pub fn samples_file(model: &Model) -> PathBuf {
    folder(model).join(format!("{}.csv", stem(model, ExportSubject::Samples)))
}

fn folder(model: &Model) -> PathBuf {
    let typed = image_file::typed_path(&model.state.export.file, &default_folder());
    if typed.is_dir() { typed } else { typed.parent().map_or_else(default_folder, Path::to_owned) }
}

fn title(subject: ExportSubject) -> String {
    match subject {
        ExportSubject::AsSeen => "As seen".into(),
        ExportSubject::Pane(pane) => format!("{pane} alone"),
        ExportSubject::ErrorMap => "The error map".into(),
        ExportSubject::Plot(_) => "The plot".into(),
        ExportSubject::Sweep(SweepFile::Picture) => "The sweep".into(),
        ExportSubject::Sweep(SweepFile::Table) => "Its table".into(),
        ExportSubject::Ladder => "The ladder".into(),
        ExportSubject::Samples => "The samples".into(),
        ExportSubject::Session => "Session".into(),
        ExportSubject::Scene => "Changed scene".into(),
        ExportSubject::Report => "Report".into(),
        ExportSubject::Slide(_) => "Slide".into(),
    }
}

/// What it is, where the name alone does not say so.
fn about(subject: ExportSubject) -> Option<&'static str> {
    match subject {
        ExportSubject::Session => Some(OF_SESSIONS),
        ExportSubject::Scene => Some(OF_SCENES),
        ExportSubject::Report => Some(OF_REPORTS),
        ExportSubject::Slide(_) => Some(OF_SLIDES),
        ExportSubject::Ladder => Some(OF_LADDERS),
        _ => None,
    }
}

/// Whether it is kept as it is shown or as linear radiance.
fn is_of_two_kinds(subject: ExportSubject) -> bool {
    matches!(subject, ExportSubject::Pane(_) | ExportSubject::ErrorMap)
}

const OF_SESSIONS: &str = "Scene, camera, A, B and view as a text (.toml): opened, it makes all of this again";

const OF_SCENES: &str =
    "What is changed in the scene and where the camera stands, as a scene (.toml) that names the one that it changes";

const OF_REPORTS: &str = "Pictures, errors, plots, settings, times, machine and session as one page (.html), to be read, printed and handed in";

const OF_SLIDES: &str =
    "The pictures of this view with large labels (.png): A or B alone, both, or both and the error map";

const OF_LADDERS: &str =
    "A folder with a picture of each rung, a table, a chart and a sheet of all: what visavis ladder makes";

/// The folder of pictures; where there is none at all, the current one.
fn default_folder() -> PathBuf {
    image_file::default_folder().unwrap_or_default()
}

/// "visavis-whitted-wipe", "visavis-whitted-path".
fn stem(model: &Model, subject: ExportSubject) -> String {
    let session = &model.session;
    let of = match (subject, session.view) {
        (ExportSubject::Pane(pane), _) => match session.source(pane) {
            PaneSource::Made => session.panes[pane].technique.name().to_owned(),
            external => external.word().to_owned(),
        },
        (ExportSubject::Plot(_), _) => format!("{}-over-{}", session.plots.measure.name(), session.plots.over.name()),
        (ExportSubject::Sweep(_), _) => sweep_name(model),
        (ExportSubject::Ladder, _) => "ladder".into(),
        (ExportSubject::Samples, _) => {
            let [column, row] = session.probe.pixel(model.state.picture.size);
            format!("samples-at-{column}-{row}")
        }
        (ExportSubject::Session, _) => "session".into(),
        (ExportSubject::Scene, _) => return name_of_changed_scene(model),
        (ExportSubject::Report, _) => "report".into(),
        (ExportSubject::Slide(_), _) => "slide".into(),
        (ExportSubject::ErrorMap, _) => format!("error-{}", session.comparison.metric.name()),
        (ExportSubject::AsSeen, _) if session.is_in(TREES) => format!("trees-level-{}", session.trees.level),
        (ExportSubject::AsSeen, _) if session.is_in(LADDER) => format!("rung-{}", session.ladder.selected.name()),
        (ExportSubject::AsSeen, view) => view.name().to_lowercase().replace(' ', "-"),
    };
    format!("visavis-{}-{of}", name_of_scene(model))
}

/// The scene's name comes from a file's; what a file may not be called stays out.
fn name_of_scene(model: &Model) -> String {
    model.document.scene.name.chars().filter(|c| c.is_alphanumeric() || "-_ ".contains(*c)).collect()
}

/// "room-edited", also of one that is called so already: the file gets a number then.
fn name_of_changed_scene(model: &Model) -> String {
    let file = file_of_scene(model).and_then(|file| Some(file.file_stem()?.to_string_lossy().into_owned()));
    let stem = file.unwrap_or_else(|| name_of_scene(model));
    if stem.ends_with("-edited") { stem } else { format!("{stem}-edited") }
}

/// The file that was opened; `None` of a built-in scene.
fn file_of_scene(model: &Model) -> Option<PathBuf> {
    let source = &model.document.source;
    builtin::text(source).is_none().then(|| std::path::absolute(source).ok()).flatten()
}

/// Where it is saved by itself: a changed scene beside the one that it changes, all else in the folder of pictures.
fn usual_folder(model: &Model, subject: ExportSubject) -> PathBuf {
    let beside = file_of_scene(model).filter(|_| subject == ExportSubject::Scene);
    beside.and_then(|file| Some(file.parent()?.to_owned())).unwrap_or_else(default_folder)
}

/// What a file of the sweep is called: "sweep-bounces", "sweep-estimator-by-sampler".
fn sweep_name(model: &Model) -> String {
    let sweep = &model.session.sweep;
    let rows = if sweep.rows.is_empty() { String::new() } else { format!("-by-{}", sweep.rows.setting) };
    format!("sweep-{}{rows}", sweep.columns.setting)
}

/// What there is to export, of the comparison, of the sweep or of trees: pictures, and what is whole.
fn subjects(cx: &UiContext) -> [Vec<ExportSubject>; 2] {
    if cx.model.session.is_in(SWEEP) {
        let files = [SweepFile::Picture, SweepFile::Table].map(ExportSubject::Sweep);
        return [files.to_vec(), vec![ExportSubject::Session, ExportSubject::Scene]];
    }
    if cx.model.session.is_in(LADDER) {
        let pictures = vec![ExportSubject::AsSeen, ExportSubject::Ladder];
        return [pictures, vec![ExportSubject::Session, ExportSubject::Scene]];
    }
    if cx.model.session.is_in(TREES) {
        return [vec![ExportSubject::AsSeen], vec![ExportSubject::Session, ExportSubject::Scene]];
    }
    let panes = cx.model.session.panes.ids().map(ExportSubject::Pane);
    let map = cx.shown.map.is_some().then_some(ExportSubject::ErrorMap);
    let pictures = std::iter::once(ExportSubject::AsSeen).chain(panes).chain(map).collect();
    let slide = ExportSubject::Slide(cx.model.state.export.slide);
    [pictures, vec![ExportSubject::Session, ExportSubject::Scene, ExportSubject::Report, slide]]
}

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    // what is not looked at is not there
    if !subjects(cx).concat().contains(&cx.model.state.export.subject) {
        cx.model.state.export.subject = seen_subject(cx.model);
    }
    let (response, _) = menu("Export").ui(ui, |ui| {
        ui.set_min_width(300.0);
        choice(cx, ui);
        file(cx, ui);
        let panes = cx.shown.panes.iter();
        let commands: Vec<_> =
            panes.filter_map(|(pane, shown)| Some((pane, command(cx.model, pane, shown)?))).collect();
        if !commands.is_empty() {
            ui.separator();
        }
        for (pane, command) in commands {
            let text = format!("Copy {pane} as command");
            let button = ui.add(framed(&text, ui)).explained(&command);
            if cx.dump.note(&format!("command {pane}"), &command, button).clicked() {
                ui.ctx().copy_text(command);
                cx.model.say(Ok(format!("Copied the command that makes {pane}")));
                ui.close();
            }
        }
    });
    cx.dump.note("export", "", response);
}

fn choice(cx: &mut UiContext, ui: &mut Ui) {
    subjects(cx).into_iter().for_each(|subjects| row(subjects, cx, ui));
    size_of_slide(cx, ui);
    let menu = &mut cx.model.state.export;
    if is_of_two_kinds(menu.subject) {
        ui.horizontal(|ui| {
            for (exr, text) in [(false, "PNG as shown"), (true, "EXR linear")] {
                let item = ui.radio_value(&mut menu.exr, exr, text);
                let item = cx.dump.note(&format!("format {text}"), menu.exr == exr, item);
                if item.clicked() && Kind::of(Path::new(menu.file.trim())).is_some() {
                    let named = Path::new(menu.file.trim()).with_extension(if exr { "exr" } else { "png" });
                    menu.file = named.display().to_string();
                }
            }
        });
    }
}

/// Subjects to choose from, side by side.
fn row(subjects: Vec<ExportSubject>, cx: &mut UiContext, ui: &mut Ui) {
    let menu = &mut cx.model.state.export;
    ui.horizontal(|ui| {
        for subject in subjects {
            let item = ui.radio_value(&mut menu.subject, subject, title(subject));
            let item = match about(subject) {
                Some(about) => item.explained(about),
                None => item,
            };
            cx.dump.note(&format!("export {}", title(subject)), menu.subject == subject, item);
        }
    });
}

fn size_of_slide(cx: &mut UiContext, ui: &mut Ui) {
    let menu = &mut cx.model.state.export;
    let ExportSubject::Slide(chosen) = &mut menu.subject else { return };
    ui.horizontal(|ui| {
        for size in SlideSize::ALL {
            let item = ui.radio_value(chosen, size, size.name().replace('x', " x "));
            cx.dump.note(&format!("slide {}", size.name()), *chosen == size, item);
        }
    });
    menu.slide = *chosen;
}

fn file(cx: &mut UiContext, ui: &mut Ui) {
    let subject = cx.model.state.export.subject;
    let menu = &mut cx.model.state.export;
    // a name that says its kind has chosen it
    menu.exr = Kind::of(Path::new(menu.file.trim())).map_or(menu.exr, |kind| kind == Kind::Exr);
    let kind = match subject {
        ExportSubject::Session | ExportSubject::Scene => "toml",
        ExportSubject::Ladder => "",
        ExportSubject::Sweep(SweepFile::Table) => "csv",
        ExportSubject::Report => "html",
        _ if menu.exr && is_of_two_kinds(subject) => "exr",
        _ => "png",
    };
    let proposal = usual_folder(cx.model, subject).join(stem(cx.model, subject)).with_added_extension(kind);
    let label = ui.label("File");
    let hint = proposal.display().to_string();
    let edit =
        egui::TextEdit::singleline(&mut cx.model.state.export.file).hint_text(&hint).desired_width(f32::INFINITY);
    let line = ui.add(edit).labelled_by(label.id).explained("A file that exists is kept: the new one gets a number");
    let entered = line.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
    cx.dump.note("export file", &cx.model.state.export.file, line);
    ui.horizontal(|ui| {
        let save = cx.dump.note(
            "save",
            "",
            ui.add(framed("Save", ui)).explained("Ctrl+S saves as seen, Ctrl+Shift+S the session, Ctrl+P a report"),
        );
        if save.clicked() || entered {
            let to = Destination::File(typed_file(&cx.model.state.export.file, proposal.clone()));
            cx.commands.push(UiCommand::Export(ExportRequest { subject, to }));
            ui.close();
        }
        let near = typed_file(&cx.model.state.export.file, proposal);
        let wish = FileWish { purpose: FilePurpose::Export(subject), near };
        if dialogue_button("choose export", "Choose where to save", wish, cx, ui) {
            ui.close();
        }
        // of which there is nothing to be seen elsewhere
        if [ExportSubject::Session, ExportSubject::Scene, ExportSubject::Report, ExportSubject::Ladder]
            .contains(&subject)
        {
            return;
        }
        let copy =
            cx.dump.note("copy picture", "", ui.add(framed("Copy picture", ui)).explained("Ctrl+C copies as seen"));
        if copy.clicked() {
            cx.commands.push(UiCommand::Export(ExportRequest { subject, to: Destination::Clipboard }));
            ui.close();
        }
    });
}

/// What was typed, as far as it goes: a folder takes the proposed name, a name without a kind takes the proposed one.
fn typed_file(typed: &str, proposal: PathBuf) -> PathBuf {
    if typed.trim().is_empty() {
        return proposal;
    }
    let path = image_file::typed_path(typed, proposal.parent().unwrap_or(Path::new("")));
    if path.is_dir() {
        return path.join(proposal.file_name().unwrap_or_default());
    }
    match (Kind::of(&path), proposal.extension()) {
        (None, Some(kind)) if path.extension().is_none() => path.with_extension(kind),
        _ => path,
    }
}

/// The line that makes the pane's picture again, as far as it has come; `None` of another program's.
fn command(model: &Model, pane: PaneId, shown: &PaneView) -> Option<String> {
    let provenance = shown.provenance.as_ref().filter(|_| shown.external.is_none())?;
    let wished = model.session.panes[pane].wished_spp().unwrap_or(1);
    let (spp, runs) = match shown.spp.filter(|_| !shown.rough) {
        Some(spp) => (spp / shown.runs.max(1), shown.runs),
        None => (wished, provenance.technique.runs()),
    };
    let out = format!("{}.png", stem(model, ExportSubject::Pane(pane)));
    Some(provenance.of_runs(runs).command(spp, model.session.display.exposure, &out))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_typed_name_is_completed_from_the_proposal() {
        let proposal = PathBuf::from("/home/pictures/visavis.exr");
        assert_eq!(typed_file(" ", proposal.clone()), proposal);
        assert_eq!(typed_file("a/b", proposal.clone()), Path::new("/home/pictures/a/b.exr"));
        assert_eq!(typed_file(" /b.png ", proposal.clone()), Path::new("/b.png"));
        // the exporter says what it thinks of that
        assert_eq!(typed_file("/b.gif", proposal.clone()), Path::new("/b.gif"));
        let folder = std::env::temp_dir();
        assert_eq!(typed_file(&folder.display().to_string(), proposal), folder.join("visavis.exr"));
    }
}
