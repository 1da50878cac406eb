//! Changes as text: an inline table of TOML in a line, as options and records have it, or the table `[edit]` of a file.
//!
//! ```toml
//! { variant = "beach", material.glass = { ior = 1.4 }, shape."sphere 1" = { center = [0.0, 2.0, 0.0] }, sun = { elevation = 20.0 } }
//! ```

use super::{CannotEdit, Edits, Kind, Property, Subject, Value};
use crate::nearest_or_begun;
use glam::Vec3;
use std::fmt::{self, Write};
use std::ops::Range;
use std::str::FromStr;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Tables of subjects that have names, and of those that there is one of.
const NAMED: [&str; 3] = ["material", "shape", "light"];
const SINGLE: [&str; 2] = ["sun", "sky"];
const VARIANT: &str = "variant";

/// What is wrong with a text.
#[derive(Debug)]
pub struct Wrong {
    /// The bytes of it that are.
    pub at: Range<usize>,
    /// What was expected there, in a line.
    pub message: String,
}

fn wrong<T>(at: &Range<usize>, message: impl Into<String>) -> Result<T, Wrong> {
    Err(Wrong { at: at.clone(), message: message.into() })
}

/// Longest text of changes, in bytes: some thousand changes.
const LONGEST: usize = 1 << 20;

impl FromStr for Edits {
    type Err = CannotEdit;

    /// Reads an inline table.
    fn from_str(text: &str) -> Result<Self, CannotEdit> {
        if text.len() > LONGEST {
            return Err(CannotEdit(format!("changes of a scene have at most {LONGEST} bytes")));
        }
        let line = text.trim();
        if !(line.starts_with('{') && line.ends_with('}')) {
            return Err(CannotEdit(
                "expected changes of a scene as { material.NAME = { colour = [r, g, b] }, .. }".into(),
            ));
        }
        let whole = format!("edit = {line}");
        let table = DeTable::parse(&whole).map_err(|fault| CannotEdit(first_line(fault.message())))?.into_inner();
        match table.into_iter().next() {
            Some((_, value)) => edits_of(value).map_err(|Wrong { message, .. }| CannotEdit(message)),
            None => Ok(Edits::default()),
        }
    }
}

fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().to_owned()
}

/// What a table of changes says, whose values know where they stand in the text.
///
/// # Errors
/// What is wrong first, and where.
pub fn edits_of(value: Spanned<DeValue>) -> Result<Edits, Wrong> {
    let mut edits = Edits::default();
    for (key, value) in table_of(value, "edit")? {
        let (at, name) = (key.span(), key.into_inner());
        match &*name {
            VARIANT => edits.variant = Some(word_of(&value, VARIANT)?),
            kind if NAMED.contains(&kind) => {
                for (name, values) in table_of(value, kind)? {
                    let name = name.into_inner().into_owned();
                    let subject = match kind {
                        "material" => Subject::Material(name),
                        "shape" => Subject::Shape(name),
                        _ => Subject::Light(name),
                    };
                    take(&mut edits, subject, values)?;
                }
            }
            "sun" => take(&mut edits, Subject::Sun, value)?,
            "sky" => take(&mut edits, Subject::Sky, value)?,
            other => {
                let known: Vec<&str> = [VARIANT].into_iter().chain(NAMED).chain(SINGLE).collect();
                return wrong(&at, unknown(other, "be changed", &known));
            }
        }
    }
    Ok(edits)
}

/// All that is changed in one subject.
fn take(edits: &mut Edits, subject: Subject, values: Spanned<DeValue>) -> Result<(), Wrong> {
    for (key, value) in table_of(values, &subject.to_string())? {
        let Some(property) = subject.property(key.get_ref()) else {
            let known: Vec<&str> = subject.properties().iter().map(|property| property.name).collect();
            return wrong(&key.span(), unknown(key.get_ref(), &format!("be changed in {subject}"), &known));
        };
        let value = value_of(&value, property, &subject)?;
        edits.set(&subject, property, value);
    }
    Ok(())
}

fn unknown(word: &str, what: &str, known: &[&str]) -> String {
    let meant = nearest_or_begun(word, known.iter().copied());
    let meant = meant.map_or_else(String::new, |meant| format!("; did you mean {meant}?"));
    format!("'{}' cannot {what}: expected one of {}{meant}", image_file::escaped(word), known.join(", "))
}

fn table_of<'t>(value: Spanned<DeValue<'t>>, name: &str) -> Result<DeTable<'t>, Wrong> {
    let at = value.span();
    match value.into_inner() {
        DeValue::Table(table) => Ok(table),
        _ => wrong(&at, format!("{name}: expected a table of what is changed in it")),
    }
}

fn word_of(value: &Spanned<DeValue>, name: &str) -> Result<String, Wrong> {
    match value.get_ref() {
        DeValue::String(text) => Ok(text.clone().into_owned()),
        _ => wrong(&value.span(), format!("{name}: expected a word in quotes")),
    }
}

