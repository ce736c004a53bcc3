//! Corrections: utterances while the arm fetches. They count like any other; if they are evidence
//! against the object, the pick is cancelled and the interaction continues.

use scene::{AttributeId, Doubt, ObjectId, Question, Reading, Reference, Response, WordId};
use vocabulary::time::Time;
use vocabulary::{ActKind, NamedQuestion};

use super::Manager;
use super::acts::call_off;
use super::attribution::{Heard, PLAIN};
use super::concede::likeliest;
use super::evidence::{Evidence, Mark};
use super::line::{Content, Preface};
use super::references::reference;
use super::state::{Basis, State};
use super::utterance::Utterance;

/// Probability below which the object being fetched is fetched no further.
const LIKELY: f64 = 0.5;

impl Manager {
    /// Processes an utterance while the arm fetches.
    pub(super) fn reconsider(&self, state: &mut State, heard: Heard, at: Time) {
        self.retract(state, &heard);
        let Some(open) = &mut state.open else { return };
        let Some((_, object)) = open.pick else { return };
        let denial = match reference(&heard) {
            Reference::Other => Some(Heard { mark: Some(self.not(object)), ..Heard::default() }),
            _ => self.denial(object, &heard.interpretations),
        };
        let is_denied = denial.is_some();
        let relation = self.relation(&heard);
        self.take_in(open, heard);
        if let Some(denial) = denial {
            self.take_in(open, denial);
        }
        self.relate(open, relation);
        let is_unlikely = open.belief().probability(object) < LIKELY;
        if state.act.kind == ActKind::Pick && (is_denied || is_unlikely) {
            open.corrected = true;
            call_off(state, Content::Correcting, at);
        }
    }

    /// Retracts words that the user replaces: by others of the same attribute ("a mug", and then
    /// "make it a cup"), or by a description that fits objects to none of which they apply ("the
    /// white one in the cabinet", and then "the clear one"), unless it answers a question about its own
    /// attribute. Only if both are certain.
    pub(super) fn retract(&self, state: &mut State, heard: &Heard<'_>) {
        let Some((question, reading)) = likeliest(&heard.interpretations) else { return };
        let Some(open) = &state.open else { return };
        if reading.base.is_empty() || reading.doubt != Doubt::default() {
            return;
        }
        let (scene, model) = (&self.setup.scene, &self.setup.model);
        let of = |word: WordId| model.meanings(word).iter().map(|(k, _)| *k);
        let said: Vec<AttributeId> = reading.base.iter().flat_map(|word| of(*word)).collect();
        // An answer is about the attribute in question alone: it takes back nothing about others. If
        // nothing fits both, the robot says so.
        let is_reply = open.posterior.said().is_some()
            && question.attribute().is_some_and(|asked| said.iter().all(|k| *k == asked));
        let objects = scene.ids();
        let fits = |i: &ObjectId| reading.base.iter().all(|word| model.has_word(*i, *word));
        let fitting: Vec<ObjectId> = objects.filter(fits).collect();
        let is_replaced = |name: &String| {
            let word = scene.word_named(name).filter(|word| !reading.base.contains(word));
            word.is_some_and(|word| {
                let applies = |i: &ObjectId| model.has_word(*i, word);
                of(word).any(|k| said.contains(&k))
                    || !is_reply && !fitting.is_empty() && !fitting.iter().any(applies)
            })
        };
        let Some(mut open) = state.open.take() else { return };
        let mut is_changed = false;
        let mut answers = Vec::new();
        for evidence in open.evidence.iter_mut().filter(|it| it.counts()) {
            let before = evidence.clone();
            for (.., earlier) in &mut evidence.interpretations {
                if earlier.doubt == Doubt::default() && earlier.base.iter().any(is_replaced) {
                    earlier.base.retain(|name| !is_replaced(name));
                    is_changed = true;
                }
            }
            let is_answer = before.interpretations.first().is_some_and(|(_, question, _)| {
                matches!(question, NamedQuestion::Choice(..) | NamedQuestion::Which(_))
            });
            if *evidence != before && is_answer {
                answers.push(Evidence { mark: Some(Mark::Replaced), ..before });
            }
        }
        if open.posterior.speaker().is_some() {
            answers.into_iter().for_each(|answer| open.remember(answer));
        }
        if is_changed {
            open.posterior = self.fold(state, &open);
        }
        state.open = Some(open);
    }

    /// Returns the denial of `object` alone, if one is likely. It counts in addition to its
    /// utterance: no user stops the robot on its way to the right object by a slip of the tongue,
    /// as may happen with the answer to a question.
    pub(super) fn denial(
        &self,
        object: ObjectId,
        interpretations: &[(f64, Question, Reading)],
    ) -> Option<Heard<'static>> {
        let that = Question::Point(object);
        let denies = |question: Question, reading: &Reading| {
            (question == that && reading.response == Response::No)
                || reading.excluded.iter().any(|group| self.describes(group, object))
        };
        let weights = interpretations.iter().map(|(weight, q, r)| (*weight, denies(*q, r)));
        let all: f64 = weights.clone().map(|(weight, _)| weight).sum();
        let no: f64 = weights.filter(|(_, denies)| *denies).map(|(weight, _)| weight).sum();
        let alone = Reading { response: Response::No, ..Reading::default() };
        let interpretations =
            vec![(no, that, alone), (all - no, Question::None, Reading::default())];
        let mark = (no >= PLAIN * all).then(|| self.not(object));
        let denial = Heard { interpretations, unknown: None, gesture: None, mark };
        (2.0 * no > all).then_some(denial)
    }

    /// Returns whether every one of the words is true of the object.
    fn describes(&self, words: &[WordId], object: ObjectId) -> bool {
        !words.is_empty() && words.iter().all(|word| self.setup.model.has_word(object, *word))
    }

    /// Decides again once an object was handed over that was called off too late for another one.
    pub(super) fn fetch_wanted(&mut self, state: &mut State, preface: Preface, at: Time) {
        let Some(refused) = Self::refuse_last(state, at) else { return };
        let (seq, not) = (state.applied, Mark::Not(refused.picked.clone()));
        let said = Utterance { seq, accepted: at, ..Utterance::default() };
        self.open_like(state, &said, refused);
        if let Some(open) = &mut state.open {
            self.take_in(open, Heard { mark: Some(not), ..Heard::default() });
        }
        self.decide(state, Basis { preface, utterance: seq, ..Basis::default() }, at);
    }

    /// Decides again once the arm has left the object that was not wanted.
    pub(super) fn choose_another(&mut self, state: &mut State, at: Time) {
        let Some(open) = &mut state.open else { return };
        (open.pick, open.corrected) = (None, false);
        open.picked.clear();
        open.announced.clear();
        if state.putting_back.is_some() {
            return self.put_back_now(state, Preface::None, at);
        }
        let utterance = open.utterances.1;
        self.decide(state, Basis { utterance, ..Basis::default() }, at);
    }
}
