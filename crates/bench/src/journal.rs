//! The journal: one line of JSON for the run, then one for each finished measurement, appended as they come. What a run
//! that was killed left behind is gone on with; the line that it was writing is cut off.

use crate::BenchError;
use crate::host::Host;
use crate::measure::Measurement;
use crate::plan::{Effort, Part};
use serde::{Deserialize, Serialize};
use std::fs::{File, TryLockError};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

/// Its name in the folder of the results.
pub const NAME: &str = "journal.jsonl";

/// All that measurements depend on beside their part, line and samples.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Version and build of the program.
    pub program: String,
    /// The machine.
    pub host: Host,
    /// How long it may take.
    pub effort: Effort,
    /// Names of the scenes; empty for all.
    pub scenes: Vec<String>,
}

/// The first line.
#[derive(Serialize, Deserialize)]
struct Header {
    run: Run,
    parts: Vec<Part>,
}

/// An open journal.
#[derive(Debug)]
pub struct Journal {
    file: File,
    path: PathBuf,
    measurements: Vec<Measurement>,
}

impl Journal {
    /// Opens that of the folder, or begins one with a plan that `plan` makes. Returns the plan that holds: the one it
    /// was begun with.
    ///
    /// # Errors
    /// [`BenchError::OtherRun`] if it belongs to another program, machine or other options; [`BenchError::Damaged`];
    /// [`BenchError::Busy`] while another program has it open; [`BenchError::Journal`].
    pub fn open(
        folder: &Path,
        run: &Run,
        plan: impl FnOnce() -> Result<Vec<Part>, BenchError>,
    ) -> Result<(Self, Vec<Part>), BenchError> {
        let path = folder.join(NAME);
        let opened = File::options().create(true).read(true).append(true).open(&path);
        let mut file = opened.map_err(BenchError::journal("write", &path))?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => return Err(BenchError::Busy(path)),
            // file systems without locks are used without
            Err(TryLockError::Error(_)) | Ok(()) => {}
        }
        let mut written = Vec::new();
        file.read_to_end(&mut written).map_err(BenchError::journal("read", &path))?;
        // the last line is whole when its end is there
        let whole = written.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        let mut lines = written[..whole].split_inclusive(|byte| *byte == b'\n').enumerate();
        let damaged = |line: usize, why: serde_json::Error| BenchError::Damaged {
            line: line + 1,
            why: why.to_string(),
            path: path.clone(),
        };
        let mut measurements = Vec::new();
        let header = match lines.next() {
            None => None,
            Some((i, line)) => Some(serde_json::from_slice::<Header>(line).map_err(|e| damaged(i, e))?),
        };
        if let Some(differs) = header.as_ref().and_then(|header| header.run.difference(run)) {
            return Err(BenchError::OtherRun { differs, path });
        }
        for (i, line) in lines {
            measurements.push(serde_json::from_slice(line).map_err(|e| damaged(i, e))?);
        }
        file.set_len(whole as u64).map_err(BenchError::journal("write", &path))?;
        let mut journal = Journal { file, path, measurements };
        let parts = match header {
            Some(header) => header.parts,
            None => {
                let header = Header { run: run.clone(), parts: plan()? };
                journal.write(&header)?;
                header.parts
            }
        };
        Ok((journal, parts))
    }

    /// What is there.
    pub fn measurements(&self) -> &[Measurement] {
        &self.measurements
    }

    /// The measurement of a line at so many samples, if it is there.
    pub fn find(&self, part: &str, line: &str, spp: u32) -> Option<&Measurement> {
        self.measurements.iter().find(|m| m.part == part && m.line == line && m.spp == spp)
    }

    /// Keeps one more.
    ///
    /// # Errors
    /// [`BenchError::Journal`].
    pub fn add(&mut self, measurement: Measurement) -> Result<(), BenchError> {
        self.write(&measurement)?;
        self.measurements.push(measurement);
        Ok(())
    }

    /// A whole line at once, on the disk before anything else is measured.
    fn write(&mut self, line: &impl Serialize) -> Result<(), BenchError> {
        let words = serde_json::to_string(line).map_err(std::io::Error::other);
        words
            .and_then(|words| self.file.write_all((words + "\n").as_bytes()).and_then(|()| self.file.sync_data()))
            .map_err(BenchError::journal("write", &self.path))
    }
}

impl Run {
    /// What differs, for people: the other's first.
    fn difference(&self, ours: &Run) -> Option<String> {
        let differ =
            |what: &str, theirs: &str, ours: &str| (theirs != ours).then(|| format!("{what} {theirs}, this is {ours}"));
        let scenes = |run: &Run| if run.scenes.is_empty() { "all".into() } else { run.scenes.join(",") };
        differ("visavis", &self.program, &ours.program)
            .or_else(|| differ("the machine", &self.host.words(), &ours.host.words()))
            .or_else(|| differ("the effort", &self.effort.words(), &ours.effort.words()))
            .or_else(|| differ("the scenes", &scenes(self), &scenes(ours)))
    }
}

