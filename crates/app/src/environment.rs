//! Environment variables that libraries stumble over. They are only set for a process that begins: in one that runs,
//! other threads may read them.

#[cfg(all(unix, not(target_vendor = "apple")))]
use std::os::unix::fs::MetadataExt;
#[cfg(all(unix, not(target_vendor = "apple")))]
use std::path::{Path, PathBuf};

/// What stands for a folder that is not there, as it does for the home of nobody.
#[cfg(all(unix, not(target_vendor = "apple")))]
const NO_FOLDER: &str = "/nonexistent";

/// Where systemd keeps the runtime folders of users, each under a user's number.
#[cfg(all(unix, not(target_vendor = "apple")))]
const RUNTIME_FOLDERS: &str = "/run/user";

/// Begins the program again where its environment makes libraries complain. Mesa's Vulkan layer that orders devices
/// asks libwayland for a display, which prints an "error" if `XDG_RUNTIME_DIR` is no absolute path, and nothing if there
/// is no display in it. The folder that is set for it instead is the one in which zbus looks for the session's bus, and so
/// for screen readers, if none is set.
pub fn settle() {
    #[cfg(all(unix, not(target_vendor = "apple")))]
    if std::env::var_os("XDG_RUNTIME_DIR").is_none_or(|folder| !Path::new(&folder).is_absolute()) {
        let own = user().and_then(|user| runtime_folder(Path::new(RUNTIME_FOLDERS), user));
        // what does not begin again goes on
        let _ = begin_again_with("XDG_RUNTIME_DIR", own.as_deref().unwrap_or(Path::new(NO_FOLDER)));
    }
}

/// The number of the user who runs this, which std tells of files alone.
#[cfg(all(unix, not(target_vendor = "apple")))]
fn user() -> Option<u32> {
    std::fs::metadata("/proc/self").ok().map(|process| process.uid())
}

/// The runtime folder of a user, if it is there and nobody else's.
#[cfg(all(unix, not(target_vendor = "apple")))]
fn runtime_folder(all: &Path, user: u32) -> Option<PathBuf> {
    let folder = all.join(user.to_string());
    std::fs::metadata(&folder).is_ok_and(|found| found.is_dir() && found.uid() == user).then_some(folder)
}

/// Begins the program again as the same process, with a variable. Returns only to say why it could not.
#[cfg(unix)]
pub fn begin_again_with(variable: &str, value: impl AsRef<std::ffi::OsStr>) -> std::io::Error {
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

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn a_runtime_folder_is_taken_if_it_is_the_users_own() {
        let folder = visavis_tests::TestFolder::new();
        let all = folder.path();
        let me = user().expect("a user");
        assert_eq!(all.metadata().map(|made| made.uid()).ok(), Some(me), "what a user makes is theirs");
        assert_eq!(runtime_folder(all, me), None, "it is not there");
        for user in [me, me + 1] {
            std::fs::create_dir(folder.file(&user.to_string())).expect("a folder");
        }
        assert_eq!(runtime_folder(all, me), Some(folder.file(&me.to_string())));
        assert_eq!(runtime_folder(all, me + 1), None, "it is another user's");
        std::fs::write(folder.file("7"), "").expect("a file");
        assert_eq!(runtime_folder(all, 7), None, "it is no folder");
    }
}
