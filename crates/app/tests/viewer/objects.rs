//! Where parts of the scene are seen: the map of the view and the outline of what is chosen, over real pictures.

use super::{User, both_whole};
use egui::TextureFilter;
use scene::edit::Subject;
use visavis::model::{Resolution, View};
use visavis::viewer::Place;

fn outlines(user: &User) -> Vec<((u32, u32), TextureFilter)> {
    let uploads = user.uploads.borrow();
    uploads.iter().filter(|(place, ..)| *place == Place::Outline).map(|(_, size, filter)| (*size, *filter)).collect()
}

#[test]
fn what_is_chosen_is_outlined_over_both_pictures_of_the_view_and_nothing_is_while_parts_are_not_looked_at() {
    let mut user = User::of("cornell");
    user.change(|model| {
        model.session.resolution = Resolution::Quarter;
        model.session.view = View::SideBySide;
    });
    let frame = user.wait_for("both pictures", both_whole);
    assert!(frame.state("objects")["size"].is_null() && !frame.shows("outline A"));
    user.change(|model| model.state.parts.open = true);
    let frame = user.wait_for("the map", |f| !f.state("objects")["size"].is_null());
    assert_eq!(frame.state("objects")["outlined"], false);
    user.change(|model| {
        let name = model.document.seen().shape_name(6).into_owned();
        model.state.parts.selected = Some(Subject::Shape(name));
        model.state.parts.looked_into = Some([0.7, 0.6]);
    });
    let frame = user.wait_for("the outline", |f| f.shows("outline A") && f.shows("outline B"));
    let [width, height] = [0, 1].map(|side| frame.state("picture_size")[side].as_u64().expect("a size") as u32);
    assert_eq!(outlines(&user), [((width.div_ceil(2), height.div_ceil(2)), TextureFilter::Linear)]);
    assert!(frame.state("objects")["along"].as_array().is_some_and(|along| !along.is_empty()));
    user.change(|model| model.document.camera.fov_y += 2.0);
    user.frame();
    let frame = user.frame();
    assert!(!frame.shows("outline A") || frame.state("objects")["outlined"] == true);
    user.wait_for("the outline again", |f| f.shows("outline A") && f.shows("outline B"));
    assert_eq!(outlines(&user).len(), 2);
    user.change(|model| model.state.parts.open = false);
    user.frame();
    let frame = user.frame();
    assert!(frame.state("objects")["size"].is_null() && !frame.shows("outline A"));
}
