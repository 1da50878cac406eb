//! The system's file dialogues. A desktop portal shows them on Linux, or zenity, over the window if the server lets it.

use crate::engine::dialogue::Choice;
use crate::model::{ExportSubject, FilePurpose, FileWish};
use std::path::Path;
use winit::window::Window;

/// Begins a dialogue; on a Mac only the window's thread may.
pub fn choose(wish: &FileWish, window: &Window) -> Choice {
    let folder = wish.near.parent().filter(|folder| folder.is_dir()).map(Path::to_owned);
    let folder = folder.and_then(|folder| std::path::absolute(folder).ok());
    let dialogue = rfd::AsyncFileDialog::new().set_parent(window);
    let dialogue = match folder.or_else(|| image_file::default_folder().ok()) {
        Some(folder) => dialogue.set_directory(folder),
        None => dialogue,
    };
    match wish.purpose {
        FilePurpose::Open => Box::pin(
            dialogue
                .set_title("Open a scene, a session or a model, or a picture to see again")
                .add_filter(
                    "Scenes, models, sessions and pictures",
                    &["toml", "glb", "gltf", "ply", "obj", "png", "exr"],
                )
                .pick_file(),
        ),
        FilePurpose::Reference => {
            Box::pin(dialogue.set_title("Compare with").add_filter("References", &["exr"]).pick_file())
        }
        FilePurpose::Follow(pane) => Box::pin(
            dialogue.set_title(format!("The picture of {pane}")).add_filter("Pictures", &["exr", "png"]).pick_file(),
        ),
        FilePurpose::Export(subject) => {
            let name = wish.near.file_name().unwrap_or_default().to_string_lossy();
            let filtered = match subject {
                ExportSubject::Session => dialogue.set_title("Save the session").add_filter("Sessions", &["toml"]),
                ExportSubject::Scene => dialogue.set_title("Save the changed scene").add_filter("Scenes", &["toml"]),
                ExportSubject::Report => dialogue.set_title("Save the report").add_filter("Pages", &["html"]),
                ExportSubject::Ladder => dialogue.set_title("Save the ladder as a folder of this name"),
                _ => dialogue.set_title("Save the picture").add_filter("Pictures", &["png", "exr"]),
            };
            Box::pin(filtered.set_file_name(name).save_file())
        }
    }
}
