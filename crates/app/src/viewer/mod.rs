//! Model, workspaces, engine and what they have brought as one: what happens in a frame, whoever has a window for it. The
//! real one is `window`; tests drive it without any.

mod cases;
mod effects;
mod external;
mod files;
mod judge;
mod ladder;
mod objects;
mod plots;
mod presentation;
mod probe;
mod report;
mod stopwatch;
mod sweep;
mod trees;

pub use presentation::{Place, TextureStore};

use crate::engine::Picture;
use crate::engine::ask::Engine;
use crate::engine::capture::Capture;
use crate::engine::effects::Effects;
use crate::engine::export::{Content, Export};
use crate::engine::load::Asked;
use crate::engine::memory::Memory;
use crate::engine::post_process::PaneUpdate;
use crate::model::{Destination, Drawing, Effort, ExportSubject, LADDER, Model, PaneId, PaneView, TREES};
use crate::ui::{self, Dump, UiCommand, UiContext, Workspaces};
use gpu::Gpu;
use judge::Judge;
use ladder::MadeLadder;
use presentation::Presentation;
use serde_json::{Value, json};
use std::time::{Duration, Instant};
use stopwatch::Stopwatch;
use sweep::MadeSweep;

/// A viewer without its window.
pub struct Viewer {
    /// All that the user can change.
    pub model: Model,
    workspaces: Workspaces,
    engine: Engine,
    presentation: Presentation,
    stopwatch: Stopwatch,
    /// The last frame's widgets.
    dump: Dump,
    commands: Vec<UiCommand>,
    /// What the next window is to know; `None` if nobody remembers.
    memory: Option<Memory>,
    /// The scene whose pictures are shown, by [`crate::model::Document::opened`].
    opened: u64,
    /// Whether the user has asked to read the scene again.
    asked_again: bool,
    /// A picture to compare with, until it is known how large what is seen is.
    judge: Option<Judge>,
    /// The tiles of the sweep that is looked at.
    sweep: MadeSweep,
    /// Finds which effects of light make what.
    effects: Effects,
    /// The rungs of the ladder that is looked at.
    ladder: MadeLadder,
}

impl Viewer {
    /// A viewer at its first frame; `started` is when the program was.
    pub fn new(model: Model, workspaces: Workspaces, engine: Engine, started: Instant) -> Self {
        Viewer {
            opened: model.document.opened,
            model,
            workspaces,
            engine,
            presentation: Presentation::default(),
            stopwatch: Stopwatch::new(started),
            dump: Dump::default(),
            commands: Vec::new(),
            memory: None,
            asked_again: false,
            judge: None,
            sweep: MadeSweep::default(),
            effects: Effects::default(),
            ladder: MadeLadder::default(),
        }
    }

    /// Takes what the workers have finished.
    pub fn collect(&mut self, textures: &mut impl TextureStore) {
        let updates = self.engine.collect().unwrap_or_default();
        for (pane, update) in updates.iter() {
            if let PaneUpdate::Picture(frame) = update {
                self.stopwatch.received(frame.picture.order.job);
                self.tell_of_refusal(pane, &frame.picture);
            }
        }
        self.presentation.update(updates, textures);
        self.presentation.update_waiting(self.engine.waiting());
        if let Some(drawn) = self.engine.error_map() {
            self.presentation.update_map(drawn, textures);
        }
        self.follow_the_reference();
        self.collect_sweep(textures);
        self.collect_ladder(textures);
        self.collect_trees(textures);
        self.collect_cases();
        self.collect_objects(textures);
        self.collect_effects();
        self.presentation.update_probe(self.engine.probes.collect());
        self.collect_files();
        for (pane, light) in self.engine.light.measured().iter() {
            self.presentation.shown.light.insert(pane, light.clone());
        }
        self.presentation.update_thumbnails(self.engine.thumbnails(), textures);
        self.engine.exported().into_iter().for_each(|outcome| self.model.say(outcome));
    }

    /// Says once that a pane's rays are not traced where they should be, or what another program did wrong.
    fn tell_of_refusal(&mut self, pane: PaneId, picture: &Picture) {
        let known = self.presentation.shown.panes.get(pane).and_then(|shown| shown.refused.as_ref());
        if let Some(why) = picture.refused.as_ref().filter(|why| known != Some(why)) {
            let who = if pane == PaneId::CASE { "The picture".to_owned() } else { pane.to_string() };
            self.model.say(Err(format!("{who} goes on on the CPU, the GPU failed: {why}. R tries it again")));
        }
        let known = self.presentation.shown.panes.get(pane).and_then(|shown| shown.external.as_ref()?.fault.as_ref());
        let fault = picture.external.as_ref().and_then(|external| external.fault.as_ref());
        if let Some(why) = fault.filter(|why| known != Some(why)) {
            self.model.say(Err(format!("{pane}: {why}")));
        }
    }

