//! The course of the errors as curves: whose, over what they cost, and those that were pinned to compare others with.

use super::{Against, ErrorPoint, IN_THE_REGION, PaneId, PaneView, Region, ViewModel};
use compare::Errors;
use technique::settings::of_panes;
use technique::{PaneSettings, Provenance};

/// What is plotted, and whether it is in sight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PlotSettings {
    /// Whether the plots are open.
    pub open: bool,
    /// What errors are drawn over.
    pub over: Cost,
    /// Which error is drawn.
    pub measure: Measure,
}

/// What a picture costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cost {
    /// Samples per pixel: of what no technique samples there are none.
    #[default]
    Samples,
    /// Seconds that rendering has taken.
    Seconds,
}

impl Cost {
    /// Both, the default first.
    pub const ALL: [Cost; 2] = [Cost::Samples, Cost::Seconds];

    /// The name on its button.
    pub fn name(self) -> &'static str {
        match self {
            Cost::Samples => "samples",
            Cost::Seconds => "seconds",
        }
    }

    /// Under the axis, with its unit.
    pub fn label(self) -> &'static str {
        match self {
            Cost::Samples => "samples per pixel",
            Cost::Seconds => "seconds of rendering",
        }
    }

    /// What a picture had cost at a moment; `None` of what a technique without samples has none of.
    pub fn of(self, point: &ErrorPoint) -> Option<f64> {
        match self {
            Cost::Samples => point.spp.map(f64::from),
            Cost::Seconds => Some(point.seconds),
        }
    }
}

/// An error that falls as a power of the samples where nothing is left but noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Measure {
    /// The relative mean squared error, [`Errors::rel_mse`].
    #[default]
    RelMse,
    /// The root of the mean squared error, [`Errors::rmse`].
    Rmse,
    /// The mean absolute error, [`Errors::mae`].
    Mae,
}

impl Measure {
    /// All, the default first.
    pub const ALL: [Measure; 3] = [Measure::RelMse, Measure::Rmse, Measure::Mae];

    /// The name on its button and beside the axis.
    pub fn name(self) -> &'static str {
        match self {
            Measure::RelMse => "relMSE",
            Measure::Rmse => "RMSE",
            Measure::Mae => "MAE",
        }
    }

    /// Its value of all errors.
    pub fn of(self, errors: &Errors) -> f64 {
        match self {
            Measure::RelMse => errors.rel_mse,
            Measure::Rmse => errors.rmse,
            Measure::Mae => errors.mae,
        }
    }

    /// The power of the number of independent samples by which noise falls: -1/2, and -1 where it is squared.
    pub fn slope(self) -> f64 {
        match self {
            Measure::RelMse => -1.0,
            Measure::Rmse | Measure::Mae => -0.5,
        }
    }

    /// The same in words.
    pub fn slope_name(self) -> &'static str {
        match self {
            Measure::RelMse => "slope -1",
            Measure::Rmse | Measure::Mae => "slope -1/2",
        }
    }
}

/// Whose curve it is, which decides how it is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Owner {
    /// A pane's, which goes on.
    Pane(PaneId),
    /// Kept, whatever panes show now.
    Pinned(usize),
}

/// The errors of one picture while it was made.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// What the picture is: "A: Path tracing, light".
    pub name: String,
    /// The pane that it belongs to, or that it was pinned.
    pub owner: Owner,
    /// In order of time, never empty.
    pub points: Vec<ErrorPoint>,
    /// The picture or the reference that its errors are from.
    pub against: Against,
    /// The part of the picture that was judged; `None` for all of it.
    pub region: Option<Region>,
}

impl Curve {
    /// The curve of a pane's picture, which was held against this there; `None` without points.
    pub fn of_pane(
        id: PaneId,
        made: &Provenance,
        points: Vec<ErrorPoint>,
        (against, region): (Against, Option<Region>),
        title: Option<String>,
    ) -> Option<Self> {
        let name = format!("{id}: {}", title.unwrap_or_else(|| name_by_itself(made)));
        (!points.is_empty()).then_some(Curve { name, owner: Owner::Pane(id), points, against, region })
    }

    /// What judged it, and where: "reference", "B in the region".
    pub fn judged_by(&self) -> String {
        let against = self.against.name();
        self.region.map_or_else(|| against.to_owned(), |_| format!("{against} {IN_THE_REGION}"))
    }

    /// Its name, with what it is held against where curves are held against several.
    pub fn name_among(&self, curves: &[Curve]) -> String {
        match judge_of_all(curves) {
            Some(_) => self.name.clone(),
            None => format!("{}, against {}", self.name, self.judged_by()),
        }
    }

