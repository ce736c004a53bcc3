//! Forged messages in a running group: numbers that nothing counts to, incarnations that were never
//! started.

use messages::{AppliedMark, Epoch, Incarnation, topics};
use service::bus::{Bus, Identity};
use whichone_tests::{Group, wait_for};

/// Messages that speech has rejected.
fn rejected(group: &Group) -> u64 {
    group.service("speech")["rejected"].as_u64().unwrap()
}

#[test]
fn forged_mark_and_incarnation_are_rejected_and_counted() {
    let group = Group::up(&[]);
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    // The topic has one writer at a time: the forger takes the place of a policy that is away.
    group.must(&["hold", "policy"]);
    let epoch = Epoch(group.status()["epoch"].as_u64().unwrap());
    let running = group.incarnation("policy") as u32;
    for (incarnation, is_counted) in [(u32::MAX, true), (running + 1, true), (running, false)] {
        let identity = Identity { epoch, incarnation: Incarnation(incarnation) };
        let bus = Bus::open(group.paths(), "forger", identity).unwrap();
        let marks = bus.writer::<AppliedMark>(&topics::MARK).unwrap();
        let before = rejected(&group);
        wait_for("the rejection", 10.0, || {
            for seq in [1 << 40, u64::MAX - 1, u64::MAX] {
                marks.send(&AppliedMark { seq }).unwrap();
            }
            (!is_counted || rejected(&group) > before).then_some(())
        });
    }
    group.say("the white bowl");
    group.must(&["release", "policy"]);
    assert_eq!(group.await_pick(Some("white"))["object"], "white");
    assert!(group.must(&["status"]).stdout.contains("rejected"), "for a person, too");
    group.verify_journals();
    group.down();
}
