//! What the shapes and the point lights of a scene file are called: as it says, else by what they are.

use super::{Fault, fault};
use std::collections::{HashMap, HashSet};
use toml::Spanned;

/// Characters that a name has at most.
const LONGEST: usize = 200;

/// The names of one list, in its order.
pub struct PartNames {
    /// What has these names, for faults.
    what: &'static str,
    names: Vec<String>,
    given: HashSet<String>,
    /// Places of names that the file does not give.
    usual: Vec<usize>,
    of_kind: HashMap<&'static str, usize>,
}

impl PartNames {
    /// None so far, of shapes or of lights.
    pub fn of(what: &'static str) -> Self {
        PartNames { what, names: Vec::new(), given: HashSet::new(), usual: Vec::new(), of_kind: HashMap::new() }
    }

    /// The name of the next one: that which the file gives, else `copied`, else the kind and its number among its kind.
    pub fn add(
        &mut self,
        kind: &'static str,
        given: Option<Spanned<String>>,
        copied: Option<String>,
    ) -> Result<(), Fault> {
        let number = self.of_kind.entry(kind).or_default();
        *number += 1;
        let Some(given) = given else {
            self.usual.push(self.names.len());
            self.names.push(copied.unwrap_or_else(|| format!("{kind} {number}")));
            return Ok(());
        };
        let (at, name) = (given.span(), given.into_inner());
        if name.trim().is_empty() || name.chars().count() > LONGEST || name.contains(char::is_control) {
            return fault(at, format!("expected a name of 1 to {LONGEST} characters in one line"));
        }
        if !self.given.insert(name.clone()) {
            return fault(at, format!("a {} is called '{name}' already", self.what));
        }
        self.names.push(name);
        Ok(())
    }

    /// All of them. A name that the file gives is that of its part, wherever another is usually called so.
    pub fn all(mut self) -> Vec<String> {
        for index in self.usual {
            let usual = &self.names[index];
            let numbered = |number: usize| format!("{usual} ({number})");
            if let Some(free) = self.given.contains(usual).then(|| (2..).map(numbered)) {
                let free = free.into_iter().find(|name| !self.given.contains(name));
                self.names[index] = free.unwrap_or_default();
            }
        }
        self.names
    }
}