    /// Whether it is the level of a picture that samples do not make better. Over seconds that of another program may fall all
    /// the same, whose samples are not known.
    pub fn is_level(&self, over: Cost) -> bool {
        let at_once = self.points.windows(2).all(|pair| pair[0].seconds == pair[1].seconds);
        self.points.iter().all(|point| point.spp.is_none()) && (over == Cost::Samples || at_once)
    }

    /// Where its line goes: (cost, error), each > 0 and finite; of one cost, at which it may have been judged again by a
    /// better reference, the latest.
    pub fn places(&self, settings: PlotSettings) -> Vec<[f64; 2]> {
        let place = |point: &ErrorPoint| Some([settings.over.of(point)?, settings.measure.of(&point.errors)]);
        let mut places: Vec<[f64; 2]> = Vec::new();
        let drawable = |place: &[f64; 2]| place.iter().all(|v| *v > 0.0 && v.is_finite());
        for place in self.points.iter().filter_map(place).filter(drawable) {
            match places.last_mut() {
                Some(last) if last[0] == place[0] => *last = place,
                _ => places.push(place),
            }
        }
        places
    }

    /// The error of the latest moment, if it is > 0.
    pub fn latest(&self, measure: Measure) -> Option<f64> {
        self.points.last().map(|point| measure.of(&point.errors)).filter(|error| *error > 0.0 && error.is_finite())
    }
}

impl ViewModel {
    /// The curves of all panes whose errors are measured.
    pub fn curves(&self) -> Vec<Curve> {
        self.panes.iter().filter_map(|(id, pane)| self.curve(id, pane)).collect()
    }

    fn curve(&self, id: PaneId, pane: &PaneView) -> Option<Curve> {
        let points: Vec<ErrorPoint> = pane.history.iter().copied().collect();
        let name = pane.external.as_ref().map(|external| external.title());
        Curve::of_pane(id, pane.provenance.as_deref()?, points, pane.course.as_ref()?.against(), name)
    }
}

/// What tells a picture from the usual one of its technique, but for its samples, along which the curve goes.
fn name_by_itself(made: &Provenance) -> String {
    let mut usual = PaneSettings::of(made.technique.name());
    let samples = of_panes("spp").and_then(|row| Some((row, (row.get)(&PaneSettings::from(made.technique))?)));
    samples.into_iter().for_each(|(row, value)| usual.set(row, value));
    usual.take_usual_estimator(&made.shot.scene);
    made.technique.label_beside(&usual.in_use(), &made.shot.scene)
}

/// A line of the slope by which noise falls, of what is held against the reference: what another picture judges, which may be
/// wrong itself, need not fall. As (cost, error) of its ends: through the latest place of the pane's curve that
/// has most, along the costs of all.
pub fn guide(curves: &[Curve], settings: PlotSettings) -> Option<[[f64; 2]; 2]> {
    let falls = |curve: &&Curve| matches!(curve.owner, Owner::Pane(_)) && curve.against == Against::Reference;
    let longest = curves.iter().filter(falls).map(|curve| curve.places(settings)).max_by_key(Vec::len)?;
    let ([first, _], [last, error]) = (*longest.first()?, *longest.last()?);
    let at = |cost: f64| [cost, error * (cost / last).powf(settings.measure.slope())];
    (first < last).then(|| [at(first), at(last)])
}

/// What all curves are held against, and where; or nothing where they do not agree.
pub fn judge_of_all(curves: &[Curve]) -> Option<String> {
    let first = curves.first()?.judged_by();
    curves.iter().all(|curve| curve.judged_by() == first).then_some(first)
}

/// The most curves that are pinned at a time: more could not be told apart.
pub const MOST_PINNED: usize = 6;

/// Keeps the curves of panes as they are now. Returns whether there was room for all.
pub fn pin(pinned: &mut Vec<Curve>, curves: Vec<Curve>) -> bool {
    for curve in curves {
        let is_there = pinned.iter().any(|kept| kept.points == curve.points);
        if is_there {
            continue;
        }
        if pinned.len() == MOST_PINNED {
            return false;
        }
        let mut name = curve.name.split_once(": ").map_or(&*curve.name, |(_, name)| name).to_owned();
        if curve.region.is_some() {
            name += &format!(" ({IN_THE_REGION})");
        }
        pinned.push(Curve { name, owner: Owner::Pinned(pinned.len()), ..curve });
    }
    true
}

