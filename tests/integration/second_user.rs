//! Another user of the machine can neither read, change, reach nor block a group.

mod prepared;

use rustix::process::Signal;
use service::folders::make_private;
use service::group::{GroupPaths, SHM};
use service::shm_cleanup;
use std::collections::BTreeSet;
use std::fs::{self, File, Permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt, chown};
use std::path::{Path, PathBuf};
use whichone_tests::isolated::{OTHER_USER, as_other_user};
use whichone_tests::second_user::{assert_closed, everything};
use whichone_tests::{Group, after, run};

/// Lets others as far as the group's folder, as they are let in a home folder.
fn open_home(paths: &GroupPaths) {
    fs::set_permissions(paths.home(), Permissions::from_mode(0o755)).unwrap();
}

#[test]
#[ignore = "needs root: acts as another user"]
fn nothing_of_a_running_group_is_open_to_another_user() {
    let mut group = Group::new();
    open_home(group.paths());
    assert_eq!(group.start(&[]).code, Some(0), "{}", group.logs());
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    assert_closed(&group);
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.down();
}

#[test]
#[ignore = "needs root: acts as another user"]
fn generous_umask_and_folders_of_an_earlier_version_open_nothing() {
    let group = Group::new();
    open_home(group.paths());
    let log = group.paths().log();
    fs::create_dir_all(&log).unwrap();
    fs::write(log.join("speech.log"), "what a user said").unwrap();
    for (path, mode) in [(group.paths().root(), 0o777), (&log, 0o777)] {
        fs::set_permissions(path, Permissions::from_mode(mode)).unwrap();
    }
    // The mask of this process holds for other tests, too.
    let config = concat!(env!("CARGO_MANIFEST_DIR"), "/../config");
    let up = group.command(&[
        "up",
        "--detach",
        "--wait",
        "ready",
        "--config",
        config,
        "--profile",
        "ci",
    ]);
    let started = run(&mut after("umask 0", &up), "", 120.0);
    assert_eq!(started.code, Some(0), "{started:?}\n{}", group.logs());
    assert_closed(&group);
    for path in everything(&group).iter().filter(|path| path.is_dir()) {
        assert_eq!(path.metadata().unwrap().mode() & 0o007, 0, "{}", path.display());
    }
    group.down();
}

/// Creates files with parts of the names of segments.
fn begin_like(segments: &[PathBuf]) -> Vec<PathBuf> {
    let names =
        segments.iter().map(|path| path.file_name().unwrap().to_string_lossy().into_owned());
    let parts = names.flat_map(|name| {
        let ends: Vec<usize> = name.match_indices(['_', '.']).map(|(at, _)| at).collect();
        let ends = ends.into_iter().flat_map(|at| [at, at + 1]).chain([65]);
        ends.filter_map(move |end| name.get(..end).map(str::to_owned)).collect::<Vec<_>>()
    });
    let parts: BTreeSet<PathBuf> = parts.map(|part| Path::new(SHM).join(part)).collect();
    parts.into_iter().filter(|path| File::create_new(path).is_ok()).collect()
}

#[test]
#[ignore = "needs root: acts as another user"]
fn files_of_another_user_under_the_groups_names_do_not_keep_it_from_starting() {
    let mut group = Group::new();
    let stem = group.paths().shm_stem();
    let foreign =
        [Path::new(SHM).join(&stem), Path::new(SHM).join(format!("{stem}_node.global_mgmt"))];
    as_other_user(|| {
        fs::create_dir(&foreign[0]).unwrap();
        File::create_new(&foreign[1]).unwrap();
    });
    assert_eq!(group.start(&[]).code, Some(0), "{}", group.logs());
    // Names that begin as those of the running group's segments do, and end where they must not.
    let segments = shm_cleanup::leftovers(group.paths());
    let cut = as_other_user(|| begin_like(&segments));
    assert!(cut.len() > 20, "{cut:?}");
    let before = group.incarnation("policy");
    group.signal("policy", Signal::KILL);
    group.wait_for_restart("policy", before);
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.down();
    for path in foreign.iter().chain(&cut) {
        assert!(path.exists(), "{} is not the group's to remove", path.display());
        let _ = if path.is_dir() { fs::remove_dir(path) } else { fs::remove_file(path) };
    }
}

#[test]
#[ignore = "needs root: acts as another user"]
fn folder_of_another_user_is_refused_with_the_fix() {
    let mut group = Group::new();
    let root = group.paths().root().to_owned();
    make_private(&root).unwrap();
    chown(&root, Some(OTHER_USER), Some(OTHER_USER)).unwrap();
    let ended = group.start(&[]);
    assert_eq!(ended.code, Some(74), "{ended:?}");
    let expected = format!("expected a folder of user 0, found one of user {OTHER_USER}; help:");
    assert!(ended.stderr.contains(&expected), "{ended:?}");
}

/// A group of another user, with root as its operator.
#[test]
#[ignore = "needs root: acts as another user"]
fn roots_orders_to_the_motion_stop_of_another_users_group_are_confirmed() {
    let mut group = Group::new();
    chown(group.paths().home(), Some(OTHER_USER), Some(OTHER_USER)).unwrap();
    let ended = as_other_user(|| group.start(&[]));
    assert_eq!(ended.code, Some(0), "{ended:?}\n{}", group.logs());
    assert_eq!(group.paths().run().metadata().unwrap().uid(), OTHER_USER);
    let state = group.must(&["stop-motion", "--timeout", "50", "--json"]).json();
    assert_eq!((&state["stopped"], &state["at_rest"]), (&true.into(), &true.into()), "{state}");
    as_other_user(|| group.wait_shown(true));
    group.release_stop();
    as_other_user(|| group.wait_shown(false));
    // What root cannot do there says how it is done, and destroys nothing of the running group.
    let ended = group.call(&["say", "hello"]);
    assert_ne!(ended.code, Some(0), "{ended:?}");
    assert!(ended.stderr.contains("help: run the command as that user"), "{ended:?}");
    assert!(!ended.stderr.contains("remove"), "{ended:?}");
    as_other_user(|| group.down());
}
