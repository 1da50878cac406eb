//! What stands below a tile, and the same of all tiles as a table.

use super::{SweepMeasure, SweepPlan};
use crate::ruler::brief;
use compare::Errors;
use std::fmt::Write;

/// What is known of a tile's picture.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TileFacts {
    /// Samples per pixel, of all runs; `None` of what does not sample.
    pub spp: Option<u32>,
    /// Seconds of rendering, those of a denoiser with it.
    pub seconds: f64,
    /// How far it is from the reference, once there is one.
    pub errors: Option<TileErrors>,
    /// Whether it is all that was asked for.
    pub done: bool,
    /// That the scene that it shows was changed part by part, in a few words.
    pub edited: Option<String>,
    /// Why there is no picture, or one that was not made as it should be: one line.
    pub fault: Option<String>,
}

/// How far a tile is from the reference of what it shows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TileErrors {
    /// The figures of `visavis compare`.
    pub errors: Errors,
    /// The mean of FLIP's map.
    pub flip: f64,
}

impl TileFacts {
    /// Whether there is a picture, if only a noisy one.
    pub fn has_a_picture(&self) -> bool {
        self.spp.is_some() || self.done && self.fault.is_none()
    }
}

impl TileErrors {
    /// The figure of this name.
    pub fn measured(&self, measure: SweepMeasure) -> f64 {
        match measure {
            SweepMeasure::RelMse => self.errors.rel_mse,
            SweepMeasure::Rmse => self.errors.rmse,
            SweepMeasure::Flip => self.flip,
        }
    }
}

/// The tiles of the least error as it is told, once all have one; none where all are alike, or not told apart from another by
/// more than the noise of the reference.
pub fn best(tiles: &[TileFacts], measure: SweepMeasure) -> Vec<usize> {
    let error = |tile: &TileFacts| Some(tile.errors.filter(|_| tile.done)?.measured(measure)).filter(|e| e.is_finite());
    let Some(errors) = tiles.iter().map(error).collect::<Option<Vec<f64>>>() else { return Vec::new() };
    let Some(least) = errors.iter().copied().reduce(f64::min).map(brief) else { return Vec::new() };
    let (best, others): (Vec<usize>, Vec<usize>) = (0..errors.len()).partition(|index| brief(errors[*index]) == least);
    let drowned = best.iter().any(|best| others.iter().any(|other| drown(&tiles[*best], &tiles[*other])));
    if others.is_empty() || drowned { Vec::new() } else { best }
}

/// Whether the reference's own noise is larger than what tells two tiles apart; that is known as relMSE alone.
fn drown(one: &TileFacts, other: &TileFacts) -> bool {
    let (Some(one), Some(other)) = (one.errors, other.errors) else { return false };
    one.errors.reference_noise.is_some_and(|noise| (one.errors.rel_mse - other.errors.rel_mse).abs() < noise)
}

/// The lines below each tile: its values; that its scene is a changed one; then what it took; then how far off it is, where that is known.
pub fn captions(plan: &SweepPlan, tiles: &[TileFacts], measure: SweepMeasure) -> Vec<Vec<String>> {
    let best = best(tiles, measure);
    let blank = TileFacts::default();
    let caption = |(index, planned): (usize, &super::PlannedTile)| {
        let facts = tiles.get(index).unwrap_or(&blank);
        let error = facts.errors.map(|errors| {
            let mark = if best.contains(&index) { ", best" } else { "" };
            format!("{} {}{mark}", measure.name(), brief(errors.measured(measure)))
        });
        planned.names.iter().chain(&facts.edited).cloned().chain([took(facts)]).chain(error).collect()
    };
    plan.tiles.iter().enumerate().map(caption).collect()
}

/// "20 spp, 0.14 s", and what went wrong.
fn took(facts: &TileFacts) -> String {
    match &facts.fault {
        None => spent(facts),
        Some(fault) if facts.has_a_picture() => format!("{}; {fault}", spent(facts)),
        Some(fault) => fault.clone(),
    }
}

fn spent(facts: &TileFacts) -> String {
    let seconds = format!("{:.2} s", facts.seconds);
    match (facts.spp, facts.done) {
        (None, false) => "waits ...".into(),
        (None, true) => seconds,
        (Some(spp), true) => format!("{spp} spp, {seconds}"),
        (Some(spp), false) => format!("{spp} spp, {seconds} ..."),
    }
}

/// All captions with the figures of every measure, a row a tile.
pub fn sweep_csv(plan: &SweepPlan, tiles: &[TileFacts]) -> String {
    let mut text = String::from(plan.columns.setting);
    let rows = plan.rows.as_ref();
    rows.into_iter().for_each(|rows| _ = write!(text, ",{}", rows.setting));
    text += ",made_spp,seconds,rel_mse,rmse,mae,flip,reference_noise\n";
    let columns = plan.columns.values.len();
    for (index, facts) in tiles.iter().enumerate().take(plan.tiles.len()) {
        text += &field(&plan.columns.values[index % columns]);
        rows.into_iter().for_each(|rows| _ = write!(text, ",{}", field(&rows.values[index / columns])));
        let spp = facts.spp.map_or_else(String::new, |spp| spp.to_string());
        let _ = write!(text, ",{spp},{}", facts.seconds);
        let figures = facts.errors.map(|TileErrors { errors: e, flip }| [e.rel_mse, e.rmse, e.mae, flip]);
        match figures {
            Some(figures) => figures.iter().for_each(|figure| _ = write!(text, ",{figure}")),
            None => text += ",,,,",
        }
        let noise = facts.errors.and_then(|errors| errors.errors.reference_noise);
        let _ = writeln!(text, ",{}", noise.map_or_else(String::new, |noise| noise.to_string()));
    }
    text
}

