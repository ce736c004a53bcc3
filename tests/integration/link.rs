//! A robot over the link: robot, router and mirror on this machine, over QUIC.

use rustix::process::Signal;
use serde_json::Value;
use std::time::Instant;
use whichone_tests::link::{Mirror, Relay, fuzzed_peer};
use whichone_tests::{Group, wait_for};

mod far;
mod link_gateway;

/// Time in which everything is back after a failure, seconds.
const BACK_S: f64 = 20.0;

/// Checks that so many utterances were accepted, none of them twice.
fn check_accepted(robot: &Group, expected: u64) {
    let journal = robot.must(&["journal", "speech", "--json"]).stdout;
    let lines = journal.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    let accepted = lines.filter(|line| line["record"]["type"] == "accepted");
    let mut keys: Vec<String> = accepted
        .map(|line| format!("{} {}", line["record"]["key"], line["record"]["segment"]))
        .collect();
    keys.sort();
    assert_eq!(keys.len() as u64, expected, "utterances in the journal");
    keys.dedup();
    assert_eq!(keys.len() as u64, expected, "an utterance was accepted twice");
}

#[test]
#[ignore = "needs whichone-link, which scripts/link builds"]
fn link_dialogue_at_a_mirror_ends_in_the_right_pick() {
    let relay = Relay::start(&["--robot", "r1", "--operator", "ann"]);
    let robot = relay.robot_up("r1", &[]);
    let mirror = Mirror::start("r1", &relay.person("ann"));
    for object in ["white2", "clear"] {
        let outcome = mirror.group.fetch("get me the bowl", object);
        assert_eq!(
            (&outcome["outcome"], &outcome["object"]),
            (&"delivered".into(), &object.into())
        );
    }
    // Both show the same dialogue, and every utterance was applied once.
    let there = robot.dialogue();
    let here = wait_for("the same dialogue here and there", 10.0, || {
        let here = mirror.group.dialogue();
        (here["applied"] == there["applied"] && here["belief"] == there["belief"]).then_some(here)
    });
    assert!(here["applied"].as_u64().unwrap() >= 4, "{here}");
    check_accepted(&robot, here["applied"].as_u64().unwrap());
    // A service's name stands for the robot's, and orders for it are refused with the reason.
    let ended = mirror.group.call(&["restart", "policy"]);
    assert!(ended.stderr.contains("mirrors robot r1"), "{ended:?}");
    robot.verify_journals();
    let listed = relay.fleet(&relay.person("ann")).json();
    let robot_of_it = &listed["robots"][0];
    assert_eq!(robot_of_it["robot"], "r1", "{listed}");
    assert_eq!(robot_of_it["presence"]["dialogue"], "idle", "{listed}");
    mirror.down();
    robot.down();
}

/// A stop from the mirror halts the robot; a release from there lifts it, also one given at the robot.
#[test]
#[ignore = "needs whichone-link, which scripts/link builds"]
fn link_motion_stop_works_from_a_mirror() {
    let relay = Relay::start(&["--robot", "r1", "--operator", "ann"]);
    let robot = relay.robot_up("r1", &["arm.time_scale=1"]);
    let mirror = Mirror::start("r1", &relay.person("ann"));
    mirror.group.say("get me the clear bowl");
    wait_for("a moving arm", 20.0, || (robot.arm()["moving"] == true).then_some(()));
    let began = Instant::now();
    let state = mirror.group.must(&["stop-motion", "--json"]).json();
    println!("stop at the mirror to arm at rest: {:.0} ms", began.elapsed().as_secs_f64() * 1e3);
    assert_eq!((&state["stopped"], &state["at_rest"]), (&true.into(), &true.into()), "{state}");
    robot.wait_shown(true);
    let is_shown = || (mirror.group.arm()["stopped"] == true).then_some(());
    wait_for("the stop at the mirror", 5.0, is_shown);
    let is_free = || (robot.arm()["stopped"] == false).then_some(());
    wait_for("a release from the mirror", 10.0, || {
        (mirror.group.call(&["resume-motion"]).code == Some(0)).then_some(())
    });
    wait_for("an arm that may move", 5.0, is_free);
    robot.must(&["stop-motion"]);
    wait_for("the robot's own stop at the mirror", 5.0, is_shown);
    // The state on which a release is based comes twice a second.
    wait_for("a release of the robot's own stop", 10.0, || {
        (mirror.group.call(&["resume-motion"]).code == Some(0)).then_some(())
    });
    wait_for("an arm that may move", 5.0, is_free);
    assert_eq!(mirror.group.await_pick(None)["outcome"], "delivered");
    mirror.down();
    robot.down();
}

