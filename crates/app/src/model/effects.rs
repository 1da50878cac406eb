//! Which effect of light makes each part of a picture, while the map of errors names them.

use super::{Model, View};
use std::sync::Arc;
use technique::Shot;
use technique::effects::{Effect, EffectMap, EffectShare, LabelPlaces};

/// The effects of a view, as they are drawn over its map of errors.
#[derive(Debug, Clone)]
pub struct EffectsOfView {
    /// Scene, camera and size whose effects are named.
    pub shot: Shot,
    /// The effect of each cell.
    pub map: EffectMap,
    /// The lines between them, in shares of the picture.
    pub outlines: Vec<Vec<[f32; 2]>>,
    /// Where labels may stand.
    pub places: Vec<LabelPlaces>,
}

impl EffectsOfView {
    /// What there is to draw of a map.
    pub fn new(shot: Shot, map: EffectMap) -> Self {
        let (outlines, places) = (map.outlines(), map.label_places());
        EffectsOfView { shot, map, outlines, places }
    }
}

/// The effects of a view, and what each has of the errors.
#[derive(Debug, Clone)]
pub struct ShownEffects {
    /// One and the same until another view is wanted.
    pub of_view: Arc<EffectsOfView>,
    /// What each effect has of pixels and squared relative error, the largest error first; empty while no errors are known.
    pub shares: Vec<EffectShare>,
}

/// The effect that is looked at alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct EffectInHand {
    /// The row that was clicked, whose effect stays alone in the light.
    pub chosen: Option<Effect>,
    /// Whose row is under the mouse.
    pub hovered: Option<Effect>,
}

impl EffectInHand {
    /// The effect whose part of the picture stays bright, if it has one.
    pub fn bright(self, of_view: &EffectsOfView) -> Option<Effect> {
        let has_part = |effect: &Effect| of_view.places.iter().any(|places| places.effect == *effect);
        self.hovered.or(self.chosen).filter(has_part)
    }
}

impl Model {
    /// The view whose effects are named, if they are.
    pub fn effects_wish(&self) -> Option<Shot> {
        let area = &self.state.picture;
        let looked_at = self.session.comparison.effects && self.session.view == View::ErrorMap;
        (looked_at && area.size.0 > 0 && area.size.1 > 0).then(|| self.document.shot(area))
    }
}

/// Labels on a picture at most: more are not read.
const MOST_LABELS: usize = 6;

/// Effects that have less of the error, and less of the picture, have no label.
const LEAST: (f64, f64) = (0.001, 0.01);

/// "Caustic 63 %" of the effects that have most of the error, without the share while that is not known; of `alone` alone, where
/// one is looked at.
pub fn label_texts(places: &[LabelPlaces], shares: &[EffectShare], alone: Option<Effect>) -> Vec<(Effect, String)> {
    let is_told = |effect: Effect| alone.is_none_or(|alone| alone == effect);
    if shares.is_empty() {
        let titles = places.iter().map(|places| (places.effect, places.effect.title().to_owned()));
        return titles.filter(|(effect, _)| is_told(*effect)).take(MOST_LABELS).collect();
    }
    let is_worth_it = |share: &EffectShare| share.error >= LEAST.0 || share.pixels >= LEAST.1 || alone.is_some();
    let told = shares.iter().filter(|share| is_worth_it(share) && is_told(share.effect));
    let text = |share: &EffectShare| (share.effect, format!("{} {}", share.effect.title(), percent(share.error)));
    told.map(text).take(MOST_LABELS).collect()
}

/// A share for people: "63 %", "0.4 %", "< 0.1 %", "0 %".
pub fn percent(share: f64) -> String {
    match 100.0 * share {
        v if v >= 9.95 => format!("{v:.0} %"),
        v if v >= 0.05 => format!("{v:.1} %"),
        v if v > 0.0 => "< 0.1 %".into(),
        _ => "0 %".into(),
    }
}

/// A rectangle in points or pixels: left, top, right, bottom.
pub type Sides = [f32; 4];

