//! The export menu: the picture as seen or one pane, to a file or the clipboard, or as a command to type.

use super::widgets::{framed, menu};
use super::{Dump, Pane, UiCommand, View, ViewModel, Viewer};
use crate::engine::Side;
use crate::engine::export::Destination;
use egui::Ui;
use image_file::{self, Kind};
use std::path::{Path, PathBuf};

/// What is exported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum What {
    /// The picture area as it is on the screen: both panes, line and labels.
    #[default]
    Seen,
    /// One pane, whole and without labels.
    Pane(Side),
    /// The map of errors, with its colour bar and without labels.
    Map,
}

/// What is typed and chosen there.
#[derive(Debug, Default)]
pub struct ExportMenu {
    what: What,
    /// As typed; the proposal while it is empty.
    file: String,
    exr: bool,
}

impl What {
    const ALL: [What; 4] = [What::Seen, What::Pane(Side::A), What::Pane(Side::B), What::Map];

    fn title(self) -> &'static str {
        match self {
            What::Seen => "As seen",
            What::Pane(Side::A) => "A alone",
            What::Pane(Side::B) => "B alone",
            What::Map => "The error map",
        }
    }
}

impl ExportMenu {
    /// The file for the picture as seen: in the folder that was typed, or the default one.
    pub fn seen_file(&self, viewer: &Viewer) -> PathBuf {
        let typed = image_file::typed_path(&self.file, &default_folder());
        let folder = if typed.is_dir() { typed } else { typed.parent().map_or_else(default_folder, Path::to_owned) };
        folder.join(format!("{}.png", stem(viewer, What::Seen)))
    }
}

/// The folder of pictures; where there is none at all, the current one.
fn default_folder() -> PathBuf {
    image_file::default_folder().unwrap_or_default()
}

/// "visavis-whitted-wipe", "visavis-whitted-path".
fn stem(viewer: &Viewer, what: What) -> String {
    let of = match (what, viewer.view) {
        (What::Pane(side), _) => viewer.settings.panes[side as usize].technique.name().to_owned(),
        (What::Map, _) => format!("error-{}", viewer.comparison.map.name()),
        (What::Seen, View::A) => "a".into(),
        (What::Seen, View::B) => "b".into(),
        (What::Seen, view) => view.name().to_lowercase().replace(' ', "-"),
    };
    // a scene's name comes from a file's; what a file may not be called stays out
    let scene: String = viewer.scene.name.chars().filter(|c| c.is_alphanumeric() || "-_ ".contains(*c)).collect();
    format!("visavis-{scene}-{of}")
}

pub fn show(viewer: &mut Viewer, ui: &mut Ui, model: &ViewModel, dump: &mut Dump, commands: &mut Vec<UiCommand>) {
    // a map that is not looked at is not there
    if model.map.is_none() && viewer.export.what == What::Map {
        viewer.export.what = What::Seen;
    }
    let (response, _) = menu("Export").ui(ui, |ui| {
        ui.set_min_width(300.0);
        choice(viewer, ui, model.map.is_some(), dump);
        file(viewer, ui, dump, commands);
        ui.separator();
        for (side, pane) in [Side::A, Side::B].into_iter().zip(&model.panes) {
            let Some(command) = command(viewer, side, pane) else { continue };
            let text = format!("Copy {side:?} as command");
            let button = ui.add(framed(&text, ui)).on_hover_text(&command);
            if dump.note(&format!("command {side:?}"), &command, button).clicked() {
                ui.ctx().copy_text(command);
                viewer.say(Ok(format!("Copied the command that makes {side:?}")));
                ui.close();
            }
        }
    });
    dump.note("export", "", response);
}

fn choice(viewer: &mut Viewer, ui: &mut Ui, with_map: bool, dump: &mut Dump) {
    let menu = &mut viewer.export;
    ui.horizontal(|ui| {
        for what in What::ALL.into_iter().filter(|what| with_map || *what != What::Map) {
            let item = ui.radio_value(&mut menu.what, what, what.title());
            dump.note(&format!("export {}", what.title()), menu.what == what, item);
        }
    });
    if menu.what != What::Seen {
        ui.horizontal(|ui| {
            for (exr, text) in [(false, "PNG as shown"), (true, "EXR linear")] {
                let item = ui.radio_value(&mut menu.exr, exr, text);
                let item = dump.note(&format!("format {text}"), menu.exr == exr, item);
                if item.clicked() && Kind::of(Path::new(menu.file.trim())).is_some() {
                    let named = Path::new(menu.file.trim()).with_extension(if exr { "exr" } else { "png" });
                    menu.file = named.display().to_string();
                }
            }
        });
    }
}

fn file(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump, commands: &mut Vec<UiCommand>) {
    let what = viewer.export.what;
    let menu = &mut viewer.export;
    // a name that says its kind has chosen it
    menu.exr = Kind::of(Path::new(menu.file.trim())).map_or(menu.exr, |kind| kind == Kind::Exr);
    let exr = menu.exr && what != What::Seen;
    let proposal = default_folder().join(format!("{}.{}", stem(viewer, what), if exr { "exr" } else { "png" }));
    let label = ui.label("File");
    let hint = proposal.display().to_string();
    let edit = egui::TextEdit::singleline(&mut viewer.export.file).hint_text(&hint).desired_width(f32::INFINITY);
    let line =
        ui.add(edit).labelled_by(label.id).on_hover_text("A file that exists is kept: the new one gets a number");
    let entered = line.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
    dump.note("export file", &viewer.export.file, line);
    ui.horizontal(|ui| {
        let save = dump.note("save", "", ui.add(framed("Save", ui)).on_hover_text("Ctrl+S saves as seen"));
        if save.clicked() || entered {
            let to = Destination::File(typed_file(&viewer.export.file, proposal));
            commands.push(UiCommand::Export { what, to });
            ui.close();
        }
        let copy =
            dump.note("copy picture", "", ui.add(framed("Copy picture", ui)).on_hover_text("Ctrl+C copies as seen"));
        if copy.clicked() {
            commands.push(UiCommand::Export { what, to: Destination::Clipboard });
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

/// The line that makes the pane's picture again, as far as it has come.
fn command(viewer: &Viewer, side: Side, pane: &Pane) -> Option<String> {
    let provenance = pane.provenance.as_ref()?;
    let wished = viewer.settings.panes[side as usize].wished_spp().unwrap_or(1);
    let spp = pane.spp.filter(|_| !pane.rough).unwrap_or(wished);
    let out = format!("{}.png", stem(viewer, What::Pane(side)));
    Some(provenance.command(spp, viewer.settings.display.exposure, &out))
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
