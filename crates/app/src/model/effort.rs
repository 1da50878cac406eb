//! How a picture's seconds were spent.

use pathtrace::Stats;

/// How a picture's seconds were spent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Effort {
    /// On so many samples and rays.
    Traced(Stats),
    /// On the triangles of the fake.
    Drawn(Drawing),
}

/// What is known of the time that the fake took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drawing {
    /// Where the time is that its pipelines took.
    pub compiling: Compiling,
    /// Whether shadow map and cube maps were there from the picture before.
    pub kept_maps: bool,
    /// Whether it was drawn while nothing else was: else what else ran may have slowed it.
    pub at_rest: bool,
}

/// Where the time is that a device needs once for its pipelines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Compiling {
    /// In the picture's seconds: they say little about the next one.
    Included,
    /// Left out of them; so many seconds, once.
    Apart(f64),
}