/// Puts labels of these sizes on a picture that lies at `picture` and is seen within `clip`, each at the first of its places where
/// it covers neither what is `taken` nor a label before it; those without such a place are left out.
pub fn put_labels(
    labels: &[(Effect, [f32; 2])],
    places: &[LabelPlaces],
    (picture, clip): (Sides, Sides),
    mut taken: Vec<Sides>,
) -> Vec<(Effect, Sides)> {
    let mut put = Vec::new();
    for (effect, size) in labels {
        let at = places.iter().find(|places| places.effect == *effect).map_or(&[][..], |places| &places.at);
        let free = at.iter().filter_map(|at| {
            let middle = [0, 1].map(|axis| picture[axis] + at[axis] * (picture[axis + 2] - picture[axis]));
            let is_seen = (0..2).all(|axis| middle[axis] >= clip[axis] && middle[axis] <= clip[axis + 2]);
            let sides = is_seen.then(|| within(middle, *size, clip))?;
            taken.iter().all(|other| are_apart(&sides, other)).then_some(sides)
        });
        let first = free.into_iter().next();
        if let Some(sides) = first {
            taken.push(sides);
            put.push((*effect, sides));
        }
    }
    put
}

/// A rectangle of this size about a middle, moved as far as it has to be to lie within another.
fn within(middle: [f32; 2], size: [f32; 2], clip: Sides) -> Sides {
    let begin = [0, 1].map(|axis| {
        let last = (clip[axis + 2] - size[axis]).max(clip[axis]);
        (middle[axis] - 0.5 * size[axis]).clamp(clip[axis], last)
    });
    [begin[0], begin[1], begin[0] + size[0], begin[1] + size[1]]
}

fn are_apart(a: &Sides, b: &Sides) -> bool {
    a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    const PICTURE: Sides = [0.0, 0.0, 100.0, 100.0];

    fn places(effect: Effect, at: &[[f32; 2]]) -> LabelPlaces {
        LabelPlaces { effect, at: at.to_vec() }
    }

    #[test]
    fn labels_stand_where_no_other_stands_and_are_left_out_where_there_is_no_such_place() {
        let places = [
            places(Effect::Sky, &[[0.5, 0.25]]),
            places(Effect::Caustic, &[[0.5, 0.26], [0.5, 0.625]]),
            places(Effect::Contact, &[[0.5, 0.63]]),
        ];
        let labels = [Effect::Sky, Effect::Caustic, Effect::Contact].map(|effect| (effect, [40.0, 10.0]));
        let put = put_labels(&labels, &places, (PICTURE, PICTURE), Vec::new());
        assert_eq!(put, [(Effect::Sky, [30.0, 20.0, 70.0, 30.0]), (Effect::Caustic, [30.0, 57.5, 70.0, 67.5])]);
        let below_a_legend = put_labels(&labels[..1], &places, (PICTURE, PICTURE), vec![[0.0, 0.0, 35.0, 50.0]]);
        assert_eq!(below_a_legend, []);
    }

    #[test]
    fn labels_lie_within_what_is_seen_and_those_of_what_is_not_are_not_there() {
        let places = [places(Effect::Sky, &[[0.02, 0.5]])];
        let labels = [(Effect::Sky, [40.0, 10.0])];
        let put = put_labels(&labels, &places, (PICTURE, PICTURE), Vec::new());
        assert_eq!(put, [(Effect::Sky, [0.0, 45.0, 40.0, 55.0])]);
        assert_eq!(put_labels(&labels, &places, (PICTURE, [50.0, 0.0, 100.0, 100.0]), Vec::new()), []);
    }

    #[test]
    fn labels_tell_the_share_of_the_error_and_leave_out_what_has_none() {
        let share = |effect, pixels, error| EffectShare { effect, pixels, error };
        let shares =
            [share(Effect::Caustic, 0.05, 0.63), share(Effect::Sky, 0.6, 0.0), share(Effect::Contact, 0.002, 0.0002)];
        let texts = |shares: &[EffectShare], alone| {
            let places = [places(Effect::Sky, &[[0.5; 2]])];
            label_texts(&places, shares, alone).into_iter().map(|(_, text)| text).collect::<Vec<_>>()
        };
        assert_eq!(texts(&shares, None), ["Caustic 63 %", "Sky 0 %"]);
        assert_eq!(texts(&[], None), ["Sky"], "before errors are known");
        assert_eq!(
            texts(&shares, Some(Effect::Contact)),
            ["Contact < 0.1 %"],
            "what is looked at alone, however small"
        );
        assert_eq!([0.0, 0.0002, 0.0123, 0.5].map(percent), ["0 %", "< 0.1 %", "1.2 %", "50 %"]);
    }
}
