//! What is learned about the person goes on from one interaction to the next.

use super::*;

fn learning_mind() -> Mind {
    shell::mind(&settings_with(&[("dialogue.planner", "information-seeking")])).unwrap()
}

/// One interaction with somebody who answers wrongly with that probability; the records of it.
fn talk(mind: &mut Mind, state: &State, errs: f64, seed: u64) -> Vec<Record> {
    let settings = settings();
    let model = Model::new(&settings.scene, settings.dialogue.params);
    let mut rng = Rng::new(seed);
    let wanted = ObjectId::from(rng.below(6));
    let (mut state, mut records) = (state.clone(), Vec::new());
    let mut seq = state.applied.0;
    let mut say = |state: &State, reading| {
        seq += 1;
        heard(seq, state.act.prompt, reading)
    };
    for turn in 0..60 {
        let cause = match (&state.open, state.act.pick) {
            (None, _) if turn > 0 => break,
            (None, _) => say(&state, Reading::default()),
            (Some(_), Some((pick, _))) => {
                Cause::PickEnded { pick, outcome: PickOutcome::Delivered }
            }
            (Some(_), None) => {
                let truth = Answer::truthful(&model, state.act.question, wanted);
                let wrong = rng.uniform() < errs;
                let said = match truth {
                    Answer::Yes if wrong => Answer::No,
                    Answer::No if wrong => Answer::Yes,
                    said => said,
                };
                say(&state, said.reading(&model))
            }
        };
        let when = at(state.applied.0 + 1);
        state = mind.step(&state, &cause, when);
        records.push(Record { cause, at: when, state: state.clone() });
    }
    assert_eq!(state.open, None, "seed {seed}: it comes to an end");
    records
}

fn acquainted(mind: &mut Mind, errs: f64, interactions: u64) -> Vec<Record> {
    let mut records: Vec<Record> = Vec::new();
    for seed in 0..interactions {
        let state = records.last().map_or_else(|| mind.first(), |record| record.state.clone());
        records.extend(talk(mind, &state, errs, seed));
    }
    records
}

#[test]
fn who_errs_is_expected_to_err_in_the_next_interaction_too() {
    let mut mind = learning_mind();
    let expected = |records: &[Record], mind: &Mind| {
        mind.expects(&records.last().unwrap().state).expect("it learns")
    };
    let (_, at_first) = mind.expects(&mind.first()).unwrap();
    let (_, careful) = {
        let records = acquainted(&mut mind, 0.0, 12);
        expected(&records, &mind)
    };
    let (_, careless) = {
        let records = acquainted(&mut mind, 0.3, 12);
        expected(&records, &mind)
    };
    assert!(careful < at_first && careless > 3.0 * at_first, "{careful} {at_first} {careless}");
}

#[test]
fn silence_and_answers_are_counted_once_each() {
    let mut mind = learning_mind();
    let p_l = |mind: &Mind, state: &State| mind.expects(state).unwrap().0;
    let state = asked(&mut mind);
    let first = p_l(&mind, &state);
    let silent = mind.step(&state, &Cause::Silence, at(9));
    assert!((p_l(&mind, &silent) - 19.0 / 21.0).abs() < 1e-12, "{}", p_l(&mind, &silent));
    let prompt = state.act.prompt;
    let once = mind.step(&state, &heard(2, prompt, answer(Response::Yes)), at(9));
    assert!((p_l(&mind, &once) - 20.0 / 21.0).abs() < 1e-12);
    let twice = mind.step(&once, &heard(3, prompt, answer(Response::Yes)), at(10));
    assert_eq!(p_l(&mind, &once), p_l(&mind, &twice), "the same question");
    let murmur = mind.step(&state, &heard(2, prompt, Reading::default()), at(9));
    assert_eq!(p_l(&mind, &murmur), first, "no answer, and no silence");
}

#[test]
fn what_is_learned_folds_again_and_survives_a_restart() {
    let records = acquainted(&mut learning_mind(), 0.2, 3);
    journal_check::refold(&mut learning_mind(), &records).unwrap();
    for cut in [1, records.len() / 2, records.len()] {
        let node = PolicyNode::recover(learning_mind(), records[..cut].to_vec()).unwrap();
        assert_eq!(node.state(), &records[cut - 1].state);
    }
    let mut tampered = records;
    let last = tampered.last_mut().unwrap();
    last.state.person = None;
    assert!(journal_check::refold(&mut learning_mind(), &tampered).is_err());
}

/// A restart with other settings scores the interaction anew, and counts nothing twice.
#[test]
fn looking_anew_learns_nothing_twice() {
    let mut mind = learning_mind();
    let mut state = asked(&mut mind);
    for seq in 2..5 {
        state = mind.step(&state, &heard(seq, state.act.prompt, answer(Response::No)), at(seq));
        let again = mind.step(&state, &Cause::Reconfigured, at(seq));
        assert_eq!(again.open.as_ref().unwrap().joint, state.open.as_ref().unwrap().joint);
        assert_eq!(again.person, state.person);
    }
    // Another planner takes people as configured, and keeps what is known for later.
    let plain = super::mind().step(&state, &Cause::Reconfigured, at(20));
    assert_eq!(plain.open.as_ref().unwrap().joint, None);
    assert_eq!(plain.person, state.person);
    let back = mind.step(&plain, &Cause::Reconfigured, at(21));
    assert_eq!(back.open.unwrap().joint, state.open.unwrap().joint);
}

#[test]
fn other_planners_learn_nothing() {
    let mut mind = mind();
    let state = asked(&mut mind);
    let state = mind.step(&state, &Cause::Silence, at(9));
    assert_eq!((state.person.clone(), mind.expects(&state)), (None, None));
    assert_eq!(state.open.unwrap().joint, None);
}

/// Answers come `reaction_s` after each question; whether the window follows.
#[test]
fn the_response_window_follows_a_person_whose_answers_were_seen() {
    let window = |reaction_s: f64, answers: u64| {
        let mut mind = learning_mind();
        let mut state = asked(&mut mind);
        for seq in 2..2 + answers {
            let mut said = typed(seq, state.act.prompt, answer(Response::Yes));
            said.asked[0].began = Time(0);
            said.onset = Time(0) + Span::from_s(reaction_s);
            said.end = said.onset;
            state = mind.step(&state, &Cause::Utterance(said), at(seq));
            if state.act.kind != ActKind::Ask {
                let again = heard(seq + 1_000, PromptId(0), Reading::default());
                let (pick, _) = state.act.pick.expect("it picks");
                let outcome = PickOutcome::Delivered;
                state = mind.step(&state, &Cause::PickEnded { pick, outcome }, at(seq));
                state = mind.step(&state, &again, at(seq));
            }
        }
        mind.response_window_s(&state)
    };
    let configured = settings().dialogue.turns.response_window_s;
    assert_eq!(window(0.5, 3), configured, "not known yet");
    assert!(window(0.5, 12) < 0.6 * configured, "{}", window(0.5, 12));
    assert!(window(12.0, 12) > configured, "{}", window(12.0, 12));
    assert!(window(60.0, 40) <= 2.0 * configured);
}
