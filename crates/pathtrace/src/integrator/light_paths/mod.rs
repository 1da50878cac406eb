//! Light apart: which paths a picture counts, in the notation of Heckbert, "Adaptive Radiosity Textures for Bidirectional
//! Ray Tracing" (SIGGRAPH 1990). A path is written as light walks it: `L`, a light, then the surfaces that scatter it, `D`
//! (diffuse), `G` (glossy: rough metal) or `S` (specular: mirror or glass), and `E`, the eye. Regular expressions of these
//! letters say which paths count: `LDE` is light that one diffuse surface sends to the eye, `LS+DE` a caustic. Production
//! renderers call them light path expressions.
//!
//! Paths are walked from the eye, so an [`Automaton`] reads them backwards, a vertex at a time. What is drawn does not
//! depend on what counts: pictures of classes that have no path in common and leave out none add up to the whole
//! picture, sample by sample.
//!
//! Twin: `shaders/pathtrace/integrator/light_paths.wgsl`.

mod automaton;
mod counting;
mod expression;
#[cfg(test)]
mod tests;

pub use automaton::{ACCEPTS, Automaton, BEGINS, MOST_STATES};
pub use counting::{CountedPaths, Scattering, counts};
pub use expression::LightPathsError;

use expression::Expression;
use std::fmt;

/// Letters and signs that an expression may have.
pub const MOST_LETTERS: usize = 32;

/// Which light paths count, by a name or an expression. Kept as text: settings are copied.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct LightPaths {
    /// ASCII without spaces, and zeros.
    text: [u8; MOST_LETTERS],
}

/// What has a name, and what it stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Named {
    /// All light, by whatever path it comes.
    All,
    /// Light that is seen itself.
    Emitted,
    /// Ldir of the slides: light that comes straight from a light to the first surface that is not mirror or glass, and
    /// lights themselves; both seen straight or by mirrors and glass. What Whitted's method follows.
    Direct,
    /// Lindir of the slides: all but [`Named::Direct`].
    Indirect,
    /// What a limit of so many bounces shows beyond one bounce less; 0 is one scattering vertex.
    Bounce(u32),
    /// What a limit of so many bounces shows.
    UpTo(u32),
    /// What a limit of one bounce less does not show.
    From(u32),
}

impl Named {
    /// The most bounces that a name may have.
    pub const MOST_BOUNCES: u32 = 20;

    /// What a word names.
    pub fn parse(word: &str) -> Option<Self> {
        let bounces = |digits: &str| digits.parse().ok().filter(|bounces| *bounces <= Self::MOST_BOUNCES);
        Some(match word {
            "all" => Named::All,
            "emitted" => Named::Emitted,
            "direct" => Named::Direct,
            "indirect" => Named::Indirect,
            _ => match word.rsplit_once('-')? {
                ("bounce", digits) => Named::Bounce(bounces(digits)?),
                ("up-to", digits) => Named::UpTo(bounces(digits)?),
                ("from", digits) => Named::From(bounces(digits)?),
                _ => return None,
            },
        })
    }

    /// Whether a word begins as those do that have a number.
    fn counts_bounces(word: &str) -> bool {
        ["bounce-", "up-to-", "from-"].iter().any(|begin| word.starts_with(begin))
    }

    /// The same as an expression.
    pub fn expression(self) -> String {
        let vertices = |bounces: u32, each: &str| each.repeat(bounces as usize + 1);
        match self {
            Named::All => "L.*E".into(),
            Named::Emitted => "LE".into(),
            Named::Direct => "L[DG]?S*E".into(),
            Named::Indirect => "L.+[DG]S*E".into(),
            Named::Bounce(bounces) => format!("L{}E", vertices(bounces, ".")),
            Named::UpTo(bounces) => format!("L{}E", vertices(bounces, ".?")),
            Named::From(bounces) => format!("L{}+E", vertices(bounces, ".")),
        }
    }
}

impl fmt::Display for Named {
    /// As it is read back.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Named::All => f.write_str("all"),
            Named::Emitted => f.write_str("emitted"),
            Named::Direct => f.write_str("direct"),
            Named::Indirect => f.write_str("indirect"),
            Named::Bounce(bounces) => write!(f, "bounce-{bounces}"),
            Named::UpTo(bounces) => write!(f, "up-to-{bounces}"),
            Named::From(bounces) => write!(f, "from-{bounces}"),
        }
    }
}

impl LightPaths {
    /// All light, by whatever path it comes.
    pub const ALL: Self = {
        let mut text = [0; MOST_LETTERS];
        (text[0], text[1], text[2]) = (b'a', b'l', b'l');
        LightPaths { text }
    };

    /// The paths of this name or expression. Spaces between letters are of no account.
    ///
    /// # Errors
    /// What is wrong, and in which column.
    pub fn parse(text: &str) -> Result<Self, LightPathsError> {
        let named = Named::parse(text.trim());
        let kept = match named {
            Some(named) => named.to_string(),
            None => Self::written(text)?,
        };
        let mut paths = LightPaths { text: [0; MOST_LETTERS] };
        paths.text[..kept.len()].copy_from_slice(kept.as_bytes());
        Ok(paths)
    }

    /// An expression that says something, without its spaces.
    fn written(text: &str) -> Result<String, LightPathsError> {
        if Named::counts_bounces(text.trim()) {
            return Err(LightPathsError::NoBounces);
        }
        let written: String = text.chars().filter(|letter| *letter != ' ').collect();
        // before it is read: its groups are read one in another
        if written.len() > MOST_LETTERS {
            return Err(LightPathsError::TooLong);
        }
        Automaton::new(&Expression::parse(text)?)?;
        Ok(written)
    }

    /// Whether every path counts.
    pub fn is_all(&self) -> bool {
        *self == Self::ALL
    }

    /// The name, if it is one.
    pub fn named(&self) -> Option<Named> {
        Named::parse(self.as_str())
    }

    /// As it is read back.
    pub fn as_str(&self) -> &str {
        let len = self.text.iter().position(|byte| *byte == 0).unwrap_or(MOST_LETTERS);
        // letters are ASCII
        std::str::from_utf8(&self.text[..len]).unwrap_or_default()
    }

    /// What reads paths and tells which count; `None` where all do.
    pub(crate) fn automaton(&self) -> Option<Automaton> {
        if self.is_all() {
            return None;
        }
        let expression = self.named().map_or_else(|| self.as_str().to_owned(), Named::expression);
        // it was read before
        Expression::parse(&expression).and_then(|expression| Automaton::new(&expression)).ok()
    }
}

/// The rows of the states as a shader reads them; zeros where all paths count.
pub(crate) fn rows(paths: &LightPaths) -> [[u32; 4]; MOST_STATES / 4] {
    let rows = paths.automaton().map_or([0; MOST_STATES], |automaton| automaton.rows);
    std::array::from_fn(|four| std::array::from_fn(|row| rows[4 * four + row]))
}

impl From<Named> for LightPaths {
    fn from(named: Named) -> Self {
        LightPaths::parse(&named.to_string()).unwrap_or_default()
    }
}

impl Default for LightPaths {
    fn default() -> Self {
        Self::ALL
    }
}

impl fmt::Display for LightPaths {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

impl fmt::Debug for LightPaths {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "LightPaths({})", self.as_str())
    }
}
