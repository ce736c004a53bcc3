//! A client that answers each question as soon as it is shown, before the robot's own voice has begun it.

use dialogue::manager::Cause;
use service::Span;
use speech::record::Record as Spoken;
use whichone_tests::settings;
use whichone_tests::simulated_group::{Faults, SimulatedGroup};

use crate::checkers;

/// Dialogues of each combination.
const DIALOGUES: u64 = 2;

/// Returns how many answers there were, and those that were not credited to the question that they answer alone.
fn credited(group: &SimulatedGroup) -> (usize, Vec<String>) {
    let answers = &group.client.as_ref().expect("a client").answers;
    let accepted = |key| {
        group.speech.journal().iter().find_map(|record| match record {
            Spoken::Accepted(accepted) if accepted.key == key => Some(accepted.seq),
            _ => None,
        })
    };
    let wrong = answers.iter().filter_map(|(key, prompt)| {
        let Some(seq) = accepted(*key) else { return Some(format!("{prompt:?}: not accepted")) };
        let record =
            group.policy.journal().iter().find(
                |record| matches!(&record.cause, Cause::Utterance(heard) if heard.seq == seq),
            );
        let attributed = record.map(|record| &record.state.attributed);
        let share = attributed.map_or(0.0, |attributed| attributed.share(*prompt));
        (share < 0.999).then(|| format!("{prompt:?}, {seq:?}: {attributed:?}"))
    });
    (answers.len(), wrong.collect())
}

#[test]
fn answers_are_credited_to_the_question_that_was_shown_however_fast_they_are() {
    let settings = settings(&[]);
    for (synthesis_ms, kills) in [(0, 0), (300, 0), (1_500, 0), (0, 1), (300, 1), (0, 2), (300, 2)]
    {
        let mut answers = 0;
        for after_ms in [0, 50, 200] {
            for seed in 0..DIALOGUES {
                let wanted = [(seed % 6) as usize, ((seed + 1 + seed / 6) % 6) as usize];
                let faults = if kills == 2 { Faults::kills(seed) } else { Faults::none() };
                let (after, synthesis) = (Span::from_ms(after_ms), Span::from_ms(synthesis_ms));
                let mut group =
                    SimulatedGroup::with_client(settings.clone(), &wanted, false, faults)
                        .answered_in_haste(after, synthesis, kills == 1);
                group.run();
                let (count, wrong) = credited(&group);
                answers += count;
                let story = || {
                    format!(
                        "{after_ms} ms, {synthesis_ms} ms, {kills}, seed {seed}\n{}",
                        group.story()
                    )
                };
                assert!(wrong.is_empty(), "{wrong:#?} {}", story());
                let wanted = wanted.map(scene::ObjectId::from);
                checkers::check(&group, &wanted).unwrap_or_else(|e| panic!("{e} {}", story()));
            }
        }
        assert!(answers >= 15, "only {answers} answers");
    }
}
