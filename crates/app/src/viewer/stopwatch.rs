//! How long the user waits: from the start to the first pictures, from a change to its first picture.

use std::time::{Duration, Instant};

/// Times of one window.
pub struct Stopwatch {
    started: Instant,
    first_pictures: Option<Duration>,
    /// The newest job of what is traced and when it was asked for, until its first picture is shown.
    waiting: Option<(u64, Instant)>,
    latency: Option<Duration>,
    /// The newest job of which a picture has come.
    received: u64,
    frames: u64,
}

impl Stopwatch {
    /// Starts at the start of the program.
    pub fn new(started: Instant) -> Self {
        Stopwatch { started, first_pictures: None, waiting: None, latency: None, received: 0, frames: 0 }
    }

    /// A new truth is asked for.
    pub fn asked(&mut self, job: u64) {
        self.waiting = Some((job, Instant::now()));
        self.latency = None;
    }

    /// A picture of a job has come.
    pub fn received(&mut self, job: u64) {
        self.received = job;
    }

    /// A frame is on the screen, with a picture on both sides or not.
    pub fn shown(&mut self, both: bool) {
        self.frames += 1;
        if both {
            self.first_pictures.get_or_insert_with(|| self.started.elapsed());
        }
        if let Some((_, since)) = self.waiting.take_if(|(job, _)| *job <= self.received) {
            self.latency = Some(since.elapsed());
        }
    }

    /// From the start to the first frame with both pictures.
    pub fn first_pictures(&self) -> Option<Duration> {
        self.first_pictures
    }

    /// From the last change to the first frame with a picture of it; `None` while that is waited for.
    pub fn latency(&self) -> Option<Duration> {
        self.latency
    }

    /// Frames shown.
    pub fn frames(&self) -> u64 {
        self.frames
    }
}
