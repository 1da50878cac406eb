//! States of a pane's picture while it was made, at every doubling of its samples, or of how often another program's has
//! changed: a reference that comes later, or becomes
//! better, still shows how the errors have fallen.

use super::earlier::is_same_picture;
use super::{Order, Picture, bare};
use crate::model::{ErrorPoint, External};
use compare::Errors;
use film::Image;
use std::sync::Arc;

/// Bytes of states that a pane keeps at most: every second one goes where there are more.
const MOST_BYTES: usize = 64 << 20;

/// The states of one picture, the earliest first.
#[derive(Debug)]
pub struct Course {
    order: Order,
    external: Option<Arc<External>>,
    states: Vec<State>,
}

#[derive(Debug)]
struct State {
    /// Samples so far; of another program's picture, which may not tell them, how often it has changed.
    steps: u32,
    spp: Option<u32>,
    seconds: f64,
    image: Image,
}

impl Course {
    /// Goes on with a pane's new picture; `None` of one that is made here without samples of its own alone.
    pub fn follow(before: Option<Course>, picture: &Picture) -> Option<Course> {
        let steps = steps(picture).filter(|_| !picture.rough && picture.lag.is_none())?;
        let (spp, seconds) = (picture.spp, picture.seconds);
        let state = State { steps, spp, seconds, image: bare(&picture.image) };
        let goes_on =
            |before: &Course| before.is_of_the_same(picture) && before.latest().is_none_or(|latest| latest <= steps);
        let states = before.filter(goes_on).map_or_else(Vec::new, |before| before.states);
        let mut course = Course { order: picture.order.clone(), external: picture.external.clone(), states };
        if course.latest().is_none_or(|latest| steps / 2 >= latest) {
            course.states.push(state);
            course.thin_out();
        }
        Some(course)
    }

    /// Whether a picture is a later state of what these are states of.
    fn is_of_the_same(&self, picture: &Picture) -> bool {
        match (&self.external, &picture.external) {
            (None, None) => is_same_picture(&self.order, &picture.order),
            (Some(a), Some(b)) => {
                let seen = |order: &Order| (order.view, order.restarts);
                (&a.source, &a.name) == (&b.source, &b.name) && seen(&self.order) == seen(&picture.order)
            }
            _ => false,
        }
    }

    fn latest(&self) -> Option<u32> {
        self.states.last().map(|state| state.steps)
    }

    fn bytes(&self) -> usize {
        self.states.iter().map(|state| size_of_val(state.image.radiances())).sum()
    }

    /// The first and the latest stay.
    fn thin_out(&mut self) {
        while self.bytes() > MOST_BYTES && self.states.len() > 2 {
            let (mut index, last) = (0, self.states.len() - 1);
            self.states.retain(|_| {
                index += 1;
                index % 2 == 1 || index - 1 == last
            });
        }
    }

    /// Their errors, as `errors` measures each.
    pub fn measured(&self, errors: impl Fn(&Image) -> Option<Errors>) -> Vec<ErrorPoint> {
        let point = |state: &State| {
            let errors = errors(&state.image)?;
            Some(ErrorPoint { spp: state.spp, seconds: state.seconds, errors })
        };
        self.states.iter().filter_map(point).collect()
    }
}

/// How far a picture has come, by what it counts; `None` of one that is done at once.
fn steps(picture: &Picture) -> Option<u32> {
    match &picture.external {
        Some(external) => Some(u32::try_from(external.changes).unwrap_or(u32::MAX).max(1)),
        None => picture.spp,
    }
}

#[cfg(test)]
mod tests {
    use super::super::earlier::tests::picture;
    use super::*;
    use film::Vec3;
    use technique::TechniqueName;

    fn samples(course: &Course) -> Vec<u32> {
        course.states.iter().map(|state| state.steps).collect()
    }

    fn of(all: &[u32]) -> Course {
        let pictures = all.iter().map(|spp| picture(TechniqueName::Path, 1, *spp));
        pictures.fold(None, |course, picture| Course::follow(course, &picture)).unwrap()
    }

    #[test]
    fn states_are_kept_at_every_doubling_and_measured_by_a_reference_that_comes_later() {
        let course = of(&[1, 2, 3, 4, 5, 9, 16, 17, 40]);
        assert_eq!(samples(&course), [1, 2, 4, 9, 40]);
        let shown = |image: &Image| Some(Errors { rmse: f64::from(image.radiances()[0].x), ..Errors::default() });
        let points = course.measured(shown);
        assert_eq!(points.iter().map(|point| point.errors.rmse).collect::<Vec<_>>(), [1.0, 2.0, 4.0, 9.0, 40.0]);
    }

    #[test]
    fn another_picture_begins_anew() {
        let with = |next: Picture| Course::follow(Some(of(&[1, 2, 4])), &next).map(|course| samples(&course));
        assert_eq!(with(picture(TechniqueName::Path, 2, 8)), Some(vec![8]), "seen from elsewhere");
        assert_eq!(with(picture(TechniqueName::Path, 1, 1)), Some(vec![1]), "begun again");
        assert_eq!(with(picture(TechniqueName::Raster, 1, 1)), None, "it has no samples");
        let rough = Picture { rough: true, ..picture(TechniqueName::Path, 1, 8) };
        assert_eq!(with(rough), None);
        let lag = Some(technique::Lag { samples: 2.0, seconds: 0.1 });
        assert_eq!(with(Picture { lag, ..picture(TechniqueName::Path, 1, 8) }), None, "earlier views count");
    }

    #[test]
    fn of_another_programs_picture_states_are_kept_by_its_changes() {
        let of = |name: &str, changes| {
            let source = crate::model::PaneSource::Received(1);
            let external = External { name: name.into(), source, changes, notes: Vec::new(), fault: None };
            let seconds = changes as f64;
            Picture { external: Some(Arc::new(external)), seconds, ..picture(TechniqueName::Raster, 1, 1) }
        };
        let follow = |course, next: &Picture| Course::follow(course, next);
        let course = [0, 1, 2, 3, 5, 9].map(|changes| of("a", changes)).iter().fold(None, follow).unwrap();
        assert_eq!(samples(&course), [1, 2, 5], "at every doubling");
        let points = course.measured(|_| Some(Errors::default()));
        let places: Vec<_> = points.iter().map(|point| (point.spp, point.seconds)).collect();
        assert_eq!(places, [(None, 0.0), (None, 2.0), (None, 5.0)]);
        assert_eq!(samples(&Course::follow(Some(course), &of("b", 30)).unwrap()), [30]);
    }

    #[test]
    fn memory_is_bounded_and_the_first_and_the_latest_state_stay() {
        let side = 1024;
        let image = Image::new(side, side, vec![Vec3::ONE; (side * side) as usize]).unwrap();
        let large = |spp: u32| Picture { image: image.clone(), ..picture(TechniqueName::Path, 1, spp) };
        let course = (0..12).fold(None, |course, power| Course::follow(course, &large(1 << power))).unwrap();
        assert!(course.bytes() <= MOST_BYTES, "{}", course.bytes());
        assert_eq!((samples(&course)[0], course.latest()), (1, Some(1 << 11)));
        assert!(course.states.len() >= 3, "{:?}", samples(&course));
    }
}
