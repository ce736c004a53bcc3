//! Settings that make a manager.

use super::*;

const ROBOT: (&str, &str) = ("dialogue.costs.from", "robot");

/// Decisions of a planner that was swapped in fold again, though the settings name another.
#[test]
fn decisions_of_a_planner_swapped_in_fold_again_with_it() {
    let settings = settings();
    let swapped_in = |key| settings.manager_of_key(key).unwrap().planner();
    assert_eq!(swapped_in(manager().key()), "lookahead");
    assert_eq!(swapped_in(1), "lookahead", "a key of other settings");
    let key = settings.manager_key("always-ask");
    assert_ne!(key, manager().key());
    assert_eq!(swapped_in(key), "always-ask");
}

#[test]
fn other_seconds_are_other_settings() {
    let key = |over: &[(&str, &str)]| settings_with(over).manager().unwrap().key();
    let slow = ("speech.voice_words_per_minute", "100");
    assert_eq!(key(&[]), key(&[slow]), "the voice decides nothing where costs are written");
    assert_ne!(key(&[ROBOT]), key(&[ROBOT, slow]));
}

/// A service reads the durations; it does not plan them again.
#[test]
fn snapshots_hold_the_durations() {
    let settings = settings_with(&[ROBOT, ("dialogue.mode", "present")]);
    let run = tempfile::tempdir().unwrap();
    settings.write_snapshot(run.path()).unwrap();
    let read = Settings::load_snapshot(run.path()).unwrap();
    assert_eq!(read.durations, settings.durations);
    let key = |settings: &Settings| settings.manager().unwrap().key();
    assert_eq!(key(&read), key(&settings));
}