    fn follow_the_reference(&mut self) {
        let view = self.engine.view_of_the_reference();
        self.presentation.shown.reference.take_if(|progress| Some(progress.view) != view);
        let Some(update) = self.engine.update() else { return };
        self.presentation.shown.reference = update.progress.or_else(|| self.presentation.shown.reference.take());
        update.faults.into_iter().for_each(|fault| self.model.say(Err(fault)));
    }

    /// Draws everything and changes the model as the user wants; what else the user wants waits in
    /// [`Viewer::take_commands`].
    pub fn draw(&mut self, ui: &mut egui::Ui) {
        self.dump = Dump::default();
        let mut cx = UiContext {
            model: &mut self.model,
            shown: &self.presentation.shown,
            textures: &self.presentation.textures,
            dump: &mut self.dump,
            commands: &mut self.commands,
        };
        ui::show(&mut self.workspaces, &mut cx, ui);
    }

    /// What the user has asked for since the last call.
    pub fn take_commands(&mut self) -> Vec<UiCommand> {
        std::mem::take(&mut self.commands)
    }

    /// Does a command; those for a window are handed back.
    pub fn handle(&mut self, command: UiCommand) -> Option<UiCommand> {
        match command {
            UiCommand::Export(request) => match request.subject {
                ExportSubject::AsSeen => return Some(UiCommand::Export(request)),
                ExportSubject::Pane(pane) => self.export_pane(pane, request.to),
                ExportSubject::ErrorMap => self.export_map(request.to),
                ExportSubject::Plot(kind) => self.export_plot(kind, request.to),
                ExportSubject::Sweep(file) => self.export_sweep(file, request.to),
                ExportSubject::Ladder => self.export_ladder(request.to),
                ExportSubject::Samples => self.export_samples(request.to),
                ExportSubject::Session => self.export_session(request.to),
                ExportSubject::Scene => self.export_scene(request.to),
                ExportSubject::Report => self.export_report(request.to),
                ExportSubject::Slide(size) => self.export_slide(size, request.to),
            },
            UiCommand::Open(name) => {
                let recent = self.model.state.remembered.recent.clone();
                self.model.state.loading = None;
                self.engine.load(Asked::Open { name, recent });
            }
            UiCommand::StopLoading => self.stop_loading(),
            UiCommand::LoadReference(file) => self.engine.load(Asked::Reference(file)),
            UiCommand::ReadAgain => self.read_again(),
            UiCommand::DrawThumbnails(names) => self.engine.draw_thumbnails(names),
            UiCommand::Choose(_) | UiCommand::FullScreen | UiCommand::Quit => return Some(command),
        }
        None
    }

    fn export_pane(&mut self, pane: PaneId, to: Destination) {
        match self.presentation.pane(pane, &self.model) {
            Some((content, records)) => self.engine.export(Export { content, records, to }),
            None => self.model.say(Err(format!("{pane} has no whole picture yet; try again in a moment"))),
        }
    }

    fn export_map(&mut self, to: Destination) {
        match self.presentation.map(&self.model) {
            Some((content, records)) => self.engine.export(Export { content, records, to }),
            None => self.model.say(Err("there is no error map yet; try again in a moment".into())),
        }
    }

    /// Exports the picture area as it was drawn, line and labels included.
    pub fn export_as_seen(&mut self, capture: Capture, to: Destination) {
        if self.model.session.is_in(TREES) || self.model.session.is_in(LADDER) {
            let records = self.records_of_the_session();
            return self.engine.export(Export { content: Content::Seen(capture), records, to });
        }
        let mut records = self.presentation.records_of_all(&self.model);
        let magnification = self.model.state.magnification;
        records.extend((magnification.factor() > 1).then(|| ("magnified", magnification.record())));
        self.engine.export(Export { content: Content::Seen(capture), records, to });
    }

