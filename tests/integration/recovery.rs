//! Any service is killed at any stage of a dialogue: no utterance is lost or counted twice, the right
//! object is picked once, and the journal folds to the same belief.

use rustix::process::{Pid, Signal};
use service::shm_cleanup::leftovers;
use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind};
use std::path::Path;
use std::process::{Child, Stdio};
use whichone_tests::{Group, wait_for};

const SERVICES: [&str; 4] = ["speech", "grounding", "policy", "arm"];

fn kill(group: &Group, service: &str) -> u64 {
    let before = group.incarnation(service);
    group.signal(service, Signal::KILL);
    before
}

fn assert_fetched(group: &Group, object: &str) {
    let outcome = group.await_pick(Some(object));
    assert_delivered(group, &outcome, object);
}

fn assert_delivered(group: &Group, outcome: &serde_json::Value, object: &str) {
    assert_eq!(outcome["outcome"], "delivered", "{outcome}\n{}", group.logs());
    assert_eq!(outcome["object"], object, "{outcome}");
    group.verify_journals();
}

#[test]
fn services_killed_at_any_stage_of_the_dialogue_recover() {
    let group = Group::up(&[]);
    let stages: [(&[&str], &[&str], &str); 3] = [
        (&[], &["get me the bowl"], "white2"),
        (&["get me the bowl"], &[], "metal2"),
        (&["get me the bowl", "the white one"], &[], "white3"),
    ];
    for (before, after, object) in stages {
        for service in SERVICES {
            before.iter().for_each(|words| group.say(words));
            if before.len() == 1 {
                group.wait_for_decision("ask");
            }
            kill(&group, service);
            after.iter().for_each(|words| group.say(words));
            assert_fetched(&group, object);
        }
    }
    group.down();
}

#[test]
fn services_killed_during_a_motion_recover() {
    let group = Group::up(&["arm.time_scale=15.0"]);
    for service in SERVICES {
        let outcome = group.fetch_while("the clear bowl", "clear", || {
            kill(&group, service);
        });
        assert_delivered(&group, &outcome, "clear");
    }
    group.down();
}

#[test]
fn arm_killed_repeatedly_in_one_pick_recovers() {
    let group = Group::up(&["arm.time_scale=8.0"]);
    let outcome = group.fetch_while("the clear bowl", "clear", || {
        for _ in 0..4 {
            let before = kill(&group, "arm");
            group.wait_for_restart("arm", before);
        }
    });
    assert_delivered(&group, &outcome, "clear");
    group.down();
}

#[test]
fn all_services_killed_at_once_recover() {
    let group = Group::up(&[]);
    group.say("get me the bowl");
    group.say("the metal one");
    for service in SERVICES {
        kill(&group, service);
    }
    assert_fetched(&group, "metal");
    group.down();
}

#[test]
fn utterances_wait_for_a_policy_that_is_down() {
    let group = Group::up(&[]);
    group.say("get me the bowl");
    group.must(&["stop", "policy"]);
    group.say("the small metal one");
    group.must(&["start", "policy"]);
    assert_fetched(&group, "metal");
    group.down();
}

#[test]
fn belief_is_restored_bit_for_bit() {
    // On a busy machine the question would be repeated meanwhile.
    let group = Group::up(&["dialogue.turns.response_window_s=600.0"]);
    group.say("the white one");
    // Whether the question has been heard is speech's part of the state.
    let heard_question = || {
        wait_for("a question that was heard", 20.0, || {
            Some(group.wait_for_decision("ask")).filter(|it| it["expects_answer"] == true)
        })
    };
    let before = heard_question();
    let incarnation = kill(&group, "policy");
    group.wait_for_restart("policy", incarnation);
    let after = heard_question();
    assert_eq!(before, after, "belief, question and reasons are the very same");
    group.down();
}

/// Removes the group's files in shared memory, or only those of topics.
fn clear_shared_memory(group: &Group, topics_only: bool) {
    for file in leftovers(group.paths()) {
        let is_topic = file.extension().is_some_and(|extension| extension == "dynamic");
        match file.is_dir() {
            _ if topics_only && !is_topic => {}
            true => remove_folder(&file),
            false => remove_file(&file),
        }
    }
}

