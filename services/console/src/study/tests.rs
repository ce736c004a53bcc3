//! The study's rules: every path of verbs and of what the robot does.

mod world;

use dialogue::Rng;
use evaluation::user_study::{Event, Participant, Protocol, Stage, Status, Verdict};
use messages::Outcome;
use scene::Scene;
use serde_json::{Map, json};

use super::desk::{Ask, Desk};
use super::watch::Wish;
use world::{FAULT_MS, PAGE, World, protocol};

fn quick(points: u8) -> Map<String, serde_json::Value> {
    Map::from_iter([("quick".to_owned(), json!(points))])
}

/// From the beginning to the thanks, every interaction right.
fn take_part(world: &mut World) {
    world.ask(&Ask::Begin).unwrap();
    world.ask(&Ask::Consent).unwrap();
    let mut seq = 0;
    while world.stage() != Some(Stage::Questionnaire) {
        world.ask(&Ask::Next).unwrap();
        if world.stage() != Some(Stage::Drawn) {
            continue;
        }
        world.grant();
        world.ask(&Ask::Start).unwrap();
        seq += 1;
        world.say(seq);
        world.ms += 5e3;
        world.view.decision = "pick".to_owned();
        world.look();
        let desired = world.desired();
        world.end(Outcome::Delivered, Some(&desired));
        world.look();
        world.check();
    }
    world.ask(&Ask::Answer(quick(4))).unwrap();
    world.grant();
    world.check();
}

#[test]
fn somebody_takes_part_from_the_consent_to_the_thanks() {
    let mut world = World::new(protocol());
    take_part(&mut world);
    let person = world.desk.of_page(PAGE).unwrap();
    assert_eq!((person.status(), person.counted().count()), (Status::Complete, 4));
    assert_eq!(person.trials.len(), 5, "one of practice");
    let policies: Vec<&str> = person.counted().map(|t| t.step.policy.as_str()).collect();
    assert_eq!(policies, ["lookahead", "lookahead", "entropy", "entropy"]);
    let trial = &person.trials[1];
    assert_eq!((trial.verdict(), trial.seconds()), (Some(Verdict::Right), Some(10.0)));
    assert_eq!((trial.questions(), trial.utterances()), (2, 3));
    assert_eq!((person.switched.clone(), world.view.planner.as_str()), (None, "lookahead"));
    assert_eq!(person.answers["quick"], 4);
}

#[test]
fn the_second_participant_waits_and_the_first_one_resumes() {
    let mut world = World::new(protocol());
    let code = world.ask(&Ask::Begin).unwrap();
    assert_eq!(world.ask(&Ask::Begin), Ok(code.clone()), "a reload changes nothing");
    let other = "f".repeat(32);
    assert!(world.ask_as(&other, &Ask::Begin).unwrap_err().contains("wait"));
    assert!(world.ask_as(&other, &Ask::Consent).is_err());
    assert!(world.ask_as(&other, &Ask::Resume("WRONG".to_owned())).is_err());
    world.ask_as(&other, &Ask::Resume(code.to_lowercase())).unwrap();
    world.ask_as(&other, &Ask::Consent).unwrap();
    assert!(world.ask(&Ask::Next).is_err(), "the first page has lost it");
    world.ask_as(&other, &Ask::Close(code)).unwrap();
    world.ask(&Ask::Begin).unwrap();
    world.check();
}

#[test]
fn nothing_begins_before_the_robot_is_ready_and_what_stands_is_called_off() {
    let mut world = World::new(protocol());
    world.ask(&Ask::Begin).unwrap();
    world.ask(&Ask::Consent).unwrap();
    world.view.interaction = 7;
    world.ask(&Ask::Next).unwrap();
    assert!(world.ask(&Ask::Start).is_err());
    assert_eq!(world.desk.wish(&world.seen()), Some(Wish::Cancel));
    world.end(Outcome::Cancelled, None);
    world.missing = Some("arm");
    assert!(world.ask(&Ask::Start).is_err());
    world.missing = None;
    world.view.planner = "optimal".to_owned();
    assert_eq!(world.desk.wish(&world.seen()), Some(Wish::Switch("lookahead".to_owned())));
    assert!(world.ask(&Ask::Start).is_err());
    world.grant();
    world.ask(&Ask::Start).unwrap();
    let trial = world.desk.active().unwrap().trial().unwrap();
    assert_eq!((trial.after, world.stage()), (7, Some(Stage::Running)));
}

