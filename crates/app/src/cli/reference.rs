//! `visavis reference`: references made, fetched and thrown away; and how other commands come by one.

use super::{ReferenceArgs, interrupt, trees};
use crate::ruler::{brief, counted};
use anyhow::Context;
use pathtrace::FEWEST_REPLICATES;
use reference::{Goal, Key, Maker, Reference, Store};
use std::cell::Cell;
use std::io::IsTerminal;
use std::sync::Arc;
use std::time::{Duration, Instant};
use technique::{Renderer, Shot, Threads};

pub fn run(args: &ReferenceArgs) -> anyhow::Result<()> {
    match args {
        ReferenceArgs::Usage => {
            let store = Store::of_the_user()?;
            let usage = store.usage()?;
            let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
            super::print(&format!(
                "folder  {}\ncount   {}\nsize    {:.1} MiB\nlimit   {:.0} MiB (VISAVIS_CACHE_MIB)\n",
                image_file::shown(store.folder()),
                usage.count,
                mib(usage.bytes),
                mib(store.most_bytes())
            ))
        }
        ReferenceArgs::Clear => {
            let store = Store::of_the_user()?;
            let gone = store.clear()?;
            super::print(&format!("removed {} references from {}\n", gone.count, image_file::shown(store.folder())))
        }
        ReferenceArgs::Make { scene, out, seen, goal } => {
            let shot = seen.of(scene)?;
            image_file::check_writable(out)?;
            let _heeded = interrupt::heed();
            let reference = obtain(&shot, Some(*goal))?;
            image_file::write_or_keep(out, &reference.encode(::reference::records(&shot))?)?;
            note!(
                "reference of {} at {}x{}: {}: {}",
                scene,
                seen.size.0,
                seen.size.1,
                course(&reference),
                image_file::shown(out)
            );
            let made = reference.replicates;
            anyhow::ensure!(!interrupt::is_asked(), "{made} pictures are saved: {}", image_file::shown(out));
            Ok(())
        }
    }
}

/// How far a reference has come.
pub(super) fn course(reference: &Reference) -> String {
    let noise = reference.rel_mse().map_or_else(|| "unknown".into(), brief);
    format!("{} pictures, noise (relMSE) {noise}, {:.1} s", reference.replicates, reference.seconds)
}

/// The reference of what is seen. One from the store is taken as it is, unless there is a goal that it does not meet;
/// what is made here is kept there. A store that cannot be used is told and does no harm.
///
/// One that is interrupted is returned as it is, and kept if there is enough of it.
///
/// # Errors
/// If there is no memory for it, or if it was interrupted before it could tell its noise.
pub fn obtain(shot: &Shot, goal: Option<Goal>) -> anyhow::Result<Reference> {
    let key = Key::of(shot);
    let store = Store::of_the_user().map_err(|fault| note!("note: {fault}")).ok();
    let fetched = store.as_ref().map_or(Ok(None), |store| store.fetch(key));
    let kept = fetched.map_err(|fault| note!("note: {fault}")).ok().flatten();
    if let (Some(kept), None) = (&kept, goal) {
        return Ok(kept.clone());
    }
    let goal = goal.unwrap_or_default();
    let told = Cell::new(false);
    let keep = |reference: &Reference| {
        if let Some(Err(fault)) = store.as_ref().map(|store| store.put(key, reference, ::reference::records(shot)))
            && !told.replace(true)
        {
            note!("note: {fault}");
        }
    };
    let made = make(shot, &goal, kept.as_ref(), keep)?;
    anyhow::ensure!(made.replicates > 1, "there is no second picture yet by which a reference tells its noise");
    if made.replicates >= FEWEST_REPLICATES && kept.is_none_or(|kept| kept.replicates < made.replicates) {
        keep(&made);
    }
    Ok(made)
}

/// Makes a reference, or goes on with one, until it is good enough. Every doubling is handed to `keep`: hours of work
/// do not go with a power cut.
fn make(shot: &Shot, goal: &Goal, begun: Option<&Reference>, keep: impl Fn(&Reference)) -> anyhow::Result<Reference> {
    let trees = trees::of(&shot.scene)?;
    let mut renderer = Renderer::on_the_processor(shot.scene.clone(), Arc::new(Threads::all()));
    drop(trees);
    let (width, height) = shot.size;
    let mut maker = Maker::new(&mut renderer, shot, begun)
        .with_context(|| format!("not enough memory for {width}x{height} pixels; ask for a smaller --size"))?;
    let progress = Progress::of(maker.progress(goal));
    let _heeded = interrupt::heed();
    let mut next_kept = (2 * FEWEST_REPLICATES).max(2 * maker.replicates());
    while !maker.is_done(goal) && maker.step(&interrupt::is_asked) {
        progress.show(&maker, goal);
        if maker.replicates() >= next_kept && !maker.is_done(goal) {
            next_kept *= 2;
            keep(&maker.reference());
        }
    }
    progress.finish();
    Ok(maker.reference())
}

/// A line on stderr that says how long it takes, where someone can see it.
struct Progress {
    shown: bool,
    start: Instant,
    /// What was done before the start, from 0 to 1.
    before: f64,
}

impl Progress {
    fn of(before: f64) -> Self {
        Progress { shown: std::io::stderr().is_terminal(), start: Instant::now(), before }
    }

    fn show(&self, maker: &Maker, goal: &Goal) {
        if self.shown {
            let left = time_left(self.before, maker.progress(goal), self.start.elapsed());
            let left = left.map_or_else(String::new, |left| format!(", about {:.0} s left", left.as_secs_f64()));
            let made = counted(maker.replicates() as usize, "picture");
            crate::console::to_stderr(format_args!("\r\x1b[Kreference: {made}, {:.1} s{left} ", maker.seconds()));
        }
    }

    fn finish(&self) {
        if self.shown {
            crate::console::to_stderr(format_args!("\r\x1b[K"));
        }
    }
}

/// At the speed so far; `None` as long as nothing is done.
fn time_left(before: f64, now: f64, elapsed: Duration) -> Option<Duration> {
    let per_share = elapsed.as_secs_f64() / (now - before);
    Duration::try_from_secs_f64((1.0 - now) * per_share).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_takes_as_long_as_what_is_done_took() {
        let left = |before, now| time_left(before, now, Duration::from_secs(10));
        assert_eq!(left(0.0, 0.5), Some(Duration::from_secs(10)));
        assert_eq!(left(0.5, 0.75), Some(Duration::from_secs(10)));
        assert_eq!(left(0.5, 0.5), None);
    }
}
