//! Which files a scene may name: those in its own folder, or in folders of that. A scene that was sent by somebody reads
//! nothing else, unless the user of the program allows it.

use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

static ALLOWS_OUTSIDE: AtomicBool = AtomicBool::new(false);

/// Lets the scenes that this program reads from now on name any file.
pub fn allow_files_outside() {
    ALLOWS_OUTSIDE.store(true, Ordering::Relaxed);
}

/// Whether scenes may name any file.
pub fn allows_files_outside() -> bool {
    ALLOWS_OUTSIDE.load(Ordering::Relaxed)
}

/// The file of this name beside a scene or a model in `folder`.
///
/// # Errors
/// In words, if the name, or a link on the way, leads out of the folder and nobody has allowed that.
pub(crate) fn beside(folder: &Path, name: &str) -> Result<PathBuf, String> {
    let path = folder.join(name);
    if allows_files_outside() || (is_inside(Path::new(name)) && stays_inside(&path, folder)) {
        return Ok(path);
    }
    Err(format!(
        "'{}' lies outside of the scene's folder: put the file itself beside the scene, or allow it with --allow-outside",
        image_file::escaped(name)
    ))
}

/// Whether a path has no root and goes up no farther than it has gone down.
pub(crate) fn is_inside(path: &Path) -> bool {
    let depth = path.components().try_fold(0usize, |depth, part| match part {
        Component::Normal(_) => Some(depth + 1),
        Component::CurDir => Some(depth),
        Component::ParentDir => depth.checked_sub(1),
        Component::RootDir | Component::Prefix(_) => None,
    });
    depth.is_some()
}

/// Whether a file lies in the folder, links followed; one that is not there does.
fn stays_inside(path: &Path, folder: &Path) -> bool {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    match (path.canonicalize(), folder.canonicalize()) {
        (Ok(real), Ok(folder)) => real.starts_with(folder),
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_that_stay_in_the_folder_are_taken() {
        let folder = Path::new("scenes");
        for inside in ["a.ply", "models/a.ply", "./a.ply", "models/../a.ply"] {
            assert_eq!(beside(folder, inside), Ok(folder.join(inside)), "{inside}");
        }
        for outside in ["../a.ply", "models/../../a.ply", "/a.ply", "/etc/passwd"] {
            let said = beside(folder, outside).expect_err(outside);
            assert!(said.contains("outside of the scene's folder") && said.contains("--allow-outside"), "{said}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_that_lead_out_of_the_folder_are_not_followed() {
        let outer = std::env::temp_dir().join(format!("visavis-beside-{}", std::process::id()));
        let folder = outer.join("scene");
        std::fs::create_dir_all(folder.join("models")).unwrap();
        std::fs::write(outer.join("secret.ply"), "").unwrap();
        std::fs::write(folder.join("models/a.ply"), "").unwrap();
        for (to, name) in [("../secret.ply", "out.ply"), ("..", "up"), ("models/a.ply", "in.ply")] {
            std::os::unix::fs::symlink(to, folder.join(name)).unwrap();
        }
        let refused = ["out.ply", "up/secret.ply", "in.ply"].map(|name| beside(&folder, name).is_err());
        std::fs::remove_dir_all(&outer).unwrap();
        assert_eq!(refused, [true, true, false]);
    }
}
