//! The study's rules: every path of verbs and of what the robot does.

mod simulated_study;

use messages::{ActKind, Outcome};
use scene::Scene;
use serde_json::{Map, json};
use user_study::Verdict;
use user_study::{Event, Participant, Protocol, Stage, Status};
use vocabulary::Rng;

use super::section::StudySection;
use super::study_controller::{Command, StudyController};
use super::trial_monitor::RobotRequest;
use simulated_study::{FAULT_MS, PAGE, SimulatedStudy, protocol};

fn quick(points: u8) -> Map<String, serde_json::Value> {
    Map::from_iter([("quick".to_owned(), json!(points))])
}

/// From the beginning to the thanks, every interaction right.
fn take_part(study: &mut SimulatedStudy) {
    study.ask(&Command::Begin).unwrap();
    study.ask(&Command::Consent).unwrap();
    let mut seq = 0;
    while study.stage() != Some(Stage::Questionnaire) {
        study.ask(&Command::Next).unwrap();
        if study.stage() != Some(Stage::Drawn) {
            continue;
        }
        study.grant();
        study.ask(&Command::Start).unwrap();
        seq += 1;
        study.say(seq);
        study.ms += 5e3;
        study.view.decision = ActKind::Pick;
        study.look();
        let desired = study.desired();
        study.end(Outcome::Delivered, Some(&desired));
        study.look();
        study.check();
    }
    study.ask(&Command::Answer(quick(4))).unwrap();
    study.grant();
    study.check();
}

#[test]
fn study_runs_from_the_consent_to_the_thanks() {
    let mut study = SimulatedStudy::new(protocol());
    take_part(&mut study);
    let person = study.controller.of_page(PAGE).unwrap();
    assert_eq!((person.status(), person.counted().count()), (Status::Complete, 4));
    assert_eq!(person.trials.len(), 5, "one of practice");
    let policies: Vec<&str> = person.counted().map(|t| t.step.policy.as_str()).collect();
    assert_eq!(policies, ["lookahead", "lookahead", "entropy", "entropy"]);
    let trial = &person.trials[1];
    assert_eq!((trial.verdict(), trial.seconds()), (Some(Verdict::Right), Some(10.0)));
    assert_eq!((trial.questions(), trial.utterances()), (2, 3));
    assert_eq!((person.switched.clone(), study.view.planner.as_str()), (None, "lookahead"));
    assert_eq!(person.answers["quick"], 4);
}

#[test]
fn study_resumes_the_active_participant_and_queues_the_next() {
    let mut study = SimulatedStudy::new(protocol());
    let code = study.ask(&Command::Begin).unwrap();
    assert_eq!(study.ask(&Command::Begin), Ok(code.clone()), "a reload changes nothing");
    let other = "f".repeat(32);
    assert!(study.ask_as(&other, &Command::Begin).unwrap_err().contains("wait"));
    assert!(study.ask_as(&other, &Command::Consent).is_err());
    assert!(study.ask_as(&other, &Command::Resume("WRONG".to_owned())).is_err());
    study.ask_as(&other, &Command::Resume(code.to_lowercase())).unwrap();
    study.ask_as(&other, &Command::Consent).unwrap();
    assert!(study.ask(&Command::Next).is_err(), "the first page has lost it");
    study.ask_as(&other, &Command::Close(code)).unwrap();
    study.ask(&Command::Begin).unwrap();
    study.check();
}

#[test]
fn study_waits_for_a_ready_robot_and_cancels_open_goals() {
    let mut study = SimulatedStudy::new(protocol());
    study.ask(&Command::Begin).unwrap();
    study.ask(&Command::Consent).unwrap();
    study.view.interaction = 7;
    study.ask(&Command::Next).unwrap();
    assert!(study.ask(&Command::Start).is_err());
    assert_eq!(study.controller.request(&study.robot()), Some(RobotRequest::Cancel));
    study.end(Outcome::Cancelled, None);
    study.missing = Some("arm");
    assert!(study.ask(&Command::Start).is_err());
    study.missing = None;
    study.view.planner = "optimal".to_owned();
    assert_eq!(
        study.controller.request(&study.robot()),
        Some(RobotRequest::Switch("lookahead".to_owned()))
    );
    assert!(study.ask(&Command::Start).is_err());
    study.grant();
    study.ask(&Command::Start).unwrap();
    let trial = study.controller.active().unwrap().trial().unwrap();
    assert_eq!((trial.after, study.stage()), (7, Some(Stage::Running)));
}

