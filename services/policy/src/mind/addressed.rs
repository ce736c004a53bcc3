//! Which of the questions asked an utterance answers: a weight for each, and for none.

use super::Mind;
use crate::evidence::Evidence;
use crate::state::{Asking, Heard, State};
use dialogue::user_model::Reaction;
use dialogue::{Addressed, Asked, Attribution, QUESTION_S};
use dialogue::{NamedQuestion, NamedReading};
use messages::{ActKind, PromptId};
use scene::{Intent, Question, Reading};
use service::{Span, Time};

impl Mind {
    /// How an utterance is divided among the questions of `heard.asked`. Those of other interactions
    /// are no longer open: they draw no answer.
    pub(super) fn addressed(&self, state: &State, heard: &Heard) -> Addressed {
        let put: Vec<Option<Asked>> = heard.asked.iter().map(|asking| put(state, asking)).collect();
        let asked: Vec<Asked> = put.iter().flatten().copied().collect();
        let among = self.among(state, heard, &asked);
        let mut shares = among.questions.into_iter();
        let share = |known: Option<Asked>| known.and_then(|_| shares.next()).unwrap_or(0.0);
        Addressed { questions: put.into_iter().map(share).collect(), none: among.none }
    }

    fn among(&self, state: &State, heard: &Heard, asked: &[Asked]) -> Addressed {
        let onset_s = seconds(heard.onset);
        match self.turns.attribution {
            Attribution::Naive => Addressed::only(pending(state, asked), asked.len()),
            Attribution::Onset => Addressed::latest_said(asked, onset_s),
            Attribution::Mixture => {
                let answered = self.model.params().p_l;
                let reaction = self.reaction(state, heard.typed);
                let rate = |seconds: f64| reaction.rate(seconds, answered);
                let divide = if heard.typed { Addressed::typed } else { Addressed::of };
                divide(asked, onset_s, rate)
            }
        }
    }

    /// How soon this person answers.
    pub(super) fn reaction(&self, state: &State, typed: bool) -> Reaction {
        let (known, configured) = if typed {
            (state.timing.typed, self.turns.typed)
        } else {
            (state.timing.spoken, self.turns.spoken)
        };
        known.unwrap_or(configured)
    }

    /// What an utterance says about the wanted object: each interpretation with the weight of its
    /// question, equal ones together.
    pub(super) fn evidence(&self, state: &State, heard: &Heard, to: &Addressed) -> Evidence {
        let mut meant: Vec<(f64, NamedQuestion, NamedReading)> = Vec::new();
        for interpretation in &heard.meant {
            let share = interpretation.answers.map_or(to.none, |at| to.questions[at]);
            let weight = share * interpretation.weight;
            if weight < NEGLIGIBLE {
                continue;
            }
            // An answer to another interaction's question says nothing about this one's object.
            let prompt = interpretation.answers.map(|at| heard.asked[at].prompt);
            let asked = prompt.and_then(|prompt| put_in_words(state, prompt)).unwrap_or_default();
            let said = NamedReading::new(&self.scene, &content(&interpretation.reading));
            match meant.iter_mut().find(|(_, a, s)| (a, s) == (&asked, &said)) {
                Some((sum, ..)) => *sum += weight,
                None => meant.push((weight, asked, said)),
            }
        }
        meant.sort_by(|a, b| b.0.total_cmp(&a.0));
        Evidence { meant, unknown: heard.unknown.clone(), gesture: heard.gesture }
    }

    /// Takes in how soon the question was answered that the utterance addresses most likely, if that
    /// is plain. A question counts as answered once, however much is said after it.
    pub(super) fn note_answer(&self, state: &mut State, heard: &Heard, to: &Addressed) {
        let at =
            (0..to.questions.len()).max_by(|a, b| to.questions[*a].total_cmp(&to.questions[*b]));
        let Some(at) = at.filter(|at| to.questions[*at] >= PLAIN) else { return };
        let asking = heard.asked[at];
        let says = |meant: &&dialogue::Interpretation| {
            meant.answers == Some(at) && content(&meant.reading) != Reading::default()
        };
        let open = state.open.as_mut().filter(|_| heard.meant.iter().find(says).is_some());
        let prompts = open.map_or(&mut [][..], |open| &mut open.prompts[..]);
        let Some(prompt) = prompts.iter_mut().find(|prompt| prompt.id == asking.prompt) else {
            return;
        };
        let first = prompt.answered.is_none();
        prompt.answered = Some(heard.end);
        if first {
            let from = if heard.typed { Some(asking.began) } else { asking.ended };
            let seconds = from.map(|from| heard.onset.since(from)).filter(|s| *s > Span(0));
            self.see_answer(state, true);
            self.see_reaction(state, heard.typed, seconds.map(|span| span.s()));
        }
    }

    fn see_reaction(&self, state: &mut State, typed: bool, seconds: Option<f64>) {
        let mut reaction = self.reaction(state, typed);
        seconds.into_iter().for_each(|seconds| reaction.see(seconds));
        let known = if typed { &mut state.timing.typed } else { &mut state.timing.spoken };
        *known = Some(reaction);
    }
}

/// Weights below this say nothing.
const NEGLIGIBLE: f64 = 1e-9;
/// Share from which it is plain which question is addressed.
const PLAIN: f64 = 0.8;

/// What a reading says about the object; nothing where it is about something else.
fn content(reading: &Reading) -> Reading {
    match reading.intent {
        Intent::Inform => reading.clone(),
        _ => Reading::default(),
    }
}

/// A question of the open interaction as the person met it; none for another's.
fn put(state: &State, asking: &Asking) -> Option<Asked> {
    put_in_words(state, asking.prompt)?;
    let open = state.open.as_ref()?;
    let prompt = open.prompts.iter().find(|prompt| prompt.id == asking.prompt);
    Some(Asked {
        question: Question::None,
        began_s: seconds(asking.began),
        ended_s: asking.ended.map_or(seconds(asking.began) + QUESTION_S, seconds),
        whole: asking.whole,
        answered_s: prompt.and_then(|prompt| prompt.answered).map(seconds),
    })
}

/// What a prompt of the open interaction asks. That something is being fetched can be denied.
fn put_in_words(state: &State, prompt: PromptId) -> Option<NamedQuestion> {
    let open = state.open.as_ref()?;
    if state.act.kind == ActKind::Pick && state.act.prompt == prompt {
        return Some(NamedQuestion::Point(open.picked.clone()));
    }
    open.prompts.iter().find(|known| known.id == prompt).map(|known| known.asked.clone())
}

fn seconds(time: Time) -> f64 {
    time.since(Time(0)).s()
}

/// The question that stands when the result arrives, as naive systems take it: the one asked last.
fn pending(state: &State, asked: &[Asked]) -> Option<usize> {
    let stands = matches!(state.act.kind, ActKind::Ask | ActKind::Pick) && !asked.is_empty();
    stands.then_some(0)
}
