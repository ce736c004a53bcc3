//! Signals that end the group, as Ctrl-C of `whichone up` does: the arm comes to rest before its service ends, and
//! nothing moves until a person starts the group again. A signal is no order to the motion stop: it latches nothing.

use super::states::During;
use super::{Trial, states_without_a_disk};
use rustix::process::{Signal, kill_process};
use service::clock;
use std::thread;
use whichone_tests::wait_for;

const SIGNALS: [Signal; 3] = [Signal::INT, Signal::TERM, Signal::HUP];

/// Ends the group in that state while the arm fetches, checks that it rests, and starts the group again.
fn end(trial: &Trial, signal: Signal, during: During) {
    let Trial { group, watch, .. } = trial;
    let what = format!("{signal:?} during {during:?}");
    trial.fetch();
    let supervisor = trial.supervisor();
    thread::scope(|scope| {
        trial.enter(during);
        if during == During::ArmRestarted {
            scope.spawn(|| group.call(&["restart", "arm"]));
        }
        // Of a killed supervisor the services learn by themselves.
        if during != During::SupervisorKilled {
            kill_process(supervisor, signal).unwrap();
        }
    });
    wait_for(&what, 20.0, || group.processes().is_empty().then_some(()));
    let ended = clock::now();
    // A killed service leaves its arm where the robot halts it.
    let is_killed = matches!(during, During::ArmKilled | During::ArmInBackoff);
    assert!(is_killed || watch.rests(), "{what}: the arm did not come to rest\n{}", group.logs());
    assert_eq!(watch.movements_since(ended), 0, "{what}");
    if let Some(disk) = &trial.disk {
        disk.free();
    }
    trial.start_again();
    println!("{what}: at rest");
    trial.finish();
}

#[test]
fn signals_that_end_the_group_stop_the_arm() {
    let trial = Trial::begin(&[]);
    end(&trial, Signal::INT, During::Nothing);
    trial.down();
}

#[test]
#[ignore = "it takes minutes"]
fn signals_stop_the_arm_in_every_state() {
    let trial = Trial::begin(&[]);
    let states = states_without_a_disk();
    // A swapped arm has restarted, and nothing races with the end.
    let states = states.filter(|during| !matches!(during, During::ArmSwapped | During::Race));
    for (signal, during) in SIGNALS.into_iter().cycle().zip(states) {
        end(&trial, signal, during);
    }
    trial.down();
}

mod as_root {
    use super::*;

    #[test]
    #[ignore = "it takes minutes"]
    fn signals_stop_the_arm_in_every_state_of_the_disk() {
        let trial = Trial::begin_on_a_small_disk(&[]);
        SIGNALS.into_iter().for_each(|signal| end(&trial, signal, During::FullDisk));
        trial.down();
    }
}
