//! The questions that an utterance answers.

use scene::{Intent, Question, Reading, UnknownWord};
use vocabulary::ids::PromptId;
use vocabulary::reaction::Reaction;
use vocabulary::time::{Span, Time};
use vocabulary::{
    ActKind, Attribution, Interpretation, NamedQuestion, NamedReading, Presentation, QuestionShare,
};

use super::Manager;
use super::evidence::Mark;
use super::state::State;
use super::utterance::Utterance;
use crate::answer_attribution::{Candidate, QUESTION_S, Shares};

/// Weight below which an attribution is ignored.
const NEGLIGIBLE: f64 = 1e-9;
/// Share from which it is plain which question is answered.
pub(super) const PLAIN: f64 = 0.8;

/// Content of an utterance in the open interaction.
#[derive(Default)]
pub(super) struct Heard<'a> {
    /// Interpretations with their weights and the question that each answers, likeliest first.
    pub(super) interpretations: Vec<(f64, Question, Reading)>,
    /// A word that the scene does not have.
    pub(super) unknown: Option<&'a UnknownWord>,
    /// The point that the user points at, metres, frame `base`.
    pub(super) gesture: Option<[f64; 3]>,
    /// Objects that it plainly refused or meant.
    pub(super) mark: Option<Mark>,
}

/// Returns the share of the question that an interpretation answers: `shares` has one for each
/// presentation, and last the one of none.
pub(super) fn share_of(interpretation: &Interpretation, shares: &[f64]) -> f64 {
    shares[interpretation.answers.unwrap_or(shares.len() - 1)]
}

impl Manager {
    /// Divides an utterance among its presentations: a share for each, and last one for none. Those
    /// of other interactions get no share. The result is also noted in the state, to be published.
    pub(super) fn attribute(&self, state: &mut State, utterance: &Utterance) -> Vec<f64> {
        let put = |put| self.candidate(state, put);
        let known: Vec<Option<Candidate>> = utterance.presentations.iter().map(put).collect();
        let candidates: Vec<Candidate> = known.iter().flatten().copied().collect();
        let Shares { questions, none } = self.shares(state, utterance, &candidates);
        let mut among = questions.into_iter();
        let share = |known: Option<Candidate>| known.and_then(|_| among.next()).unwrap_or(0.0);
        let mut shares: Vec<f64> = known.into_iter().map(share).collect();
        let noted = &mut state.attributed;
        (noted.utterance, noted.none) = (utterance.seq, none);
        noted.questions.clear();
        let all = utterance.presentations.iter().zip(&shares).filter(|(_, share)| **share > 0.0);
        noted.questions.extend(all.map(|(put, share)| QuestionShare {
            prompt: put.prompt,
            presentation: put.number,
            share: *share,
        }));
        shares.push(none);
        shares
    }

    fn shares(&self, state: &State, utterance: &Utterance, candidates: &[Candidate]) -> Shares {
        let onset_s = seconds(utterance.onset);
        match self.setup.turns.attribution {
            Attribution::Naive => {
                let stands = matches!(state.act.kind, ActKind::Ask | ActKind::Pick);
                Shares::only(stands.then_some(0), candidates.len())
            }
            Attribution::Onset => Shares::latest_said(candidates, onset_s),
            Attribution::Mixture => {
                let answered = self.setup.model.params().p_l;
                let reaction = self.reaction(state, utterance.typed);
                let rate = |seconds: f64| reaction.rate(seconds, answered);
                let divide = if utterance.typed { Shares::typed } else { Shares::spoken };
                divide(candidates, onset_s, rate)
            }
        }
    }

    /// Returns a presentation as a candidate for an answer; `None` for another interaction's.
    fn candidate(&self, state: &State, put: &Presentation) -> Option<Candidate> {
        self.question(state, put.prompt)?;
        let before = || state.handed_over.as_ref().map(|before| &before.interaction);
        let prompt = state.open.as_ref().or_else(before).and_then(|open| open.prompt(put.prompt));
        Some(Candidate {
            began_s: seconds(put.began),
            ended_s: put.ended.map_or(seconds(put.began) + QUESTION_S, seconds),
            complete: put.complete,
            answered_s: prompt.and_then(|prompt| prompt.answered).map(seconds),
        })
    }

    /// Returns the question of a prompt of the open interaction. That an object is being fetched
    /// can be denied, like "this one?".
    fn question(&self, state: &State, prompt: PromptId) -> Option<Question> {
        if let Some(object) = state.goes_back(prompt) {
            return Some(Question::Point(object));
        }
        let Some(open) = &state.open else {
            let offered = self.offered(state).filter(|_| prompt == state.act.prompt);
            return offered.map(Question::Point).or_else(|| answered_after(state, prompt));
        };
        if let (ActKind::Pick, Some((_, object))) = (state.act.kind, state.act.pick)
            && open.announced.contains(&prompt)
        {
            return Some(Question::Point(object));
        }
        open.prompt(prompt).map(|prompt| prompt.question)
    }

