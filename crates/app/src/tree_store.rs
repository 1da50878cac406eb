//! Trees of large meshes on disk, one file each in the user's cache folder, beside the references; those not used for longest go
//! when there are too many. That none can be read or written is told once, and trees are built.

use image_file::{hold, shown, write_whole};
use pathtrace::intersect::mesh_kept::{self, Shelf};
use std::fs::{DirEntry, File};
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::Once;
use std::time::SystemTime;

/// Bytes of all trees at most unless `VISAVIS_TREES_MIB` says otherwise: those of 330 million triangles.
const MOST_BYTES: u64 = 4 << 30;

/// What the files' names end in.
const END: &str = "tree";

/// A folder of trees.
#[derive(Debug)]
pub struct TreeStore {
    folder: PathBuf,
    most_bytes: u64,
    told: Once,
}

/// Keeps trees in the user's cache from now on: `trees` in `$VISAVIS_CACHE`, else `visavis/trees` in the folder that the
/// system has for caches. Not if `VISAVIS_TREES_MIB` is 0 or, with a line, no number, and not where there is no folder.
pub fn keep() {
    let given = std::env::var("VISAVIS_TREES_MIB").map_or(Ok(MOST_BYTES), |word| most_bytes_of(&word));
    let most_bytes = given.unwrap_or_else(|line| {
        note!("note: no trees are kept: {line}");
        0
    });
    let chosen = std::env::var_os("VISAVIS_CACHE").filter(|folder| !folder.is_empty()).map(PathBuf::from);
    let folder = chosen.or_else(|| image_file::cache_folder().map(|folder| folder.join("visavis")));
    if let Some(folder) = folder.filter(|_| most_bytes > 0) {
        mesh_kept::keep_on(TreeStore::new(folder.join("trees"), most_bytes));
    }
}

fn most_bytes_of(word: &str) -> Result<u64, String> {
    let mib = word.trim().parse::<u64>();
    let mib =
        mib.map_err(|_| format!("VISAVIS_TREES_MIB {word}: expected a whole number of MiB, 0 to keep no trees"))?;
    Ok(mib.saturating_mul(1 << 20))
}

impl TreeStore {
    /// A store in this folder, of at most so many bytes.
    pub fn new(folder: PathBuf, most_bytes: u64) -> Self {
        TreeStore { folder, most_bytes, told: Once::new() }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name).with_extension(END)
    }

    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), String> {
        let fault = |why: std::io::Error| format!("{why}: {}", shown(&self.folder));
        if bytes.len() as u64 > self.most_bytes {
            return Ok(());
        }
        std::fs::create_dir_all(&self.folder).map_err(fault)?;
        write_whole(&self.path(name), bytes).map_err(|why| why.to_string())?;
        let _held = hold(&self.folder, true);
        self.make_room(&self.path(name)).map_err(fault)
    }

    fn make_room(&self, newest: &Path) -> std::io::Result<()> {
        let listing: Vec<DirEntry> = std::fs::read_dir(&self.folder)?.collect::<Result<_, _>>()?;
        let entry = |file: &DirEntry| {
            let meta = file.metadata().ok().filter(|meta| meta.is_file() && is_tree(&file.path()))?;
            Some((meta.modified().unwrap_or(SystemTime::UNIX_EPOCH), file.path(), meta.len()))
        };
        let mut entries: Vec<_> = listing.iter().filter_map(entry).collect();
        entries.sort();
        let mut bytes: u64 = entries.iter().map(|(.., bytes)| bytes).sum();
        for (_, path, own) in entries.iter().filter(|(_, path, _)| path != newest) {
            if bytes <= self.most_bytes {
                break;
            }
            match std::fs::remove_file(path) {
                // another program was faster
                Err(why) if why.kind() != ErrorKind::NotFound => return Err(why),
                _ => bytes -= own,
            }
        }
        Ok(())
    }
}

/// Whether a file is one of this program's by its name; whatever else lies in the folder is the user's.
fn is_tree(path: &Path) -> bool {
    let is_digit = |digit: u8| matches!(digit, b'0'..=b'9' | b'a'..=b'f');
    let name = path.file_stem().and_then(|name| name.to_str()).unwrap_or_default();
    name.len() == 32 && name.bytes().all(is_digit) && path.extension().is_some_and(|end| end == END)
}

