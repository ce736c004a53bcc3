//! The motion stop, and recovery, while something is short or hangs.

use std::thread::sleep;
use std::time::{Duration, Instant};

use messages::{Receipt, ReceiptStatus, Sound, topics};
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value as Json;
use service::client::{Client, deliver};
use service::{Span, Time, clock};
use whichone_tests::console::http;
use whichone_tests::shortage::{
    JointWatch, NoDescriptors, SmallDisk, SmallGroup, in_private_mounts,
};
use whichone_tests::{Ended, Group, after, run, wait_for};

/// Real time, so that there is a motion to be stopped.
const REAL_TIME: &str = "arm.time_scale=1.0";
/// Longest time from the stop command to standing joints, milliseconds: the arm's 100 ms, and the
/// start of a process on a busy machine.
const STOP_MS_MAX: f64 = 1_000.0;

fn stop(group: &Group, joints: &JointWatch) {
    joints.wait_moving();
    let took_ms = joints.stop(group).unwrap_or_default();
    assert!(took_ms < STOP_MS_MAX, "{took_ms} ms");
}

fn assert_delivered(group: &Group, outcome: &Json, object: &str) {
    assert_eq!(outcome["outcome"], "delivered", "{outcome}\n{}", group.logs());
    assert_eq!(outcome["object"], object, "{outcome}");
    group.verify_journals();
}

fn supervisor(group: &Group) -> Pid {
    let pid = group.status()["supervisor_pid"].as_i64().expect("its pid");
    Pid::from_raw(i32::try_from(pid).unwrap()).unwrap()
}

#[test]
fn arm_stops_with_a_hung_supervisor_a_stopped_policy_and_no_free_descriptor() {
    let group = Group::up(&[REAL_TIME]);
    let joints = JointWatch::open(&group);
    let outcome = group.fetch_while("the clear bowl", "clear", || {
        let supervisor = supervisor(&group);
        joints.wait_moving();
        kill_process(supervisor, Signal::STOP).unwrap();
        stop(&group, &joints);
        group.release_stop();
        kill_process(supervisor, Signal::CONT).unwrap();

        group.signal("policy", Signal::STOP);
        stop(&group, &joints);
        group.release_stop();
        group.signal("policy", Signal::CONT);

        let no_descriptors = NoDescriptors::of(group.pid("arm"));
        stop(&group, &joints);
        drop(no_descriptors);
        group.release_stop();
    });
    assert_delivered(&group, &outcome, "clear");
    drop(joints);
    group.down();
}

/// Starts the group with a limit that no process of it can raise.
fn up_within(group: &Group, limit: &str) -> Ended {
    let config = concat!(env!("CARGO_MANIFEST_DIR"), "/../config");
    let up = group.command(&["up", "--detach", "--config", config, "--profile", "ci"]);
    run(&mut after(&format!("ulimit {limit}"), &up), "", 120.0)
}

#[test]
fn want_of_descriptors_is_no_failure_of_a_service() {
    let group = Group::new();
    let ended = up_within(&group, "-n 128");
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let begun = Instant::now();
    // Longer than five starts take.
    while begun.elapsed() < Duration::from_secs(10) {
        let status = group.status();
        let mut services = status["services"].as_array().unwrap().iter();
        assert!(services.all(|it| it["state"] != "failed"), "{status}");
        sleep(Duration::from_millis(500));
    }
    group.must(&["down"]);
}

/// Shared memory is files, too. The signal that ends a program at such a limit would give no reason.
#[test]
fn limit_of_file_sizes_that_leaves_no_shared_memory_is_named() {
    let ended = up_within(&Group::new(), "-f 128");
    assert_eq!(ended.code, Some(1), "{ended:?}");
    assert!(ended.stderr.contains("File too large"), "{ended:?}");
}

/// What needs file systems of its own.
mod as_root {
    use super::*;

    #[test]
    #[ignore = "needs root, for a small disk"]
    fn arm_stops_on_a_full_disk_and_the_stop_survives_a_kill() {
        let SmallGroup { group, disk } = SmallGroup::up(&[REAL_TIME]);
        let joints = JointWatch::open(&group);
        let outcome = group.fetch_while("the clear bowl", "clear", || {
            joints.wait_moving();
            disk.fill();
            stop(&group, &joints);
            let state = group.must(&["stop-motion", "--json"]).json();
            assert_eq!(state["durable"], true, "the journal's reserve holds it: {state}");
            let before = group.incarnation("arm");
            group.signal("arm", Signal::KILL);
            disk.free();
            group.wait_for_restart("arm", before);
            assert_eq!(group.arm()["stopped"], true, "the stop has survived");
            group.release_stop();
        });
        assert_delivered(&group, &outcome, "clear");
        drop(joints);
        group.down();
    }

