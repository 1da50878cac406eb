//! Speed against error: what each technique costs, how far off it is, and how that changes with samples and seconds;
//! numbers that hold, made by one command that anyone can repeat.
//!
//! A bench is a [`plan`]: parts (a scene under one sun), lines (a way to make a picture, see [`mod@line`]) and a ladder of
//! samples. Each part has a reference with an error of its own ([`references`]). Each [`measure::Measurement`] is five
//! pictures of independent seeds; it goes to the [`journal`] when it is finished, so that a bench that was interrupted
//! goes on where it was. [`summary`] makes medians, slopes, efficiencies and bias tests of them; tables, plots and one
//! page tell them.
//!
//! What is written, column by column: `docs/bench.md`.

mod clock;
pub mod device;
mod error;
mod host;
pub mod journal;
pub mod line;
pub mod measure;
mod page;
mod peer;
mod pictures;
pub mod plan;
mod plots;
pub mod references;
mod run;
mod speed;
pub mod summary;
mod tables;
pub mod variant;

pub use clock::Progress;
pub use error::BenchError;
pub use host::{Host, build_of_this_program, today};
pub use peer::{HEADER as PEER_HEADER, PeerRow};
pub use pictures::data_uri;
pub use run::{Options, Outcome, run};
