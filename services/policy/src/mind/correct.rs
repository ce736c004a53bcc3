//! Corrections: what is said while the arm fetches. It counts like everything that was said before,
//! and where it speaks against the object, the pick is called off and the interaction goes on.

use super::Mind;
use super::acts::call_off;
use crate::evidence::Evidence;
use crate::state::{Heard, State};
use dialogue::{NamedQuestion, NamedReading};
use messages::{ActKind, PromptId};
use scene::{ObjectId, Response};
use service::Time;

/// Where what is fetched has become less likely than this, it is fetched no further.
const LIKELY: f64 = 0.5;

impl Mind {
    /// Takes in what was said while the arm fetches.
    pub(super) fn reconsider(&self, state: &mut State, heard: &Heard, at: Time) {
        let to = self.addressed(state, heard);
        let evidence = self.evidence(state, heard, &to);
        let Some(open) = &mut state.open else { return };
        let Some((_, object)) = open.pick else { return };
        let denial = self.denial(object, &open.picked, &evidence);
        let is_denied = denial.is_some();
        self.take_in(open, evidence);
        denial.into_iter().for_each(|denial| self.take_in(open, denial));
        let is_unlikely = open.belief().probabilities()[object.index()] < LIKELY;
        if state.act.kind == ActKind::Pick && (is_denied || is_unlikely) {
            open.corrected = true;
            call_off(state, "All right.", at);
        }
    }

    /// The denial of `object` alone, where it is likely that there is one. It counts besides what it
    /// came with: nobody stops the robot on its way to the right object by a slip of the tongue, as
    /// may happen with the answer to a question.
    fn denial(&self, object: ObjectId, name: &str, evidence: &Evidence) -> Option<Evidence> {
        let that = NamedQuestion::Point(name.to_owned());
        let denies = |asked: &NamedQuestion, said: &NamedReading| {
            (*asked == that && said.response == Response::No)
                || said.excluded.iter().any(|group| self.describes(group, object))
        };
        let meant = evidence.meant.iter();
        let weights = meant.map(|(weight, asked, said)| (*weight, denies(asked, said)));
        let all: f64 = weights.clone().map(|(weight, _)| weight).sum();
        let no: f64 = weights.filter(|(_, denies)| *denies).map(|(weight, _)| weight).sum();
        let alone = NamedReading { response: Response::No, ..NamedReading::default() };
        let meant =
            vec![(no, that, alone), (all - no, NamedQuestion::None, NamedReading::default())];
        (2.0 * no > all).then(|| Evidence { meant, ..Evidence::default() })
    }

    /// Whether every one of the words is true of the object.
    fn describes(&self, words: &[String], object: ObjectId) -> bool {
        let is_true = |word: &String| {
            self.scene.word_named(word).is_some_and(|word| self.model.has_word(object, word))
        };
        !words.is_empty() && words.iter().all(is_true)
    }

    /// The arm has left what was not wanted.
    pub(super) fn choose_another(&mut self, state: &mut State, at: Time) {
        let Some(open) = &mut state.open else { return };
        (open.pick, open.corrected) = (None, false);
        open.picked.clear();
        let utterance = open.utterances.1;
        self.decide(state, PromptId(0), "", utterance, at);
    }
}
