use std::os::unix::fs::symlink;

use super::*;

/// A name that a draft of `file` may have.
fn leftover(file: &Path) -> PathBuf {
    let name = file.file_name().unwrap().to_str().unwrap();
    file.with_file_name(format!(".{name}.abcdefghij.new"))
}

fn mode(path: &Path) -> u32 {
    fs::metadata(path).unwrap().mode() & 0o777
}

fn entries(folder: &Path) -> usize {
    fs::read_dir(folder).unwrap().count()
}

#[test]
fn replaced_file_is_whole_and_has_the_wanted_mode() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("settings.toml");
    replace_private_synced(&file, "one").unwrap();
    assert_eq!((fs::read_to_string(&file).unwrap().as_str(), mode(&file)), ("one", 0o600));
    replace(&file, "two", Readers::Mode(0o646)).unwrap();
    assert_eq!((fs::read_to_string(&file).unwrap().as_str(), mode(&file)), ("two", 0o646));
    replace(&file, "three", Readers::AsBefore).unwrap();
    assert_eq!((fs::read_to_string(&file).unwrap().as_str(), mode(&file)), ("three", 0o646));
    assert_eq!(entries(folder.path()), 1);
}

#[test]
fn failed_replacement_leaves_the_old_file_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    // A folder that is not empty cannot be replaced by a file.
    let path = folder.path().join("settings.toml");
    fs::create_dir_all(path.join("kept")).unwrap();
    assert!(replace_private(&path, "new").is_err());
    assert!(replace_private_synced(&path, "new").is_err());
    assert_eq!(entries(folder.path()), 1);
    assert!(path.join("kept").is_dir());
}

#[test]
fn dropped_draft_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("token");
    replace_private(&file, "secret").unwrap();
    let mut draft = Draft::of(&file, Readers::Owner).unwrap();
    draft.write_all(b"half").unwrap();
    assert_eq!(entries(folder.path()), 2);
    drop(draft);
    assert_eq!(
        (fs::read_to_string(&file).unwrap().as_str(), entries(folder.path())),
        ("secret", 1)
    );
}

#[test]
fn leftover_of_a_crash_is_removed_and_a_draft_in_use_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("token");
    let left = leftover(&file);
    fs::write(&left, "half").unwrap();
    let in_use = Draft::of(&file, Readers::Owner).unwrap();
    assert!(!left.exists());
    replace_private(&file, "other").unwrap();
    assert_eq!(entries(folder.path()), 2);
    in_use.replace().unwrap();
    assert_eq!((fs::read(&file).unwrap().len(), entries(folder.path())), (0, 1));
}

#[test]
fn files_with_similar_names_stay() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("token");
    for name in [".token.short.new", ".token.abcdefgh-j.new", "token.new", ".other.abcdefghij.new"]
    {
        fs::write(folder.path().join(name), "").unwrap();
    }
    replace_private(&file, "x").unwrap();
    assert_eq!(entries(folder.path()), 5);
}

#[test]
fn link_is_replaced_and_not_written_through() {
    let folder = tempfile::tempdir().unwrap();
    let [file, other] = ["token", "other"].map(|name| folder.path().join(name));
    fs::write(&other, "precious").unwrap();
    symlink(&other, &file).unwrap();
    symlink(&other, leftover(&file)).unwrap();
    replace_private(&file, "new").unwrap();
    assert_eq!(fs::read_to_string(&other).unwrap(), "precious");
    assert!(fs::symlink_metadata(&file).unwrap().is_file());
}

#[test]
fn file_that_exists_is_kept_where_a_new_one_is_wanted() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.toml");
    Draft::of(&file, Readers::AsBefore).unwrap().put_if_absent().unwrap();
    let error = Draft::of(&file, Readers::AsBefore).unwrap().put_if_absent().unwrap_err();
    assert_eq!(error.kind(), ErrorKind::AlreadyExists);
    assert_eq!(entries(folder.path()), 1);
}

#[test]
fn long_name_and_relative_path_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("x".repeat(255));
    replace_private(&file, "x").unwrap();
    assert_eq!(entries(folder.path()), 1);
    assert_eq!(folder_of(Path::new("file")), Path::new("."));
}

#[test]
fn writers_at_the_same_time_never_lose_a_draft() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("token");
    std::thread::scope(|scope| {
        for writer in 0..4 {
            let file = &file;
            scope.spawn(move || {
                for _ in 0..500 {
                    replace_private(file, format!("{writer}").repeat(9)).unwrap();
                }
            });
        }
    });
    assert_eq!((fs::read(&file).unwrap().len(), entries(folder.path())), (9, 1));
}

#[test]
fn new_file_for_a_program_takes_the_place_of_a_link() {
    let folder = tempfile::tempdir().unwrap();
    let [log, other] = ["log", "other"].map(|name| folder.path().join(name));
    fs::write(&other, "precious").unwrap();
    symlink(&other, &log).unwrap();
    create_private(&log).unwrap().write_all(b"line").unwrap();
    assert_eq!(fs::read_to_string(&other).unwrap(), "precious");
    assert_eq!((fs::read_to_string(&log).unwrap().as_str(), mode(&log)), ("line", 0o600));
}

#[test]
fn lock_file_is_kept_and_no_link() {
    let folder = tempfile::tempdir().unwrap();
    let [lock, link] = ["lock", "link"].map(|name| folder.path().join(name));
    fs::write(&lock, "17").unwrap();
    open_lock(&lock).unwrap();
    assert_eq!(fs::read_to_string(&lock).unwrap(), "17");
    symlink(&lock, &link).unwrap();
    assert!(open_lock(&link).is_err());
}

#[test]
fn probe_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    probe(folder.path()).unwrap();
    assert_eq!(entries(folder.path()), 0);
    assert!(probe(&folder.path().join("missing")).is_err());
}