/// Waits until the list that these keys get names exactly these robots, all of them answering.
fn wait_listed(relay: &Relay, person: &str, robots: &[&str]) {
    wait_for("the robots in the list", BACK_S, || {
        let ended = relay.fleet(&relay.person(person));
        let list = (ended.code == Some(0)).then(|| ended.json())?;
        let list = list["robots"].as_array()?;
        let is_whole = list.iter().all(|robot| robot["presence"].is_object());
        let names = list.iter().filter_map(|robot| robot["robot"].as_str());
        (is_whole && names.eq(robots.iter().copied())).then_some(())
    });
}

/// Replaces a value of a folder's `link.json`.
fn forge(folder: &std::path::Path, key: &str, value: &str) {
    let path = folder.join("link.json");
    let mut link: Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    link[key] = value.into();
    std::fs::write(path, link.to_string()).unwrap();
}

#[test]
#[ignore = "needs whichone-link, which scripts/link builds"]
fn link_refuses_wrong_keys() {
    let people = ["--operator", "ann", "--operator", "eve", "--operator", "mallory"];
    let relay = Relay::start(&[&["--robot", "r1", "--robot", "r2"], &people[..]].concat());
    relay.init(&["--viewer", "bob"]);
    relay.init(&["--operator", "carl", "--for", "r2"]);
    let mut relay = relay;
    relay.kill_router();
    relay.start_router();
    // A robot cannot speak for another one, neither with its own keys nor with a changed name.
    std::thread::scope(|scope| {
        let peer = scope.spawn(|| fuzzed_peer(&relay.robot("r2"), "r1", 1, 4.0));
        while !peer.is_finished() {
            let listed = relay.fleet(&relay.person("ann"));
            assert_eq!(listed.json()["robots"].as_array().map(Vec::len), Some(0), "{listed:?}");
        }
        assert_eq!(peer.join().unwrap().code, Some(0));
    });
    forge(&relay.robot("r2"), "name", "r1");
    assert_ne!(fuzzed_peer(&relay.robot("r2"), "r1", 1, 1.0).code, Some(0));
    let robot = relay.robot_up("r1", &[]);
    wait_listed(&relay, "ann", &["r1"]);
    // A wrong password.
    forge(&relay.person("eve"), "password", "0123456789abcdef");
    let refused = relay.fleet(&relay.person("eve"));
    assert_eq!(refused.code, Some(1), "{refused:?}");
    assert!(refused.stderr.contains("no connection"), "{refused:?}");
    // The certificate of another authority, with the right password.
    let other = Relay::start(&["--robot", "r1", "--operator", "mallory"]);
    for file in ["certificate.pem", "key.pem"] {
        let (from, to) = (other.person("mallory").join(file), relay.person("mallory").join(file));
        std::fs::copy(from, to).unwrap();
    }
    assert_eq!(relay.fleet(&relay.person("mallory")).code, Some(1));
    // Another one's robot is neither listed nor mirrored.
    let listed = relay.fleet(&relay.person("carl")).json();
    assert_eq!(listed["robots"].as_array().map(Vec::len), Some(0));
    let mut foreign = Mirror::launch("r1", &relay.person("carl"));
    // A viewer sees, and is neither heard nor obeyed.
    let viewer = Mirror::start("r1", &relay.person("bob"));
    let before = robot.dialogue()["applied"].clone();
    assert_ne!(viewer.group.call(&["say", "get me the bowl", "--timeout", "4"]).code, Some(0));
    assert_ne!(viewer.group.call(&["stop-motion", "--timeout", "4"]).code, Some(0));
    assert_eq!(robot.dialogue()["applied"], before);
    assert_eq!(robot.arm()["stopped"], false);
    assert!(foreign.runs(), "it waits for a robot that it may see");
    assert!(!foreign.group.paths().run().exists(), "nothing of the robot was shown");
    viewer.down();
    drop(foreign);
    robot.down();
}

