//! Where a pane's picture comes from: made here, or by another program that is judged beside what is made here.

use super::{Model, PaneId, Session};
use image_file::{Kind, shown};
use std::fmt;
use std::path::{Path, PathBuf};

/// Where a pane's picture comes from.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum PaneSource {
    /// Made here, by the pane's technique.
    #[default]
    Made,
    /// Received from another program of this machine by the protocol of tev, on this port.
    Received(u16),
    /// A picture's file, which is read again whenever it changes.
    Followed(PathBuf),
}

/// The port on which tev listens, and to which renderers send unless they are told another.
pub const USUAL_PORT: u16 = 14158;

impl PaneSource {
    /// Reads "received", "received=14159" or "picture=mine.exr"; `None` of words that are none of these, which say how a
    /// picture is made here.
    ///
    /// # Errors
    /// What was expected in place of the port or the file.
    pub fn parse(words: &str) -> Option<Result<Self, String>> {
        let (name, value) = words.split_once('=').map_or((words, None), |(name, value)| (name, Some(value)));
        match (name.trim(), value) {
            (name, _) if name.starts_with("received,") => Some(Err(format!(
                "nothing is set of a picture that another program makes: expected received, or received=PORT as \
                 received={USUAL_PORT}"
            ))),
            ("received", None) => Some(Ok(PaneSource::Received(USUAL_PORT))),
            ("received", Some(port)) => Some(Self::received_on(port)),
            ("picture", Some(file)) => Some(Self::of_file(Path::new(file))),
            ("picture", None) => {
                Some(Err("expected picture=FILE, a picture that is read again whenever it changes".into()))
            }
            _ => None,
        }
    }

    fn received_on(port: &str) -> Result<Self, String> {
        let port = port.trim().parse().ok().filter(|port| *port > 0);
        port.map(PaneSource::Received).ok_or_else(|| format!("expected a port from 1 to 65535, {USUAL_PORT} is usual"))
    }

    /// A file that is followed, wherever the program goes on from; it need not be there yet.
    ///
    /// # Errors
    /// If its name is none of a picture.
    pub fn of_file(file: &Path) -> Result<Self, String> {
        if Kind::of(file).is_none() {
            return Err(format!("the name of a picture ends in .png or .exr: {}", shown(file)));
        }
        std::path::absolute(file).map(PaneSource::Followed).map_err(|why| format!("{}: {why}", shown(file)))
    }

    /// The word for it in the name of a file.
    pub fn word(&self) -> &'static str {
        match self {
            PaneSource::Made => "made",
            PaneSource::Received(_) => "received",
            PaneSource::Followed(_) => "picture",
        }
    }
}

/// "received on 127.0.0.1:14158", "read from /home/me/mine.exr".
impl fmt::Display for PaneSource {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            PaneSource::Made => f.write_str("made here"),
            PaneSource::Received(port) => write!(f, "received on 127.0.0.1:{port}"),
            PaneSource::Followed(file) => write!(f, "read from {}", shown(file)),
        }
    }
}

/// What is known of a picture that another program has made.
#[derive(Debug, Clone, PartialEq)]
pub struct External {
    /// What that program calls it, or its file's name.
    pub name: String,
    /// How it came here.
    pub source: PaneSource,
    /// How often it has changed since it was begun.
    pub changes: u64,
    /// What the file has that the picture does not show, a line each.
    pub notes: Vec<String>,
    /// What went wrong since: one line.
    pub fault: Option<String>,
}

/// More of a name says nothing on a label.
const LONGEST_TITLE: usize = 60;

impl External {
    /// Its name as a label has it: one line, not too long.
    pub fn title(&self) -> String {
        let name = image_file::escaped(self.name.trim());
        match name.char_indices().nth(LONGEST_TITLE) {
            Some((end, _)) => format!("{}...", &name[..end]),
            None if name.is_empty() => "a picture without a name".into(),
            None => name,
        }
    }

    /// "the picture of another program mine.exr, read from /home/me/mine.exr".
    pub fn told(&self) -> String {
        format!("the picture of another program {}, {}", image_file::escaped(&self.name), self.source)
    }
}

impl Session {
    /// Where a pane's picture comes from.
    pub fn source(&self, pane: PaneId) -> &PaneSource {
        self.sources.get(pane).unwrap_or(&PaneSource::Made)
    }

    /// Takes a pane's picture from elsewhere, or makes it here again.
    pub fn set_source(&mut self, pane: PaneId, source: PaneSource) {
        match source {
            PaneSource::Made => drop(self.sources.remove(pane)),
            source => drop(self.sources.insert(pane, source)),
        }
    }
}

impl Model {
    /// Shows another program's picture in a pane, and again whenever its file changes.
    ///
    /// # Errors
    /// If its name is none of a picture.
    pub fn follow(&mut self, pane: PaneId, file: &Path) -> Result<(), String> {
        let source = PaneSource::of_file(file)?;
        if let PaneSource::Followed(file) = &source {
            self.state.picture_files.insert(pane, file.display().to_string());
        }
        self.session.set_source(pane, source);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_name_a_port_or_a_file_and_all_others_are_left_to_techniques() {
        let port = |words| PaneSource::parse(words).map(|source| source.ok());
        assert_eq!(port("received"), Some(Some(PaneSource::Received(14158))));
        assert_eq!(port("received=9"), Some(Some(PaneSource::Received(9))));
        for words in ["path,spp=4", "raster", "photon-picture=points"] {
            assert_eq!(PaneSource::parse(words), None, "{words}");
        }
        for (words, said) in [
            ("received=0", "a port from 1 to 65535"),
            ("received=70000", "a port from 1 to 65535"),
            ("picture", "picture=FILE"),
            ("received,spp=4", "expected received, or received=PORT as received=14158"),
            ("received=14158,spp=4", "a port from 1 to 65535"),
            ("picture=mine.gif", "ends in .png or .exr: mine.gif"),
        ] {
            let fault = PaneSource::parse(words).expect("words of a source").expect_err(words);
            assert!(fault.contains(said), "{words}: {fault}");
        }
        let followed = PaneSource::parse("picture=a, b.exr").expect("a source").expect("a file");
        assert_eq!(followed, PaneSource::Followed(std::path::absolute("a, b.exr").expect("a folder")));
    }

    #[test]
    fn a_pane_that_is_made_here_again_is_as_one_that_always_was() {
        let mut session = Session::default();
        session.set_source(PaneId::B, PaneSource::Received(7));
        assert_eq!(
            (session.source(PaneId::A), session.source(PaneId::B)),
            (&PaneSource::Made, &PaneSource::Received(7))
        );
        session.set_source(PaneId::B, PaneSource::Made);
        assert_eq!(session, Session::default());
    }
}
