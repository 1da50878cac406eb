//! Waits for what the user chooses in a file dialogue of the system's, so that the window does not.

use super::Wake;
use super::ask::Engine;
use super::worker::{Control, Service, Worker};
use crate::model::FilePurpose;
use std::future::Future;
use std::path::PathBuf;
use std::pin::Pin;
use std::sync::{Mutex, PoisonError};

/// The dialogue's answer to come; `None` where the user wants no file.
pub type Choice = Pin<Box<dyn Future<Output = Option<rfd::FileHandle>> + Send>>;

/// What the user has chosen.
#[derive(Debug)]
pub struct Answer {
    /// What it is for.
    pub purpose: FilePurpose,
    /// The file, or none; or one line on why there is no dialogue.
    pub chosen: Result<Option<PathBuf>, String>,
}

/// Waits for one dialogue at a time.
pub struct Dialogues {
    wake: Wake,
    open: Option<Worker<Job, Option<Answer>>>,
}

type Job = Option<(FilePurpose, Choice)>;

impl Dialogues {
    /// Calls `wake` whenever [`Dialogues::answer`] has something.
    pub fn new(wake: Wake) -> Self {
        Dialogues { wake, open: None }
    }

    /// Waits for this one; what comes of one before is not heard.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn wait_for(&mut self, purpose: FilePurpose, choice: Choice) -> std::io::Result<()> {
        let worker = Worker::start("dialogue", self.wake.clone(), || Patience)?;
        worker.post(|slot| *slot = Some((purpose, choice)));
        self.open.replace(worker).into_iter().for_each(Worker::leave);
        Ok(())
    }

    /// What was chosen since the last call.
    pub fn answer(&mut self) -> Option<Answer> {
        let answer = self.open.as_ref()?.collect().flatten()?;
        self.open.take().into_iter().for_each(Worker::leave);
        Some(answer)
    }
}

impl Drop for Dialogues {
    fn drop(&mut self) {
        // a window does not stay open until a file is chosen
        self.open.take().into_iter().for_each(Worker::leave);
    }
}

struct Patience;

impl Service for Patience {
    type Job = Job;
    type Update = Option<Answer>;

    fn serve(&mut self, job: Self::Job, control: &Control<Self::Job, Self::Update>) {
        let Some((purpose, choice)) = job else { return };
        listen();
        let file = pollster::block_on(choice).map(|handle| handle.path().to_owned());
        let fault = heard().take().filter(|_| file.is_none());
        let chosen = fault.map_or(Ok(file), |why| Err(refusal(&why)));
        control.tell(|slot| *slot = Some(Answer { purpose, chosen }));
    }

    fn recover(&mut self, _control: &Control<Self::Job, Self::Update>) {}
}

/// On Linux the last that rfd tries is zenity, and of that alone it tells.
fn refusal(why: &str) -> String {
    let why = if cfg!(target_os = "linux") { "neither a desktop portal nor zenity answers" } else { why };
    format!("there is no file dialogue here ({why}): type the file's name into the field")
}

/// rfd gives no file both where the user wants none and where there is no dialogue; why, it tells the log alone.
static HEARD: Mutex<Option<String>> = Mutex::new(None);

fn heard() -> std::sync::MutexGuard<'static, Option<String>> {
    HEARD.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Hears what rfd says that failed.
struct Ear;

impl log::Log for Ear {
    fn enabled(&self, about: &log::Metadata) -> bool {
        about.target().starts_with("rfd")
    }

    fn log(&self, record: &log::Record) {
        if self.enabled(record.metadata()) {
            *heard() = Some(image_file::escaped(&record.args().to_string()));
        }
    }

    fn flush(&self) {}
}

/// From now on; the second time it listens already.
fn listen() {
    *heard() = None;
    if log::set_logger(&Ear).is_ok() {
        log::set_max_level(log::LevelFilter::Error);
    }
}

impl Engine {
    /// Waits for the user's choice of a file.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn wait_for_file(&mut self, purpose: FilePurpose, choice: Choice) -> std::io::Result<()> {
        self.dialogues.wait_for(purpose, choice)
    }

    /// The file that was chosen since the last call.
    pub fn chosen_file(&mut self) -> Option<Answer> {
        self.dialogues.answer()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::time::{Duration, Instant};

    fn answer_to(choice: Choice) -> Result<Option<PathBuf>, String> {
        let mut dialogues = Dialogues::new(Arc::new(|| {}));
        dialogues.wait_for(FilePurpose::Open, choice).expect("a thread");
        let start = Instant::now();
        loop {
            if let Some(answer) = dialogues.answer() {
                return answer.chosen;
            }
            assert!(start.elapsed() < Duration::from_secs(60), "waited a minute");
            std::thread::yield_now();
        }
    }

    #[test]
    fn no_file_and_no_dialogue_are_told_apart() {
        assert_eq!(answer_to(Box::pin(async { None })), Ok(None));
        let fault = answer_to(Box::pin(async {
            log::error!(target: "rfd::backend", "no portal");
            None
        }));
        let said = fault.expect_err("there is no dialogue");
        assert!(said.contains("portal") && said.ends_with("type the file's name into the field"), "{said}");
        assert_eq!(answer_to(Box::pin(async { None })), Ok(None), "the fault before is over");
    }
}
