//! What other renderers need for the same pictures, as their users measured it: a table of five columns.

use crate::BenchError;
use crate::plan::part_names;
use std::path::Path;

/// The first line of a peer's table.
pub const HEADER: &str = "name,scene,spp,seconds,relmse";

/// One measurement by another program.
#[derive(Debug, Clone, PartialEq)]
pub struct PeerRow {
    /// The program and its settings.
    pub name: String,
    /// Name of the part.
    pub part: String,
    /// Samples per pixel, at least 1.
    pub spp: u32,
    /// Wall-clock seconds, above 0.
    pub seconds: f64,
    /// Against its own reference, above 0.
    pub rel_mse: f64,
}

/// Reads a table.
///
/// # Errors
/// [`BenchError::Peer`] names the line and what was expected.
pub fn read(path: &Path) -> Result<Vec<PeerRow>, BenchError> {
    let fault = |line: usize, (found, expected): (String, String)| BenchError::Peer {
        line,
        found,
        expected,
        path: path.into(),
    };
    let text = std::fs::read_to_string(path).map_err(|e| fault(0, (e.to_string(), "a CSV file".into())))?;
    let mut lines = text.lines().map(str::trim).enumerate().filter(|(_, line)| !line.is_empty());
    match lines.next() {
        // spreadsheets put a byte order mark first
        Some((_, line)) if line.trim_start_matches('\u{feff}') == HEADER => {}
        first => {
            let (i, found) = first.map_or((0, "nothing".into()), |(i, line)| (i, quoted(line)));
            return Err(fault(i + 1, (found, format!("the header {HEADER}"))));
        }
    }
    lines.map(|(i, line)| row(line).map_err(|why| fault(i + 1, why))).collect()
}

/// A row, or what was found and what was expected.
fn row(line: &str) -> Result<PeerRow, (String, String)> {
    let fields: Vec<&str> = line.split(',').map(str::trim).collect();
    let [name, part, spp, seconds, rel_mse] = fields[..] else {
        return Err((format!("{} columns", fields.len()), format!("the 5 columns {HEADER}, none with a comma within")));
    };
    let positive = |column: &str, word: &str| {
        let value = word.parse::<f64>().ok().filter(|v| *v > 0.0 && v.is_finite());
        value.ok_or_else(|| (format!("{column} {}", quoted(word)), "a number above 0".to_owned()))
    };
    if name.is_empty() {
        return Err(("an empty name".into(), "what to call the peer".into()));
    }
    if !part_names().any(|known| known == part) {
        let known = part_names().collect::<Vec<_>>().join(", ");
        return Err((format!("scene {}", quoted(part)), format!("one of {known}")));
    }
    let spp = spp
        .parse()
        .ok()
        .filter(|spp| *spp > 0)
        .ok_or_else(|| (format!("spp {}", quoted(spp)), format!("a whole number from 1 to {}", u32::MAX)))?;
    Ok(PeerRow {
        name: name.into(),
        part: part.into(),
        spp,
        seconds: positive("seconds", seconds)?,
        rel_mse: positive("relmse", rel_mse)?,
    })
}

/// As much of a file's words as fits in a line of our own.
fn quoted(words: &str) -> String {
    const MOST: usize = 60;
    let printable = words.chars().map(|c| if c.is_control() { ' ' } else { c });
    let short: String = printable.clone().take(MOST).collect();
    if printable.count() > MOST { format!("'{short}...'") } else { format!("'{short}'") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use visavis_tests::TestFolder;

    fn of(text: &str) -> Result<Vec<PeerRow>, String> {
        let folder = TestFolder::new();
        let file = folder.file("peer.csv");
        std::fs::write(&file, text).unwrap();
        read(&file).map_err(|e| e.to_string())
    }

    #[test]
    fn a_table_is_read_also_with_a_spreadsheets_endings() {
        let rows = of("\u{feff}name,scene,spp,seconds,relmse\r\nMitsuba 3, cornell, 4, 0.05, 1e-2\r\n\r\n").unwrap();
        let expected =
            PeerRow { name: "Mitsuba 3".into(), part: "cornell".into(), spp: 4, seconds: 0.05, rel_mse: 0.01 };
        assert_eq!(rows, [expected]);
    }

    #[test]
    fn what_is_malformed_is_named_by_line_and_expectation() {
        let with = |row: &str| of(&format!("{HEADER}\nok,cornell,1,1,1\n{row}\n")).unwrap_err();
        let cases = [
            ("a,cornell,1,1", "4 columns"),
            (",cornell,1,1,1", "an empty name"),
            ("a,teapot,1,1,1", "scene 'teapot', expected one of cornell, whitted-sun-0"),
            ("a,cornell,0,1,1", "spp '0', expected a whole number from 1"),
            ("a,cornell,1,-1,1", "seconds '-1', expected a number above 0"),
            ("a,cornell,1,1,nan", "relmse 'nan', expected a number above 0"),
            ("a,cornell,1,1,inf", "relmse 'inf'"),
        ];
        for (row, words) in cases {
            let line = with(row);
            assert!(line.starts_with("line 3 of a peer's table") && line.contains(words), "{row}: {line}");
            assert!(line.contains("peer.csv") && line.lines().count() == 1, "{line}");
        }
        assert!(of("").unwrap_err().contains("nothing, expected the header name,scene"));
        assert!(of("spp,seconds\n").unwrap_err().contains("line 1"));
        assert!(read(Path::new("/nowhere/peer.csv")).unwrap_err().to_string().contains("/nowhere/peer.csv"));
    }
}