/// All of a file, if it is one and has at most so many bytes.
fn read(path: &Path, most: u64) -> Option<Vec<u8>> {
    // a pipe or a device might never end
    if !std::fs::metadata(path).ok()?.is_file() {
        return None;
    }
    let file = File::open(path).ok()?;
    let length = file.metadata().ok()?.len();
    let mut bytes = Vec::new();
    // what is longer is damaged, and so is what grows while it is read: neither is read further than that
    bytes.try_reserve_exact(usize::try_from(length.min(most)).ok()? + 1).ok()?;
    file.take(most.saturating_add(1)).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}

impl Shelf for TreeStore {
    fn fetch(&self, name: &str, most: u64) -> Option<Vec<u8>> {
        let bytes = read(&self.path(name), most)?;
        // that it was used decides how long it stays; a folder that is read-only keeps it anyway
        let _ =
            File::options().append(true).open(self.path(name)).and_then(|file| file.set_modified(SystemTime::now()));
        Some(bytes)
    }

    fn put(&self, name: &str, bytes: &[u8]) {
        if let Err(why) = self.write(name, bytes) {
            self.told.call_once(|| note!("note: the tree of a mesh cannot be kept: {why}"));
        }
    }

    fn found_damaged(&self, name: &str) {
        note!("note: the tree of a mesh that was kept is damaged and is built anew: {}", shown(&self.path(name)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;
    use visavis_tests::TestFolder;

    fn name(digit: char) -> String {
        digit.to_string().repeat(32)
    }

    fn names_in(folder: &Path) -> Vec<String> {
        let listing = std::fs::read_dir(folder).unwrap();
        let mut names: Vec<_> = listing.map(|file| file.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn those_used_longest_ago_go_first_and_nothing_of_the_users() {
        let folder = TestFolder::new();
        let store = TreeStore::new(folder.file("trees"), 250);
        store.put(&name('a'), &[1; 100]);
        let mine = ["notes.tree", &format!("{}.txt", name('f'))].map(|mine| folder.file("trees").join(mine));
        mine.iter().for_each(|mine| std::fs::write(mine, [0; 999]).unwrap());
        store.put(&name('b'), &[2; 100]);
        // long ago, in this order
        for (digit, minutes) in [('a', 20), ('b', 10)] {
            let file = File::options().append(true).open(store.path(&name(digit))).unwrap();
            file.set_modified(SystemTime::now() - Duration::from_secs(60 * minutes)).unwrap();
        }
        assert_eq!(store.fetch(&name('a'), 100), Some(vec![1; 100]));
        store.put(&name('c'), &[3; 100]);
        assert_eq!([store.fetch(&name('b'), 100), store.fetch(&name('c'), 100)], [None, Some(vec![3; 100])]);
        assert_eq!(names_in(&folder.file("trees")).len(), 4);
        // what does not fit at all is not kept, and pushes nothing out
        store.put(&name('d'), &[4; 251]);
        assert_eq!(names_in(&folder.file("trees")).len(), 4);
    }

    #[test]
    fn what_is_longer_than_a_tree_can_be_is_read_no_further() {
        let folder = TestFolder::new();
        let store = TreeStore::new(folder.path().to_owned(), 1000);
        store.put(&name('a'), &[1; 100]);
        assert_eq!(store.fetch(&name('a'), 10).map(|bytes| bytes.len()), Some(11));
        assert_eq!(store.fetch(&name('b'), 10), None);
        std::fs::create_dir(store.path(&name('b'))).unwrap();
        assert_eq!(store.fetch(&name('b'), 10), None, "a folder");
    }

    #[test]
    fn a_limit_is_a_whole_number_of_mib() {
        assert_eq!([most_bytes_of("0"), most_bytes_of(" 3 ")], [Ok(0), Ok(3 << 20)]);
        assert!(most_bytes_of("much").is_err_and(|line| line.contains("VISAVIS_TREES_MIB much")));
    }
}
