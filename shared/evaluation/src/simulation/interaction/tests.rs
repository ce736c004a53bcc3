use super::*;
use crate::simulation::testing::{House, planner as planner_of};
use crate::simulation::{UserKind, interactions};
use dialogue::{Belief, evaluate, registry};
use preflight::{Motions, Pace};
use vocabulary::{Actions, Announce, Costs, Mode, TurnTaking};

fn play(house: &House, planner: &str, wanted: &str, turns: Vec<Turn>) -> SimulatedInteraction {
    let mut manager = house.room().manager(planner_of(planner));
    let wanted = house.scene.object_named(wanted).unwrap();
    interact(
        &house.room(),
        &mut manager,
        &mut SimulatedUser::scripted(wanted, turns),
        &mut Rng::new(1),
    )
}

/// The study of people as the model has them against the exact evaluation, for every policy that
/// decides by the belief over objects alone, as the evaluation does.
#[test]
fn simulation_average_matches_the_exact_evaluation() {
    let (seed, n) = (20_261, 20_000);
    let house = House::new();
    let mut rooms = vec![house.room(), house.room(), house.room()];
    rooms[1].problem.actions =
        Actions { mode: Mode::Present, attribute: false, which: true, choice: false };
    rooms[2].problem.announce = Announce { heard: 0.8, cost_s: 8.0 };
    for room in &rooms {
        for name in registry::names() {
            let mut planner = registry::planner(name).unwrap();
            if planner.uses_user_model() {
                continue;
            }
            let mut manager = room.manager(planner_of(name));
            let tally = interactions(room, &mut manager, UserKind::Model, seed, 0..n);
            let exact = evaluate(&mut *planner, &room.problem, &Belief::uniform(6), 1e-9);
            let case = format!("seed {seed}, {name}: {exact:?}");
            let spread = (exact.success * (1.0 - exact.success) / n as f64).sqrt();
            let off = (tally.success() - exact.success).abs();
            assert!(off <= 5.0 * spread + 1e-6, "{case}, success {}", tally.success());
            let means = [
                (&tally.questions, exact.questions),
                (&tally.denied, exact.denied),
                (&tally.value, exact.value),
            ];
            for (mean, exact) in means {
                let off = (mean.mean() - exact).abs();
                assert!(off <= 5.0 * mean.error() + 1e-3, "{case}, {} not {exact}", mean.mean());
            }
        }
    }
}

#[test]
fn interaction_fetches_at_once_after_an_unambiguous_request() {
    let house = House::new();
    let words = Turn::words("get me the small metal bowl in the cabinet, the silver one");
    let outcome = play(&house, "never-ask", "metal", vec![words]);
    assert_eq!((outcome.verdict, outcome.questions), (Verdict::Right, 0));
    assert_eq!((outcome.talk_s, outcome.value), (0.0, 50.0));
    assert!(outcome.seconds > 1.0, "saying what it fetches takes time");
}

#[test]
fn interaction_repeats_a_question_into_silence_and_then_gives_up() {
    let house = House::new();
    let outcome = play(&house, "lookahead", "metal", vec![]);
    let patience = TurnTaking::default();
    assert_eq!(
        (outcome.verdict, outcome.questions),
        (Verdict::Abandoned, patience.repeats_max + 1)
    );
    assert!(outcome.talk_s > 3.0 * patience.response_window_s);
    let costs = Costs::SECONDS;
    let times = outcome.questions.cast_signed();
    let asked: f64 = (0..times).map(|k| -4.0 * costs.discount.powi(k)).sum();
    let value = asked + costs.discount.powi(times) * costs.wait_value();
    assert!((outcome.value - value).abs() < 1e-9, "{outcome:?} not {value}");
}

