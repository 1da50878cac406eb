//! What files of pictures as they are seen keep: the view, what makes each pane's picture again, and the session. The
//! window opens such a file as what it shows.

use super::restore::{REGION, SESSION};
use crate::model::{ComparisonSettings, Model, PaneId, SavedSession};
use image_file::Records;
use scene::Camera;
use technique::Shot;

/// The records of a view: of what is shown by its own camera, and for each pane of the command that makes its picture.
pub fn records_of_view(
    model: &Model,
    shown: Option<(&Shot, &Camera)>,
    commands: impl Iterator<Item = (PaneId, String)>,
) -> Records {
    let session = &model.session;
    let mut records = vec![
        ("view", session.view.name().to_owned()),
        ("line", format!("{} at {}", session.line.name(), session.wipe)),
        ("exposure", session.display.exposure.to_string()),
    ];
    records.extend(records_of_comparison(&session.comparison));
    if let Some((shot, own_camera)) = shown {
        records.push(shot.hash_record());
        records.extend(shot.camera_options(own_camera));
    }
    records.extend(commands.map(|(pane, command)| (pane.name(), command)));
    let document = &model.document;
    records.push((SESSION, SavedSession::of(model, None).text(&document.scene, &document.source)));
    records
}

/// What is compared with what, and how errors are mapped.
fn records_of_comparison(comparison: &ComparisonSettings) -> Records {
    let scale = comparison.map().held.map_or_else(|| "fitted".into(), |end| end.to_string());
    let mut records = vec![
        ("against", comparison.with.name().to_owned()),
        ("errors of", comparison.of.name().to_owned()),
        ("errors", comparison.metric.name().to_owned()),
        ("scale", scale),
    ];
    records.extend(comparison.region.map(|region| (REGION, region.record())));
    records
}

/// The file that a pane's command writes.
pub fn file_of(pane: PaneId) -> String {
    format!("{}.png", pane.name().to_lowercase())
}
