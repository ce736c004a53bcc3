//! Every way to stop the arm in every state of the group: a stop that was accepted is followed by a latch, and
//! nothing moves after "stopped" was shown or said.

#![allow(clippy::print_stdout, reason = "the pairs that were tried, for the log")]

use serde_json::json;
use service::clock;
use states::{During, STATES};
use std::time::Instant;
use ways::{Givers, Way};
use whichone_tests::motion_watch::MotionWatch;
use whichone_tests::shortage::{SmallDisk, SmallGroup};
use whichone_tests::{Group, wait_for};

mod signals;
mod states;
mod ways;

/// Real time, so that there is a motion to be stopped; restarts that back off as on a robot.
const SETTINGS: [&str; 2] = ["arm.time_scale=1.0", "group.restart.backoff_max_ms=2000"];
/// Time in which nothing may move after a stop, seconds.
const REST_S: f64 = 1.0;

/// A group with an arm that moves, in which stops are given.
struct Trial {
    group: Group,
    watch: MotionWatch,
    givers: Givers,
    disk: Option<SmallDisk>,
}

impl Trial {
    /// Begins in a group of its own, for these ways.
    fn begin(ways: &[Way]) -> Self {
        let givers = Givers::of(ways, &SETTINGS);
        let group = Group::up(&givers.settings());
        Self::join(ways, givers, group, None)
    }

    /// As [`Trial::begin`], on a disk that can be filled.
    fn begin_on_a_small_disk(ways: &[Way]) -> Self {
        let givers = Givers::of(ways, &SETTINGS);
        let SmallGroup { group, disk } = SmallGroup::up(&givers.settings());
        Self::join(ways, givers, group, Some(disk))
    }

    fn join(ways: &[Way], mut givers: Givers, group: Group, disk: Option<SmallDisk>) -> Self {
        let watch = MotionWatch::start(group.paths());
        givers.join(ways, &group);
        Self { group, watch, givers, disk }
    }

    fn run_all(&self, pairs: &[(Way, During)]) {
        for (way, during) in pairs {
            let begun = Instant::now();
            self.run(*way, *during);
            println!("{way:?} during {during:?}: stopped, {:.1} s", begun.elapsed().as_secs_f64());
        }
    }

    /// Gives a stop while the arm fetches, checks its effect, and lets the arm go on.
    fn run(&self, way: Way, during: During) {
        let what = format!("{way:?} during {during:?}");
        let Self { group, watch, .. } = self;
        self.fetch();
        let report = self.give(way, during);
        let logs = || format!("{what}: {report:?}: {}\n{}", report.text, group.logs());
        assert!(report.is_accepted, "not accepted: {}", logs());
        if during != During::Race {
            watch.wait_stopped(&what);
            let rests = clock::now();
            watch.wait_states(rests, REST_S);
            assert_eq!(
                watch.movements_since(rests),
                0,
                "it moves after it was stopped: {}",
                logs()
            );
        }
        let shown = report.stopped.into_iter().chain(watch.said_stopped());
        if let Some(shown) = shown.min().filter(|_| during != During::Race) {
            assert_eq!(watch.movements_since(shown), 0, "it moves after \"stopped\": {}", logs());
        }
        if way.is_words() && during != During::Race {
            wait_for("the robot's report", 10.0, || watch.said_stopped());
        }
        self.finish();
    }

    /// Has the arm move.
    fn fetch(&self) {
        self.group.say("get me the clear bowl");
        self.watch.wait_moving();
        self.watch.clear();
    }

    /// Releases the stop and has the arm give up what it fetches.
    fn finish(&self) {
        self.group.release_stop();
        self.group.say("never mind");
        wait_for("an idle arm", 30.0, || {
            let status = self.watch.status();
            let rests = status.stopped == 0 && status.moving == 0;
            let is_over = self.group.dialogue()["interaction"].as_u64() == Some(0);
            (rests && is_over).then_some(())
        });
    }

    fn down(self) {
        let Self { group, watch, givers, disk } = self;
        drop((watch, givers));
        group.down();
        drop(disk);
    }
}

/// Runs these pairs in one group.
fn run_all(ways: &[Way], pairs: &[(Way, During)]) {
    let trial = Trial::begin(ways);
    trial.run_all(pairs);
    trial.group.verify_journals();
    trial.down();
}

