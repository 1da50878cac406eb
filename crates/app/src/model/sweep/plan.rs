//! The tiles of a sweep: for each value of a setting, or each pair of values of two, the settings that make its picture.

use super::Axis;
use scene::nearest_or_begun;
use technique::settings::{Setting, Value, of_panes};
use technique::{PaneSettings, Technique, TechniqueName};

/// The most values of one setting, and the fewest.
pub const MOST_VALUES: usize = 8;
const FEWEST_VALUES: usize = 2;

/// The most tiles of a matrix.
pub const MOST_TILES: usize = 16;

/// The name of what is no row of the table of settings, but chooses among techniques.
pub const TECHNIQUE: &str = "technique";

/// What is to be shown, tile by tile.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepPlan {
    /// What is varied from tile to tile of a row.
    pub columns: Line,
    /// What is varied from row to row; `None` of a strip.
    pub rows: Option<Line>,
    /// All of them, row by row from the top.
    pub tiles: Vec<PlannedTile>,
    /// Seconds of rendering that each tile has; `None` where it has the samples that it is set to.
    pub seconds: Option<f32>,
}

/// What acts from view to view, of which a tile has one alone.
pub(super) const HISTORY: &str = "history";

/// A setting with its values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// Its name in the table.
    pub setting: &'static str,
    /// As options say them, in the order in which they were typed.
    pub values: Vec<String>,
}

impl Line {
    /// As it is typed to be this again.
    pub(super) fn axis(&self) -> Axis {
        Axis::new(self.setting, &self.values.join(", "))
    }
}

/// A picture that is to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedTile {
    /// What tells it from the others, as captions call it: that of its column, and that of its row if there are rows.
    pub names: Vec<String>,
    /// All settings that make its picture.
    pub pane: PaneSettings,
}

impl PlannedTile {
    /// "2 bounces", "light, sobol random numbers".
    pub fn name(&self) -> String {
        self.names.join(", ")
    }
}

/// A value as it was typed, for what it can be.
#[derive(Clone, Copy)]
enum Varied {
    Technique(TechniqueName),
    Setting(&'static Setting<PaneSettings>, Value),
}

impl SweepPlan {
    /// `base` at all values of the first axis, and of the second if it has any; for `seconds` each, if that is given.
    ///
    /// # Errors
    /// The word that is wrong, and what was expected: one line.
    pub fn of(base: &PaneSettings, [columns, rows]: [&Axis; 2], seconds: Option<f32>) -> Result<Self, String> {
        let axes = [columns, rows];
        let mut base = *base;
        base.denoise.history = 0;
        let base = &base;
        if !rows.is_empty() && rows.setting == columns.setting {
            return Err(format!("{0} is varied along columns and rows: choose another setting for one", rows.setting));
        }
        if let Some(axis) = axes.iter().find(|axis| seconds.is_some() && axis.setting == "spp") {
            return Err(format!("at equal time nothing is left of {} to vary: choose equal samples", axis.setting));
        }
        let techniques = techniques(base, axes)?;
        let in_columns = values(columns, &techniques)?;
        let in_rows = if rows.is_empty() { Vec::new() } else { values(rows, &techniques)? };
        let count = in_columns.len() * in_rows.len().max(1);
        if count > MOST_TILES {
            return Err(format!("{} x {} are {count} tiles: {MOST_TILES} at most", in_columns.len(), in_rows.len()));
        }
        let tiles = tiles(base, (&in_columns, &in_rows))?;
        if let Some(tile) = tiles.iter().find(|tile| seconds.is_some() && tile.pane.in_use().runs() > 1) {
            return Err(format!(
                "{}: several runs end with their samples, not at equal time: set runs to 1",
                tile.name()
            ));
        }
        let line =
            |values: &[Varied]| Line { setting: name_of(values), values: values.iter().map(|v| v.word()).collect() };
        let rows = (!in_rows.is_empty()).then(|| line(&in_rows));
        Ok(SweepPlan { columns: line(&in_columns), rows, tiles, seconds })
    }
}

impl Axis {
    /// Reads "bounces=0,1,2": a setting of any technique, or [`TECHNIQUE`], and its values.
    ///
    /// # Errors
    /// The word that is wrong, and what was expected: one line.
    pub fn parse(text: &str) -> Result<Self, String> {
        let Some((setting, values)) = text.split_once('=') else {
            return Err(format!("{text}: expected NAME=V1,V2,... with the name of a setting of render, or technique"));
        };
        let axis = Axis::new(setting.trim(), values.trim());
        let words = words(&axis)?;
        match of_panes(&axis.setting) {
            Some(row) => words.into_iter().try_for_each(|word| value_of(row, word, &[]).map(|_| ()))?,
            None if axis.setting == TECHNIQUE => words.into_iter().try_for_each(|word| technique(word).map(|_| ()))?,
            None => {
                let known: Vec<_> = super::variable_of_any().collect();
                let meant = did_you_mean(&axis.setting, &known);
                return Err(format!("{} is no setting: expected {}{meant}", axis.setting, known.join(", ")));
            }
        }
        Ok(axis)
    }

