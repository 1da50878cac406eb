//! Scenes, pictures and references as they come from disk: opened, chosen, read again, remembered.

use super::Viewer;
use super::judge::Judge;
use crate::engine::changed_scene::SceneToSave;
use crate::engine::dialogue::{Answer, Choice};
use crate::engine::export::{Content, Export};
use crate::engine::load::{Loaded, Opened, Refusal};
use crate::engine::memory::{Memo, Memory};
use crate::engine::session::SessionToSave;
use crate::engine::watch::{News, Reread, Watched};
use crate::model::{Destination, ExportRequest, FilePurpose, Remembered, SavedSession, WindowPlace};
use crate::ui::UiCommand;
use image_file::shown;
use scene::{FileRead, builtin};
use std::path::{Path, PathBuf};

impl Viewer {
    /// Begins with what was remembered, and remembers from now on.
    pub fn remember(&mut self, remembered: Remembered, memory: Option<Memory>) {
        (self.model.state.remembered, self.memory) = (remembered, memory);
    }

    /// Remembers the window's size and place.
    pub fn remember_window(&mut self, place: WindowPlace) {
        self.note(Memo::Window(place));
    }

    fn note(&mut self, memo: Memo) {
        memo.clone().note_in(&mut self.model.state.remembered);
        self.memory.iter().for_each(|memory| memory.note(memo.clone()));
    }

    /// What is open, for the window's title: "whitted", "scene.toml (folder)".
    pub fn title(&self) -> String {
        let source = &self.model.document.source;
        let path = std::path::absolute(source).unwrap_or_else(|_| PathBuf::from(source));
        let name = |path: &Path| path.file_name().map(|name| shown(Path::new(name)));
        match (builtin::text(source), name(&path), path.parent().and_then(name)) {
            (None, Some(file), Some(folder)) => format!("{file} ({folder})"),
            _ => source.clone(),
        }
    }

    /// Goes on with the scene that the model was begun with.
    pub fn begin_with(&mut self, opened: Opened) {
        let Opened { asked, files, reference, notes, .. } = opened;
        self.follow_the_file(&asked, files);
        // who opens the window has said all of them on stderr
        self.model.say_notes(&notes);
        self.judge = reference.map(|reference| Judge::of_its_scene(reference, &self.model, notes));
    }

    /// Says what of the scene is probably not meant, what does not fit over the pictures on stderr.
    pub(super) fn tell(&mut self, notes: &[String]) {
        self.model.say_notes(notes).iter().for_each(|line| note!("note: {line}"));
    }

    /// Follows the files of the scene that is open, and remembers what opened it.
    fn follow_the_file(&mut self, asked: &str, files: Vec<FileRead>) {
        self.model.state.scene_fault = None;
        self.model.state.neighbours.clear();
        self.watch(files, false);
        if builtin::text(asked).is_none()
            && let Ok(file) = std::path::absolute(asked)
        {
            self.note(Memo::Opened(file));
        }
    }

    /// Takes down what is of another scene where undo, or a case, has brought this one, and reads its file again.
    pub(super) fn follow_the_scene(&mut self) {
        if std::mem::replace(&mut self.opened, self.model.document.opened) != self.model.document.opened {
            self.presentation.clear();
            self.model.state.scene_fault = None;
            self.model.state.neighbours.clear();
            self.watch(Vec::new(), true);
        }
    }

    fn watch(&self, files: Vec<FileRead>, at_once: bool) {
        let document = &self.model.document;
        let is_file = builtin::text(&document.source).is_none();
        let watched = Watched { opened: document.opened, path: PathBuf::from(&document.source), files, at_once };
        self.engine.watch(is_file.then_some(watched));
    }

    /// Reads the scene's file again, changed or not.
    pub(super) fn read_again(&mut self) {
        let source = self.model.document.source.clone();
        if builtin::text(&source).is_some() {
            return self.model.say(Ok(format!("{source} is built in: there is no file to read again")));
        }
        self.asked_again = true;
        self.watch(Vec::new(), true);
    }

    /// Takes what was read, chosen or found on disk since the last frame.
    pub(super) fn collect_files(&mut self) {
        match self.engine.loaded(&mut self.model.state.loading) {
            Some(Ok(Loaded::Scene(opened))) => self.open(*opened),
            Some(Ok(Loaded::Reference(reference))) => self.judge = Some(Judge::alone(reference)),
            Some(Err(refusal)) => self.refuse(refusal),
            None => {}
        }
        let News { reread, folder } = self.engine.news();
        if let Some(scenes) = folder {
            self.model.state.neighbours = scenes;
        }
        if let Some(reread) = reread.filter(|reread| reread.opened == self.model.document.opened) {
            self.show_again(reread);
        }
        if let Some(answer) = self.engine.chosen_file() {
            self.take_file(answer);
        }
    }

    /// Gives up the scene that is being read; the one that is open stays.
    pub(super) fn stop_loading(&mut self) {
        if self.engine.stop_loading() && self.model.state.loading.take().is_some() {
            self.model.say(Ok("Reading was stopped".into()));
        }
    }

