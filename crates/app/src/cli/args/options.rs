//! Tables of options: a row says what an option is called, what it does and how it is read. The parser knows no option that
//! is not in a table, and --help is made from the tables: it lists every one.

use super::help;
use super::seen::Seen;
use super::usage;
use super::values::{decimal_comma, text};
use crate::cli::CliError;
use lexopt::prelude::*;
use std::ffi::OsString;
use technique::settings::{OF_SCENES, Setting, all_of_panes, of_scenes};

/// An option of a command whose words are read into an `A`.
pub struct CommandOption<A> {
    /// As it is typed, all ways: "--help, -h".
    pub names: &'static [&'static str],
    /// What stands for its value in --help; empty for a switch.
    pub value: &'static str,
    /// What it does; empty for one that --help does not list.
    pub help: &'static str,
    /// Takes its value, if it has one, from the words that follow it.
    pub read: fn(&mut A, &mut lexopt::Parser) -> Result<(), CliError>,
}

/// What was typed after a command.
pub enum Typed<A> {
    /// Its options, read, and its other words.
    Words(A, Vec<OsString>),
    /// Only a text is asked for.
    Print(String),
}

/// Reads options of a table, those that `more` knows, and at most so many other words.
pub fn read<A>(
    mut parser: lexopt::Parser,
    mut args: A,
    options: &[CommandOption<A>],
    most_words: usize,
    more: fn(&mut A, &str, &mut lexopt::Parser) -> Result<bool, CliError>,
) -> Result<Typed<A>, CliError> {
    let mut words = Vec::new();
    while let Some(arg) = parser.next()? {
        let name = match arg {
            Value(word) if words.len() < most_words => {
                words.push(word);
                continue;
            }
            Long("help") => return Ok(Typed::Print(help::text())),
            Long(name) => format!("--{name}"),
            Short(letter) => format!("-{letter}"),
            other => return Err(other.unexpected().into()),
        };
        match options.iter().find(|option| option.names.contains(&name.as_str())) {
            Some(option) => (option.read)(&mut args, &mut parser)?,
            None if name.strip_prefix("--").map_or(Ok(false), |name| more(&mut args, name, &mut parser))? => {}
            None => return Err(unknown(&name, &mut args, options, more)),
        }
    }
    Ok(Typed::Words(args, words))
}

/// An option that is none, and the one that was probably meant.
fn unknown<A>(
    name: &str,
    args: &mut A,
    options: &[CommandOption<A>],
    more: fn(&mut A, &str, &mut lexopt::Parser) -> Result<bool, CliError>,
) -> CliError {
    let settings = all_of_panes().map(|row| row.name).chain(OF_SCENES.iter().map(|row| row.name));
    // without a word to read, a command that knows the name misses its value
    let mut takes = |name: &&str| more(args, name, &mut lexopt::Parser::from_args::<[OsString; 0]>([])).is_err();
    let settings: Vec<String> = settings.filter(&mut takes).map(|name| format!("--{name}")).collect();
    let listed = options.iter().filter(|option| !option.help.is_empty()).flat_map(|option| option.names);
    let known = listed.copied().chain(["--help"]).chain(settings.iter().map(String::as_str));
    match scene::nearest(name, known) {
        Some(near) => CliError::Usage(format!("invalid option '{name}': did you mean {near}?")),
        None => lexopt::Error::UnexpectedOption(name.to_owned()).into(),
    }
}

/// Where there are no more options than those of the table.
pub fn no_more<A>(_: &mut A, _: &str, _: &mut lexopt::Parser) -> Result<bool, CliError> {
    Ok(false)
}

/// Reads the value of a setting.
pub fn set<T>(setting: &Setting<T>, of: &mut T, parser: &mut lexopt::Parser) -> Result<(), CliError> {
    let word = text(parser)?;
    match setting.kind.parse(&word) {
        Ok(value) => (setting.set)(of, value),
        Err(expected) => {
            return usage(format!("--{} {word}: expected {expected}{}", setting.name, decimal_comma(&word)));
        }
    }
    Ok(())
}

/// Reads a change of the scene; `false` if the name is none's.
pub fn set_in_the_scene(seen: &mut Seen, name: &str, parser: &mut lexopt::Parser) -> Result<bool, CliError> {
    match of_scenes(name) {
        Some(setting) => set(setting, &mut seen.changes, parser).map(|()| true),
        None => Ok(false),
    }
}
