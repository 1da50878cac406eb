//! How references are made beside the UI: from the store at once if they are there, else picture by picture. What was made is
//! kept: when it is good enough, after each doubling, and when something else is asked for or the window closes.

use pathtrace::FEWEST_REPLICATES;
use reference::{Goal, Key, Maker, Reference, Store, StoreError};
use std::sync::Arc;
use technique::{Rank, Renderer, Shot, Threads, Trees};

/// Where references are kept, looked up anew for each.
pub type OpenStore = Arc<dyn Fn() -> Result<Store, StoreError> + Send + Sync>;

/// Who waits for a reference.
pub trait ReferenceWatch: Sync {
    /// Whether to end after the picture in hand, or within it.
    fn ends_soon(&self) -> bool;

    /// Whether to wait where it is.
    fn is_held(&self) -> bool;

    /// Waits until it is held no more, or shall end soon.
    fn wait(&self);

    /// Is shown it as far as it is, and whether no more will come; `None` before there is anything.
    fn show(&self, reference: Option<&Reference>, done: bool);

    /// Hears what went wrong: one line.
    fn fail(&self, fault: String);
}

/// Makes one reference after the other.
pub struct ReferenceMaking {
    threads: Arc<Threads>,
    open_store: OpenStore,
    /// The scene of the last one, ready for rays.
    renderer: Option<Renderer>,
}

impl ReferenceMaking {
    /// On these threads, kept where `open_store` says.
    pub fn new(threads: Arc<Threads>, open_store: OpenStore) -> Self {
        ReferenceMaking { threads, open_store, renderer: None }
    }

    /// Keeps nothing of the last one, which a fault has ended.
    pub fn forget(&mut self) {
        self.renderer = None;
    }

    /// That of the store, if there is one, and where it is kept.
    pub fn fetch(&self, shot: &Shot, watch: &impl ReferenceWatch) -> (Option<Reference>, Option<Store>) {
        let store = (self.open_store)().map_err(|fault| watch.fail(fault.to_string())).ok();
        let fetched = store.as_ref().map_or(Ok(None), |store| store.fetch(Key::of(shot)));
        (fetched.map_err(|fault| watch.fail(fault.to_string())).ok().flatten(), store)
    }

    /// Makes the reference of what is seen until it is good enough or `watch` ends it.
    pub fn make(&mut self, shot: &Shot, watch: &impl ReferenceWatch) {
        let (kept, store) = self.fetch(shot, watch);
        watch.show(kept.as_ref(), false);
        // who waits holds no threads
        let Some(_trees) = Trees::of(&shot.scene, &|_| !watch.ends_soon()) else { return };
        let mut renderer = match self.renderer.take() {
            Some(renderer) if Arc::ptr_eq(renderer.scene(), &shot.scene) => renderer,
            _ => Renderer::on_the_processor(shot.scene.clone(), self.threads.clone()),
        };
        // pictures go first
        renderer.rank = Rank::Background;
        let mut keeper = Keeper { store, shot, kept: kept.as_ref().map_or(0, |kept| kept.replicates) };
        match Maker::new(&mut renderer, shot, kept.as_ref()) {
            Some(mut maker) => work(&mut maker, &Goal::default(), &mut keeper, watch),
            None => watch.fail("not enough memory for a reference; make the window smaller".into()),
        }
        self.renderer = Some(renderer);
    }
}

fn work(maker: &mut Maker, goal: &Goal, keeper: &mut Keeper, watch: &impl ReferenceWatch) {
    while !maker.is_done(goal) && !watch.ends_soon() {
        // who waits holds no threads
        watch.wait();
        if !maker.step(&|| watch.is_held() || watch.ends_soon()) {
            continue;
        }
        let reference = maker.reference();
        let done = maker.is_done(goal);
        watch.show(Some(&reference), done);
        if done || reference.replicates >= keeper.next() {
            keeper.keep(&reference).unwrap_or_else(|fault| watch.fail(fault));
        }
    }
    let reference = maker.reference();
    if maker.is_done(goal) {
        watch.show(Some(&reference), true);
    }
    keeper.keep(&reference).unwrap_or_else(|fault| watch.fail(fault));
}

/// Puts one reference into the store, now and then.
struct Keeper<'a> {
    store: Option<Store>,
    shot: &'a Shot,
    /// Pictures of the one that is in the store; 0 if there is none.
    kept: u32,
}

impl Keeper<'_> {
    /// How many pictures are worth keeping: a first time, and then each doubling.
    fn next(&self) -> u32 {
        FEWEST_REPLICATES.max(2 * self.kept)
    }

    /// Keeps it, if it has become finer and there are enough pictures to tell its noise.
    fn keep(&mut self, reference: &Reference) -> Result<(), String> {
        if reference.replicates < FEWEST_REPLICATES || reference.replicates <= self.kept {
            return Ok(());
        }
        // a store that failed once is not tried again: one line is enough
        let Some(store) = self.store.take() else { return Ok(()) };
        let key = Key::of(self.shot);
        store.put(key, reference, reference::records(self.shot)).map_err(|fault| fault.to_string())?;
        self.kept = reference.replicates;
        self.store = Some(store);
        Ok(())
    }
}