/// A stop is not "busy": nothing but a person ends it.
#[test]
fn study_says_that_the_robot_is_stopped_whatever_else_it_waits_for() {
    let mut study = SimulatedStudy::new(protocol());
    for ask in [Command::Begin, Command::Consent, Command::Next] {
        study.ask(&ask).unwrap();
    }
    study.arm_is_stopped = true;
    let refused = study.ask(&Command::Start).unwrap_err();
    assert!(refused.contains("call the experimenter"), "{refused}");
    let section = |study: &SimulatedStudy| {
        serde_json::to_value(StudySection::new(&study.controller, &study.robot(), None)).unwrap()
    };
    study.view.interaction = 7;
    assert_eq!(section(&study)["active"]["trial"]["waits_for"], "stopped");
    assert_eq!(study.controller.request(&study.robot()), Some(RobotRequest::Cancel));
    study.arm_is_stopped = false;
    assert_eq!(section(&study)["active"]["trial"]["waits_for"], "busy");
    study.end(Outcome::Cancelled, None);
    study.ask(&Command::Start).unwrap();
}

/// The policy of the one before is given back first: else it would go in the middle of an interaction.
#[test]
fn study_restores_the_policy_before_the_next_participant() {
    let mut study = SimulatedStudy::new(Protocol { warmup: 0, ..protocol() });
    let id = study.ask(&Command::Begin).unwrap();
    study.write(&id, vec![Event::Switched { planner: "lookahead".to_owned() }]);
    study.ask(&Command::Withdraw(false)).unwrap();
    let next = "e".repeat(32);
    for ask in [Command::Begin, Command::Consent, Command::Next] {
        study.ask_as(&next, &ask).unwrap();
    }
    let trial = study.controller.active().unwrap().trial().unwrap();
    study.view.planner = trial.step.policy.clone();
    assert!(study.ask_as(&next, &Command::Start).is_err());
    assert_eq!(study.controller.request(&study.robot()), Some(RobotRequest::Restore(id)));
    study.grant();
    study.ask_as(&next, &Command::Start).unwrap();
}

/// A participant who has just begun an interaction.
fn running(seconds_max: f64) -> SimulatedStudy {
    let mut study = SimulatedStudy::new(Protocol { seconds_max, warmup: 0, ..protocol() });
    study.ask(&Command::Begin).unwrap();
    study.ask(&Command::Consent).unwrap();
    study.ask(&Command::Next).unwrap();
    study.ask(&Command::Start).unwrap();
    study
}

fn outcome_of(study: &SimulatedStudy) -> String {
    let person = study.controller.of_page(PAGE).unwrap();
    let json = user_study::to_json(std::slice::from_ref(person));
    json["participants"][0]["trials"][0]["outcome"].as_str().unwrap().to_owned()
}

#[test]
fn study_distinguishes_the_ends_of_an_interaction() {
    let ends = [
        (Outcome::Failed, "failed"),
        (Outcome::Cancelled, "cancelled"),
        (Outcome::Abandoned, "abandoned"),
        (Outcome::NotHere, "not_here"),
        (Outcome::SceneChanged, "fault"),
    ];
    for (outcome, name) in ends {
        let mut study = running(60.0);
        study.say(1);
        study.end(outcome, None);
        study.look();
        assert_eq!((outcome_of(&study).as_str(), study.stage()), (name, Some(Stage::Over)));
    }
    let mut study = running(60.0);
    study.say(1);
    study.end(Outcome::Delivered, Some("not what was desired"));
    study.look();
    assert_eq!(outcome_of(&study), "wrong");
}

#[test]
fn study_ends_and_cancels_an_interaction_at_its_time_limit() {
    for says in [true, false] {
        let mut study = running(60.0);
        if says {
            study.say(1);
        }
        study.ms += 59e3;
        study.look();
        assert_eq!(study.stage(), Some(Stage::Running));
        study.ms += 2e3;
        study.look();
        assert_eq!(outcome_of(&study), "too_long");
        assert_eq!(study.controller.request(&study.robot()), says.then_some(RobotRequest::Cancel));
    }
}

#[test]
fn study_repeats_an_interaction_after_a_technical_fault() {
    let faults: [fn(&mut SimulatedStudy); 5] = [
        |study| {
            study.missing = Some("grounding");
            study.look();
            study.ms += FAULT_MS + 1.0;
        },
        |study| study.view.planner = "optimal".to_owned(),
        |study| {
            let text = include_str!("../../../config/scenes/tools.toml");
            study.scene = Scene::from_toml("tools.toml", text).unwrap();
        },
        |study| {
            study.end(Outcome::Cancelled, None);
            study.say(2);
            study.end(Outcome::Cancelled, None);
        },
        |study| {
            let id = study.controller.active().unwrap().id().to_owned();
            study.ask_as("", &Command::Spoilt(id, "the lights went out".to_owned())).unwrap();
        },
    ];
    for (n, fault) in faults.into_iter().enumerate() {
        let mut study = running(600.0);
        study.say(1);
        fault(&mut study);
        study.look();
        assert_eq!(outcome_of(&study), "fault", "{n}");
        let person = study.controller.active().unwrap();
        assert_eq!((person.counted().count(), person.next_step()), (0, Some(0)), "{n}");
        study.check();
    }
    let mut study = running(600.0);
    study.missing = Some("policy");
    study.look();
    study.ms += FAULT_MS - 1.0;
    study.look();
    study.missing = None;
    study.look();
    assert_eq!(study.stage(), Some(Stage::Running), "it was back in time");
}

