//! The interface of planners: functions from a belief to a decision.

use scene::Question;
use serde::{Deserialize, Serialize};
use vocabulary::{Action, Actions, Announce, Costs, Durations};

use crate::user_model::Joint;
use crate::{Belief, Concessions, Decision, Model, Naming, PolicyTable};

/// The decision problem `(S, A, T, R, Ω, O)` of section 3, but for the belief.
///
/// `Q_t` and `Q_v` are known to the robot and `D` never changes, so the belief over objects is all
/// that a planner needs of the state.
#[derive(Clone, Copy, Debug)]
pub struct DecisionProblem<'a> {
    /// Objects, attributes, and how people answer.
    pub model: &'a Model,
    /// Costs of actions and the worth of a pick.
    pub costs: Costs,
    /// Actions available to the robot.
    pub actions: Actions,
    /// Costs of single questions, if they were measured; `costs` has those of the others.
    pub durations: Option<&'a Durations>,
    /// Whether an announced pick can be denied.
    pub announce: Announce,
    /// The user's concessions about attributes in this interaction.
    pub concessions: &'a Concessions,
    /// Questions that are not asked again, as their answers are known, nor are choices that offer
    /// the value of one.
    pub spent: &'a [Question],
}

static NOTHING_CONCEDED: Concessions = Concessions::NONE;

impl<'a> DecisionProblem<'a> {
    /// The problem in which all questions of a kind cost the same, picks are final, and the user
    /// has conceded nothing.
    pub fn new(model: &'a Model, costs: Costs, actions: Actions) -> Self {
        let (announce, concessions) = (Announce::FINAL, &NOTHING_CONCEDED);
        Self { model, costs, actions, durations: None, announce, concessions, spent: &[] }
    }

    /// Returns the problem as seen by a planner that assumes final picks.
    #[must_use]
    pub fn with_final_picks(self) -> Self {
        Self { announce: Announce::FINAL, ..self }
    }
}

impl DecisionProblem<'_> {
    /// Every question that may be asked, useful or not, in the order of [`Model::questions`].
    pub fn questions(&self) -> Vec<Question> {
        let mut questions = self.model.questions(self.actions);
        let is_barred = |it: &Question| it.attribute().is_some_and(|k| self.concessions.bar(k));
        questions.retain(|question| !self.is_spent(*question) && !is_barred(question));
        questions
    }

    /// Whether a question is not asked again.
    pub(crate) fn is_spent(&self, question: Question) -> bool {
        let offers = |spent: &Question| match (question, *spent) {
            (Question::Choice(k, options), Question::Attribute(of, v)) => {
                k == of && options.contains(v)
            }
            _ => *spent == question,
        };
        self.spent.iter().any(offers)
    }

    /// Cost of an action itself (a positive number); a pick is paid by its outcome.
    pub fn cost(&self, action: Action) -> f64 {
        let costs = &self.costs;
        let alike = match action {
            Action::Wait | Action::Ask(Question::None) => costs.wait_s,
            Action::Ask(Question::Attribute(..)) => costs.attribute_s,
            Action::Ask(Question::Which(_)) => costs.which_s,
            Action::Ask(question @ Question::Choice(..)) => {
                let answers = Naming::of(self.model, question).map_or(2, |law| law.answers);
                self.choice_cost(answers)
            }
            Action::Ask(Question::Point(_)) => costs.point_s,
            Action::Pick(_) => 0.0,
        };
        self.durations.and_then(|durations| durations.of(action)).unwrap_or(alike)
    }

    /// Cost of a choice with that many answers, which is not measured ([`Durations::question_s`]).
    pub(crate) fn choice_cost(&self, answers: usize) -> f64 {
        self.costs.choice_s + self.costs.option_s * answers.saturating_sub(2) as f64
    }
}

/// Position of a decision: all the randomness that a planner may use, so that a replay decides the
/// same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Step {
    /// Index of the interaction over the life of the group.
    pub interaction: u64,
    /// Index of the decision in the interaction, from 0.
    pub step: u32,
}

/// A planner.
///
/// A decision depends on problem, belief and step alone. A planner may keep results, but an earlier
/// decision must not influence a later one.
pub trait Planner {
    /// The name that the registry knows it by.
    fn name(&self) -> &'static str;

    /// Returns the next action.
    ///
    /// # Panics
    /// If the belief is not about the problem's scene.
    fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, step: Step) -> Decision;

    /// Returns the next action given the belief about the person as well. Planners with a fixed
    /// model of answers decide by the belief over objects alone.
    fn decide_with(
        &mut self,
        problem: &DecisionProblem<'_>,
        joint: &Joint,
        step: Step,
    ) -> Decision {
        self.decide(problem, &joint.belief(), step)
    }

    /// Whether the planner uses the belief about the person.
    fn uses_user_model(&self) -> bool {
        false
    }

    /// Works ahead from a belief that dialogues are likely to begin with, if that is any use and
    /// takes well under a second. It changes no decision.
    fn prepare(&mut self, _problem: &DecisionProblem<'_>, _belief: &Belief) {}

    /// The decisions worked out so far, if it keeps them.
    fn table(&self) -> Option<&PolicyTable> {
        None
    }

    /// Takes decisions that were worked out before; [`PolicyTable::fits`] says whether they are of
    /// the problem at hand.
    fn adopt(&mut self, _table: PolicyTable) {}
}

#[cfg(test)]
mod tests;
