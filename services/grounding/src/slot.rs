//! The readings of an utterance, by the question that it may answer.

use messages::{Interpretation, READINGS_MAX};
use scene::{Question, Reading};
use whichone_sdk::grounding::{Grounded, Heard};

/// The readings of an utterance in case it answers one question, or none.
pub(crate) struct Slot {
    /// The question's place among those that the utterance may answer; `None` for none.
    pub(crate) place: Option<usize>,
    /// The question; [`Question::None`] also if it is of another scene.
    pub(crate) question: Question,
    /// The readings, likeliest first; their weights sum to 1.
    pub(crate) readings: Vec<(f64, Reading)>,
}

impl Slot {
    /// Readings for this question as a message has them.
    pub(crate) fn interpretations(
        &self,
        readings: Vec<(f64, Reading)>,
    ) -> impl Iterator<Item = Interpretation> + use<> {
        let answers = self.place;
        readings.into_iter().map(move |(weight, reading)| Interpretation {
            weight,
            answers,
            reading,
        })
    }
}

/// Most readings for one of `slots` questions, none counted as one.
pub(crate) fn at_most(slots: usize) -> usize {
    READINGS_MAX / slots
}

/// The readings of `grounded` for each of the questions and for none.
pub(crate) fn slots(heard: &Heard, grounded: &Grounded) -> Vec<Slot> {
    let slot = |place: Option<usize>| {
        let of_place = grounded.interpretations.iter().filter(|one| one.answers == place);
        Slot {
            place,
            question: place.map_or(Question::None, |at| heard.questions[at]),
            readings: of_place.map(|one| (one.weight, one.reading.clone())).collect(),
        }
    };
    (0..heard.questions.len()).map(Some).chain([None]).map(slot).collect()
}