/// The policy of the one before is given back first: else it would go in the middle of an interaction.
#[test]
fn the_next_participant_waits_until_the_policy_is_given_back() {
    let mut world = World::new(Protocol { warmup: 0, ..protocol() });
    let id = world.ask(&Ask::Begin).unwrap();
    world.write(&id, vec![Event::Switched { planner: "lookahead".to_owned() }]);
    world.ask(&Ask::Withdraw(false)).unwrap();
    let next = "e".repeat(32);
    for ask in [Ask::Begin, Ask::Consent, Ask::Next] {
        world.ask_as(&next, &ask).unwrap();
    }
    let trial = world.desk.active().unwrap().trial().unwrap();
    world.view.planner = trial.step.policy.clone();
    assert!(world.ask_as(&next, &Ask::Start).is_err());
    assert_eq!(world.desk.wish(&world.seen()), Some(Wish::Restore(id)));
    world.grant();
    world.ask_as(&next, &Ask::Start).unwrap();
}

/// A participant who has just begun an interaction.
fn running(seconds_max: f64) -> World {
    let mut world = World::new(Protocol { seconds_max, warmup: 0, ..protocol() });
    world.ask(&Ask::Begin).unwrap();
    world.ask(&Ask::Consent).unwrap();
    world.ask(&Ask::Next).unwrap();
    world.ask(&Ask::Start).unwrap();
    world
}

fn outcome_of(world: &World) -> String {
    let person = world.desk.of_page(PAGE).unwrap();
    let json = evaluation::user_study::to_json(std::slice::from_ref(person));
    json["participants"][0]["trials"][0]["outcome"].as_str().unwrap().to_owned()
}

#[test]
fn each_end_of_an_interaction_is_told_from_the_others() {
    let ends = [
        (Outcome::Failed, "failed"),
        (Outcome::Cancelled, "cancelled"),
        (Outcome::Abandoned, "abandoned"),
        (Outcome::NotHere, "not_here"),
        (Outcome::SceneChanged, "fault"),
    ];
    for (outcome, name) in ends {
        let mut world = running(60.0);
        world.say(1);
        world.end(outcome, None);
        world.look();
        assert_eq!((outcome_of(&world).as_str(), world.stage()), (name, Some(Stage::Over)));
    }
    let mut world = running(60.0);
    world.say(1);
    world.end(Outcome::Delivered, Some("not what was desired"));
    world.look();
    assert_eq!(outcome_of(&world), "wrong");
}

#[test]
fn what_lasts_too_long_is_ended_and_called_off() {
    for says in [true, false] {
        let mut world = running(60.0);
        if says {
            world.say(1);
        }
        world.ms += 59e3;
        world.look();
        assert_eq!(world.stage(), Some(Stage::Running));
        world.ms += 2e3;
        world.look();
        assert_eq!(outcome_of(&world), "too_long");
        assert_eq!(world.desk.wish(&world.seen()), says.then_some(Wish::Cancel));
    }
}

#[test]
fn technical_faults_spoil_an_interaction_and_it_is_repeated() {
    let faults: [fn(&mut World); 5] = [
        |world| {
            world.missing = Some("grounding");
            world.look();
            world.ms += FAULT_MS + 1.0;
        },
        |world| world.view.planner = "optimal".to_owned(),
        |world| {
            let text = include_str!("../../../../config/scenes/tools.toml");
            world.scene = Scene::from_toml("tools.toml", text).unwrap();
        },
        |world| {
            world.end(Outcome::Cancelled, None);
            world.say(2);
            world.end(Outcome::Cancelled, None);
        },
        |world| {
            let id = world.desk.active().unwrap().id().to_owned();
            world.ask_as("", &Ask::Spoilt(id, "the lights went out".to_owned())).unwrap();
        },
    ];
    for (n, fault) in faults.into_iter().enumerate() {
        let mut world = running(600.0);
        world.say(1);
        fault(&mut world);
        world.look();
        assert_eq!(outcome_of(&world), "fault", "{n}");
        let person = world.desk.active().unwrap();
        assert_eq!((person.counted().count(), person.next_step()), (0, Some(0)), "{n}");
        world.check();
    }
    let mut world = running(600.0);
    world.missing = Some("policy");
    world.look();
    world.ms += FAULT_MS - 1.0;
    world.look();
    world.missing = None;
    world.look();
    assert_eq!(world.stage(), Some(Stage::Running), "it was back in time");
}

