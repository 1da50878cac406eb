//! What a beginner is told beside the TOML parser's own words: what was probably meant, and how that is written.

mod names;
mod numbers;
mod place;
mod types;

pub(super) use names::{unknown_material, unknown_mesh};

use super::Fault;
use place::Place;
use std::ops::Range;

/// The values of a text of TOML, with advice where they are others than expected.
pub(super) fn from_toml<T: serde::de::DeserializeOwned>(text: &str) -> Result<T, Fault> {
    toml::from_str(text).map_err(|fault| {
        let at = fault.span().unwrap_or(0..0);
        let message = fault.message().lines().collect::<Vec<_>>().join(", ");
        Fault { message: advised(text, at.clone(), message), at }
    })
}

/// The parser's message about this place of the text, with the cure if the mistake is a usual one.
fn advised(text: &str, at: Range<usize>, message: String) -> String {
    let place = Place { text, at };
    if let Some(line) = place.single_brackets(&message) {
        return line;
    }
    let cure = names::unknown_field(&place, &message)
        .or_else(|| place.double_brackets(&message))
        .or_else(|| place.syntax(&message))
        .or_else(|| place.wrong_number(&message))
        .or_else(|| place.wrong_type(&message))
        .or_else(|| place.stated_twice(&message))
        .or_else(|| place.missing_field(&message));
    cure.map_or(message.clone(), |cure| format!("{message}; {cure}"))
}

/// The parser's words where it was led astray by a value that is not written in TOML's way.
const ASTRAY: [&str; 6] = [
    "unexpected key or value",
    "extra comma in inline table",
    "invalid literal string",
    "key with no value",
    "missing assignment",
    "string values must be quoted",
];

/// Names whose value is a word.
const WORDS: [&str; 6] = ["material", "metal", "image", "file", "name", "of"];

impl Place<'_> {
    /// A value that is not written in TOML's way.
    fn syntax(&self, message: &str) -> Option<String> {
        if !ASTRAY.iter().any(|words| message.starts_with(words)) {
            return None;
        }
        self.colon()
            .or_else(|| self.curly_quotes())
            .or_else(|| self.parentheses())
            .or_else(|| self.list_without_brackets())
            .or_else(|| self.decimal_comma())
            .or_else(|| self.value_without_quotes().filter(|_| message.starts_with("string values must be quoted")))
    }

    /// A number that is out of its range, or of no form.
    fn wrong_number(&self, message: &str) -> Option<String> {
        self.decimal_comma_in_a_list(message)
            .or_else(|| self.screen_colour(message))
            .or_else(|| numbers::number_in_quotes(message))
            .or_else(|| self.bare_point(message))
    }

    /// "radius: 1" for "radius = 1".
    fn colon(&self) -> Option<String> {
        let (before, rest) = (self.before().trim_end(), self.rest_of_line());
        let (before, value) = match (before.strip_suffix(':'), rest.strip_prefix(':')) {
            (Some(before), _) => (before, rest),
            (None, Some(value)) => (before, value),
            (None, None) => return None,
        };
        let word = |c: char| c.is_alphanumeric() || c == '_';
        let key = before.trim_end().trim_end_matches('"').rsplit(|c| !word(c)).next().filter(|key| !key.is_empty())?;
        let value = Some(place::value(value)).filter(|value| !value.is_empty())?;
        Some(format!("a value stands behind =, not behind a colon: write {key} = {value}"))
    }

    fn curly_quotes(&self) -> Option<String> {
        let curly = ['“', '”', '„', '‘', '’', '«', '»'];
        let word = self.rest_of_line().strip_prefix(curly)?;
        Some(format!("quotes are straight: write \"{}\"", word.split(curly).next()?))
    }

    /// (0, 1, 0) or vec3(0, 1, 0) for [0, 1, 0].
    fn parentheses(&self) -> Option<String> {
        let (_, value) = self.assignment().filter(|(key, _)| !WORDS.contains(key))?;
        let of_here = |text: &'_ str| {
            let (name, inside) = text.split_once('(')?;
            let is_name = name.chars().all(|c| c.is_alphanumeric() || c == '_');
            is_name.then(|| inside.split([')', '#', '\n']).next().unwrap_or_default().to_owned())
        };
        let inside = of_here(self.rest_of_line()).or_else(|| of_here(value))?;
        let words: Vec<&str> = inside.split(',').map(str::trim).filter(|word| !word.is_empty()).collect();
        match words[..] {
            [] => None,
            [word] => Some(format!("a value stands without parentheses: write {word}")),
            _ => Some(format!("a list stands in square brackets: [{}]", words.join(", "))),
        }
    }

    /// What stands where a value is expected, and is neither a number nor in quotes.
    fn value_without_quotes(&self) -> Option<String> {
        let written = self.rest_of_line();
        if written.contains("//") || written.contains("/*") {
            return Some("a remark begins with #".into());
        }
        let value = written.split([',', ']', '}', '#']).next().unwrap_or_default().trim();
        let ended = || value.strip_suffix(';').map(|value| format!("a value ends with its line: write {value}"));
        self.numbers_with_spaces(value)
            .or_else(ended)
            .or_else(|| numbers::no_number(value))
            .or_else(|| self.word(value))
    }

    /// A word, where one is expected.
    fn word(&self, value: &str) -> Option<String> {
        let lower = value.to_lowercase();
        match (self.assignment()?.0, lower.as_str()) {
            (_, "true" | "false") => Some(format!("write {lower}")),
            ("two_sided", "yes" | "on") => Some("write true".into()),
            ("two_sided", "no" | "off") => Some("write false".into()),
            (key, _) if WORDS.contains(&key) => Some(format!("write \"{value}\"")),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests;
