//! Corrections: what is said while the arm fetches. It counts like everything that was said before,
//! and where it speaks against the object, the pick is called off and the interaction goes on.

use super::Mind;
use super::acts::call_off;
use crate::evidence::{Asked, Evidence, Said};
use crate::state::{Heard, State};
use node::Time;
use protocol::{ActKind, PromptId};
use scene::{ObjectId, Response};

/// Where what is fetched has become less likely than this, it is fetched no further.
const LIKELY: f64 = 0.5;

impl Mind {
    /// Takes in what was said while the arm fetches. "I will get the white bowl" asks nothing, but
    /// whoever says "no" to it means that bowl.
    pub(super) fn reconsider(&mut self, state: &mut State, heard: &Heard, at: Time) {
        let to = self.addressed(state, heard);
        let told = state.act.decided;
        let Some(open) = &mut state.open else { return };
        let Some((_, object)) = open.pick else { return };
        let mut evidence = self.evidence(open, heard, &to);
        let mut denied = None;
        // What was said before the robot told what it fetches answers what was asked before.
        if said_at(heard) >= told {
            let that = Asked::Point(open.picked.clone());
            evidence = as_answer_to(&that, evidence);
            denied = self.denial(object, that, &evidence);
        }
        self.take_in(open, evidence);
        let is_denied = denied.is_some();
        denied.into_iter().for_each(|denial| self.take_in(open, denial));
        let is_unlikely = open.belief().probabilities()[object.index()] < LIKELY;
        if state.act.kind == ActKind::Pick && (is_denied || is_unlikely) {
            open.corrected = true;
            call_off(state, "All right.", at);
        }
    }

    /// The denial of `object` alone, where it is likely that there is one. It counts besides what it
    /// came with: nobody stops the robot on its way to the right object by a slip of the tongue, as
    /// may happen with the answer to a question.
    fn denial(&self, object: ObjectId, that: Asked, evidence: &Evidence) -> Option<Evidence> {
        let denies = |said: &Said| {
            said.response == Response::No
                || said.excluded.iter().any(|group| self.describes(group, object))
        };
        let all: f64 = evidence.meant.iter().map(|(weight, ..)| weight).sum();
        let no: f64 = evidence
            .meant
            .iter()
            .filter(|(.., said)| denies(said))
            .map(|(weight, ..)| weight)
            .sum();
        let alone = Said { response: Response::No, ..Said::default() };
        let meant = vec![(no, that, alone), (all - no, Asked::Nothing, Said::default())];
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

/// When it was said: typed words are sent when they are complete.
fn said_at(heard: &Heard) -> Time {
    if heard.typed { heard.end } else { heard.onset }
}

/// The evidence with every yes and no as the answer to `asked`.
fn as_answer_to(asked: &Asked, evidence: Evidence) -> Evidence {
    let meant = evidence.meant.into_iter().map(|(weight, before, said)| {
        let answers = said.response != Response::None;
        (weight, if answers { asked.clone() } else { before }, said)
    });
    Evidence { meant: meant.collect(), ..evidence }
}
