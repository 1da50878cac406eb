use super::*;
use crate::partial::remove_unless_held;
use visavis_tests::TestFolder;

fn read(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap()
}

/// Every way to write over a file, and what it makes of it.
fn check_and_write(path: &Path, bytes: &[u8]) -> Result<(), ImageFileError> {
    check_writable(path)?;
    write_whole(path, bytes)
}

#[test]
fn a_check_leaves_nothing_and_a_write_nothing_but_its_file() {
    let folder = TestFolder::new();
    let path = folder.file("a.exr");
    check_writable(&path).unwrap();
    assert!(folder.names().is_empty());
    write_whole(&path, b"one").unwrap();
    check_and_write(&path, b"another").unwrap();
    assert_eq!((read(&path), folder.names()), (b"another".to_vec(), vec!["a.exr".to_owned()]));
}

#[test]
fn names_of_255_bytes_are_written_and_numbered_and_longer_ones_refused_by_the_check() {
    let folder = TestFolder::new();
    for stem in ["n".repeat(251), "\u{e9}".repeat(125) + "n"] {
        let path = folder.file(&format!("{stem}.png"));
        check_and_write(&path, b"one").unwrap();
        let second = write_new(&path, b"two").unwrap();
        assert_eq!((read(&path), read(&second)), (b"one".to_vec(), b"two".to_vec()));
        assert!(second.to_string_lossy().ends_with("-2.png"));
    }
    assert!(check_writable(&folder.file(&("n".repeat(252) + ".png"))).is_err());
    assert_eq!(folder.names().len(), 4);
}

#[test]
fn what_cannot_be_written_is_refused_by_the_check() {
    let folder = TestFolder::new();
    let inside = |name: &str| folder.file(name);
    std::fs::create_dir(inside("folder.png")).unwrap();
    std::fs::write(inside("file"), "").unwrap();
    for name in ["folder.png", "none/a.png", "file/a.png", "a.png/"] {
        let said = check_writable(&inside(name)).unwrap_err().to_string();
        assert!(said.contains(name) && said.lines().count() == 1, "{said}");
    }
    assert_eq!(folder.names(), ["file", "folder.png"]);
}

#[test]
fn an_error_is_one_line_whatever_the_name() {
    let said = check_writable(Path::new("none\nsuch/a\r.png")).unwrap_err().to_string();
    assert!(said.ends_with("none\\nsuch/a\\r.png") && said.lines().count() == 1, "{said}");
}

#[test]
fn what_cannot_be_put_in_its_place_is_kept_and_said_where() {
    let folder = TestFolder::new();
    let path = folder.file("a.exr");
    check_writable(&path).unwrap();
    // while the picture was made, somebody put a folder in its place
    std::fs::create_dir(&path).unwrap();
    let Err(ImageFileError::Kept { fault, kept }) = write_or_keep(&path, b"picture") else { panic!("not kept") };
    assert_eq!((read(&kept), kept.clone()), (b"picture".to_vec(), folder.file("a-2.exr")));
    assert!(fault.to_string().contains("a folder"), "{fault}");
    // or took the folder away
    let name = format!("visavis-kept-{}.exr", std::process::id());
    let Err(ImageFileError::Kept { kept, .. }) = write_or_keep(&folder.path().join("gone").join(&name), b"picture")
    else {
        panic!("not kept")
    };
    assert_eq!((read(&kept), kept.clone()), (b"picture".to_vec(), std::env::temp_dir().join(name)));
    std::fs::remove_file(kept).unwrap();
}

#[test]
fn leftovers_of_dead_writers_go_and_those_of_living_ones_stay() {
    let folder = TestFolder::new();
    let living = Partial::create(folder.path(), false).unwrap();
    std::fs::write(folder.file(".visavis-0000000000000000.partial"), "half").unwrap();
    std::fs::write(folder.file("a.png.123.partial"), "somebody's").unwrap();
    write_whole(&folder.file("a.png"), b"whole").unwrap();
    let living_name = living.path().file_name().unwrap().to_string_lossy().into_owned();
    assert_eq!(folder.names(), [living_name, "a.png".into(), "a.png.123.partial".into()]);
    drop(living);
    assert_eq!(folder.names(), ["a.png", "a.png.123.partial"]);
}

#[test]
fn two_writers_in_one_folder_do_not_disturb_each_other() {
    let folder = TestFolder::new();
    std::thread::scope(|threads| {
        for thread in 0..4 {
            let path = folder.file(&format!("{thread}.png"));
            threads
                .spawn(move || (0..50).for_each(|i| write_whole(&path, format!("{thread} {i}").as_bytes()).unwrap()));
        }
    });
    assert_eq!(folder.names(), ["0.png", "1.png", "2.png", "3.png"]);
    assert_eq!(read(&folder.file("3.png")), b"3 49");
}

