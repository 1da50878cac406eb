//! Names that tell the parts of a scene apart.

use std::collections::{HashMap, HashSet};

/// Names that were given: of thousands that a file calls the same, each in the time of one.
#[derive(Default)]
pub struct Names {
    given: HashSet<String>,
    /// What stands behind the next one of a name.
    next: HashMap<String, u32>,
}

impl Names {
    /// The name, or with a number behind it if it was given before.
    pub fn free(&mut self, name: String) -> String {
        let mut free = name.clone();
        while !self.given.insert(free.clone()) {
            let number = self.next.entry(name.clone()).or_insert(1);
            *number += 1;
            free = format!("{name} {number}");
        }
        free
    }
}
