//! Names that tell the parts of a scene apart.

use super::buffers::Document;
use super::nodes::Placed;
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

/// Letters of a part's own name.
const MOST_LETTERS: usize = 80;

/// Levels of the tree of nodes that a name tells, the last ones.
const MOST_LEVELS: usize = 8;

/// Bytes that all paths have together: beyond them parts are called by their node's number.
const MOST_BYTES: usize = 1 << 26;

/// What shapes are called: by their nodes from the root on, with `/` between.
pub struct Paths<'a> {
    document: &'a Document,
    placed: &'a [Placed<'a>],
    bytes_left: usize,
}

impl<'a> Paths<'a> {
    /// Of the nodes that are shown.
    pub fn new(document: &'a Document, placed: &'a [Placed<'a>]) -> Self {
        Paths { document, placed, bytes_left: MOST_BYTES }
    }

    /// Of what stands at a place among the nodes; `below` tells apart what is shown there.
    pub fn of(&mut self, place: usize, below: Option<&str>) -> String {
        let mut levels: Vec<String> = below.and_then(level).into_iter().collect();
        let mut next = Some(place);
        while let Some(at) = next.filter(|_| levels.len() < MOST_LEVELS) {
            levels.push(self.own_name(at));
            next = self.placed[at].parent;
        }
        levels.reverse();
        let path = levels.join("/");
        match self.bytes_left.checked_sub(path.len()) {
            Some(left) => {
                self.bytes_left = left;
                path
            }
            None => format!("node {}", self.placed[place].index),
        }
    }

    /// A node without a name is called by its mesh.
    fn own_name(&self, place: usize) -> String {
        let Placed { node, index, .. } = &self.placed[place];
        let mesh = node.mesh.and_then(|mesh| self.document.root.meshes.get(mesh as usize));
        let name = node.name.as_deref().and_then(level);
        name.or_else(|| level(mesh?.name.as_deref()?)).unwrap_or_else(|| format!("node {index}"))
    }
}

/// A name of the file as one level of a part's: in a line, without `/`; `None` if it is blank.
pub fn level(name: &str) -> Option<String> {
    let end = name.char_indices().nth(MOST_LETTERS).map(|(end, _)| end);
    let cut = image_file::escaped(&name[..end.unwrap_or(name.len())]).replace('/', "_");
    let more = if end.is_some() { "..." } else { "" };
    (!cut.trim().is_empty()).then_some(cut + more)
}
