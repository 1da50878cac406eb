//! What the program says on stderr, from the command line and from the window.

/// A line on stderr, in the manner of `eprintln!` but without its panic where stderr is full or closed, and one line
/// whatever the names in it.
macro_rules! note {
    ($($text:tt)*) => {
        $crate::console::to_stderr(format_args!("{}\n", image_file::escaped(&format!($($text)*))))
    };
}

/// Writes to stderr; there is nobody to tell if that fails.
pub fn to_stderr(text: std::fmt::Arguments) {
    use std::io::Write;
    let _ = std::io::stderr().lock().write_fmt(text);
}