    #[test]
    #[ignore = "needs root, for a small disk"]
    fn full_disk_is_waited_out_and_the_same_interaction_completed() {
        let SmallGroup { group, disk } = SmallGroup::up(&["dialogue.turns.questions_max=1000"]);
        // A client that joins now, because a new one makes files.
        let client = Client::join(group.paths()).unwrap();
        let receipts = client.bus().reader::<Receipt>(&topics::RECEIPT).unwrap();
        let writer = client.bus().encoded_writer(&topics::INJECTION).unwrap();
        let say = |text: &str| {
            let said = (clock::now(), Time(0));
            deliver(
                &writer,
                &receipts,
                Sound::Text(text.into()),
                said,
                Span::from_ms(2_000),
                || None,
            )
        };
        let is_accepted = |text: &str| {
            let receipts = say(text).unwrap_or_default();
            receipts.first().is_some_and(|receipt| receipt.status == ReceiptStatus::Accepted)
        };
        assert!(is_accepted("get me the bowl"));
        let asked = group.wait_for_decision("ask")["interaction"].clone();
        let services = ["speech", "policy", "arm"];
        let incarnations = services.map(|service| group.incarnation(service));
        disk.fill();
        // Small frames use up what the journals have been given, until one needs more.
        let freed = std::thread::scope(|scope| {
            let short = scope.spawn(|| {
                wait_for("a service that waits for the disk", 60.0, || {
                    services.iter().find_map(|service| {
                        let row = group.service(service);
                        row["why"].as_str().filter(|why| why.contains("disk")).map(|_| ())
                    })
                });
                wait_for("a status that says so", 10.0, || {
                    let ended = group.call(&["status", "--json"]);
                    (ended.code == Some(1) && ended.json()["state"] == "degraded").then_some(())
                });
                let ended = group.call(&["say", "hello"]);
                // Not accepted, or kept until there is space; it says so at once.
                assert!(ended.stderr.contains("free in"), "{ended:?}");
                disk.free();
                clock::now()
            });
            while !short.is_finished() {
                is_accepted("hello");
            }
            short.join().expect("the disk is freed")
        });
        wait_for("an utterance that is accepted again", 20.0, || {
            is_accepted("hello").then_some(())
        });
        assert!(clock::now().since(freed) < Span::from_ms(20_000), "it goes on by itself");
        wait_for("a ready group", 10.0, || (group.call(&["status"]).code == Some(0)).then_some(()));
        let now = services.map(|service| group.incarnation(service));
        assert_eq!(incarnations, now, "nobody died of it");
        let outcome = group.await_pick(Some("clear"));
        assert_delivered(&group, &outcome, "clear");
        assert_eq!(group.dialogue()["last"]["interaction"], asked);
        drop((receipts, writer, client));
        group.down();
    }

    #[test]
    #[ignore = "needs root, for a small disk"]
    fn full_disk_leaves_token_page_and_settings_as_they_are() {
        let SmallGroup { group, disk } = SmallGroup::up(&[]);
        let console = group.console();
        let incarnation = group.incarnation("console");
        let files = || {
            let folders = [group.paths().root().to_owned(), group.paths().run()];
            let names =
                |folder| std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
            let half = |path: &std::path::PathBuf| path.extension().is_some_and(|end| end == "new");
            folders.into_iter().flat_map(names).filter(half).collect::<Vec<_>>()
        };
        disk.fill();
        let renewed = group.call(&["console", "--renew"]);
        assert_eq!(renewed.code, Some(74), "{renewed:?}");
        assert!(renewed.stderr.contains("the former token stays"), "{renewed:?}");
        let reloaded = group.call(&["reload"]);
        assert_eq!(reloaded.code, Some(74), "{reloaded:?}");
        for words in ["No space left on device", "KiB free", "nothing was changed"] {
            assert!(reloaded.stderr.contains(words), "{reloaded:?}");
        }
        assert!(files().is_empty(), "{:?}", files());
        assert_eq!(http(&console, "GET", "/api/state", &[], "").0, 200);
        assert_eq!(group.incarnation("console"), incarnation);
        disk.free();
        let renewed = group.must(&["console", "--renew", "--json"]).json();
        assert_ne!(renewed["token"].as_str(), console.token.as_deref());
        group.must(&["reload"]);
        group.down();
    }

    #[test]
    #[ignore = "needs root, for a small shared memory"]
    fn arm_stops_with_full_shared_memory() {
        in_private_mounts("shortage::as_root::arm_stops_with_full_shared_memory", || {
            let group = Group::up(&[REAL_TIME]);
            let joints = JointWatch::open(&group);
            let shared_memory = SmallDisk::shared_memory();
            // A client that starts meanwhile finds no memory: this one waits for the outcome afterwards.
            group.say("the clear bowl");
            joints.wait_moving();
            shared_memory.fill();
            stop(&group, &joints);
            shared_memory.free();
            group.release_stop();
            assert_delivered(&group, &group.await_pick(None), "clear");
            drop(joints);
            group.down();
        });
    }
}
