//! Which of the questions asked an utterance answers: a weight for each, and for none.

use super::Mind;
use crate::evidence::{Asked as InWords, Evidence, Said};
use crate::state::{Asking, Heard, Interaction, State};
use dialogue::person::Reaction;
use dialogue::{Addressed, Asked, Attribution};
use node::{Span, Time};
use protocol::ActKind;
use scene::{Intent, Question, Reading};

impl Mind {
    /// How an utterance is divided among the questions of `heard.asked`.
    pub(super) fn addressed(&self, state: &State, heard: &Heard) -> Addressed {
        let onset_s = heard.onset.since(Time(0)).s();
        let asked: Vec<Asked> = heard.asked.iter().map(|asking| put(state, asking)).collect();
        match self.turns.attribution {
            Attribution::Naive => Addressed::only(pending(state, heard), asked.len()),
            Attribution::Onset => Addressed::latest_said(&asked, onset_s),
            Attribution::Mixture => {
                let answered = self.model.params().p_l;
                let reaction = self.reaction(state, heard.typed);
                let rate = |seconds: f64| reaction.rate(seconds, answered);
                let divide = if heard.typed { Addressed::typed } else { Addressed::of };
                divide(&asked, onset_s, rate)
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
    pub(super) fn evidence(&self, open: &Interaction, heard: &Heard, to: &Addressed) -> Evidence {
        let mut meant: Vec<(f64, InWords, Said)> = Vec::new();
        for interpretation in &heard.meant {
            let share = interpretation.question.map_or(to.none, |at| to.questions[at]);
            let weight = share * interpretation.weight;
            if weight < NEGLIGIBLE {
                continue;
            }
            // An answer to another interaction's question says nothing about this one's object.
            let prompt = interpretation.question.map(|at| heard.asked[at].prompt);
            let asked = open.prompts.iter().find(|known| Some(known.id) == prompt);
            let asked = asked.map_or(InWords::Nothing, |known| known.asked.clone());
            let said = Said::new(&self.scene, &content(&interpretation.reading));
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
        let says = |meant: &&protocol::Interpretation| {
            meant.question == Some(at) && content(&meant.reading) != Reading::default()
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

/// About how long it takes to say a question, seconds, where it is still being said.
const QUESTION_S: f64 = 1.5;

/// The question as the person met it.
fn put(state: &State, asking: &Asking) -> Asked {
    let seconds = |time: Time| time.since(Time(0)).s();
    let open = state.open.as_ref();
    let prompt = open.and_then(|open| open.prompts.iter().find(|p| p.id == asking.prompt));
    Asked {
        question: Question::None,
        began_s: seconds(asking.began),
        ended_s: asking.ended.map_or(seconds(asking.began) + QUESTION_S, seconds),
        whole: asking.whole,
        answered_s: prompt.and_then(|prompt| prompt.answered).map(seconds),
    }
}

/// The question that stands when the result arrives, as naive systems take it.
fn pending(state: &State, heard: &Heard) -> Option<usize> {
    let standing = (state.act.kind == ActKind::Ask).then_some(state.act.prompt);
    let is_standing = |asking: &Asking| Some(asking.prompt) == standing;
    heard.asked.iter().position(is_standing).or((!heard.asked.is_empty()).then_some(0))
}
