//! The menu of scenes: built-in ones, those beside the one that is open, files of before, and any other by its name.

use super::widgets::{Explained, framed, menu};
use super::{UiCommand, UiContext, dialogue_button};
use crate::model::{CASES, FilePurpose, FileWish};
use egui::{
    Atom, Button, Color32, Grid, Image, Rect, Response, RichText, ScrollArea, Sense, TextureId, Ui, Vec2, pos2, vec2,
};
use image_file::shown;
use scene::builtin;
use std::path::{Path, PathBuf};

/// The most letters of a scene's name that the bar shows.
const MOST_LETTERS: usize = 18;

/// Height in points beyond which a list of files scrolls.
const TALLEST: f32 = 150.0;

/// Width and height in points of a scene's picture, and how many stand in a row.
const PICTURE: Vec2 = vec2(66.0, 44.0);
const IN_A_ROW: usize = 2;

/// Width in points of what is said of a hard case.
const ABOUT: f32 = 360.0;

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let name = &cx.model.document.scene.name;
    let short: String = name.chars().take(MOST_LETTERS).collect();
    let title = if short == *name { format!("Scene: {name}") } else { format!("Scene: {short}…") };
    let (response, _) = menu(title).ui(ui, |ui| {
        built_in(cx, ui);
        let hard = ui.menu_button("Hard cases", |ui| hard_cases(cx, ui));
        cx.dump.note("hard cases", "", hard.response);
        let neighbours = cx.model.state.neighbours.clone();
        let recent = cx.model.state.remembered.recent.clone();
        let all = [neighbours.clone(), recent.clone()].concat();
        // those of one folder have names of their own
        files(&folder_of(&neighbours), "beside", (&neighbours, &recent), cx, ui);
        files("Opened before", "recent", (&recent, &all), cx, ui);
        ui.separator();
        by_name(cx, ui);
        read_again(cx, ui);
    });
    cx.dump.note("scene", &cx.model.document.scene.name, response);
}

/// Each with its picture.
fn built_in(cx: &mut UiContext, ui: &mut Ui) {
    if !std::mem::replace(&mut cx.model.state.thumbnails[0], true) {
        cx.commands.push(UiCommand::DrawThumbnails(builtin::names().collect()));
    }
    Grid::new("built-in scenes").num_columns(IN_A_ROW).spacing(vec2(4.0, 2.0)).show(ui, |ui| {
        for (place, name) in builtin::names().enumerate() {
            let picture = picture(cx.textures.thumbnails.get(name).copied());
            let chosen = cx.model.document.source == name;
            let item = ui.add(Button::selectable(chosen, (picture, name)));
            let item = item.explained(&builtin::about(name).unwrap_or_default());
            let item = cx.dump.note(&format!("scene {name}"), "", item);
            open_if_clicked(&item, name, cx, ui);
            if (place + 1) % IN_A_ROW == 0 {
                ui.end_row();
            }
        }
    });
}

/// Takes its room before it is there.
fn picture(texture: Option<TextureId>) -> Atom<'static> {
    Atom::paint(PICTURE, move |ui, args| {
        if let Some(texture) = texture {
            ui.painter().image(texture, args.rect, Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)), Color32::WHITE);
        }
    })
}

fn open_if_clicked(item: &Response, name: &str, cx: &mut UiContext, ui: &mut Ui) {
    if item.clicked() {
        cx.commands.push(UiCommand::Open(name.to_owned()));
        ui.close();
    }
}

/// Each with its picture and what it is for.
fn hard_cases(cx: &mut UiContext, ui: &mut Ui) {
    if !std::mem::replace(&mut cx.model.state.thumbnails[1], true) {
        // one wish takes the place of the other
        cx.commands.push(UiCommand::DrawThumbnails(builtin::names().chain(builtin::hard_names()).collect()));
    }
    let measure = ui.button("Measure them ...");
    let measure = measure.explained("What each claims, measured here beside what was expected");
    if cx.dump.note("measure hard cases", "", measure).clicked() {
        cx.model.session.workspace = CASES;
        ui.close();
    }
    let tallest = (ui.ctx().content_rect().height() - 150.0).max(100.0);
    ScrollArea::vertical().max_height(tallest).show(ui, |ui| {
        for name in builtin::hard_names() {
            ui.horizontal(|ui| hard_case(name, cx, ui));
        }
    });
}

fn hard_case(name: &'static str, cx: &mut UiContext, ui: &mut Ui) {
    let (size, sense) = (vec2(96.0, 64.0), Sense::CLICK);
    let picture = match cx.textures.thumbnails.get(name) {
        Some(texture) => {
            let image = ui.add(Image::new((*texture, size)).sense(sense));
            cx.dump.note(&format!("thumbnail {name}"), "", image)
        }
        None => ui.allocate_response(size, sense),
    };
    open_if_clicked(&picture, name, cx, ui);
    ui.vertical(|ui| {
        ui.set_width(ABOUT);
        let item = cx.dump.note(&format!("scene {name}"), "", ui.button(name));
        open_if_clicked(&item, name, cx, ui);
        ui.label(RichText::new(builtin::about(name).unwrap_or_default()).weak());
    });
}

