//! The observation of an utterance: the message that a grounder answers with.

use messages::{Fits, FixedText, Observation, Utterance, WireError, WireReading};
use scene::Scene;

use super::{Grounded, Grounder, Heard};
use crate::{Interpretation, Time};

/// Returns the observation of the utterance by this grounder.
///
/// # Errors
/// Counts, spans, weights or codes of the utterance that make no sense.
pub fn observation(
    grounder: &mut (impl Grounder + ?Sized),
    scene: &Scene,
    utterance: &Utterance,
    now: Time,
) -> Result<Observation, WireError> {
    let heard = Heard::new(utterance, scene)?;
    let grounded = grounder.ground(&heard, scene);
    Ok(message(utterance, &heard, scene, &grounded, now))
}

/// Returns the message: what the utterance brings, and what it means.
pub fn message(
    utterance: &Utterance,
    heard: &Heard,
    scene: &Scene,
    grounded: &Grounded,
    now: Time,
) -> Observation {
    let mut observation = Observation {
        seq: utterance.seq,
        asked: utterance.asked,
        asked_count: utterance.asked_count,
        source: utterance.source,
        from: utterance.from,
        scene_key: scene.key(),
        gesture: heard.gesture_m.into(),
        onset_ns: utterance.onset_ns,
        end_ns: utterance.end_ns,
        accepted_ns: utterance.accepted_ns,
        grounded_ns: now.ns(),
        ..Observation::default()
    };
    put_readings(&mut observation, &grounded.interpretations);
    if let Some(word) = &grounded.unknown {
        observation.unknown = FixedText::truncated(&word.text);
        observation.unknown_role = word.role.into();
    }
    observation
}

/// Puts readings in place of those of an observation.
pub fn put_readings(observation: &mut Observation, interpretations: &[Interpretation]) {
    observation.readings = Observation::default().readings;
    let mut count = 0;
    for (slot, interpretation) in observation.readings.iter_mut().zip(interpretations) {
        let (wire, fits) = WireReading::new(interpretation);
        if fits == Fits::Cut {
            tracing::warn!(seq = observation.seq, "more scene words than a message holds");
        }
        *slot = wire;
        count += 1;
    }
    observation.reading_count = count;
}

/// Checks what a grounder has returned as the policy will.
///
/// # Errors
/// Words that the scene does not have, questions that were not asked, weights and doubts that are no probabilities.
pub(super) fn check(grounded: &Grounded, heard: &Heard, scene: &Scene) -> Result<(), String> {
    let (words, asked) = (scene.words().len(), heard.questions.len());
    let (found, most) = (grounded.interpretations.len(), messages::READINGS_MAX);
    if found == 0 || found > most {
        return Err(format!("expected 1 to {most} readings, found {found}"));
    }
    for interpretation in &grounded.interpretations {
        let (wire, _) = WireReading::new(interpretation);
        wire.interpretation(words, asked).map_err(|error| error.to_string())?;
    }
    for place in (0..asked).map(Some).chain([None]) {
        let of_place = grounded.interpretations.iter().filter(|one| one.answers == place);
        let (count, sum) =
            of_place.fold((0, 0.0), |(count, sum), one| (count + 1, sum + one.weight));
        if count > 0 && f64::abs(sum - 1.0) > WEIGHT_TOLERANCE {
            let of = place.map_or("no question".to_owned(), |at| format!("question {at}"));
            return Err(format!(
                "expected weights of the readings for {of} that sum to 1, found {sum}"
            ));
        }
    }
    Ok(())
}

/// Deviation of a sum of weights from 1 that is taken for rounding.
const WEIGHT_TOLERANCE: f64 = 1e-6;