    /// As it is read again.
    pub fn text(&self) -> String {
        format!("{}={}", self.setting, self.values)
    }
}

/// Those that tiles are of, which say what other settings may be.
fn techniques(base: &PaneSettings, axes: [&Axis; 2]) -> Result<Vec<TechniqueName>, String> {
    match axes.into_iter().find(|axis| axis.setting == TECHNIQUE) {
        None => Ok(vec![base.technique]),
        Some(axis) => words(axis)?.into_iter().map(technique).collect(),
    }
}

fn technique(word: &str) -> Result<TechniqueName, String> {
    let names = TechniqueName::ALL.map(TechniqueName::name);
    TechniqueName::named(word)
        .ok_or_else(|| format!("{TECHNIQUE}={word}: expected {}{}", names.join(", "), did_you_mean(word, &names)))
}

fn did_you_mean(word: &str, known: &[&'static str]) -> String {
    nearest_or_begun(word, known.iter().copied()).map_or_else(String::new, |meant| format!("; did you mean {meant}?"))
}

/// The typed words, each once.
fn words(axis: &Axis) -> Result<Vec<&str>, String> {
    let words: Vec<&str> = axis.values.split(',').map(str::trim).collect();
    let setting = &axis.setting;
    if setting == HISTORY {
        return Err(format!("{HISTORY} changes no tile: each is of one view, without earlier ones"));
    }
    if axis.values.trim().is_empty() || words.len() < FEWEST_VALUES || words.len() > MOST_VALUES {
        let count = if axis.values.trim().is_empty() { 0 } else { words.len() };
        let expected = format!("expected {FEWEST_VALUES} to {MOST_VALUES} values with commas between");
        return Err(format!("{setting} has {count}: {expected}"));
    }
    match words.iter().enumerate().find(|(i, word)| words[..*i].contains(word)) {
        Some((_, twice)) => Err(format!("{setting}={twice} stands there twice")),
        None => Ok(words),
    }
}

fn values(axis: &Axis, techniques: &[TechniqueName]) -> Result<Vec<Varied>, String> {
    let words = words(axis)?;
    if axis.setting == TECHNIQUE {
        return words.into_iter().map(|word| technique(word).map(Varied::Technique)).collect();
    }
    for technique in techniques {
        if !of_panes(&axis.setting).is_some_and(|row| row.is_of(*technique)) {
            let known: Vec<_> = super::variable(*technique).collect();
            let meant = did_you_mean(&axis.setting, &known);
            let (setting, technique) = (&axis.setting, technique.name());
            return Err(format!("{setting} is no setting of {technique}: expected {}{meant}", known.join(", ")));
        }
    }
    let Some(row) = of_panes(&axis.setting) else { return Err(format!("{} is no setting", axis.setting)) };
    let value = |word| Ok(Varied::Setting(row, value_of(row, word, techniques)?));
    words.into_iter().map(value).collect()
}

/// What a word says of a row, if it is a value of it for all of these techniques.
fn value_of(row: &Setting<PaneSettings>, word: &str, techniques: &[TechniqueName]) -> Result<Value, String> {
    let of_all = techniques.iter().map(|technique| row.kind_in(*technique).parse(word));
    let value = of_all.reduce(|one, other| one.and(other)).unwrap_or_else(|| row.kind.parse(word));
    value.map_err(|expected| format!("{}={word}: expected {expected}", row.name))
}

fn tiles(base: &PaneSettings, (columns, rows): (&[Varied], &[Varied])) -> Result<Vec<PlannedTile>, String> {
    let one = |column: Varied, row: Option<Varied>| {
        let mut pane = *base;
        // a technique first: what it is set to comes after
        let mut varied: Vec<Varied> = row.into_iter().chain([column]).collect();
        varied.sort_by_key(|varied| matches!(varied, Varied::Setting(..)));
        varied.iter().for_each(|varied| varied.give_to(&mut pane, base));
        let tile = PlannedTile { names: std::iter::once(column).chain(row).map(Varied::name).collect(), pane };
        check(&pane).map_err(|fault| format!("{}: {fault}", tile.name()))?;
        Ok(tile)
    };
    match rows {
        [] => columns.iter().map(|column| one(*column, None)).collect(),
        rows => rows.iter().flat_map(|row| columns.iter().map(move |column| one(*column, Some(*row)))).collect(),
    }
}

/// Whether such a picture can be made.
fn check(pane: &PaneSettings) -> Result<(), String> {
    match pane.in_use() {
        Technique::Traced(traced) => traced.integrator.check().map_err(|fault| fault.to_string()),
        Technique::Fake(_) => Ok(()),
    }
}

impl Varied {
    /// Another technique has as many samples as the one that it stands beside.
    fn give_to(self, pane: &mut PaneSettings, base: &PaneSettings) {
        match self {
            Varied::Setting(row, value) => pane.set(row, value),
            Varied::Technique(technique) => {
                pane.technique = technique;
                if let (Some(spp), Some(row)) = (base.wished_spp(), of_panes("spp").filter(|row| row.is_of(technique)))
                {
                    pane.set(row, Value::Whole(spp));
                }
            }
        }
    }

    /// As captions call it.
    fn name(self) -> String {
        match self {
            Varied::Technique(technique) => technique.in_full().into(),
            Varied::Setting(row, value) => row.brief(value),
        }
    }

    /// As an option says it.
    fn word(self) -> String {
        match self {
            Varied::Technique(technique) => technique.name().into(),
            Varied::Setting(_, value) => value.to_string(),
        }
    }
}

fn name_of(values: &[Varied]) -> &'static str {
    match values.first() {
        Some(Varied::Setting(row, _)) => row.name,
        Some(Varied::Technique(_)) | None => TECHNIQUE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(base: TechniqueName, columns: (&str, &str), rows: (&str, &str)) -> Result<SweepPlan, String> {
        let axes = [columns, rows].map(|(setting, values)| Axis::new(setting, values));
        SweepPlan::of(&PaneSettings::of(base), [&axes[0], &axes[1]], None)
    }

    #[test]
    fn a_strip_has_a_tile_for_each_value_and_all_else_of_its_base() {
        let strip = plan(TechniqueName::Path, ("bounces", "0, 1,inf"), ("", "")).unwrap();
        let names: Vec<String> = strip.tiles.iter().map(PlannedTile::name).collect();
        assert_eq!(names, ["0 bounces", "1 bounce", "no limit of bounces"]);
        let base = PaneSettings::of(TechniqueName::Path);
        for (tile, bounces) in strip.tiles.iter().zip([Some(0), Some(1), None]) {
            let mut expected = base;
            expected.truth.path.bounces = bounces;
            assert_eq!(tile.pane, expected);
        }
    }

    #[test]
    fn a_matrix_has_a_tile_for_each_pair_row_by_row_and_techniques_keep_the_number_of_samples() {
        let matrix = plan(TechniqueName::Path, ("technique", "path, whitted"), ("spp", "4, 9")).unwrap();
        let made = matrix.tiles.iter().map(|tile| (tile.pane.technique, tile.pane.wished_spp()));
        use TechniqueName::{Path, Whitted};
        let expected = [(Path, Some(4)), (Whitted, Some(4)), (Path, Some(9)), (Whitted, Some(9))];
        assert_eq!(made.collect::<Vec<_>>(), expected);
        assert_eq!(matrix.tiles[1].name(), "Whitted, 4 spp");
        let mut base = PaneSettings::of(Path);
        base.truth.spp = 7;
        let techniques = Axis::new(TECHNIQUE, "path, photon");
        let strip = SweepPlan::of(&base, [&techniques, &Axis::default()], None).unwrap();
        assert!(strip.tiles.iter().all(|tile| tile.pane.wished_spp() == Some(7)));
    }

    #[test]
    fn what_is_wrong_is_told_in_one_line() {
        use TechniqueName::Path;
        let cases = [
            (("bounces", ""), ("", ""), "bounces has 0: expected 2 to 8 values"),
            (("bounces", "1"), ("", ""), "bounces has 1: expected 2 to 8 values"),
            (("spp", "1,2,3,4,5,6,7,8,9"), ("", ""), "spp has 9: expected 2 to 8 values"),
            (("spp", "1, 1"), ("", ""), "spp=1 stands there twice"),
            (("spp", "1, many"), ("", ""), "spp=many: expected a whole number"),
            (("spp", "1,,2"), ("", ""), "spp=: expected a whole number"),
            (("sampp", "1, 2"), ("", ""), "sampp is no setting of path"),
            (("sampp", "1, 2"), ("", ""), "did you mean sampler?"),
            (("estimator", "light, misty"), ("", ""), "estimator=misty: expected"),
            (("technique", "path, pth"), ("", ""), "technique=pth: expected raster, whitted, path"),
            (("technique", "path, whitted"), ("estimator", "light, mis"), "estimator is no setting of whitted"),
            (
                ("technique", "path, metropolis"),
                ("estimator", "light, guided"),
                "Metropolis, guided: a guide is learned for paths",
            ),
            (("history", "0, 64"), ("", ""), "history changes no tile"),
            (("branches", "1, 2"), ("", ""), "need a limit of bounces"),
            (("spp", "1, 2"), ("spp", "3, 4"), "spp is varied along columns and rows"),
            (("spp", "1,2,3,4,5,6"), ("seed", "1,2,3"), "6 x 3 are 18 tiles: 16 at most"),
        ];
        for (columns, rows, said) in cases {
            let fault = plan(Path, columns, rows).expect_err(said);
            assert!(fault.contains(said) && !fault.contains('\n'), "{columns:?} {rows:?}: {fault}");
        }
        let axis = Axis::new("spp", "1, 2");
        let at_equal_time = SweepPlan::of(&PaneSettings::of(Path), [&axis, &Axis::default()], Some(1.0));
        assert!(at_equal_time.is_err_and(|fault| fault.contains("at equal time nothing is left of spp")));
        let axis = Axis::new("runs", "1, 4");
        let of_runs = SweepPlan::of(&PaneSettings::of(Path), [&axis, &Axis::default()], Some(1.0));
        assert!(of_runs.is_err_and(|fault| fault.contains("4 runs: several runs end with their samples")));
    }
}