/// "In scenes", after the folder.
fn folder_of(files: &[PathBuf]) -> String {
    let folder = files.first().and_then(|file| std::path::absolute(file).ok()).unwrap_or_default();
    let name = folder.parent().and_then(Path::file_name).unwrap_or(std::ffi::OsStr::new("/"));
    format!("In {}", shown(Path::new(name)))
}

/// A file's name; with its folder's, or all its path, where another one of `all` has the same.
fn name_among(file: &Path, all: &[PathBuf]) -> String {
    let whole = |file: &Path| std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    let name = |file: &Path| shown(Path::new(file.file_name().unwrap_or(file.as_os_str())));
    let with_folder = |file: &Path| match whole(file).parent().and_then(Path::file_name) {
        Some(folder) => format!("{} ({})", name(file), shown(Path::new(folder))),
        None => name(file),
    };
    let of_its_name = all.iter().filter(|other| other.file_name() == file.file_name());
    let own = whole(file);
    let others: Vec<_> = of_its_name.filter(|other| whole(other) != own).collect();
    if others.is_empty() {
        name(file)
    } else if others.iter().all(|other| with_folder(other) != with_folder(file)) {
        with_folder(file)
    } else {
        shown(&own)
    }
}

/// Files by their names among `all` under a title; nothing where there are none.
fn files(title: &str, kind: &str, (files, all): (&[PathBuf], &[PathBuf]), cx: &mut UiContext, ui: &mut Ui) {
    if files.is_empty() {
        return;
    }
    ui.separator();
    ui.label(RichText::new(title).weak());
    ScrollArea::vertical().id_salt(kind).max_height(TALLEST).show(ui, |ui| {
        for file in files {
            let name = name_among(file, all);
            let chosen = Path::new(&cx.model.document.source) == file;
            let item = ui.selectable_label(chosen, &name).explained(&shown(file));
            let item = cx.dump.note(&format!("{kind} {name}"), chosen, item);
            open_if_clicked(&item, &file.display().to_string(), cx, ui);
        }
    });
}

fn by_name(cx: &mut UiContext, ui: &mut Ui) {
    let label = ui
        .label("A scene (.toml) or a model (.glb, .gltf, .ply, .obj):")
        .explained("Or a session (.toml) or a picture of this program (.png, .exr), which is shown again");
    let edit = egui::TextEdit::singleline(&mut cx.model.state.scene_file).hint_text("folder/scene.toml");
    let line = ui.add(edit).labelled_by(label.id);
    let entered = line.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
    cx.dump.note("scene file", &cx.model.state.scene_file, line);
    ui.horizontal(|ui| {
        let open = cx.dump.note("open", "", ui.add(framed("Open", ui)));
        let typed = cx.model.state.scene_file.trim();
        if (open.clicked() || entered) && !typed.is_empty() {
            let built_in = builtin::text(typed).is_some();
            let path = image_file::typed_path(typed, Path::new(""));
            cx.commands.push(UiCommand::Open(if built_in { typed.to_owned() } else { path.display().to_string() }));
            ui.close();
        }
        let near = PathBuf::from(&cx.model.document.source);
        let wish = FileWish { purpose: FilePurpose::Open, near };
        if dialogue_button("choose scene", "Choose a scene or a picture", wish, cx, ui) {
            ui.close();
        }
    });
}

/// Only a file can have changed.
fn read_again(cx: &mut UiContext, ui: &mut Ui) {
    if builtin::text(&cx.model.document.source).is_some() {
        return;
    }
    let button = ui.add(framed("Read again", ui)).explained(
        "The scene is read again by itself when its file changes, or one that it names: its base, a picture, a model (Ctrl+R reads it at once)",
    );
    if cx.dump.note("read again", "", button).clicked() {
        cx.commands.push(UiCommand::ReadAgain);
        ui.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_one_name_are_told_by_their_folders() {
        let names = |files: &[&str]| -> Vec<String> {
            let files: Vec<_> = files.iter().map(PathBuf::from).collect();
            files.iter().map(|file| name_among(file, &files)).collect()
        };
        assert_eq!(names(&["/p/a.toml", "/q/b.toml"]), ["a.toml", "b.toml"]);
        assert_eq!(names(&["/p/a.toml", "/q/a.toml", "/a.toml"]), ["a.toml (p)", "a.toml (q)", "a.toml"]);
        assert_eq!(names(&["/r/p/a.toml", "/s/p/a.toml"]), ["/r/p/a.toml", "/s/p/a.toml"]);
        assert_eq!(names(&["/p/a.toml", "/p/a.toml"]), ["a.toml", "a.toml"], "one file in two lists");
        let here = std::path::absolute("a.toml").expect("a path").display().to_string();
        assert_eq!(names(&["a.toml", &here]), ["a.toml", "a.toml"]);
    }
}
