//! A full log disk: every write to a log fails.

use rustix::process::Signal;
use whichone_tests::Group;

#[test]
fn full_log_disk_ends_no_process() {
    let mut group = Group::new();
    std::fs::create_dir_all(group.paths().log()).unwrap();
    for name in ["supervisor", "speech", "grounding", "policy", "arm", "console"] {
        std::os::unix::fs::symlink("/dev/full", group.paths().log_file(name)).unwrap();
    }
    assert_eq!(group.start(&[]).code, Some(0));
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.signal("policy", Signal::KILL);
    group.wait_for_restart("policy", 1);
    assert_eq!(group.fetch("the white bowl", "white")["object"], "white");
    for name in ["speech", "grounding", "arm"] {
        assert_eq!(group.incarnation(name), 1, "{name}");
    }
    group.verify_journals();
    group.down();
}