    /// Returns the user's reaction-time model.
    fn reaction(&self, state: &State, typed: bool) -> Reaction {
        let (known, configured) = if typed {
            (state.timing.typed, self.setup.turns.typed)
        } else {
            (state.timing.spoken, self.setup.turns.spoken)
        };
        known.unwrap_or(configured)
    }

    /// Returns the content of an utterance: each interpretation weighted by its question's share,
    /// equal ones together.
    pub(super) fn interpret<'a>(
        &self,
        state: &State,
        utterance: &'a Utterance,
        shares: &[f64],
    ) -> Heard<'a> {
        let mut all: Vec<(f64, Question, Reading)> = Vec::new();
        for interpretation in &utterance.interpretations {
            let weight = share_of(interpretation, shares) * interpretation.weight;
            if weight < NEGLIGIBLE {
                continue;
            }
            // An answer to another interaction's question says nothing about this one's object.
            let put = interpretation.answers.map(|at| utterance.presentations[at].prompt);
            let question = put.and_then(|put| self.question(state, put)).unwrap_or_default();
            let reading = content(&interpretation.reading);
            match all.iter_mut().find(|(_, q, r)| *q == question && *r == *reading) {
                Some((sum, ..)) => *sum += weight,
                None => all.push((weight, question, reading.into_owned())),
            }
        }
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        let (unknown, gesture) = (utterance.unknown.as_ref(), utterance.gesture);
        Heard { interpretations: all, unknown, gesture, mark: None }
    }

    /// Returns an interpretation by names.
    pub(super) fn named(
        &self,
        weight: f64,
        question: Question,
        reading: &Reading,
    ) -> (f64, NamedQuestion, NamedReading) {
        let scene = &self.setup.scene;
        (weight, NamedQuestion::new(scene, question), NamedReading::new(scene, reading))
    }

    /// Notes that a question was answered, if it is plain which one, and how soon, if it is plain
    /// which presentation of it. A question counts as answered once, however much is said after it.
    pub(super) fn note_answer(&self, state: &mut State, utterance: &Utterance, shares: &[f64]) {
        let asked = || utterance.presentations.iter().zip(shares);
        // An answer to a repeated question has the share divided among its presentations.
        let of_prompt = |prompt: PromptId| -> f64 {
            asked().filter(|(put, _)| put.prompt == prompt).map(|(_, share)| share).sum()
        };
        let plain = asked().filter(|(put, _)| of_prompt(put.prompt) >= PLAIN);
        let Some((put, share)) = plain.max_by(|a, b| a.1.total_cmp(b.1)) else { return };
        let says_something = |it: &Interpretation| {
            it.answers.is_some_and(|at| utterance.presentations[at].prompt == put.prompt)
                && *content(&it.reading) != Reading::default()
        };
        if !utterance.interpretations.iter().any(says_something) {
            return;
        }
        let open = state.open.as_mut();
        let Some(prompt) = open.and_then(|open| open.prompt_mut(put.prompt)) else { return };
        if prompt.answered.replace(utterance.end).is_none() {
            let from = if utterance.typed { Some(put.began) } else { put.ended };
            let from = from.filter(|_| *share >= PLAIN);
            let after = from.map(|from| utterance.onset.since(from)).filter(|span| *span > Span(0));
            self.see_answer(state, true);
            self.see_reaction(state, utterance.typed, after.map(Span::s));
        }
    }

    fn see_reaction(&self, state: &mut State, typed: bool, seconds: Option<f64>) {
        let mut reaction = self.reaction(state, typed);
        seconds.into_iter().for_each(|seconds| reaction.see(seconds));
        let known = if typed { &mut state.timing.typed } else { &mut state.timing.spoken };
        *known = Some(reaction);
    }
}

/// Returns the content of a reading about the object: `None` if it is about something else.
pub(super) fn content(reading: &Reading) -> std::borrow::Cow<'_, Reading> {
    use std::borrow::Cow;
    match reading.intent {
        Intent::Inform => Cow::Borrowed(reading),
        // "Stop, not that one": the words in addition to the order; a plain "stop" has none.
        Intent::Stop | Intent::GoOn => {
            Cow::Owned(Reading { intent: Intent::Inform, ..reading.clone() })
        }
        Intent::Cancel if !reading.excluded.is_empty() => Cow::Borrowed(reading),
        _ => Cow::Owned(Reading::default()),
    }
}

/// Returns the question of a prompt after a hand-over: this hand-over can be denied.
fn answered_after(state: &State, prompt: PromptId) -> Option<Question> {
    let handed_over = state.handed_over.as_ref()?;
    let earlier = || handed_over.interaction.prompt(prompt).map(|prompt| prompt.question);
    state.refusable(prompt).map(Question::Point).or_else(earlier)
}

fn seconds(time: Time) -> f64 {
    time.since(Time(0)).s()
}
