//! Regular expressions of light paths, read into their positions: which letters may stand first, last and before each
//! other. Glushkov, "The abstract theory of automata" (1961).

use super::MOST_LETTERS;

/// The light at which a path begins.
pub const L: u8 = 1;
/// A vertex at a surface that reflects to all sides alike.
pub const D: u8 = 1 << 1;
/// A vertex at rough metal, which reflects about one direction.
pub const G: u8 = 1 << 2;
/// A mirror or glass.
pub const S: u8 = 1 << 3;
/// The eye at which a path ends.
pub const E: u8 = 1 << 4;

/// An expression that says nothing about paths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LightPathsError {
    /// Something else than a letter or a group.
    #[error(
        "column {0}: expected L, D, G, S, E, a point for any surface, [ or (; a path goes from the light L to the eye E, \
         as LDE or LS+DE does"
    )]
    NoLetter(usize),
    /// What stands in brackets.
    #[error("column {0}: expected one or more of D, G and S and then ]")]
    NoSet(usize),
    /// A group without its end.
    #[error("column {0}: this ( has no )")]
    Open(usize),
    /// An end without its group.
    #[error("column {0}: this ) has no (")]
    Closed(usize),
    /// No path is like that.
    #[error(
        "no path is like that: each goes from the light L to the eye E, which stand nowhere else, as in LDE or LS+DE"
    )]
    Nothing,
    /// More than fits in a setting.
    #[error("an expression has at most {MOST_LETTERS} letters and signs")]
    TooLong,
    /// A number of bounces that no name has.
    #[error("K in bounce-K, up-to-K and from-K is a number from 0 to {}", super::Named::MOST_BOUNCES)]
    NoBounces,
    /// More states than there is room for.
    #[error("this takes more than {} states to read: say less at once", super::MOST_STATES - 1)]
    TooManyStates,
}

/// A set of positions, a bit each.
pub type Positions = u32;

/// An expression by its positions: each is one letter of it, or a set of letters.
#[derive(Debug, Default)]
pub struct Expression {
    /// Letters that each position takes.
    pub letters: Vec<u8>,
    /// Positions that may stand right before each.
    pub before: Vec<Positions>,
    /// Those at which a path that it describes may begin.
    pub first: Positions,
    /// Those at which a path that it describes may end.
    pub last: Positions,
}

/// What a part of an expression may begin and end with.
#[derive(Clone, Copy)]
struct Part {
    nullable: bool,
    first: Positions,
    last: Positions,
}

/// What is still to be read.
struct Reader<'t> {
    text: &'t [u8],
    at: usize,
    read: Expression,
}

impl Expression {
    /// Reads a whole expression.
    ///
    /// # Errors
    /// What is wrong, and in which column.
    pub fn parse(text: &str) -> Result<Self, LightPathsError> {
        let mut reader = Reader { text: text.as_bytes(), at: 0, read: Expression::default() };
        let whole = reader.alternatives()?;
        if reader.peek().is_some() {
            return Err(LightPathsError::Closed(reader.column()));
        }
        Ok(Expression { first: whole.first, last: whole.last, ..reader.read })
    }
}

impl Part {
    fn or(self, other: Part) -> Part {
        Part {
            nullable: self.nullable || other.nullable,
            first: self.first | other.first,
            last: self.last | other.last,
        }
    }

    fn then(self, next: Part) -> Part {
        Part {
            nullable: self.nullable && next.nullable,
            first: self.first | if self.nullable { next.first } else { 0 },
            last: next.last | if next.nullable { self.last } else { 0 },
        }
    }
}

impl Reader<'_> {
    /// The next character that is no space.
    fn peek(&mut self) -> Option<u8> {
        while self.text.get(self.at) == Some(&b' ') {
            self.at += 1;
        }
        self.text.get(self.at).copied()
    }

    /// Goes on behind this character, if it comes next.
    fn take(&mut self, wanted: u8) -> bool {
        let found = self.peek() == Some(wanted);
        self.at += usize::from(found);
        found
    }

    /// Of what comes next, counted from 1 in characters.
    fn column(&mut self) -> usize {
        self.peek();
        1 + self.text[..self.at].iter().filter(|byte| **byte & 0xc0 != 0x80).count()
    }

    fn alternatives(&mut self) -> Result<Part, LightPathsError> {
        let mut part = self.sequence()?;
        while self.take(b'|') {
            part = part.or(self.sequence()?);
        }
        Ok(part)
    }

    fn sequence(&mut self) -> Result<Part, LightPathsError> {
        let mut part = self.repeated()?;
        while !matches!(self.peek(), None | Some(b'|' | b')')) {
            let next = self.repeated()?;
            self.may_follow(part, next);
            part = part.then(next);
        }
        Ok(part)
    }

    fn repeated(&mut self) -> Result<Part, LightPathsError> {
        let mut part = self.atom()?;
        while let Some(sign @ (b'*' | b'+' | b'?')) = self.peek() {
            self.at += 1;
            if sign != b'?' {
                self.may_follow(part, part);
            }
            part.nullable |= sign != b'+';
        }
        Ok(part)
    }

    fn atom(&mut self) -> Result<Part, LightPathsError> {
        let column = self.column();
        if self.take(b'(') {
            let part = self.alternatives()?;
            return if self.take(b')') { Ok(part) } else { Err(LightPathsError::Open(column)) };
        }
        let letters =
            if self.take(b'[') { self.set()? } else { self.letter().ok_or(LightPathsError::NoLetter(column))? };
        self.position(letters)
    }

    /// One letter, or any surface.
    fn letter(&mut self) -> Option<u8> {
        let letter = match self.peek()? {
            b'L' => L,
            b'E' => E,
            b'.' => D | G | S,
            other => surface(other)?,
        };
        self.at += 1;
        Some(letter)
    }

    /// What stands in brackets, and their end.
    fn set(&mut self) -> Result<u8, LightPathsError> {
        let mut letters = 0;
        while let Some(letter) = self.peek().and_then(surface) {
            letters |= letter;
            self.at += 1;
        }
        if letters != 0 && self.take(b']') { Ok(letters) } else { Err(LightPathsError::NoSet(self.column())) }
    }

    fn position(&mut self, letters: u8) -> Result<Part, LightPathsError> {
        let position = self.read.letters.len();
        if position == MOST_LETTERS {
            return Err(LightPathsError::TooLong);
        }
        self.read.letters.push(letters);
        self.read.before.push(0);
        Ok(Part { nullable: false, first: 1 << position, last: 1 << position })
    }

    fn may_follow(&mut self, part: Part, next: Part) {
        for (position, before) in self.read.before.iter_mut().enumerate() {
            if next.first >> position & 1 != 0 {
                *before |= part.last;
            }
        }
    }
}

fn surface(letter: u8) -> Option<u8> {
    match letter {
        b'D' => Some(D),
        b'G' => Some(G),
        b'S' => Some(S),
        _ => None,
    }
}
