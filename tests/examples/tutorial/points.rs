//! What a point of the tutorial is, and how it is seen that it is shown. Names of widgets are those of `--ui-dump`.

use visavis_tests::Frame;

/// Something that a hand does.
pub enum Step {
    /// Clicks on a widget.
    Click(&'static str),
    /// Presses a key of a letter or digit.
    Key(char),
    /// Types into the number of a widget, and Enter.
    Type(&'static str, &'static str),
    /// Drags the line of the wipe to a share of the picture's width, or of its height where the line is horizontal.
    Wipe(f32),
    /// Drags the picture a little.
    Orbit,
}

/// A way to show a point.
pub struct Way {
    pub name: &'static str,
    pub steps: &'static [Step],
}

/// What is seen when a point is shown.
#[derive(Debug)]
pub enum Sign {
    /// The scene of this name is open.
    Scene(&'static str),
    /// The view of this name is shown.
    View(&'static str),
    /// A pane ("a", "b") whose technique's label has these words, in any case.
    Label(&'static str, &'static str),
    /// A pane with so many samples per pixel at least.
    Samples(&'static str, u64),
    /// A widget with this value.
    Value(&'static str, &'static str),
    /// The map of errors.
    Map,
    /// A picture of what was set last, of B: nothing else on the screen tells it from the one before.
    Newest,
}

impl Sign {
    /// Whether a frame has it.
    pub fn is_in(&self, frame: &Frame) -> bool {
        match *self {
            Sign::Scene(name) => frame.state("scene") == name,
            Sign::View(name) => frame.state("view") == name,
            Sign::Label(pane, words) => {
                let label = frame.state(pane)["label"].as_str().unwrap_or_default().to_lowercase();
                label.contains(words)
            }
            Sign::Samples(pane, least) => frame.state(pane)["spp"].as_u64() >= Some(least),
            Sign::Value(name, value) => frame.value(name) == value,
            Sign::Newest => frame.state("latency_ms").is_number(),
            Sign::Map => frame.state("map").is_string(),
        }
    }
}

/// A point of the tutorial.
pub struct Point {
    /// Task and title of its slide.
    pub name: &'static str,
    /// The first that can be gone is taken.
    pub ways: &'static [Way],
    pub shows: &'static [Sign],
}

impl Point {
    /// Its name without what a file's may not have.
    pub fn file_name(&self) -> String {
        self.name.chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect()
    }
}
