//! Views of clients.

use super::*;
use crate::view::view;

/// Clients learn which object can be refused, and until when.
#[test]
fn the_view_shows_what_can_be_refused() {
    let mut manager = manager();
    let end = handed_over(&mut manager);
    let refusable = |state: &State| view(&manager, state, 0).refusable;
    let delivery = refusable(&end).expect("a delivery");
    assert_eq!(delivery.object, settings().scene.object_named("clear").unwrap().0);
    assert_eq!(Some(delivery.interaction), end.ended.as_ref().map(|ended| ended.interaction.0));
    let handed_at = end.handed_over.as_ref().expect("a delivery").at;
    let window = Span::from_s(manager.turns().refusal_s);
    assert_eq!(delivery.until_ns, (handed_at + window).ns());
    let mut manager = self::manager();
    let next = remark(&mut manager, &end, words(&["metallic"]));
    assert_eq!(refusable(&next), None, "a request is open");
}

#[test]
fn clients_see_objects_and_absence_apart() {
    let mut manager =
        settings_with(&[("dialogue.prior.absent", "0.1"), ("dialogue.prior.objects", "history")])
            .manager()
            .unwrap();
    let state = asked(&mut manager);
    for state in [&manager.first(), &state] {
        let seen = view(&manager, state, 0);
        assert_eq!(seen.belief.len(), 6);
        assert!((seen.absent - 0.1).abs() < 1e-12, "{seen:?}");
        assert!((seen.belief.iter().sum::<f64>() - 0.9).abs() < 1e-12, "{seen:?}");
    }
    let uniform = self::manager();
    assert_eq!(view(&uniform, &uniform.first(), 0).absent, 0.0);
}

#[test]
fn policy_publishes_the_attribution_of_an_utterance_between_two_questions() {
    let mut manager = manager();
    let first = asked(&mut manager);
    let one = said(first.act.prompt, 1_000);
    let no = spoken(2, &[one], 4_000);
    let second = manager.next(&first, &no, at(5));
    let two = said(second.act.prompt, 5_000);
    let after = manager.next(&second, &spoken(3, &[two, one], 6_200), at(8));
    let seen = view(&manager, &after, 0);
    assert_eq!(seen.attributed.utterance, UtteranceSeq(3));
    let mut prompts: Vec<PromptId> = seen.attributed.questions.iter().map(|q| q.prompt).collect();
    prompts.sort();
    assert_eq!(prompts, [one.prompt, two.prompt]);
    let shares: Vec<f64> = seen.attributed.questions.iter().map(|q| q.share).collect();
    assert!(shares.iter().all(|share| *share > 0.01), "{shares:?}");
    let sum = shares.iter().sum::<f64>() + seen.attributed.none;
    assert!((sum - 1.0).abs() < 1e-12, "{shares:?}, none {}", seen.attributed.none);
    // Published views are typed: no English, no wire codes.
    assert_eq!((seen.decision, seen.question), (after.act.kind, after.act.question));
    assert_eq!(seen.alternatives, after.act.alternatives);
}

/// A question that sounds for two seconds.
fn said(prompt: PromptId, began_ms: u64) -> Presentation {
    let began = Time(0) + Span::from_ms(began_ms);
    let ended = Some(began + Span::from_s(2.0));
    Presentation { prompt, began, ended, complete: true, ..Presentation::default() }
}

/// A "no" that may be meant for any of the questions asked, newest first.
fn spoken(seq: u64, asked: &[Presentation], onset_ms: u64) -> Cause {
    let as_answer_to = |question| {
        let reading = answer(Response::No);
        Interpretation { weight: 1.0, answers: question, reading }
    };
    let onset = Time(0) + Span::from_ms(onset_ms);
    Cause::Utterance(Utterance {
        seq: UtteranceSeq(seq),
        presentations: asked.to_vec(),
        onset,
        end: onset + Span::from_ms(500),
        accepted: onset + Span::from_ms(1_000),
        interpretations: (0..asked.len()).map(Some).chain([None]).map(as_answer_to).collect(),
        ..Utterance::default()
    })
}

/// A grounder that is broken does not look healthy.
#[test]
fn invalid_observations_are_counted_for_the_operators_status() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    let meant = Interpretation { weight: f64::NAN, answers: None, reading: Reading::default() };
    let mut invalid = Observation {
        seq: 1,
        scene_key: settings().scene.key(),
        reading_count: 1,
        ..Observation::default()
    };
    invalid.readings[0] = WireReading::new(&meant).0;
    for count in 1..=2 {
        let (records, _) = tell(&mut node, In::Observation(invalid.into()), at(count));
        assert!(records.is_empty(), "the utterance stays pending");
        assert_eq!(node.rejected(), count);
    }
    tell(&mut node, observation(1, 0, &Reading::default()), at(3));
    assert_eq!((node.rejected(), node.state().applied.0), (2, 1));
}
