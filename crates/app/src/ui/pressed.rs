//! Keys that went down, as whoever hears them counts them, and lines of the help that say what they do.

use egui::{Context, Event, Key, Modifiers};

/// A line of the help: what one does, and what that does.
pub type HelpLine = (&'static str, &'static str);

/// The keys that went down since the last frame.
pub struct Keys<'a>(&'a Context);

impl<'a> Keys<'a> {
    /// Those of this frame.
    pub fn of(context: &'a Context) -> Self {
        Keys(context)
    }

    /// How often a key went down alone.
    pub fn presses(&self, key: Key) -> usize {
        self.presses_with(key, Modifiers::NONE)
    }

    /// How often a key went down with just these modifiers. Two presses within one slow frame are two; a key that is
    /// held is one.
    pub fn presses_with(&self, wanted: Key, with: Modifiers) -> usize {
        let is_wanted = |event: &&Event| match event {
            Event::Key { key, pressed: true, repeat: false, modifiers, .. } => {
                *key == wanted && modifiers.matches_exact(with)
            }
            _ => false,
        };
        self.0.input(|i| i.events.iter().filter(is_wanted).count())
    }

    /// Whether a key went down, with whatever modifiers its place on the keyboard asks for.
    pub fn is_pressed(&self, key: Key) -> bool {
        self.0.input(|i| i.key_pressed(key))
    }

    /// How often a key went down with Ctrl, or Command.
    pub fn command(&self, key: Key) -> usize {
        self.presses_with(key, Modifiers::COMMAND)
    }
}
