//! Environment variables that libraries stumble over. They are only set for a process that begins: in one that runs,
//! other threads may read them.

/// What stands for a folder that is not there, as it does for the home of nobody.
#[cfg(all(unix, not(target_vendor = "apple")))]
const NO_FOLDER: &str = "/nonexistent";

/// Begins the program again where its environment makes libraries complain. Mesa's Vulkan layer that orders devices
/// asks libwayland for a display, which prints an "error" if `XDG_RUNTIME_DIR` is no absolute path, and nothing if there
/// is no display in it.
pub fn settle() {
    #[cfg(all(unix, not(target_vendor = "apple")))]
    if std::env::var_os("XDG_RUNTIME_DIR").is_none_or(|folder| !std::path::Path::new(&folder).is_absolute()) {
        // what does not begin again goes on
        let _ = begin_again_with("XDG_RUNTIME_DIR", NO_FOLDER);
    }
}

/// Begins the program again as the same process, with a variable. Returns only to say why it could not.
#[cfg(unix)]
pub fn begin_again_with(variable: &str, value: &str) -> std::io::Error {
    use std::os::unix::process::CommandExt;
    let program = match std::env::current_exe() {
        Ok(program) => program,
        Err(why) => return why,
    };
    let mut arguments = std::env::args_os();
    let mut again = std::process::Command::new(program);
    if let Some(name) = arguments.next() {
        again.arg0(name);
    }
    again.args(arguments).env(variable, value).exec()
}