#[test]
fn study_participant_may_withdraw_and_have_the_data_deleted() {
    let mut study = running(60.0);
    study.view.planner = "lookahead".to_owned();
    let id = study.controller.active().unwrap().id().to_owned();
    study.write(&id, vec![Event::Switched { planner: "entropy".to_owned() }]);
    study.say(1);
    study.ask(&Command::Withdraw(false)).unwrap();
    assert_eq!(study.controller.people()[0].status(), Status::Withdrawn);
    assert_eq!(study.controller.request(&study.robot()), Some(RobotRequest::Restore(id.clone())));
    study.ask(&Command::Withdraw(true)).unwrap();
    let person = &study.controller.people()[0];
    assert_eq!((person.status(), person.trials.len()), (Status::Deleted, 0));
    assert_eq!(person.switched.as_deref(), Some("entropy"), "it is still to be given back");
    assert!(study.disk[0].1.iter().all(|entry| !entry.to_line().contains("heard")));
    study.check();
    assert!(study.ask(&Command::Next).is_err());
}

#[test]
fn study_cancels_the_goal_of_a_participant_who_left() {
    let mut study = running(60.0);
    study.say(1);
    let id = study.controller.active().unwrap().id().to_owned();
    study.ask_as("", &Command::Close(id)).unwrap();
    assert_eq!(study.controller.request(&study.robot()), Some(RobotRequest::Cancel));
    study.grant();
    assert_eq!(study.controller.request(&study.robot()), None);
}

/// Any verbs in any order, with a robot and services that do as they please, and a console that is
/// killed at any time.
#[test]
fn study_data_only_grows_and_refolds_after_any_events() {
    let mut ends = [0_u32; 2];
    for seed in 0..300 {
        let mut rng = Rng::new(seed);
        let mut study = SimulatedStudy::new(Protocol { interactions: 1, ..protocol() });
        let mut before: Vec<(String, usize)> = Vec::new();
        for step in 0..250 {
            random_step(&mut study, &mut rng, step);
            study.check();
            for (id, lines) in before.drain(..) {
                let (_, entries) = study.disk.iter().find(|(known, _)| *known == id).unwrap();
                let deleted =
                    matches!(entries.last().unwrap().event, Event::Deleted | Event::Restored);
                assert!(entries.len() >= lines || deleted, "data only grows");
            }
            before = study.disk.iter().map(|(id, entries)| (id.clone(), entries.len())).collect();
        }
        for person in study.controller.people() {
            ends[0] += u32::from(person.status() == Status::Complete);
            ends[1] += u32::from(person.status() == Status::Withdrawn);
        }
    }
    assert!(ends[0] > 50 && ends[1] > 50, "both are met often: {ends:?}");
}

fn random_step(study: &mut SimulatedStudy, rng: &mut Rng, step: u64) {
    study.ms += 1e3 * rng.uniform() * 8.0;
    let names = ["white", "white2", "clear", "metal"];
    match rng.below(18) {
        0..=7 => {
            let id = study.controller.people().last().map_or(String::new(), |p| p.id().to_owned());
            let asks = [
                Command::Begin,
                Command::Consent,
                Command::Next,
                Command::Next,
                Command::Start,
                Command::Start,
                Command::Answer(quick(1 + rng.below(6) as u8)),
                Command::Answer(quick(3)),
                Command::Resume(id.clone()),
            ];
            // Refusals are part of the walk.
            let _ = study.ask(&asks[rng.below(asks.len())]);
        }
        8 if rng.below(12) == 0 => {
            let id = study.controller.people().last().map_or(String::new(), |p| p.id().to_owned());
            let asks = [
                Command::Withdraw(rng.below(4) == 0),
                Command::Close(id.clone()),
                Command::Spoilt(id.clone(), "a test".to_owned()),
                Command::Delete(id),
            ];
            let _ = study.ask(&asks[rng.below(asks.len())]);
        }
        9..=11 => study.say(step),
        12 | 13 => {
            let object =
                if rng.below(2) == 0 { study.desired() } else { names[rng.below(4)].into() };
            study.end(Outcome::Delivered, Some(&object));
        }
        14 => study.missing = (rng.below(4) == 0).then_some("arm"),
        15 | 16 => study.grant(),
        _ => {
            // Killed, and up again.
            let people = study.disk.iter().filter_map(|(_, entries)| Participant::fold(entries));
            let people = people.collect();
            study.controller = StudyController::new(
                Protocol { interactions: 1, ..protocol() },
                "lab".to_owned(),
                people,
            );
        }
    }
    study.look();
}
