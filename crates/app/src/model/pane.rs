//! Panes: the pictures that are made beside each other, each by a way of its own.

use std::fmt;
use std::ops::{Index, IndexMut};

/// One of the pictures.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PaneId(u8);

/// One letter for each pane that there can be.
const LETTERS: &str = "ABCDEFGHIJKLMNOPQRSTUVWXYZ";

impl PaneId {
    /// The first pane: left of the wipe's line.
    pub const A: PaneId = PaneId(0);
    /// The second: right of it.
    pub const B: PaneId = PaneId(1);
    /// The picture of a hard case, which no session has.
    pub const CASE: PaneId = PaneId(25);

    /// The one with this letter, from A to Z.
    pub fn named(name: &str) -> Option<Self> {
        let index = LETTERS.find(name).filter(|_| name.len() == 1)?;
        u8::try_from(index).ok().map(PaneId)
    }

    /// Its letter: "A", "B".
    pub fn name(self) -> &'static str {
        let index = usize::from(self.0);
        &LETTERS[index..=index]
    }
}

impl fmt::Display for PaneId {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl fmt::Debug for PaneId {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Something for each pane, in the order of their letters. There are few of them: a sorted list is faster than a tree.
#[derive(Debug, Clone, PartialEq)]
pub struct Panes<T>(Vec<(PaneId, T)>);

impl<T> Panes<T> {
    /// What a pane has, if it has it.
    pub fn get(&self, id: PaneId) -> Option<&T> {
        self.place(id).ok().map(|place| &self.0[place].1)
    }

    /// The same to be changed.
    pub fn get_mut(&mut self, id: PaneId) -> Option<&mut T> {
        self.place(id).ok().map(|place| &mut self.0[place].1)
    }

    /// What a pane has; the default if it had nothing yet.
    pub fn entry(&mut self, id: PaneId) -> &mut T
    where
        T: Default,
    {
        let place = self.place(id).unwrap_or_else(|place| {
            self.0.insert(place, (id, T::default()));
            place
        });
        &mut self.0[place].1
    }

    /// Gives a pane something and returns what it had.
    pub fn insert(&mut self, id: PaneId, value: T) -> Option<T> {
        match self.place(id) {
            Ok(place) => Some(std::mem::replace(&mut self.0[place].1, value)),
            Err(place) => {
                self.0.insert(place, (id, value));
                None
            }
        }
    }

    /// Takes from a pane what it has.
    pub fn remove(&mut self, id: PaneId) -> Option<T> {
        self.place(id).ok().map(|place| self.0.remove(place).1)
    }

    /// Keeps what `keep` says.
    pub fn retain(&mut self, mut keep: impl FnMut(PaneId, &T) -> bool) {
        self.0.retain(|(id, value)| keep(*id, value));
    }

    /// The panes that have something.
    pub fn ids(&self) -> impl Iterator<Item = PaneId> + use<'_, T> {
        self.0.iter().map(|(id, _)| *id)
    }

    /// All with their panes.
    pub fn iter(&self) -> impl Iterator<Item = (PaneId, &T)> {
        self.0.iter().map(|(id, value)| (*id, value))
    }

    /// All with their panes, to be changed.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = (PaneId, &mut T)> {
        self.0.iter_mut().map(|(id, value)| (*id, value))
    }

    /// All without their panes.
    pub fn values(&self) -> impl Iterator<Item = &T> {
        self.0.iter().map(|(_, value)| value)
    }

    /// All without their panes, to be changed.
    pub fn values_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.0.iter_mut().map(|(_, value)| value)
    }

    /// Whether no pane has anything.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Where a pane stands in the list, or would.
    fn place(&self, id: PaneId) -> Result<usize, usize> {
        self.0.binary_search_by_key(&id, |(id, _)| *id)
    }
}

impl<T> Default for Panes<T> {
    fn default() -> Self {
        Panes(Vec::new())
    }
}

impl<T> FromIterator<(PaneId, T)> for Panes<T> {
    fn from_iter<I: IntoIterator<Item = (PaneId, T)>>(items: I) -> Self {
        let mut panes = Panes::default();
        items.into_iter().for_each(|(id, value)| drop(panes.insert(id, value)));
        panes
    }
}

impl<T> IntoIterator for Panes<T> {
    type Item = (PaneId, T);
    type IntoIter = std::vec::IntoIter<(PaneId, T)>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

/// For panes that are known to have something, as those of a [`Session`](super::Session) have their settings.
impl<T> Index<PaneId> for Panes<T> {
    type Output = T;

    fn index(&self, id: PaneId) -> &T {
        match self.get(id) {
            Some(value) => value,
            None => panic!("there is nothing for pane {id}"),
        }
    }
}

impl<T> IndexMut<PaneId> for Panes<T> {
    fn index_mut(&mut self, id: PaneId) -> &mut T {
        match self.get_mut(id) {
            Some(value) => value,
            None => panic!("there is nothing for pane {id}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panes_are_named_by_letters_and_stay_in_their_order() {
        let d = PaneId::named("D").unwrap();
        assert_eq!([PaneId::A.name(), PaneId::B.name(), d.name()], ["A", "B", "D"]);
        assert_eq!([PaneId::named("AB"), PaneId::named("é"), PaneId::named("")], [None; 3]);
        let mut panes: Panes<u32> = [(d, 4), (PaneId::A, 1)].into_iter().collect();
        *panes.entry(PaneId::B) += 2;
        assert_eq!(panes.insert(d, 5), Some(4));
        assert_eq!(panes.iter().collect::<Vec<_>>(), [(PaneId::A, &1), (PaneId::B, &2), (d, &5)]);
        assert_eq!((panes.remove(PaneId::A), panes.get(PaneId::A)), (Some(1), None));
    }
}
