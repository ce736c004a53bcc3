//! Decisions: asked of the planner, and carried out.

use scene::ObjectId;
use vocabulary::ids::UtteranceSeq;
use vocabulary::time::Time;
use vocabulary::{Action, Outcome};

use super::acts::{set, set_reasons};
use super::line::{Content, Preface};
use super::state::{Act, Basis, Preference, State};
use super::{LEFT_MAX, Manager};
use crate::{Belief, Decision, DecisionProblem, Step};

/// Alternatives that an act lists.
const ALTERNATIVES_MAX: usize = 5;

impl Manager {
    /// Decides on the present belief.
    pub(super) fn decide(&mut self, state: &mut State, basis: Basis, at: Time) {
        if self.ask_about_kept(state, basis.preface.clone(), at) {
            return;
        }
        let Some(decision) = self.plan(state) else { return };
        let standing = Action::Ask(state.act.question);
        let others = decision.alternatives.iter().map(|(action, _)| *action);
        let mut questions = others.filter(|action| matches!(action, Action::Ask(_)));
        let action = match (basis.preference, decision.action) {
            (Preference::Any, action) => state
                .open
                .as_ref()
                .map_or(action, |open| Action::Pick(self.likeliest_object(&open.belief()))),
            (Preference::Otherwise, action) if action == standing => {
                questions.next().unwrap_or(action)
            }
            (_, action) => action,
        };
        self.carry_out(state, action, decision, basis, at);
    }

    /// Returns the likeliest of the scene's objects; of several the first.
    pub(super) fn likeliest_object(&self, belief: &Belief) -> ObjectId {
        let objects = self.setup.scene.ids();
        let likelier = |best: ObjectId, next: ObjectId| {
            if belief.probability(next) > belief.probability(best) { next } else { best }
        };
        objects.reduce(likelier).unwrap_or(ObjectId(0))
    }

    /// Asks the planner.
    fn plan(&mut self, state: &mut State) -> Option<Decision> {
        let concessions = self.concessions(state.open.as_ref()?);
        let open = state.open.as_mut()?;
        let step = Step { interaction: open.id.0, step: open.step };
        open.step += 1;
        // Earlier statements about values in doubt apply to the coming questions.
        let model = self.learned(open.counting()).into_owned();
        let spent = open.spent();
        let problem = DecisionProblem {
            model: &model,
            concessions: &concessions,
            spent: &spent,
            ..self.setup.problem()
        };
        Some(open.posterior.decide(&mut *self.planner, &problem, step))
    }

    fn carry_out(
        &mut self,
        state: &mut State,
        action: Action,
        decision: Decision,
        basis: Basis,
        at: Time,
    ) {
        let Some(open) = &state.open else { return };
        let exhausted = open.presentations >= self.setup.turns.questions_max;
        let action = match action {
            Action::Ask(_) if exhausted => Action::Pick(open.belief().most_likely()),
            action => action,
        };
        let value = decision.value;
        let reasons = reasons(decision, basis.utterance, at);
        let alike = match action {
            Action::Pick(object) => self.left_over(state, object),
            Action::Ask(_) | Action::Wait => Preface::None,
        };
        let offered = match action {
            Action::Ask(_) | Action::Wait => self.offer_instead(state, value),
            Action::Pick(object) if !exhausted => {
                self.offer_first(state, object, (&alike, basis.preference))
            }
            Action::Pick(_) => None,
        };
        if let Some(offered) = offered {
            return self.offer(state, offered, basis.preface, reasons);
        }
        match action {
            Action::Wait => set(state, reasons),
            Action::Ask(question) => self.ask(state, question, basis, reasons),
            Action::Pick(object) if self.setup.model.absent() == Some(object) => {
                self.close(state, Outcome::NotHere, at, Content::NotHere);
                set_reasons(state, reasons);
            }
            Action::Pick(object) => {
                let preface = match basis.preface {
                    Preface::None => alike,
                    preface => preface,
                };
                self.pick(state, object, preface, reasons);
            }
        }
    }

    /// Names the objects that the user cannot distinguish before one of them is picked.
    fn left_over(&mut self, state: &State, object: ObjectId) -> Preface {
        let Some(open) = &state.open else { return Preface::None };
        let left = self.left(&open.belief());
        let is_told = open.conceded.unknown.is_empty();
        if is_told || !(2..=LEFT_MAX).contains(&left.len()) || !left.contains(&object) {
            return Preface::None;
        }
        Preface::Left(left.into_iter().map(|i| self.description(i)).collect())
    }
}

/// An act with nothing but the reasons of a decision.
fn reasons(decision: Decision, utterance: UtteranceSeq, at: Time) -> Act {
    let Decision { value, mut alternatives, expected_questions, bounds, .. } = decision;
    alternatives.truncate(ALTERNATIVES_MAX);
    let decided = at;
    Act { utterance, decided, value, alternatives, expected_questions, bounds, ..Act::default() }
}
