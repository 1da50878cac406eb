//! What one comparison of measured with expected says.

use std::fmt;
use technique::Device;

/// How measured and expected must lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Relation {
    /// No farther apart than the tolerance.
    Equal,
    /// Measured no larger than expected, which is a bound.
    AtMost,
}

impl Relation {
    /// "expected" or "at most".
    pub fn name(self) -> &'static str {
        match self {
            Relation::Equal => "expected",
            Relation::AtMost => "at most",
        }
    }
}

/// What came of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// As it must be.
    Pass,
    /// Not as it must be.
    Fail,
    /// Nothing is demanded; good to know.
    Information,
}

impl Verdict {
    /// "pass", "fail" or "information".
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Pass => "pass",
            Verdict::Fail => "fail",
            Verdict::Information => "information",
        }
    }
}

/// One comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Number of the case, from 1.
    pub case: u32,
    /// Where it ran.
    pub device: Device,
    /// Technique and estimator, like "path mis" or "whitted"; or the part that was asked by itself, like "fresnel".
    pub subject: String,
    /// What was measured.
    pub quantity: String,
    /// The closed form, or the bound.
    pub expected: f64,
    /// What the renderer says.
    pub measured: f64,
    /// How measured and expected must lie.
    pub relation: Relation,
    /// Largest difference that passes; four standard errors for Monte Carlo.
    pub tolerance: f64,
    /// Monte Carlo: standard error of `measured`, relative to `expected`, and the largest that has power.
    pub power: Option<(f64, f64)>,
    /// What came of it.
    pub verdict: Verdict,
}

impl fmt::Display for Row {
    /// One line: what, measured, expected, allowed, verdict.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "{:>2} {:<12} {:<44} {:<15.9} {} {:<15.9} +- {:<9.2e} {}",
            self.case,
            self.subject,
            self.quantity,
            self.measured,
            self.relation.name(),
            self.expected,
            self.tolerance,
            self.verdict.name()
        )?;
        match self.power {
            Some((reached, wanted)) if reached > wanted => write!(f, " (no power: {reached:.1e} > {wanted:.1e})"),
            _ => Ok(()),
        }
    }
}
