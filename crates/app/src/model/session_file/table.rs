//! Tables of a session's file, taken apart key by key, so that whatever is wrong is told with its place and with
//! what was expected there.

use scene::edit::{Edits, Wrong, edits_of};
use scene::{Vec3, nearest_or_begun};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// What is wrong, at a byte range of the text.
#[derive(Debug)]
pub struct Fault {
    pub at: Range<usize>,
    pub message: String,
}

pub fn fault<T>(at: &Range<usize>, message: impl Into<String>) -> Result<T, Fault> {
    Err(Fault { at: at.clone(), message: message.into() })
}

/// A table of which keys are taken; what is left in the end was not expected.
pub struct Table<'t> {
    /// As messages call it.
    name: String,
    /// The bytes of the file in which it stands, for faults.
    pub at: Range<usize>,
    /// In the order of the text.
    entries: Vec<Entry<'t>>,
    /// All keys that were asked for.
    known: Vec<&'static str>,
}

/// A key with its value.
pub struct Entry<'t> {
    pub key: String,
    pub key_at: Range<usize>,
    pub at: Range<usize>,
    value: DeValue<'t>,
}

impl<'t> Table<'t> {
    pub fn new(name: impl Into<String>, at: Range<usize>, table: DeTable<'t>) -> Self {
        let mut entries: Vec<Entry> = table.into_iter().map(|(key, value)| Entry::new(key, value)).collect();
        entries.sort_by_key(|entry| entry.key_at.start);
        Table { name: name.into(), at, entries, known: Vec::new() }
    }