#[test]
fn two_writers_of_one_new_name_do_not_disturb_each_other() {
    let folder = TestFolder::new();
    let path = folder.file("a.png");
    for _ in 0..50 {
        std::thread::scope(|threads| {
            for _ in 0..4 {
                threads.spawn(|| check_and_write(&path, b"picture").unwrap());
            }
        });
        assert_eq!((read(&path), folder.names()), (b"picture".to_vec(), vec!["a.png".to_owned()]));
        std::fs::remove_file(&path).unwrap();
    }
}

/// Writers that begin look for leftovers at the same time.
#[test]
fn no_living_writer_loses_its_file_to_another() {
    let folder = TestFolder::new();
    std::thread::scope(|threads| {
        for _ in 0..4 {
            threads.spawn(|| {
                for _ in 0..1000 {
                    assert!(Partial::create(folder.path(), false).unwrap().path().exists());
                }
            });
        }
    });
    assert!(folder.names().is_empty());
}

#[test]
fn a_file_that_is_held_is_no_leftover() {
    let folder = TestFolder::new();
    let path = folder.file("held");
    let held = File::create(&path).unwrap();
    held.lock().unwrap();
    remove_unless_held(&path).unwrap();
    assert!(path.exists());
    drop(held);
    remove_unless_held(&path).unwrap();
    assert!(!path.exists());
}

/// A signal may come while a file is written: nothing is begun then that the end would break off.
#[test]
fn a_process_that_is_being_ended_writes_nothing_in_place() {
    let folder = TestFolder::new();
    let path = folder.file("a.png");
    std::fs::write(&path, "before").unwrap();
    let ending = in_the_making();
    let (done, is_done) = std::sync::mpsc::channel();
    let file = File::options().write(true).open(&path).unwrap();
    let writer = std::thread::spawn(move || {
        let written = write_in_place(file, b"after");
        done.send(()).unwrap();
        written
    });
    // a writer that did not wait would be done long before
    assert!(is_done.recv_timeout(std::time::Duration::from_millis(100)).is_err());
    assert_eq!(read(&path), b"before");
    drop(ending);
    writer.join().unwrap().unwrap();
    assert_eq!(read(&path), b"after");
}

