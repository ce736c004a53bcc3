//! Programs that run groups and are interrupted.

use rustix::process::{Pid, Signal, kill_process};
use std::process::{Command, Stdio};
use whichone_tests::{Group, wait_for};

#[test]
fn interrupted_program_ends_the_groups_that_it_has_started() {
    // What is interrupted leaves its folders.
    let folder = tempfile::tempdir().unwrap();
    let mut soak = Command::new(env!("CARGO_BIN_EXE_soak"));
    let mut soak = soak
        .env("TMPDIR", folder.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let processes = || Group::pids_started_by(soak.id());
    wait_for("a supervisor and services", 60.0, || (processes().len() > 3).then_some(()));
    kill_process(Pid::from_child(&soak), Signal::INT).unwrap();
    let ended = wait_for("its end", 60.0, || soak.try_wait().unwrap());
    assert!(!ended.success(), "{ended:?}");
    assert_eq!(Group::pids_started_by(soak.id()), []);
}
