//! The scene in hand: which of its parts is looked at and changed, and where parts are seen in the pictures.

use super::{Model, ViewModel, pixel_at};
use scene::camera::PictureFrame;
use scene::edit::{Property, Subject, Value};
use scene::{Camera, Scene};
use std::sync::Arc;
use technique::Shot;

/// The parts of the scene, while they are looked at.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PartsState {
    /// Whether the parts are in sight, and a click on the picture chooses one.
    pub open: bool,
    /// The part whose properties are shown.
    pub selected: Option<Subject>,
    /// Where the picture was clicked last, in shares from its upper left corner: all that lies behind each other there is
    /// found out, so that the next click there chooses what is behind.
    pub looked_into: Option<[f32; 2]>,
    /// What was told of the last change of a part, if it could not be made.
    pub refused: Option<String>,
}

/// Which shape each pixel of a view shows first, glass and all.
#[derive(Debug, Clone)]
pub struct ObjectMap {
    /// The scene that is seen, with its changes.
    pub scene: Arc<Scene>,
    /// Where it is seen from.
    pub camera: Camera,
    /// Columns and rows; a map may be coarser than the picture.
    pub size: (u32, u32),
    /// Indices of shapes, row by row from the top; [`ObjectMap::NOTHING`] where nothing is hit.
    pub shapes: Vec<u32>,
}

impl ObjectMap {
    /// Where nothing is hit.
    pub const NOTHING: u32 = u32::MAX;

    /// Columns and rows of the map of a picture: half of its pixels along each side. What is to be clicked is larger, and a
    /// quarter of the rays is soon there.
    pub fn size_for((width, height): (u32, u32)) -> (u32, u32) {
        (width.div_ceil(2), height.div_ceil(2))
    }

    /// Whether it is of what such a picture shows.
    pub fn is_of(&self, shot: &Shot) -> bool {
        self.is_of_view(&shot.scene, &shot.camera, shot.size)
    }

    fn is_of_view(&self, scene: &Arc<Scene>, camera: &Camera, size: (u32, u32)) -> bool {
        Arc::ptr_eq(&self.scene, scene) && (self.camera, self.size) == (*camera, Self::size_for(size))
    }

    /// The shape at a place in shares of the picture from its upper left corner.
    pub fn shape_at(&self, at: [f32; 2]) -> Option<usize> {
        let [column, row] = pixel_at(at, self.size);
        let index = row as usize * self.size.0 as usize + column as usize;
        self.shapes.get(index).filter(|shape| **shape != Self::NOTHING).map(|shape| *shape as usize)
    }
}

/// The shapes that lie behind each other at a place of a view, each once.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapesAlong {
    /// The place, in shares of the picture from its upper left corner.
    pub at: [f32; 2],
    /// Indices of shapes from front to back, at most [`pathtrace::MOST_ALONG`].
    pub shapes: Vec<u32>,
}

impl ShapesAlong {
    /// The shape behind another; the first behind the last, and where the other is none of them.
    pub fn behind(&self, shape: Option<usize>) -> Option<usize> {
        let place = self.shapes.iter().position(|along| Some(*along as usize) == shape);
        let next = place.map_or(0, |place| (place + 1) % self.shapes.len());
        self.shapes.get(next).map(|shape| *shape as usize)
    }
}

/// What is to be known of where parts are seen.
#[derive(Debug, Clone)]
pub struct ObjectsWish {
    /// The scene that is seen, with its changes.
    pub scene: Arc<Scene>,
    /// Where it is seen from.
    pub camera: Camera,
    /// Width and height of the picture in pixels.
    pub size: (u32, u32),
    /// The shapes that are outlined.
    pub outlined: Vec<u32>,
    /// The place at which all shapes are wanted that lie behind each other, in shares of the picture.
    pub looked_into: Option<[f32; 2]>,
}

impl PartialEq for ObjectsWish {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && (self.camera, self.size, &self.outlined) == (other.camera, other.size, &other.outlined)
            && self.looked_into == other.looked_into
    }
}

