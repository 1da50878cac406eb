//! How long a bench still takes: what was forecast of the rest, times how wrong forecasts were so far.

use std::time::Instant;

/// What a bench is doing.
#[derive(Debug)]
pub struct Progress<'a> {
    /// At this.
    pub what: &'a str,
    /// Share of all work that is done, from 0 to 1.
    pub done: f64,
    /// Seconds that the rest takes.
    pub seconds_left: f64,
}

/// Work ahead and behind, in seconds of the forecast.
pub struct Clock {
    start: Instant,
    ahead: f64,
    behind: f64,
}

impl Clock {
    /// Begins with so many forecast seconds ahead.
    pub fn new(ahead: f64) -> Self {
        Clock { start: Instant::now(), ahead, behind: 0.0 }
    }

    /// So many forecast seconds of the work are done.
    pub fn done(&mut self, forecast: f64) {
        self.behind += forecast;
        self.ahead = (self.ahead - forecast).max(0.0);
    }

    /// So many forecast seconds of the work were done before.
    pub fn skip(&mut self, forecast: f64) {
        self.ahead = (self.ahead - forecast).max(0.0);
    }

    /// What to tell while `begun` forecast seconds are done beside those of [`Clock::done`].
    pub fn progress<'a>(&self, what: &'a str, begun: f64) -> Progress<'a> {
        let (behind, ahead) = (self.behind + begun, (self.ahead - begun).max(0.0));
        let wrong = if behind > 0.0 { self.start.elapsed().as_secs_f64() / behind } else { 1.0 };
        let all = behind + ahead;
        Progress { what, done: if all > 0.0 { behind / all } else { 1.0 }, seconds_left: ahead * wrong }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_is_what_is_not_done() {
        let mut clock = Clock::new(40.0);
        assert_eq!((clock.progress("a", 0.0).done, clock.progress("a", 0.0).seconds_left), (0.0, 40.0));
        clock.done(10.0);
        let progress = clock.progress("b", 20.0);
        assert!((progress.done - 0.75).abs() < 1e-12 && progress.seconds_left < 1.0);
        clock.skip(15.0);
        assert!((clock.progress("b", 10.0).done - 0.8).abs() < 1e-12);
        clock.done(15.0);
        assert_eq!(clock.progress("c", 0.0).seconds_left, 0.0);
    }
}