/// A field of a table whose commas part fields.
fn field(text: &str) -> String {
    if text.contains([',', '"']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.into() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::sweep::Axis;
    use technique::{PaneSettings, TechniqueName};

    fn facts(spp: u32, rel_mse: f64) -> TileFacts {
        let errors = Errors { rel_mse, rmse: 1.0 / rel_mse, ..Errors::default() };
        let errors = Some(TileErrors { errors, flip: 0.5 });
        TileFacts { spp: Some(spp), seconds: 0.126, errors, done: true, edited: None, fault: None }
    }

    fn plan() -> SweepPlan {
        let mut base = PaneSettings::of(TechniqueName::Path);
        base.truth.path.bounces = Some(2);
        let axes = [Axis::new("spp", "1, 4"), Axis::new("roulette", "off, 0.8+throughput")];
        SweepPlan::of(&base, [&axes[0], &axes[1]], None).unwrap()
    }

    #[test]
    fn a_caption_tells_value_samples_seconds_and_error_and_marks_the_best() {
        let tiles = [facts(1, 0.4), facts(4, 0.1), facts(1, 0.5), facts(4, 0.2)];
        let told = captions(&plan(), &tiles, SweepMeasure::RelMse);
        assert_eq!(told[0][2..], ["1 spp, 0.13 s", "relMSE 0.400"]);
        assert_eq!(told[0][0], "1 spp");
        assert_eq!(told[1][3], "relMSE 0.100, best");
        let mut on_the_way = tiles.clone();
        on_the_way[3].done = false;
        let told = captions(&plan(), &on_the_way, SweepMeasure::RelMse);
        assert_eq!(
            (told[1][3].as_str(), told[3][2].as_str()),
            ("relMSE 0.100", "4 spp, 0.13 s ..."),
            "nothing is best yet"
        );
        assert_eq!(captions(&plan(), &tiles, SweepMeasure::Rmse)[2][3], "RMSE 2.000, best");
        assert!(best(&tiles, SweepMeasure::Flip).is_empty(), "all are alike");
        let nearly = [facts(1, 0.4), facts(1, 0.100_02), facts(1, 0.100_01)];
        assert_eq!(best(&nearly, SweepMeasure::RelMse), [1, 2], "no caption tells them apart");
        let noisy = |rel_mse, noise| {
            let TileErrors { errors, flip } = facts(1, rel_mse).errors.unwrap();
            TileFacts {
                errors: Some(TileErrors { errors: errors.with_reference_noise(noise), flip }),
                ..facts(1, rel_mse)
            }
        };
        let of_noise = |noise| best(&[noisy(0.4, noise), noisy(0.2, noise), noisy(0.23, noise)], SweepMeasure::RelMse);
        assert_eq!(of_noise(0.02), [1]);
        assert_eq!(of_noise(0.04), [0; 0], "the reference is not good enough to tell");
        let unmeasured = [facts(1, 0.4), TileFacts { errors: None, ..facts(4, 0.1) }];
        assert!(best(&unmeasured, SweepMeasure::RelMse).is_empty(), "one is not known yet");
    }

    #[test]
    fn tiles_of_a_changed_scene_say_so_between_values_and_cost() {
        let edited = Some("edited: 2 parts".to_owned());
        let tiles = [1, 4, 1, 4].map(|spp| TileFacts { edited: edited.clone(), ..facts(spp, 0.1) });
        assert_eq!(captions(&plan(), &tiles, SweepMeasure::RelMse)[0][2..4], ["edited: 2 parts", "1 spp, 0.13 s"]);
    }

    #[test]
    fn what_went_wrong_is_told_beside_what_the_picture_took() {
        let mut tile = TileFacts { fault: Some("not denoised: no memory".into()), ..facts(4, 0.1) };
        assert_eq!(took(&tile), "4 spp, 0.13 s; not denoised: no memory");
        tile.spp = None;
        assert_eq!(took(&tile), "not denoised: no memory", "there is no picture");
    }

    #[test]
    fn the_table_has_a_row_for_each_tile_and_a_field_for_each_figure() {
        let tiles = [facts(1, 0.25), facts(4, 0.1), facts(1, 0.5), TileFacts::default()];
        let table = sweep_csv(&plan(), &tiles);
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(lines[0], "spp,roulette,made_spp,seconds,rel_mse,rmse,mae,flip,reference_noise");
        assert_eq!(lines.len(), 5);
        assert!(lines[1].starts_with("1,off,1,") && lines[1].ends_with(",0.126,0.25,4,0,0.5,"), "{}", lines[1]);
        let commas =
            |line: &str| line.split('"').step_by(2).flat_map(|part| part.chars()).filter(|c| *c == ',').count();
        assert!(lines.iter().all(|line| commas(line) == 8), "{table}");
    }
}
