//! The trees of large meshes, which commands build before they trace anything.

use super::interrupt;
use anyhow::Context;
use scene::Scene;
use std::io::IsTerminal;
use technique::Trees;

/// Those of a scene, to be held until it is ready for rays; a line on stderr says how far they are, where someone sees it.
///
/// # Errors
/// If the user ends it before: nothing was traced yet.
pub fn of(scene: &Scene) -> anyhow::Result<Trees> {
    let shown = std::io::stderr().is_terminal();
    let _heeded = interrupt::heed();
    let trees = Trees::of(scene, &|trees| {
        if let Some(trees) = trees.filter(|_| shown) {
            crate::console::to_stderr(format_args!("\r\x1b[K{trees} "));
        }
        !interrupt::is_asked()
    });
    if shown {
        crate::console::to_stderr(format_args!("\r\x1b[K"));
    }
    trees.context("nothing was traced yet: the tree of a large mesh was not done")
}