#[test]
fn interaction_treats_non_answers_like_the_policy() {
    let house = House::new();
    let yes = |n: usize| vec![Turn::words("yes"); n];
    let repeated = [vec![Turn::SILENT, Turn::words("can you repeat that?")], yes(9)].concat();
    let plain = [vec![Turn::SILENT], yes(9)].concat();
    let (repeated, plain) =
        (play(&house, "lookahead", "metal", repeated), play(&house, "lookahead", "metal", plain));
    assert_eq!(repeated.questions, plain.questions + 1);
    let cancelled = vec![Turn::SILENT, Turn::words("forget it, never mind")];
    assert_eq!(play(&house, "lookahead", "metal", cancelled).verdict, Verdict::Cancelled);
    let late = Turn { late_s: 60.0, ..Turn::words("yes") };
    let late = [vec![Turn::SILENT, late], yes(9)].concat();
    let late = play(&house, "lookahead", "metal", late);
    assert_eq!(late.questions, plain.questions + 1);
    assert!(late.talk_s > plain.talk_s + TurnTaking::default().response_window_s);
}

#[test]
fn interaction_without_an_end_has_the_value_of_waiting() {
    let house = House::new();
    let mut room = house.room();
    room.problem.costs = Costs::PREDECESSOR;
    let mut manager = room.manager(planner_of("never-ask"));
    let wanted = ObjectId(0);
    let mut silent = SimulatedUser::scripted(wanted, vec![]);
    let outcome = interact(&room, &mut manager, &mut silent, &mut Rng::new(1));
    assert_eq!((outcome.verdict, outcome.questions), (Verdict::Abandoned, 0));
    assert_eq!(outcome.value, Costs::PREDECESSOR.wait_value());
    let turns = vec![Turn::SILENT, Turn::words("it's in the dishwasher")];
    let outcome = interact(
        &room,
        &mut manager,
        &mut SimulatedUser::scripted(wanted, turns),
        &mut Rng::new(1),
    );
    assert!(
        (outcome.value - (-1.0 + 0.9 * 10.0)).abs() < 1e-9 || outcome.verdict != Verdict::Right
    );
}

/// "No" while the arm is on its way: it comes back, and the robot knows better.
#[test]
fn denied_pick_costs_time_and_teaches() {
    let house = House::new();
    let (robot, settings) = (manipulation::Robot::baxter(), manipulation::PlanSettings::default());
    let extent = preflight::Extent::Picks;
    let motions = Motions::plan(robot, &house.scene, None, &settings, extent).unwrap();
    // A quick voice, user and recogniser: "no" is heard before the fingers close.
    let voice = preflight::Voice { words_per_minute: 330.0 };
    let pace =
        preflight::Pace { reaction_s: (0.4, 0.05), recogniser_s: (0.1, 0.2), ..Pace::default() };
    let room = Room { motions: Some(&motions), voice, pace: &pace, ..house.room() };
    let wanted = house.scene.object_named("white").unwrap();
    let request = Turn::words("get me the small white plastic bowl on the counter");
    let play = |room: &Room<'_>, turns: Vec<Turn>| {
        let mut manager = room.manager(planner_of("never-ask"));
        interact(room, &mut manager, &mut SimulatedUser::scripted(wanted, turns), &mut Rng::new(1))
    };
    let wrong = play(&room, vec![request.clone()]);
    assert_eq!((wrong.verdict, wrong.denied), (Verdict::Wrong, 0));
    let no = Turn::words("no");
    let denied = play(&room, vec![request.clone(), no.clone()]);
    assert_eq!((denied.verdict, denied.denied), (Verdict::Right, 1), "{denied:?}");
    assert!(denied.talk_s > 3.0 && denied.seconds > wrong.seconds + 1.0, "{denied:?} {wrong:?}");
    // Too late, or in an evaluation in which a pick is final.
    let late = play(&room, vec![request.clone(), Turn { late_s: 20.0, ..no.clone() }]);
    assert_eq!((late.verdict, late.denied), (Verdict::Wrong, 0));
    assert_eq!(late.seconds, wrong.seconds);
    let unheard = play(&Room { denials: false, ..room }, vec![request, no]);
    assert_eq!(unheard, wrong);
}