/// Runs these ways in a group whose disk is full while the stop is given.
fn run_on_a_full_disk(ways: &[Way]) {
    let trial = Trial::begin_on_a_small_disk(ways);
    let pairs: Vec<_> = ways.iter().map(|way| (*way, During::FullDisk)).collect();
    trial.run_all(&pairs);
    trial.down();
}

fn states_without_a_disk() -> impl Iterator<Item = During> {
    STATES.into_iter().filter(|during| *during != During::FullDisk)
}

/// Each way once, and each state once: words for the arm's outages, and what a suspended process makes wait.
const EACH_ONCE: [(Way, During); 12] = [
    (Way::Words, During::Nothing),
    (Way::Words, During::ArmKilled),
    (Way::Chat, During::ArmRestarted),
    (Way::Words, During::ArmHeld),
    (Way::Socket, During::ArmSwapped),
    (Way::Python, During::ArmInBackoff),
    (Way::Ros2, During::SupervisorKilled),
    (Way::Gateway, During::SupervisorKilled),
    (Way::Study, During::Suspended("policy")),
    (Way::Spoken, During::Suspended("speech")),
    (Way::Page, During::Suspended("console")),
    (Way::CommandLine, During::Race),
];

#[test]
fn each_way_stops_the_arm_and_each_state_lets_it_be_stopped() {
    let ways = Way::all_here();
    // Words stand in for a way that is not here.
    let present = |way| if ways.contains(&way) { way } else { Way::Words };
    run_all(&ways, &EACH_ONCE.map(|(way, during)| (present(way), during)));
}

/// Every way in every state.
#[test]
#[ignore = "it takes minutes"]
fn every_way_stops_the_arm_in_every_state() {
    let ways = Way::all_here();
    let pairs: Vec<_> = states_without_a_disk()
        .flat_map(|during| ways.iter().map(move |way| (*way, during)))
        .collect();
    run_all(&ways, &pairs);
}

mod as_root {
    use super::*;

    #[test]
    fn words_stop_the_arm_on_a_full_disk() {
        run_on_a_full_disk(&[Way::Words]);
    }

    #[test]
    #[ignore = "it takes a minute"]
    fn every_way_stops_the_arm_on_a_full_disk() {
        run_on_a_full_disk(&Way::all_here());
    }
}

/// The words of the smallest case: nothing fails, and the arm's service is away.
#[test]
fn said_stop_waits_for_an_arm_that_is_held() {
    let trial = Trial::begin(&[]);
    trial.group.say("get me the clear bowl");
    trial.watch.wait_moving();
    trial.group.must(&["hold", "arm"]);
    trial.watch.clear();
    let ended = trial.group.call(&["say", "stop", "--timeout", "2"]);
    assert_eq!(ended.code, Some(1), "{ended:?}");
    for words in ["not confirmed", "arm is held", "the stop is kept"] {
        assert!(ended.stderr.contains(words), "{words}: {ended:?}");
    }
    wait_for("the robot's warning", 10.0, || {
        trial.watch.line().contains("has not confirmed the stop").then_some(())
    });
    assert_eq!(trial.watch.said_stopped(), None);
    trial.group.must(&["release", "arm"]);
    trial.watch.wait_stopped("the arm's latch");
    wait_for("the robot's report", 10.0, || trial.watch.said_stopped());
    let answer = trial.group.call(&["watch", "--once", "--json"]).json();
    assert_eq!(answer["arm"]["stopped"], json!(true), "{answer}");
    trial.down();
}

/// The client waits for the speech service alone: a held arm takes no words from it.
#[test]
fn said_stop_outlasts_a_suspended_speech_service_while_the_arm_is_held() {
    let trial = Trial::begin(&[]);
    trial.fetch();
    trial.enter(During::ArmHeld);
    let report = trial.give(Way::Words, During::Suspended("speech"));
    assert!(report.is_accepted, "{report:?}");
    assert!(report.text.contains("arm is held"), "what keeps it from being obeyed: {report:?}");
    trial.group.must(&["release", "arm"]);
    trial.watch.wait_stopped("the arm's latch");
    trial.down();
}
