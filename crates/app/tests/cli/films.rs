//! Every picture is bit for bit what it was.

use std::collections::BTreeSet;
use std::path::Path;
use visavis_tests::films::{FilmRenderer, Row};

/// No operation is fused and no sum depends on the number of threads: no tolerance. tests/data/README.md says how the
/// table is made, and when it may be made anew.
#[test]
fn films_are_those_of_the_table() {
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/films.txt");
    let table = Row::read_all(&std::fs::read_to_string(table).expect("the table"));
    let films: Vec<String> = table.iter().map(|row| row.film.clone()).collect();
    let renderer = FilmRenderer::new(Path::new(env!("CARGO_BIN_EXE_visavis")));
    let mut left_out = BTreeSet::new();
    let mut differing = Vec::new();
    for (row, rendered) in table.iter().zip(renderer.render_all(&films)) {
        match rendered {
            Ok(rendered) if rendered == *row => {}
            Ok(rendered) => differing.push(format!("{rendered}\n    instead of {} | {}", row.pixels, row.counts)),
            // a narrower machine renders the same films in fewer lanes
            Err(said) if said.starts_with("visavis: --lanes ") && !row.film.ends_with("array") => {
                left_out.insert(said);
            }
            Err(said) => differing.push(format!("{}\n    {said}", row.film)),
        }
    }
    left_out.iter().for_each(|said| eprintln!("left out: {said}"));
    let (count, all) = (differing.len(), table.len());
    assert!(all > 1000 && differing.is_empty(), "{count} of {all} films differ:\n{}", differing.join("\n"));
}