/// Removes a file that its group may remove meanwhile.
fn remove_file(file: &Path) {
    if let Err(error) = std::fs::remove_file(file) {
        assert_eq!(error.kind(), ErrorKind::NotFound, "{}", file.display());
    }
}

/// Removes a folder in which services may make files meanwhile.
fn remove_folder(folder: &Path) {
    while let Err(error) = std::fs::remove_dir_all(folder) {
        assert_eq!(error.kind(), ErrorKind::DirectoryNotEmpty, "{}", folder.display());
    }
}

#[test]
fn cleared_shared_memory_is_noticed_whatever_was_made_again() {
    for topics_only in [false, true] {
        let group = Group::up(&[]);
        let before = group.incarnation("policy");
        if !topics_only {
            // What the successors make hides what is gone.
            for service in SERVICES {
                kill(&group, service);
            }
        }
        clear_shared_memory(&group, topics_only);
        let log = group.paths().log().join("supervisor.log");
        wait_for("the supervisor to notice", 30.0, || {
            let text = std::fs::read_to_string(&log).unwrap();
            text.contains("files of the running group are gone").then_some(())
        });
        group.wait_for_restart("policy", before);
        assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
        group.verify_journals();
        group.down();
    }
}

#[test]
fn interaction_survives_down_and_up() {
    let mut group = Group::up(&[]);
    group.say("get me the bowl");
    group.say("the white one");
    wait_for("both to be applied", 10.0, || (group.dialogue()["applied"] == 2).then_some(()));
    group.must(&["down"]);
    assert_eq!(group.start(&[]).code, Some(0));
    assert_fetched(&group, "white3");
    group.down();
}

#[test]
fn client_that_outlives_a_group_takes_nothing_of_the_next_one() {
    let mut group = Group::up(&[]);
    group.fetch("the clear bowl", "clear");
    let folder = tempfile::tempdir().unwrap();
    let seen = folder.path().join("seen");
    let mut clients = [&["watch", "--json"][..], &["await", "pick", "--json"]].map(|words| {
        let output = File::options().append(true).create(true).open(&seen).unwrap();
        group.command(words).stdout(output).stderr(Stdio::null()).spawn().unwrap()
    });
    let name = group.paths().shm_name().unwrap();
    for client in &clients {
        wait_for("the client to join", 20.0, || {
            let maps = std::fs::read_to_string(format!("/proc/{}/maps", client.id())).unwrap();
            maps.contains(name.prefix()).then_some(())
        });
    }
    wait_for("the client to look", 20.0, || {
        (std::fs::metadata(&seen).unwrap().len() > 0).then_some(())
    });
    // They wake in the life of the next group, and end there.
    let signal = |client: &Child, signal| {
        rustix::process::kill_process(Pid::from_child(client), signal).unwrap();
    };
    clients.iter().for_each(|client| signal(client, Signal::STOP));
    group.must(&["down"]);
    assert_eq!(group.start(&[]).code, Some(0));
    clients.iter().for_each(|client| signal(client, Signal::CONT));
    for client in &mut clients {
        wait_for("the client to end", 20.0, || client.try_wait().unwrap());
        group.say("hello");
    }
    assert_eq!(group.fetch("get me the metal bowl", "metal")["object"], "metal");
    group.down();
}

#[test]
fn killed_clients_leave_their_places_to_others() {
    let group = Group::up(&[]);
    for _ in 0..messages::topics::READERS_MAX + 2 {
        let mut client =
            group.command(&["watch", "--json"]).stdout(Stdio::piped()).spawn().unwrap();
        let mut first = String::new();
        BufReader::new(client.stdout.take().unwrap()).read_line(&mut first).unwrap();
        client.kill().unwrap();
        client.wait().unwrap();
        // Refused, because every place is taken for now: there is nothing more to take.
        if first.is_empty() {
            break;
        }
    }
    wait_for("places for a new client", 10.0, || {
        (group.call(&["watch", "--once", "--json"]).code == Some(0)).then_some(())
    });
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.down();
}
