//! Folders that are the user's own.

use crate::ImageFileError;
use std::ffi::OsString;
use std::path::PathBuf;

/// The user's home folder, if there is one. A relative one would be another in every folder, and is none.
pub fn home_folder() -> Option<PathBuf> {
    std::env::home_dir().filter(|home| home.is_absolute() && home.is_dir())
}

/// Where pictures go unless the user says otherwise: the pictures folder of the home folder if there is one, else the
/// home folder, else the current one.
///
/// # Errors
/// If there is no current folder either.
pub fn default_folder() -> Result<PathBuf, ImageFileError> {
    match home_folder() {
        Some(home) => Ok(Some(home.join("Pictures")).filter(|p| p.is_dir()).unwrap_or(home)),
        None => std::env::current_dir().map_err(|e| ImageFileError::NoFolder(e.to_string())),
    }
}

/// Where the system has the user's caches: `$XDG_CACHE_HOME`, `%LOCALAPPDATA%`, or a folder in the home folder.
pub fn cache_folder() -> Option<PathBuf> {
    caches(|name| std::env::var_os(name), home_folder())
}

/// Where the system has what programs remember of their last run: `$XDG_STATE_HOME`, `%LOCALAPPDATA%`, or a folder in the
/// home folder.
pub fn state_folder() -> Option<PathBuf> {
    let in_home = if cfg!(target_os = "macos") { "Library/Application Support" } else { ".local/state" };
    own_folder(|name| std::env::var_os(name), "XDG_STATE_HOME", home_folder().map(|home| home.join(in_home)))
}

fn caches(variable: impl Fn(&str) -> Option<OsString>, home: Option<PathBuf>) -> Option<PathBuf> {
    let in_home = if cfg!(target_os = "macos") { "Library/Caches" } else { ".cache" };
    own_folder(variable, "XDG_CACHE_HOME", home.map(|home| home.join(in_home)))
}

/// A variable whose path is relative is ignored, as the XDG Base Directory Specification asks for.
fn own_folder(variable: impl Fn(&str) -> Option<OsString>, name: &str, usual: Option<PathBuf>) -> Option<PathBuf> {
    let folder = |name| variable(name).map(PathBuf::from).filter(|path| path.is_absolute());
    folder(name).or_else(|| folder("LOCALAPPDATA")).or(usual)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn caches_lie_where_an_absolute_variable_says_or_in_the_home_folder() {
        let at = |cache: &'static str| {
            let variable = move |name: &str| (name == "XDG_CACHE_HOME").then(|| OsString::from(cache));
            caches(variable, Some("/home/someone".into())).unwrap()
        };
        let in_home = caches(|_| None, Some("/home/someone".into())).unwrap();
        assert!(in_home.starts_with("/home/someone") && in_home != *"/home/someone");
        assert_eq!(at("/var/cache/mine"), PathBuf::from("/var/cache/mine"));
        assert_eq!([at(""), at("cache"), at("./cache")], [in_home.clone(), in_home.clone(), in_home]);
        assert_eq!(caches(|_| None, None), None);
    }
}
