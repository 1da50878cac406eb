//! How a file in one folder names a file in another, so that both can be moved together.

use std::path::{Component, Path, PathBuf};

/// A file as a folder finds it, also after both were moved; its whole path where they have nothing in common.
pub fn file_from(folder: &Path, file: &Path) -> PathBuf {
    let file = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    // through a link the folder above may be another
    let near = relative(folder, &file).filter(|near| is_same_place(&folder.join(near), &file));
    near.map_or(file, PathBuf::from)
}

/// Whether two names stand for one file. It need not be there yet: then the nearest folder decides that is.
fn is_same_place(a: &Path, b: &Path) -> bool {
    if a.exists() || b.exists() {
        return image_file::is_same_file(a, b);
    }
    let name = |path: &Path| path.file_name().map(ToOwned::to_owned);
    let folders = a.parent().zip(b.parent()).filter(|_| name(a).is_some() && name(a) == name(b));
    folders.is_some_and(|(a, b)| is_same_place(a, b))
}

/// Without `folder/..`, where that is no way through a link: each time that a session is saved elsewhere it would grow.
pub fn without_detours(path: &Path) -> PathBuf {
    let mut short = PathBuf::new();
    for part in path.components() {
        let is_below_a_name = matches!(short.components().next_back(), Some(Component::Normal(_)));
        match part {
            Component::ParentDir if is_below_a_name => drop(short.pop()),
            part => short.push(part),
        }
    }
    if is_same_place(&short, path) { short } else { path.to_owned() }
}

/// The way from a folder to a file, by names that both systems' paths read; `None` where they meet in the root alone, or where
/// names have no text.
fn relative(folder: &Path, file: &Path) -> Option<String> {
    let (from, to): (Vec<_>, Vec<_>) = (folder.components().collect(), file.components().collect());
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let has_a_name = from[..shared].iter().any(|part| matches!(part, Component::Normal(_)));
    let up = from[shared..].iter().map(|_| "..".to_owned());
    let down = to[shared..].iter().map(|part| part.as_os_str().to_str().map(str::to_owned));
    let way: Option<Vec<_>> = up.map(Some).chain(down).collect();
    way.filter(|_| has_a_name).map(|way| way.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_leads_up_and_down_where_there_is_one() {
        let way = |from: &str, to: &str| relative(Path::new(from), Path::new(to));
        assert_eq!(way("/a/b", "/a/b/c.toml").as_deref(), Some("c.toml"));
        assert_eq!(way("/a/b/c", "/a/d/e.toml").as_deref(), Some("../../d/e.toml"));
        assert_eq!(way("/a", "/b/c.toml"), None, "nothing in common");
    }
}