impl Effort {
    /// "full" or "60 s".
    pub fn words(self) -> String {
        match self {
            Effort::Full => "full".into(),
            Effort::Seconds(seconds) => format!("{seconds} s"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::Picture;
    use crate::plan::Speed;
    use crate::references::Worth;
    use visavis_tests::TestFolder;

    fn run() -> Run {
        let host = Host { name: "h".into(), cpu: "c".into(), threads: 2, system: "s".into(), adapter: "a".into() };
        Run { program: "1".into(), host, effort: Effort::Seconds(3.0), scenes: Vec::new() }
    }

    fn part() -> Part {
        Part {
            name: "cornell".into(),
            scene: "cornell".into(),
            sun_radius: None,
            width: 8,
            height: 8,
            most_spp: 16,
            reference_seconds: 0.1,
            speed: Speed { reference: 1.0 / 3.0, lines: 0.1, learning: 0.0, denoising: 0.0 },
        }
    }

    fn measurement(spp: u32) -> Measurement {
        let reference =
            Worth { spp: 1, seconds: 0.1, mean: 0.5, mse: 1e-300, rel_mse: 0.1, tail_weight: 0.0, nonfinite: 0 };
        let picture = Picture {
            seed: 1,
            seconds: 0.1,
            samples: 1,
            rays: 1,
            cut_paths: 0,
            nonfinite: 0,
            rmse: 1.0 / 3.0,
            rel_mse: 0.1,
            mae: 0.1,
            bias: -0.1,
            flip: 0.1,
            tail_weight: 0.1,
        };
        Measurement { part: "cornell".into(), line: "x".into(), spp, pictures: vec![picture], bias: None, reference }
    }

    fn reopened(folder: &TestFolder, run: &Run) -> Result<(Journal, Vec<Part>), BenchError> {
        Journal::open(folder.path(), run, || panic!("the plan is there"))
    }

    #[test]
    fn cut_anywhere_it_keeps_every_whole_line_to_the_last_bit() {
        let folder = TestFolder::new();
        let path = folder.file(NAME);
        let mut journal = Journal::open(folder.path(), &run(), || Ok(vec![part()])).unwrap().0;
        let first = std::fs::metadata(&path).unwrap().len() as usize;
        journal.add(measurement(1)).unwrap();
        let second = std::fs::metadata(&path).unwrap().len() as usize;
        journal.add(measurement(4)).unwrap();
        drop(journal);
        let written = std::fs::read(&path).unwrap();
        for cut in (first..=written.len()).step_by(7).chain([second - 1, second, written.len() - 1, written.len()]) {
            std::fs::write(&path, &written[..cut]).unwrap();
            let (mut journal, parts) = reopened(&folder, &run()).unwrap();
            let whole = usize::from(cut >= second) + usize::from(cut >= written.len());
            assert_eq!(journal.measurements().len(), whole, "{cut}");
            assert!(journal.measurements().iter().all(|m| *m == measurement(m.spp)));
            assert_eq!(parts, [part()]);
            // what is appended after a cut begins a line of its own
            journal.add(measurement(64)).unwrap();
            drop(journal);
            assert_eq!(reopened(&folder, &run()).unwrap().0.measurements().len(), whole + 1);
        }
    }

    #[test]
    fn another_run_is_refused_by_what_differs() {
        let folder = TestFolder::new();
        drop(Journal::open(folder.path(), &run(), || Ok(vec![part()])).unwrap());
        let mut others = [run(), run(), run(), run()];
        others[0].program = "2".into();
        others[1].host.threads = 3;
        others[2].effort = Effort::Full;
        others[3].scenes = vec!["whitted".into()];
        for (other, words) in others.iter().zip(["visavis 1", "2 threads", "3 s, this is full", "all, this is whitted"])
        {
            let line = reopened(&folder, other).unwrap_err().to_string();
            assert!(line.contains(words) && line.contains(NAME), "{line}");
        }
    }

    #[test]
    fn two_benches_do_not_share_a_folder() {
        let folder = TestFolder::new();
        let first = Journal::open(folder.path(), &run(), || Ok(vec![part()])).unwrap();
        assert!(matches!(reopened(&folder, &run()), Err(BenchError::Busy(_))));
        drop(first);
        assert!(reopened(&folder, &run()).is_ok());
    }

    #[test]
    fn a_damaged_line_is_named() {
        let folder = TestFolder::new();
        drop(Journal::open(folder.path(), &run(), || Ok(vec![part()])).unwrap());
        let mut text = std::fs::read_to_string(folder.file(NAME)).unwrap();
        text += "{\"part\": 7}\n";
        std::fs::write(folder.file(NAME), text).unwrap();
        let line = reopened(&folder, &run()).unwrap_err().to_string();
        assert!(line.starts_with("line 2 of the journal"), "{line}");
    }
}