fn value_of(value: &Spanned<DeValue>, property: &Property, subject: &Subject) -> Result<Value, Wrong> {
    let read = match (&property.kind, value.get_ref()) {
        (Kind::Number { .. }, number) => number_of(number).map(Value::Number),
        (Kind::Word, DeValue::String(text)) => Some(Value::Word(text.clone().into_owned())),
        (Kind::Flag, DeValue::Boolean(flag)) => Some(Value::Flag(*flag)),
        (Kind::Colour | Kind::Light | Kind::Point | Kind::Turn, DeValue::Array(list)) => {
            let numbers: Option<Vec<f32>> = list.iter().map(|number| number_of(number.get_ref())).collect();
            let numbers = numbers.and_then(|numbers| <[f32; 3]>::try_from(numbers).ok());
            numbers.map(|numbers| Value::Triple(Vec3::from(numbers)))
        }
        _ => None,
    };
    let fits = read.filter(|read| property.kind.holds(read));
    fits.map_or_else(
        || wrong(&value.span(), format!("{} of {subject}: expected {}", property.name, property.kind.expected())),
        Ok,
    )
}

/// By its digits, so that none is lost on the way. -0 is 0: the sign would turn what is drawn at random.
fn number_of(value: &DeValue) -> Option<f32> {
    let digits = match value {
        DeValue::Integer(number) if number.radix() == 10 => number.as_str(),
        DeValue::Float(number) => number.as_str(),
        _ => return None,
    };
    digits.parse().ok().filter(|number: &f32| number.is_finite()).map(|number| number + 0.0)
}

impl fmt::Display for Edits {
    /// An inline table, from which the same changes are read.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let variant = self.variant.iter().map(|name| format!("{VARIANT} = {}", quoted(name)));
        let subjects = self.iter().map(|(subject, values)| {
            let values: Vec<String> =
                values.iter().map(|(name, value)| format!("{name} = {}", text_of(value))).collect();
            format!("{} = {{ {} }}", key_of(subject), values.join(", "))
        });
        let parts: Vec<String> = variant.chain(subjects).collect();
        if parts.is_empty() { f.write_str("{}") } else { write!(f, "{{ {} }}", parts.join(", ")) }
    }
}

impl Edits {
    /// The tables of a file of their own, each change on a line.
    pub fn tables(&self) -> String {
        let mut text = String::from("[edit]\n");
        self.variant.iter().for_each(|name| _ = writeln!(text, "{VARIANT} = {}", quoted(name)));
        for (subject, values) in self.iter() {
            _ = writeln!(text, "\n[edit.{}]", key_of(subject));
            values.iter().for_each(|(name, value)| _ = writeln!(text, "{name} = {}", text_of(value)));
        }
        text
    }
}

/// The dotted key of a subject.
fn key_of(subject: &Subject) -> String {
    match subject {
        Subject::Material(name) => format!("material.{}", key(name)),
        Subject::Shape(name) => format!("shape.{}", key(name)),
        Subject::Light(name) => format!("light.{}", key(name)),
        Subject::Sun => "sun".into(),
        Subject::Sky => "sky".into(),
    }
}

/// A key of TOML, in quotes where it must be.
fn key(name: &str) -> String {
    let bare = !name.is_empty() && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-' || b == b'_');
    if bare { name.to_owned() } else { quoted(name) }
}

/// A value of TOML. Numbers have the fewest digits that come back as the same.
fn text_of(value: &Value) -> String {
    match value {
        Value::Number(number) => format!("{number:?}"),
        Value::Triple(v) => format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z),
        Value::Word(word) => quoted(word),
        Value::Flag(flag) => flag.to_string(),
    }
}

/// A text as a basic string of TOML, quotes with it.
pub fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' | '\\' => quoted.extend(['\\', letter]),
            control if control.is_control() => _ = write!(quoted, "\\u{:04X}", u32::from(control)),
            other => quoted.push(other),
        }
    }
    quoted + "\""
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Edits {
        text.parse().expect("changes")
    }

    fn fault(text: &str) -> String {
        text.parse::<Edits>().expect_err("no changes").to_string()
    }

    #[test]
    fn changes_are_read_as_they_were_written() {
        let text = "{ variant = \"a \\\"b\\\"\", material.glass = { colour = [0.1, 0.2, 1.0], ior = 1.4 }, \
                    shape.\"a/b c\" = { center = [1.0, -2.5, 1e-7], hidden = true }, sun = { elevation = 20.0 } }";
        let edits = read(text);
        assert_eq!(edits.to_string(), text);
        let [file, line] = [edits.tables(), format!("edit = {edits}")].map(|text| {
            let mut table = DeTable::parse(&text).map(Spanned::into_inner).expect("TOML");
            edits_of(table.remove("edit").expect("a table")).expect("changes")
        });
        assert_eq!((file, line), (edits.clone(), edits));
        assert_eq!(read("{}"), Edits::default());
        assert_eq!(Edits::default().to_string(), "{}");
    }

    #[test]
    fn dotted_keys_and_whole_numbers_are_read_too() {
        let long = read("{ material = { glass = { ior = 2.0 } } }");
        assert_eq!(read("{ material.glass.ior = 2 }"), long);
    }

    #[test]
    fn a_fault_says_what_was_expected() {
        assert!(fault("ior").starts_with("expected changes of a scene as {"));
        assert!(fault("{ material.glass.iro = 2 }").ends_with("did you mean ior?"));
        assert_eq!(fault("{ material.glass.ior = 0 }"), "ior of material 'glass': expected a number from 0.01 to 100");
        assert!(fault("{ material.glass.ior = nan }").contains("expected a number"));
        assert!(fault("{ shape.a.center = [1, 2] }").contains("expected a point"));
        assert!(fault("{ moon.radius = 1 }").contains("'moon' cannot be changed"));
        assert!(fault("{ sun = 3 }").contains("the sun: expected a table"));
    }
}