/// All that curves hold as CSV: a row a moment, numbers in all their digits.
pub fn csv(curves: &[Curve]) -> String {
    let mut text = String::from("curve,against,spp,seconds,relMSE,RMSE,MAE,mean difference\n");
    for curve in curves {
        let name = curve.name.replace('"', "\"\"");
        for ErrorPoint { spp, seconds, errors } in &curve.points {
            let spp = spp.map_or(String::new(), |spp| spp.to_string());
            let Errors { rel_mse, rmse, mae, bias, .. } = errors;
            let against = curve.judged_by();
            text += &format!("\"{name}\",{against},{spp},{seconds},{rel_mse},{rmse},{mae},{bias}\n");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(name: &str, errors: &[(Option<u32>, f64)]) -> Curve {
        let point = |&(spp, rmse): &(Option<u32>, f64)| {
            let errors = Errors { rmse, rel_mse: rmse * rmse, ..Errors::default() };
            ErrorPoint { spp, seconds: 0.5 * f64::from(spp.unwrap_or(0)), errors }
        };
        let points = errors.iter().map(point).collect();
        Curve { name: name.into(), owner: Owner::Pane(PaneId::A), points, against: Against::Reference, region: None }
    }

    #[test]
    fn only_what_has_a_logarithm_has_a_place() {
        let falling = curve("A: path", &[(Some(1), 0.5), (Some(2), 0.0), (Some(4), f64::NAN), (Some(8), 0.25)]);
        let places = |over, measure| {
            let places = falling.places(PlotSettings { open: true, over, measure });
            places.into_iter().map(|[x, y]| (x, y)).collect::<Vec<_>>()
        };
        assert_eq!(places(Cost::Samples, Measure::Rmse), [(1.0, 0.5), (8.0, 0.25)]);
        assert_eq!(places(Cost::Seconds, Measure::RelMse), [(0.5, 0.25), (4.0, 0.0625)]);
        let again = curve("A: path", &[(Some(1), 0.5), (Some(2), 0.4), (Some(2), 0.3)]);
        let settings = PlotSettings { measure: Measure::Rmse, ..PlotSettings::default() };
        assert_eq!(again.places(settings), [[1.0, 0.5], [2.0, 0.3]], "judged again by a better reference");
        let fake = curve("A: fake", &[(None, 0.1)]);
        assert!(Cost::ALL.into_iter().all(|over| !falling.is_level(over) && fake.is_level(over)));
        let mut received = curve("B: homework", &[(None, 0.2), (None, 0.1)]);
        assert!(received.is_level(Cost::Seconds), "judged again by a better reference");
        received.points[1].seconds = 1.0;
        assert_eq!(Cost::ALL.map(|over| received.is_level(over)), [true, false]);
    }

    #[test]
    fn the_guide_goes_through_the_latest_error_with_the_slope_of_noise() {
        let falling = curve("A: path", &[(Some(1), 0.9), (Some(4), 0.5), (Some(16), 0.25)]);
        let settings = |measure| PlotSettings { open: true, over: Cost::Samples, measure };
        let of = |measure| guide(std::slice::from_ref(&falling), settings(measure));
        assert_eq!(of(Measure::Rmse), Some([[1.0, 1.0], [16.0, 0.25]]));
        assert_eq!(of(Measure::RelMse), Some([[1.0, 1.0], [16.0, 0.0625]]));
        assert_eq!(guide(&[curve("A: path", &[(Some(1), 0.9)])], settings(Measure::Rmse)), None, "one is no line");
        let judged_by_b = Curve { against: Against::Pane(PaneId::B), ..falling.clone() };
        assert_eq!(guide(&[judged_by_b], settings(Measure::Rmse)), None, "it need not fall");
    }

    #[test]
    fn pinned_curves_stay_and_are_told_apart_by_their_names_without_a_pane() {
        let mut pinned = Vec::new();
        let [a, b] = [curve("A: path, light", &[(Some(1), 0.5)]), curve("B: path, cosine", &[(Some(1), 0.7)])];
        assert!(pin(&mut pinned, vec![a.clone(), b]));
        assert!(pin(&mut pinned, vec![a]), "it is there already");
        let names: Vec<_> = pinned.iter().map(|curve| (&*curve.name, curve.owner)).collect();
        assert_eq!(names, [("path, light", Owner::Pinned(0)), ("path, cosine", Owner::Pinned(1))]);
        let many = (0..MOST_PINNED as u32).map(|i| curve("A: path", &[(Some(i + 2), 0.5)])).collect();
        assert!(!pin(&mut pinned, many));
        assert_eq!(pinned.len(), MOST_PINNED);
    }

    #[test]
    fn csv_has_a_row_for_each_moment_and_quotes_names() {
        let text = csv(&[curve("A: \"mine\", light", &[(Some(1), 0.5), (None, 0.25)])]);
        let rows: Vec<&str> = text.lines().collect();
        assert_eq!(rows[0].split(',').count(), 8);
        assert_eq!(rows[1], "\"A: \"\"mine\"\", light\",reference,1,0.5,0.25,0.5,0,0");
        assert_eq!(rows[2], "\"A: \"\"mine\"\", light\",reference,,0,0.0625,0.25,0,0");
    }
}
