use std::fs;
use std::os::unix::fs::symlink;

use rustix::fs::mknodat;

use super::*;

#[test]
fn folders_are_created_and_files_replaced() {
    let top = tempfile::tempdir().unwrap();
    let path = top.path().join("a/../b/c");
    let folder = OutputFolder::open(&path).unwrap();
    folder.write("study.csv", b"one").unwrap();
    folder.write("study.csv", b"two").unwrap();
    let file = top.path().join("b/c/study.csv");
    assert_eq!(fs::read_to_string(&file).unwrap(), "two");
    let error = folder.write_new("study.csv", b"three", Readers::AsBefore).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::AlreadyExists);
    write_output(&file, b"four").unwrap();
    assert_eq!(fs::read_to_string(&file).unwrap(), "four");
    assert_eq!(fs::read_dir(path).unwrap().count(), 1);
}

#[test]
fn own_links_are_followed_and_kept() {
    let top = tempfile::tempdir().unwrap();
    let [real, link] = ["real", "link"].map(|name| top.path().join(name));
    fs::create_dir(&real).unwrap();
    symlink("real", &link).unwrap();
    symlink(real.join("one.svg"), real.join("latest.svg")).unwrap();
    write_output(&link.join("latest.svg"), b"<svg/>").unwrap();
    assert_eq!(fs::read_to_string(real.join("one.svg")).unwrap(), "<svg/>");
    OutputFolder::open(&link).unwrap().write("latest.svg", b"").unwrap();
    assert_eq!(fs::metadata(real.join("one.svg")).unwrap().len(), 0);
    assert!(fs::symlink_metadata(real.join("latest.svg")).unwrap().is_symlink());
}

#[test]
fn what_is_no_file_is_refused() {
    let top = tempfile::tempdir().unwrap();
    let pipe = top.path().join("pipe");
    mknodat(CWD, &pipe, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0).unwrap();
    let error = write_output(&pipe, b"x").unwrap_err().to_string();
    assert!(error.contains("expected a regular file, found a pipe"), "{error}");
    for folder in [top.path(), Path::new("/"), Path::new("..")] {
        assert_eq!(write_output(folder, b"").unwrap_err().kind(), ErrorKind::IsADirectory);
    }
    let error = OutputFolder::open(&pipe).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::NotADirectory);
    let turns = top.path().join("turns");
    symlink("turns", &turns).unwrap();
    assert!(write_output(&turns, b"").is_err());
}

#[test]
fn links_of_others_are_refused() {
    let own = geteuid().as_raw();
    own_link(OsStr::new("link"), own).unwrap();
    own_link(OsStr::new("link"), ROOT).unwrap();
    let error = own_link(OsStr::new("link"), own + 7).unwrap_err().to_string();
    assert!(error.contains(&format!("link is a link of user {}", own + 7)), "{error}");
}