    fn open(&mut self, opened: Opened) {
        if self.is_seen(&opened) {
            return self.judge = opened.reference.map(Judge::alone);
        }
        let Opened { asked, source, scene, files, setup, session, reference, notes } = opened;
        let what = match (&setup, &session) {
            (Some(_), _) => format!("{} as {} shows it", scene.name, shown(Path::new(&asked))),
            (None, Some(_)) => format!("the session {} of {}", shown(Path::new(&asked)), scene.name),
            (None, None) => scene.name.clone(),
        };
        let slide = self.model.state.awaited_slide.filter(|slide| slide.scene == source);
        self.model.open(scene, source);
        let seen = match session {
            Some(session) => self.model.restore(&session, &setup.unwrap_or_default()),
            None => setup.map_or(Ok(()), |setup| self.model.set_up(&setup)),
        };
        match seen {
            Err(fault) => self.model.say(Err(fault)),
            // which has said what it is about
            Ok(()) if slide.is_some() => {}
            Ok(()) if notes.is_empty() => self.model.say(Ok(format!("Opened {what}"))),
            Ok(()) => self.tell(&notes),
        }
        self.presentation.clear();
        self.opened = self.model.document.opened;
        self.follow_the_file(&asked, files);
        self.judge = reference.map(|reference| Judge::of_its_scene(reference, &self.model, notes));
    }

    fn refuse(&mut self, refusal: Refusal) {
        let file = std::path::absolute(&refusal.asked).unwrap_or_default();
        let forgotten = refusal.missing && self.model.state.remembered.recent.contains(&file);
        if forgotten {
            self.note(Memo::Gone(file));
        }
        let aside = if forgotten { "; it is no longer among the files opened before" } else { "" };
        self.model.say(Err(format!("{}{aside}", refusal.line)));
    }

    /// The scene stays what it was where the file is faulty.
    fn show_again(&mut self, reread: Reread) {
        let asked = std::mem::take(&mut self.asked_again);
        let name = shown(Path::new(&self.model.document.source));
        match reread.scene {
            Ok(scene) => {
                self.model.state.scene_fault = None;
                let notes = scene.notes();
                let lost = self.model.reread(scene);
                let aside = if lost.is_some() { "" } else { ": nothing has changed" };
                let said = format!("Read {name} again{aside}");
                let is_told = asked || lost.is_some();
                let notes = [lost.unwrap_or_default(), notes].concat();
                match (is_told, notes.is_empty()) {
                    (true, true) => self.model.say(Ok(said)),
                    (true, false) => self.tell(&[vec![said], notes].concat()),
                    (false, _) => {}
                }
            }
            // what was said before does not stand before it
            Err(fault) => (self.model.state.scene_fault, self.model.state.message) = (Some(fault), None),
        }
    }

    /// Keeps all that makes what is seen.
    pub(super) fn export_session(&self, to: Destination) {
        self.engine.export(Export { content: Content::Session(Box::new(self.session())), records: Vec::new(), to });
    }

    /// Keeps what is changed in the scene as a scene of its own.
    pub(super) fn export_scene(&mut self, to: Destination) {
        let document = &self.model.document;
        let camera = Some(document.camera).filter(|camera| *camera != document.scene.camera);
        let edits = match document.changes.as_edits(&document.scene) {
            Ok(edits) => edits,
            Err(why) => return self.model.say(Err(why.to_string())),
        };
        if edits.is_empty() && camera.is_none() {
            let name = &document.scene.name;
            return self.model.say(Err(format!("nothing is changed in {name}: there is no changed scene to save")));
        }
        let scene = SceneToSave { edits, camera, source: document.source.clone() };
        self.engine.export(Export { content: Content::Scene(Box::new(scene)), records: Vec::new(), to });
    }

    /// What makes all of it again.
    pub(super) fn session(&self) -> SessionToSave {
        let document = &self.model.document;
        SessionToSave {
            session: SavedSession::of(&self.model, self.model.state.window),
            scene: document.scene.clone(),
            source: document.source.clone(),
        }
    }

    /// Waits for a file that the user chooses in this dialogue.
    pub fn wait_for_file(&mut self, purpose: FilePurpose, choice: Choice) {
        if let Err(why) = self.engine.wait_for_file(purpose, choice) {
            self.model.state.choosing_file = false;
            self.model.say(Err(format!("no thread for a file dialogue ({why})")));
        }
    }

    fn take_file(&mut self, answer: Answer) {
        self.model.state.choosing_file = false;
        match (answer.chosen, answer.purpose) {
            (Ok(None), _) => {}
            (Ok(Some(file)), FilePurpose::Open) => self.commands.push(UiCommand::Open(file.display().to_string())),
            (Ok(Some(file)), FilePurpose::Reference) => self.commands.push(UiCommand::LoadReference(file)),
            (Ok(Some(file)), FilePurpose::Follow(pane)) => {
                self.model.follow(pane, &file).unwrap_or_else(|fault| self.model.say(Err(fault)));
            }
            (Ok(Some(file)), FilePurpose::Export(subject)) => {
                let to = Destination::File(file);
                self.commands.push(UiCommand::Export(ExportRequest { subject, to }));
            }
            (Err(why), _) => self.model.say(Err(why)),
        }
    }
}