    /// Asks the engine for what is wanted now.
    pub fn ask(&mut self) {
        self.follow_the_scene();
        let judge = self.take_judge();
        let wanted = self.workspaces.open().wanted(&self.model);
        self.presentation.keep(&wanted);
        self.ask_effects(&wanted);
        self.engine.ask_cases(&wanted);
        self.engine.ask(&wanted).values().for_each(|job| self.stopwatch.asked(*job));
        judge.into_iter().for_each(|file| self.engine.load_reference(file));
    }

    /// A frame is on the screen.
    pub fn shown(&mut self) {
        let textures = &self.presentation.textures.panes;
        self.stopwatch.shown(self.model.session.panes.ids().all(|pane| textures.get(pane).is_some()));
    }

    /// Goes on with another device of the window, whose textures are lost.
    pub fn move_to(&mut self, gpu: &Gpu) {
        self.model.state.thumbnails = [false; 2];
        self.presentation.lose_textures();
        // it is climbed again, and counts anew
        self.ladder = MadeLadder::default();
        self.engine.move_to(gpu);
    }

    /// The last frame's widgets and the state behind them, for tests. `more` adds to the state.
    pub fn dump(&self, context: &egui::Context, pixels_per_point: f32, more: Value) -> String {
        let ready = |pane| self.presentation.textures.panes.get(pane).is_some();
        let shown = &self.presentation.shown;
        let pane = |id| dump_of(shown.panes.get(id).unwrap_or(&PaneView::default()), ready(id));
        let milliseconds = |time: Option<Duration>| time.map(|time| time.as_millis() as u64);
        let focused = context.memory(|m| m.focused());
        let Model { document, session, state, .. } = &self.model;
        let mut state = json!({
            "scene": document.scene.name,
            "view": session.view.name(),
            "line": session.line.name(),
            "wipe": session.wipe,
            "region": session.comparison.region.map(|region| [region.start, region.end]),
            "magnification": state.magnification.factor(),
            "flicker": state.flicker.map(|pane| pane.name()),
            "paused": state.paused,
            "sweep": self.sweep_dump(),
            "ladder": self.ladder_dump(),
            "trees": self.trees_dump(),
            "cases": self.cases_dump(),
            "objects": self.objects_dump(),
            "effects": self.effects_dump(),
            "theme": state.theme.name(),
            "picture_size": state.picture.size,
            "eye": document.camera.eye.to_array(),
            "fov": document.camera.fov_y,
            "message": state.message.as_ref().map(|m| &m.text),
            "scene_fault": state.scene_fault,
            "loading": state.loading,
            "title": self.title(),
            "neighbours": state.neighbours.len(),
            "focus_id": focused.map(|id| id.value()),
            "pressing": context.input(|i| i.pointer.any_down()),
            "typing": context.text_edit_focused(),
            "map": shown.map.as_ref().map(|map| &map.map.label),
            "reference": shown.reference.as_ref().map(|r| [r.pictures, u32::from(r.done)]),
            "a": pane(PaneId::A),
            "b": pane(PaneId::B),
            "frames": self.stopwatch.frames(),
            "latency_ms": milliseconds(self.stopwatch.latency()),
            "first_pictures_ms": milliseconds(self.stopwatch.first_pictures()),
        });
        if let (Some(state), Value::Object(more)) = (state.as_object_mut(), more) {
            state.extend(more);
        }
        self.dump.json(pixels_per_point, focused, state)
    }
}

fn dump_of(pane: &PaneView, ready: bool) -> Value {
    json!({
        "ready": ready,
        "label": pane.provenance.as_ref().filter(|_| pane.external.is_none()).map(|p| p.technique.label()),
        "external": pane.external.as_ref().map(|external| &external.name),
        "changes": pane.external.as_ref().map(|external| external.changes),
        "spp": pane.spp,
        "rough": pane.rough,
        "unfinished": pane.unfinished,
        "at_rest": matches!(pane.effort, Some(Effort::Drawn(Drawing { at_rest: true, .. }))),
        "nonfinite": pane.nonfinite,
        "earlier_views": pane.lag.map(|lag| [lag.samples, lag.seconds]),
        "rel_mse": pane.errors.map(|(_, e)| e.rel_mse),
        "fault": pane.fault,
        "adapter": pane.adapter.as_deref(),
        "device": pane.provenance.as_ref().map(|p| p.device.name()),
        "refused": pane.refused.as_deref(),
        "filter_fault": pane.filter_fault.as_deref(),
        "cut": pane.cut.as_deref(),
    })
}