#[test]
fn somebody_withdraws_and_may_have_the_data_deleted() {
    let mut world = running(60.0);
    world.view.planner = "lookahead".to_owned();
    let id = world.desk.active().unwrap().id().to_owned();
    world.write(&id, vec![Event::Switched { planner: "entropy".to_owned() }]);
    world.say(1);
    world.ask(&Ask::Withdraw(false)).unwrap();
    assert_eq!(world.desk.people()[0].status(), Status::Withdrawn);
    assert_eq!(world.desk.wish(&world.seen()), Some(Wish::Restore(id.clone())));
    world.ask(&Ask::Withdraw(true)).unwrap();
    let person = &world.desk.people()[0];
    assert_eq!((person.status(), person.trials.len()), (Status::Deleted, 0));
    assert_eq!(person.switched.as_deref(), Some("entropy"), "it is still to be given back");
    assert!(world.disk[0].1.iter().all(|entry| !entry.to_line().contains("heard")));
    world.check();
    assert!(world.ask(&Ask::Next).is_err());
}

#[test]
fn what_somebody_left_standing_is_called_off() {
    let mut world = running(60.0);
    world.say(1);
    let id = world.desk.active().unwrap().id().to_owned();
    world.ask_as("", &Ask::Close(id)).unwrap();
    assert_eq!(world.desk.wish(&world.seen()), Some(Wish::Cancel));
    world.grant();
    assert_eq!(world.desk.wish(&world.seen()), None);
}

/// Any verbs in any order, with a robot and services that do as they please, and a console that is
/// killed at any time.
#[test]
fn whatever_is_asked_and_happens_the_data_only_grows_and_folds_again() {
    let mut ends = [0_u32; 2];
    for seed in 0..300 {
        let mut rng = Rng::new(seed);
        let mut world = World::new(Protocol { interactions: 1, ..protocol() });
        let mut before: Vec<(String, usize)> = Vec::new();
        for step in 0..250 {
            random_step(&mut world, &mut rng, step);
            world.check();
            for (id, lines) in before.drain(..) {
                let (_, entries) = world.disk.iter().find(|(known, _)| *known == id).unwrap();
                let deleted =
                    matches!(entries.last().unwrap().event, Event::Deleted | Event::Restored);
                assert!(entries.len() >= lines || deleted, "data only grows");
            }
            before = world.disk.iter().map(|(id, entries)| (id.clone(), entries.len())).collect();
        }
        for person in world.desk.people() {
            ends[0] += u32::from(person.status() == Status::Complete);
            ends[1] += u32::from(person.status() == Status::Withdrawn);
        }
    }
    assert!(ends[0] > 50 && ends[1] > 50, "both are met often: {ends:?}");
}

fn random_step(world: &mut World, rng: &mut Rng, step: u64) {
    world.ms += 1e3 * rng.uniform() * 8.0;
    let names = ["white", "white2", "clear", "metal"];
    match rng.below(18) {
        0..=7 => {
            let id = world.desk.people().last().map_or(String::new(), |p| p.id().to_owned());
            let asks = [
                Ask::Begin,
                Ask::Consent,
                Ask::Next,
                Ask::Next,
                Ask::Start,
                Ask::Start,
                Ask::Answer(quick(1 + rng.below(6) as u8)),
                Ask::Answer(quick(3)),
                Ask::Resume(id.clone()),
            ];
            // Refusals are part of the walk.
            let _ = world.ask(&asks[rng.below(asks.len())]);
        }
        8 if rng.below(12) == 0 => {
            let id = world.desk.people().last().map_or(String::new(), |p| p.id().to_owned());
            let asks = [
                Ask::Withdraw(rng.below(4) == 0),
                Ask::Close(id.clone()),
                Ask::Spoilt(id.clone(), "a test".to_owned()),
                Ask::Delete(id),
            ];
            let _ = world.ask(&asks[rng.below(asks.len())]);
        }
        9..=11 => world.say(step),
        12 | 13 => {
            let object =
                if rng.below(2) == 0 { world.desired() } else { names[rng.below(4)].into() };
            world.end(Outcome::Delivered, Some(&object));
        }
        14 => world.missing = (rng.below(4) == 0).then_some("arm"),
        15 | 16 => world.grant(),
        _ => {
            // Killed, and up again.
            let people = world.disk.iter().filter_map(|(_, entries)| Participant::fold(entries));
            let people = people.collect();
            world.desk =
                Desk::new(Protocol { interactions: 1, ..protocol() }, "lab".to_owned(), people);
        }
    }
    world.look();
}