impl ObjectsWish {
    /// What the camera sees in the whole picture.
    pub fn frame(&self) -> PictureFrame {
        self.camera.frame(self.size.0 as f32 / self.size.1 as f32)
    }

    /// Whether a map is of what is wanted, whatever is outlined in it.
    pub fn is_of_the_view_of(&self, map: &ObjectMap) -> bool {
        map.is_of_view(&self.scene, &self.camera, self.size)
    }
}

/// How far from the last click, in pixels of the map, another is one at the same place: nobody holds a mouse quite still.
const SAME_PLACE: u32 = 2;

impl Model {
    /// Changes a property of a part of the scene, or leaves it to the scene again. What cannot be made is told, and left.
    pub fn edit(&mut self, subject: &Subject, property: &'static Property, value: Option<Value>) {
        let seen = self.document.seen().clone();
        let changes = &mut self.document.changes;
        match value {
            Some(value) => changes.edits.set(subject, property, value),
            None => changes.edits.reset(subject, property),
        }
        match property.name {
            // the slider of all glass stays with the others
            "ior" => changes.drop_idle_ratio(&seen),
            // there is one sun, over which its slider would hold
            "angular_radius" => changes.sun_radius = None,
            _ => {}
        }
        self.apply_changes();
    }

    /// What is to be known of where parts are seen, while they are looked at and there is a picture.
    pub fn objects_wish(&self) -> Option<ObjectsWish> {
        let (document, area, parts) = (&self.document, &self.state.picture, &self.state.parts);
        let is_seen = parts.open && area.size.0 > 0 && area.size.1 > 0;
        is_seen.then(|| ObjectsWish {
            scene: document.seen().clone(),
            camera: area.camera(&document.camera),
            size: area.size,
            outlined: parts.selected.as_ref().map_or(Vec::new(), |part| outlined(part, document.seen())),
            looked_into: parts.looked_into,
        })
    }

    /// Chooses the shape that is seen at a place of the picture, in shares from its upper left corner; at the place of the
    /// last click the one behind that which is chosen, and the first again behind the last. Where nothing is seen nothing is
    /// chosen; while it is not known what is seen, what is chosen stays.
    pub fn choose_at(&mut self, at: [f32; 2], shown: &ViewModel) {
        let Some(map) = &shown.objects else { return };
        let (scene, parts) = (self.document.seen(), &mut self.state.parts);
        let is_near = |before: &[f32; 2]| {
            let (before, at) = (pixel_at(*before, map.size), pixel_at(at, map.size));
            before[0].abs_diff(at[0]).max(before[1].abs_diff(at[1])) <= SAME_PLACE
        };
        let again = parts.looked_into.filter(is_near);
        let along = shown.along.as_ref().filter(|along| Some(along.at) == again);
        let chosen = match &parts.selected {
            Some(part @ Subject::Shape(_)) => part.index_in(scene),
            _ => None,
        };
        let next = along.map_or_else(|| map.shape_at(at), |along| along.behind(chosen));
        parts.selected = next.map(|shape| Subject::Shape(scene.shape_name(shape).into_owned()));
        parts.looked_into = again.or(Some(at));
    }

    /// Makes the document's changes. What cannot be made is told, and left.
    pub fn apply_changes(&mut self) {
        if let Err(why) = self.document.apply_changes() {
            self.say(Err(why.to_string()));
        }
    }
}

/// The shapes that show a part: itself, or all that wear it. Lights beside shapes are seen nowhere.
fn outlined(part: &Subject, scene: &Scene) -> Vec<u32> {
    let Some(index) = part.index_in(scene) else { return Vec::new() };
    match part {
        Subject::Shape(_) => vec![index as u32],
        Subject::Material(_) => {
            (0..).zip(&*scene.shapes).filter(|(_, s)| s.material == index).map(|(i, _)| i).collect()
        }
        Subject::Light(_) | Subject::Sun | Subject::Sky => Vec::new(),
    }
}

#[cfg(test)]
#[path = "parts_tests.rs"]
mod tests;
