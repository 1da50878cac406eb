//! What a file asks for and does not get: a line for each kind, whoever asks for it named.

use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};

/// Names that a line has at most.
const MOST_NAMED: usize = 4;

/// Lines to be, in the order in which their kinds were first met.
#[derive(Default)]
pub struct Remarks(Vec<Remark>);

struct Remark {
    line: &'static str,
    named: Vec<String>,
    others: usize,
    /// Hashes of all names.
    seen: HashSet<u64>,
}

impl Remarks {
    /// Something that a file has or has not.
    pub fn add(&mut self, line: &'static str) {
        self.find(line);
    }

    /// Something that one of the file's parts has, which is told once.
    pub fn of(&mut self, line: &'static str, name: String) {
        let remark = self.find(line);
        let mut hasher = DefaultHasher::new();
        name.hash(&mut hasher);
        if !remark.seen.insert(hasher.finish()) {
            return;
        }
        if remark.named.len() < MOST_NAMED {
            remark.named.push(name);
        } else {
            remark.others += 1;
        }
    }

    fn find(&mut self, line: &'static str) -> &mut Remark {
        let place = self.0.iter().position(|remark| remark.line == line).unwrap_or_else(|| {
            self.0.push(Remark { line, named: Vec::new(), others: 0, seen: HashSet::new() });
            self.0.len() - 1
        });
        &mut self.0[place]
    }

    pub fn lines(self) -> impl Iterator<Item = String> {
        self.0.into_iter().map(|Remark { line, named, others, .. }| match (named.is_empty(), others) {
            (true, _) => line.to_owned(),
            (false, 0) => format!("{line}: {}", named.join(", ")),
            (false, _) => format!("{line}: {} and {others} more", named.join(", ")),
        })
    }
}
