//! States of a pane's picture while it was made, at every doubling of its samples: a reference that comes later, or becomes
//! better, still shows how the errors have fallen.

use super::earlier::is_same_picture;
use super::{Order, Picture, bare};
use crate::model::ErrorPoint;
use compare::Errors;
use film::Image;

/// Bytes of states that a pane keeps at most: every second one goes where there are more.
const MOST_BYTES: usize = 64 << 20;

/// The states of one picture, the earliest first.
#[derive(Debug)]
pub struct Course {
    order: Order,
    states: Vec<State>,
}

#[derive(Debug)]
struct State {
    samples: u32,
    seconds: f64,
    image: Image,
}

impl Course {
    /// Goes on with a pane's new picture; `None` of a picture without samples of its own alone.
    pub fn follow(before: Option<Course>, picture: &Picture) -> Option<Course> {
        let samples = picture.spp.filter(|_| !picture.rough && picture.lag.is_none())?;
        let state = State { samples, seconds: picture.seconds, image: bare(&picture.image) };
        let goes_on = |before: &Course| {
            is_same_picture(&before.order, &picture.order) && before.latest().is_none_or(|latest| latest <= samples)
        };
        let mut course =
            before.filter(goes_on).unwrap_or_else(|| Course { order: picture.order.clone(), states: Vec::new() });
        course.order = picture.order.clone();
        if course.latest().is_none_or(|latest| samples / 2 >= latest) {
            course.states.push(state);
            course.thin_out();
        }
        Some(course)
    }

    fn latest(&self) -> Option<u32> {
        self.states.last().map(|state| state.samples)
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
            Some(ErrorPoint { spp: Some(state.samples), seconds: state.seconds, errors })
        };
        self.states.iter().filter_map(point).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::earlier::tests::picture;
    use super::*;
    use film::Vec3;
    use technique::TechniqueName;

    fn samples(course: &Course) -> Vec<u32> {
        course.states.iter().map(|state| state.samples).collect()
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
