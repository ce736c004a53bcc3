//! Another user of the machine, who tries everything on the files of a group.

use crate::Group;
use crate::isolated::as_other_user;
use rustix::fs::{FlockOperation, flock};
use service::group::SHM;
use service::shm_cleanup;
use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions, Permissions};
use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt};
use std::os::unix::net::{UnixDatagram, UnixStream};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// What a hostile user tries with a file, folder or socket; returns what succeeded.
fn attack(path: &Path) -> Vec<&'static str> {
    let mut done = Vec::new();
    let mut attempt = |what, succeeded: bool| {
        if succeeded {
            done.push(what);
        }
    };
    let locked = |file: File| flock(&file, FlockOperation::NonBlockingLockShared).is_ok();
    attempt("list", fs::read_dir(path).is_ok());
    attempt("create in", File::create_new(path.join("foreign")).is_ok());
    attempt(
        "read",
        File::open(path).is_ok_and(|file| !file.metadata().is_ok_and(|meta| meta.is_dir())),
    );
    attempt("lock", File::open(path).is_ok_and(locked));
    attempt("write", OpenOptions::new().write(true).open(path).is_ok());
    attempt("truncate", OpenOptions::new().write(true).truncate(true).open(path).is_ok());
    attempt("connect to", UnixStream::connect(path).is_ok());
    let sent = UnixDatagram::unbound().and_then(|socket| socket.send_to(b"READY=1", path));
    attempt("send to", sent.is_ok());
    attempt("change the mode of", fs::set_permissions(path, Permissions::from_mode(0o777)).is_ok());
    attempt("rename", fs::rename(path, path.with_extension("foreign")).is_ok());
    attempt("remove", fs::remove_file(path).is_ok());
    done
}

/// Everything below a folder, and the folder.
fn below(path: &Path, found: &mut BTreeSet<PathBuf>) {
    found.insert(path.to_owned());
    for entry in fs::read_dir(path).into_iter().flatten().flatten() {
        let path = entry.path();
        match entry.file_type() {
            Ok(kind) if kind.is_dir() => below(&path, found),
            _ => drop(found.insert(path)),
        }
    }
}

/// Files and named sockets that the group's processes hold open, wherever they are.
fn held_open(group: &Group) -> BTreeSet<PathBuf> {
    let sockets = fs::read_to_string("/proc/net/unix").expect("sockets of the machine");
    let socket = |number: &str| {
        let line = sockets.lines().find(|line| line.split_whitespace().nth(6) == Some(number))?;
        line.split_whitespace().nth(7).map(PathBuf::from)
    };
    let status = group.status();
    let pids =
        status["services"].as_array().expect("services").iter().map(|service| &service["pid"]);
    let pids = pids.chain([&status["supervisor_pid"]]).filter_map(|pid| pid.as_u64());
    let links = pids
        .flat_map(|pid| fs::read_dir(format!("/proc/{pid}/fd")).into_iter().flatten().flatten());
    let path = |link: PathBuf| {
        let text = link.to_string_lossy().into_owned();
        match text.strip_prefix("socket:[").and_then(|rest| rest.strip_suffix(']')) {
            Some(number) => socket(number),
            None => Some(link).filter(|link| link.is_file() && !link.starts_with("/proc")),
        }
    };
    links.filter_map(|entry| path(fs::read_link(entry.path()).ok()?)).collect()
}

/// All files that a running group has made.
pub fn everything(group: &Group) -> BTreeSet<PathBuf> {
    let mut all = held_open(group);
    below(group.paths().root(), &mut all);
    shm_cleanup::leftovers(group.paths()).iter().for_each(|path| below(path, &mut all));
    // A recogniser's model or a library may be held open, too: what is older is not of the group.
    let since = group.paths().home().metadata().and_then(|home| home.created());
    let since = since.unwrap_or(SystemTime::UNIX_EPOCH);
    let is_ours = |path: &PathBuf| {
        let file = path.symlink_metadata();
        file.is_ok_and(|file| file.uid() == 0 && file.modified().is_ok_and(|at| at >= since))
    };
    all.into_iter().filter(is_ours).collect()
}

/// Checks as another user that nothing of a running group is open.
///
/// # Panics
/// Without root, or if an attack succeeds.
pub fn assert_closed(group: &Group) {
    let all = everything(group);
    let holds = |test: &dyn Fn(&PathBuf) -> bool| all.iter().any(test);
    let is_socket = |path: &PathBuf| path.metadata().is_ok_and(|file| file.file_type().is_socket());
    assert!(holds(&|path| path.starts_with(SHM) && path.is_file()), "{all:?}");
    assert!(holds(&|path| path.starts_with(SHM) && is_socket(path)), "{all:?}");
    assert!(holds(&|path| path.ends_with("control.sock")), "{all:?}");
    assert!(holds(&|path| path.ends_with("policy.journal")), "{all:?}");
    assert!(holds(&|path| path.ends_with("supervisor.log")), "{all:?}");
    for path in &all {
        let done = as_other_user(|| attack(path));
        let mode = path.symlink_metadata().map_or(0, |file| file.mode() & 0o7777);
        assert!(done.is_empty(), "{}, mode {mode:o}: {done:?}", path.display());
    }
}