#[test]
#[ignore = "needs whichone-link, which scripts/link builds"]
fn link_is_back_by_itself() {
    let mut relay = Relay::start(&["--robot", "r1", "--operator", "ann"]);
    let mut robot = relay.robot_up("r1", &[]);
    let mirror = Mirror::start("r1", &relay.person("ann"));
    let back = |what: &str, robot: &Group| {
        let began = Instant::now();
        wait_for("words that arrive", BACK_S, || {
            let said = mirror.group.call(&["say", "hello", "--timeout", "3"]);
            (said.code == Some(0)).then_some(())
        });
        println!("{what}: words arrive again after {:.1} s", began.elapsed().as_secs_f64());
        mirror.wait_ready(BACK_S);
        let outcome = mirror.group.fetch("get me the bowl", "white2");
        assert_eq!(outcome["object"], "white2", "{what}: {outcome}");
        robot.verify_journals();
    };
    back("at first", &robot);
    robot.signal("link", Signal::KILL);
    back("robot's link killed", &robot);
    relay.kill_router();
    relay.start_router();
    back("router killed", &robot);
    robot.must(&["down"]);
    let own = relay.settings("r1");
    let started = robot.start(&own.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(started.code, Some(0), "{started:?}");
    back("robot's group started again", &robot);
    mirror.down();
    robot.down();
}

/// A peer with valid keys sends nonsense to a robot, and one with the robot's keys to its mirrors.
#[test]
#[ignore = "needs whichone-link, which scripts/link builds"]
fn link_fuzzed_peer_harms_nothing() {
    let relay = Relay::start(&["--robot", "r1", "--operator", "ann", "--operator", "eve"]);
    let robot = relay.robot_up("r1", &[]);
    let mirror = Mirror::start("r1", &relay.person("ann"));
    robot.must(&["stop-motion"]);
    let before = robot.incarnation("link");
    std::thread::scope(|scope| {
        let keys = [relay.person("eve"), relay.person("eve"), relay.robot("r1")];
        let peers = keys.map(|keys| {
            let seed = keys.as_os_str().len() as u64;
            scope.spawn(move || fuzzed_peer(&keys, "r1", seed, 10.0))
        });
        for peer in peers {
            let ended = peer.join().unwrap();
            assert_eq!(ended.code, Some(0), "{ended:?}");
        }
    });
    assert_eq!(robot.incarnation("link"), before, "{}", robot.logs());
    assert_eq!(robot.arm()["stopped"], true, "a nonsensical release was obeyed");
    wait_for("no sound files that are left", 10.0, || {
        let mut files = std::fs::read_dir(robot.paths().run()).unwrap().filter_map(Result::ok);
        let is_left = files.any(|file| file.file_name().to_string_lossy().starts_with("link-"));
        (!is_left).then_some(())
    });
    mirror.wait_ready(BACK_S);
    wait_for("a release from the mirror", 10.0, || {
        (mirror.group.call(&["resume-motion"]).code == Some(0)).then_some(())
    });
    let outcome = mirror.group.fetch("get me the bowl", "white2");
    assert_eq!(outcome["object"], "white2", "{outcome}");
    robot.verify_journals();
    mirror.down();
    robot.down();
}

/// Copies a folder of keys aside.
fn copied(folder: &std::path::Path) -> tempfile::TempDir {
    let copy = tempfile::tempdir().unwrap();
    for file in std::fs::read_dir(folder).unwrap() {
        let file = file.unwrap();
        std::fs::copy(file.path(), copy.path().join(file.file_name())).unwrap();
    }
    copy
}

/// The steps of docs/remote.md, "Renewing and revoking".
#[test]
#[ignore = "needs whichone-link, which scripts/link builds"]
fn link_renewed_keys_replace_the_old_ones_and_revoked_ones_end() {
    let people = ["--operator", "ann", "--operator", "carl", "--operator", "bob"];
    let mut relay = Relay::start(&[&["--robot", "r1", "--robot", "r2"], &people[..]].concat());
    let robots = ["r1", "r2"].map(|name| relay.robot_up(name, &[]));
    let mirror = Mirror::start("r1", &relay.person("carl"));
    wait_listed(&relay, "ann", &["r1", "r2"]);
    let old = ["ann", "bob"].map(|name| copied(&relay.person(name)));
    relay.init(&["--renew", "ann", "--renew", "r2", "--revoke", "bob"]);
    assert!(!relay.person("bob").exists());
    // Until its next start the router goes by what it has read.
    assert_eq!(relay.fleet(old[1].path()).code, Some(0));
    relay.kill_router();
    relay.start_router();
    let began = Instant::now();
    wait_listed(&relay, "ann", &["r1"]);
    println!(
        "router started again: a robot with old keys is back after {:.1} s",
        began.elapsed().as_secs_f64()
    );
    for (folder, name) in old.iter().zip(["ann, with old keys", "bob, revoked"]) {
        let refused = relay.fleet(folder.path());
        assert_eq!(refused.code, Some(1), "{name}: {refused:?}");
    }
    // A robot reads its new keys when its link is started again.
    robots[1].must(&["restart", "link"]);
    wait_listed(&relay, "ann", &["r1", "r2"]);
    mirror.wait_ready(BACK_S);
    mirror.group.must(&["say", "hello"]);
    mirror.down();
    robots.into_iter().for_each(Group::down);
}