#[cfg(unix)]
mod on_unix {
    use super::*;
    use std::fs::Permissions;
    use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};

    fn mode(path: &Path) -> u32 {
        path.metadata().unwrap().permissions().mode() & 0o7777
    }

    #[test]
    fn a_file_keeps_its_mode_and_its_other_names() {
        let folder = TestFolder::new();
        let (path, other) = (folder.file("a.png"), folder.file("b.png"));
        for wanted in [0o600, 0o640, 0o666, 0o755, 0o2755, 0o4711] {
            std::fs::write(&path, "before, and longer").unwrap();
            std::fs::set_permissions(&path, Permissions::from_mode(wanted)).unwrap();
            check_and_write(&path, b"after").unwrap();
            assert_eq!((mode(&path), read(&path)), (wanted, b"after".to_vec()));
        }
        std::fs::hard_link(&path, &other).unwrap();
        for content in [&b"both"[..], b"both, and longer", b"and shorter"] {
            check_and_write(&path, content).unwrap();
            assert_eq!((read(&other), other.metadata().unwrap().nlink()), (content.to_vec(), 2));
            assert_eq!(mode(&path), 0o4711);
        }
        assert!(is_same_file(&path, &other) && !is_same_file(&path, &folder.file("none.png")));
    }

    #[test]
    fn links_are_written_through_and_loops_refused() {
        let folder = TestFolder::new();
        let inside = |name: &str| folder.file(name);
        symlink("b.png", inside("a.png")).unwrap();
        symlink("c.png", inside("b.png")).unwrap();
        check_and_write(&inside("a.png"), b"new").unwrap();
        assert_eq!((read(&inside("c.png")), inside("a.png").is_symlink()), (b"new".to_vec(), true));
        symlink("y.png", inside("x.png")).unwrap();
        symlink("x.png", inside("y.png")).unwrap();
        let said = check_writable(&inside("x.png")).unwrap_err().to_string();
        assert!(said.contains("too many links"), "{said}");
        symlink("/dev/full", inside("full.png")).unwrap();
        let said = check_writable(&inside("full.png")).unwrap_err().to_string();
        assert!(said.contains("not a file"), "{said}");
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_file_keeps_the_attributes_that_users_gave_it() {
        let folder = TestFolder::new();
        let path = folder.file("a.png");
        std::fs::write(&path, "before").unwrap();
        let flags = rustix::fs::XattrFlags::empty();
        // not every file system has them
        if rustix::fs::setxattr(&path, "user.note", b"mine", flags).is_ok() {
            check_and_write(&path, b"after").unwrap();
            let mut value = [0; 8];
            assert_eq!(rustix::fs::getxattr(&path, "user.note", &mut value), Ok(4));
        }
        assert!(!has_attributes(&File::create(folder.file("plain.png")).unwrap()));
    }

    /// A file in memory that may not grow stands for the full disk.
    #[test]
    #[cfg(target_os = "linux")]
    fn a_disk_without_room_for_more_keeps_what_is_written_in_place() {
        use rustix::fs::{MemfdFlags, SealFlags, fcntl_add_seals, memfd_create};
        let mut file = File::from(memfd_create("full", MemfdFlags::ALLOW_SEALING).unwrap());
        file.write_all(b"precious").unwrap();
        fcntl_add_seals(&file, SealFlags::GROW).unwrap();
        let content = |mut file: &File| {
            let mut bytes = Vec::new();
            file.rewind().unwrap();
            std::io::Read::read_to_end(&mut file, &mut bytes).unwrap();
            bytes
        };
        assert!(write_in_place(file.try_clone().unwrap(), b"longer than before").is_err());
        assert_eq!(content(&file), b"precious");
        write_in_place(file.try_clone().unwrap(), b"shorter").unwrap();
        assert_eq!(content(&file), b"shorter");
    }

    /// Only root can make such a folder, and not on every file system.
    #[test]
    #[cfg(target_os = "linux")]
    fn nothing_is_left_in_a_folder_from_which_nothing_can_be_removed() {
        use rustix::fs::{IFlags, ioctl_getflags, ioctl_setflags};
        let folder = TestFolder::new();
        let opened = File::open(folder.path()).unwrap();
        let Ok(flags) = ioctl_getflags(&opened) else { return };
        if ioctl_setflags(&opened, flags | IFlags::APPEND).is_err() {
            return;
        }
        let path = folder.file("a.png");
        let written = [&b"one"[..], b"another"].map(|content| check_and_write(&path, content));
        let numbered = write_new(&path, b"numbered");
        ioctl_setflags(&opened, flags).unwrap();
        assert!(written.iter().all(Result::is_ok), "{written:?}");
        assert_eq!((read(&path), read(&numbered.unwrap())), (b"another".to_vec(), b"numbered".to_vec()));
        assert_eq!(folder.names(), ["a-2.png", "a.png"]);
    }

    /// Root may write what nobody else may: these are what a user meets.
    mod as_a_user {
        use super::*;

        /// False for root, who is not refused.
        fn modes_count(folder: &TestFolder) -> bool {
            let path = folder.file("probe");
            std::fs::write(&path, "").unwrap();
            std::fs::set_permissions(&path, Permissions::from_mode(0o444)).unwrap();
            let refused = File::options().write(true).open(&path).is_err();
            std::fs::remove_file(path).unwrap();
            refused
        }

        #[test]
        fn a_write_protected_file_is_refused_and_kept() {
            let folder = TestFolder::new();
            let path = folder.file("a.png");
            std::fs::write(&path, "precious").unwrap();
            std::fs::set_permissions(&path, Permissions::from_mode(0o444)).unwrap();
            if modes_count(&folder) {
                assert!(check_writable(&path).is_err() && write_whole(&path, b"new").is_err());
                assert_eq!(read(&path), b"precious");
            } else {
                check_and_write(&path, b"new").unwrap();
            }
            assert_eq!(mode(&path), 0o444);
        }

        #[test]
        fn a_file_that_may_be_written_is_written_where_its_folder_may_not() {
            let folder = TestFolder::new();
            let path = folder.file("a.png");
            std::fs::write(&path, "before, and longer").unwrap();
            std::fs::set_permissions(folder.path(), Permissions::from_mode(0o555)).unwrap();
            let written = check_and_write(&path, b"after");
            let another = check_writable(&folder.file("b.png"));
            std::fs::set_permissions(folder.path(), Permissions::from_mode(0o755)).unwrap();
            written.unwrap();
            assert_eq!(read(&path), b"after");
            assert_eq!(another.is_err(), modes_count(&folder));
        }
    }
}