    /// Takes what a key says, if it is there.
    pub fn take(&mut self, key: &'static str) -> Option<Entry<'t>> {
        self.known.push(key);
        let index = self.entries.iter().position(|entry| entry.key == key)?;
        Some(self.entries.remove(index))
    }

    /// Takes a key's value as `read` has it, if it is there.
    pub fn read<T>(
        &mut self,
        key: &'static str,
        read: impl FnOnce(Entry<'t>) -> Result<T, Fault>,
    ) -> Result<Option<T>, Fault> {
        self.take(key).map(read).transpose()
    }

    /// Takes the table under this key; an empty one if it is not there.
    pub fn table(&mut self, key: &'static str) -> Result<Table<'t>, Fault> {
        let name = self.name_of(key);
        let at = self.at.clone();
        Ok(self.read(key, |entry| entry.table(name.clone()))?.unwrap_or_else(|| Table::new(name, at, DeTable::new())))
    }

    /// As messages call what is under a key: "panes.A".
    pub fn name_of(&self, key: &str) -> String {
        if self.name.is_empty() { key.to_owned() } else { format!("{}.{key}", self.name) }
    }

    /// All that was not taken, whatever its keys.
    pub fn rest(self) -> Vec<Entry<'t>> {
        self.entries
    }

    /// # Errors
    /// The first key that was not taken.
    pub fn end(self) -> Result<(), Fault> {
        let Some(first) = self.entries.first() else { return Ok(()) };
        let place = if self.name.is_empty() { "a session".to_owned() } else { format!("[{}]", self.name) };
        fault(&first.key_at, format!("{} is no key of {place}: {}", first.key, expected(&first.key, &self.known)))
    }
}

/// "expected a, b or c", and which of them was probably meant.
pub fn expected(word: &str, known: &[&str]) -> String {
    let list = match known {
        [first @ .., last] if !first.is_empty() => format!("{} or {last}", first.join(", ")),
        known => known.concat(),
    };
    let meant = nearest_or_begun(word, known.iter().copied());
    format!("expected {list}{}", meant.map_or_else(String::new, |meant| format!("; did you mean {meant}?")))
}

impl<'t> Entry<'t> {
    fn new(key: Spanned<toml::de::DeString<'t>>, value: Spanned<DeValue<'t>>) -> Self {
        let (key_at, at) = (key.span(), value.span());
        Entry { key: key.into_inner().into_owned(), key_at, at, value: value.into_inner() }
    }

    /// A word or a number as the table of settings reads it; `None` of what is neither.
    pub fn word(&self) -> Option<String> {
        match &self.value {
            DeValue::String(text) => Some(text.clone().into_owned()),
            DeValue::Integer(number) if number.radix() == 10 => Some(number.as_str().to_owned()),
            DeValue::Float(number) => Some(number.as_str().to_owned()),
            _ => None,
        }
    }

    pub fn no<T>(&self, expected: &str) -> Result<T, Fault> {
        fault(&self.at, format!("{}: expected {expected}", self.key))
    }

    pub fn table(self, name: impl Into<String>) -> Result<Table<'t>, Fault> {
        match self.value {
            DeValue::Table(table) => Ok(Table::new(name, self.at, table)),
            _ => fault(&self.at, format!("{}: expected a table, [{}]", self.key, name.into())),
        }
    }

    /// Several tables of one name.
    pub fn tables(self, name: &str) -> Result<Vec<Table<'t>>, Fault> {
        let expected = format!("tables, each under [[{name}]]");
        let DeValue::Array(array) = self.value else { return self.no(&expected) };
        let one = |value: Spanned<DeValue<'t>>| match (value.span(), value.into_inner()) {
            (at, DeValue::Table(table)) => Ok(Table::new(name, at, table)),
            (at, _) => fault(&at, format!("{}: expected {expected}", self.key)),
        };
        array.into_iter().map(one).collect()
    }

    /// What is changed in a scene part by part.
    pub fn edits(self) -> Result<Edits, Fault> {
        let wrong = |Wrong { at, message }| Fault { at, message };
        edits_of(Spanned::new(self.at, self.value)).map_err(wrong)
    }

    pub fn text(&self, expected: &str) -> Result<String, Fault> {
        match &self.value {
            DeValue::String(text) if !text.is_empty() => Ok(text.clone().into_owned()),
            _ => self.no(expected),
        }
    }

    pub fn flag(&self) -> Result<bool, Fault> {
        if let DeValue::Boolean(flag) = self.value { Ok(flag) } else { self.no("true or false") }
    }

    /// A number that `holds`.
    pub fn number(&self, expected: &str, holds: impl Fn(f32) -> bool) -> Result<f32, Fault> {
        number(&self.value).filter(|number| holds(*number)).map_or_else(|| self.no(expected), Ok)
    }

    /// An array of exactly `N` numbers, all of which `holds`.
    pub fn numbers<const N: usize>(&self, expected: &str, holds: impl Fn(f32) -> bool) -> Result<[f32; N], Fault> {
        let DeValue::Array(array) = &self.value else { return self.no(expected) };
        let numbers = array.iter().map(|value| number(value.get_ref()).filter(|number| holds(*number)));
        let numbers = numbers.collect::<Option<Vec<f32>>>().and_then(|numbers| numbers.try_into().ok());
        numbers.map_or_else(|| self.no(expected), Ok)
    }

    pub fn point(&self) -> Result<Vec3, Fault> {
        self.numbers("three numbers, [x, y, z]", |_| true).map(Vec3::from)
    }

    /// A whole number up to 255, as those of adapters are.
    pub fn small_number(&self, expected: &str) -> Result<u8, Fault> {
        self.word().and_then(|word| word.parse().ok()).map_or_else(|| self.no(expected), Ok)
    }

    /// That of `all` whose name this is.
    pub fn one_of<T: Copy>(&self, all: &[T], name: impl Fn(T) -> &'static str) -> Result<T, Fault> {
        let word = self.word().unwrap_or_default();
        let names: Vec<_> = all.iter().map(|one| name(*one)).collect();
        let found = all.iter().copied().find(|one| name(*one) == word);
        found.map_or_else(|| fault(&self.at, format!("{} {word}: {}", self.key, expected(&word, &names))), Ok)
    }
}

/// By its digits, so that none is lost on the way.
fn number(value: &DeValue) -> Option<f32> {
    let digits = match value {
        DeValue::Integer(number) if number.radix() == 10 => number.as_str(),
        DeValue::Float(number) => number.as_str(),
        _ => return None,
    };
    digits.parse().ok().filter(|number: &f32| number.is_finite())
}
