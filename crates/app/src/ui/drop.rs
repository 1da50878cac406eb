//! Files that are dragged onto the window: says what would be done with them, and does it.

use super::{UiCommand, UiContext};
use egui::{Align2, Color32, Context, FontId, Id, LayerId, Order, TextStyle};
use image_file::{Kind, shown};
use std::path::{Path, PathBuf};

pub fn show(cx: &mut UiContext, context: &Context) {
    let paths = |files: Vec<Option<PathBuf>>| files.into_iter().flatten().collect::<Vec<_>>();
    let hovered = paths(context.input(|i| i.raw.hovered_files.iter().map(|file| file.path.clone()).collect()));
    let dropped =
        paths(context.input(|i| i.raw.dropped_files.iter().map(|file| Some(file.path().to_owned())).collect()));
    if let Some(outcome) = promise(&dropped) {
        match outcome {
            Ok(_) => cx.commands.push(UiCommand::Open(dropped[0].display().to_string())),
            Err(why) => cx.model.say(Err(why)),
        }
    } else if let Some(outcome) = promise(&hovered) {
        announce(cx, context, &outcome.unwrap_or_else(|why| why));
    }
}

/// What would be done with these files, or why nothing; `None` of none.
fn promise(files: &[PathBuf]) -> Option<Result<String, String>> {
    let file = match files {
        [] => return None,
        [file] => file,
        several => return Some(Err(format!("{} files at once: drop one scene or one picture", several.len()))),
    };
    let name = shown(Path::new(file.file_name().unwrap_or(file.as_os_str())));
    Some(match Kind::of(file) {
        Some(Kind::Png) => Ok(format!("Drop to see again what {name} shows")),
        Some(Kind::Exr) => {
            Ok(format!("Drop to see again what {name} shows; if it does not say that, to compare with it"))
        }
        None if is_a(file, &["toml"]) => Ok(format!("Drop to open {name}, a scene or a session")),
        None if is_a(file, &["glb", "gltf"]) => Ok(format!("Drop to open {name}, a model")),
        None if is_a(file, &["ply", "obj"]) => {
            Ok(format!("Drop to look at {name}, a model, on a floor under sun and sky"))
        }
        None => Err(format!(
            "{name} is neither a scene (.toml), nor a model (.glb, .gltf, .ply, .obj), nor a picture (.png, .exr)"
        )),
    })
}

fn is_a(file: &Path, kinds: &[&str]) -> bool {
    file.extension().is_some_and(|suffix| kinds.iter().any(|kind| suffix.eq_ignore_ascii_case(kind)))
}

/// Over all that there is.
fn announce(cx: &mut UiContext, context: &Context, text: &str) {
    let (rect, id) = (context.content_rect(), Id::unique("announced drop"));
    let painter = context.layer_painter(LayerId::new(Order::Foreground, id));
    painter.rect_filled(rect, 0.0, Color32::from_black_alpha(200));
    let font = FontId::proportional(1.4 * TextStyle::Body.resolve(&context.global_style()).size);
    let galley = painter.layout(text.to_owned(), font, Color32::WHITE, 0.9 * rect.width());
    let place = Align2::CENTER_CENTER.anchor_size(rect.center(), galley.size());
    painter.galley(place.min, galley, Color32::WHITE);
    cx.dump.note_text("drop", text, place, rect);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_drop_would_do_is_said_by_the_kind_of_file() {
        let said = |names: &[&str]| promise(&names.iter().map(PathBuf::from).collect::<Vec<_>>());
        assert_eq!(said(&[]), None);
        assert_eq!(said(&["a/b.TOML"]), Some(Ok("Drop to open b.TOML, a scene or a session".into())));
        assert!(said(&["bunny.OBJ"]).is_some_and(|it| it.is_ok_and(|line| line.contains("a model"))));
        assert_eq!(said(&["duck.glb"]), Some(Ok("Drop to open duck.glb, a model".into())));
        assert!(said(&["b.png"]).is_some_and(|it| it.is_ok_and(|line| line.contains("what b.png shows"))));
        assert!(said(&["b.exr"]).is_some_and(|it| it.is_ok_and(|line| line.contains("compare with it"))));
        for refused in [&["bunny.stl"][..], &["a.toml", "b.toml"], &["folder"]] {
            assert!(said(refused).is_some_and(|it| it.is_err()), "{refused:?}");
        }
    }
}
