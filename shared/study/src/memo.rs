//! A policy's decisions, remembered by belief.

use std::collections::HashMap;

use dialogue::person::Person;
use dialogue::{Action, Belief, DecisionProblem, Planner, Posterior, Step};
use scene::Question;

/// What a policy decided, as far as an interaction needs it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// What it does.
    pub action: Action,
    /// The best other question that it weighed.
    pub instead: Option<Question>,
}

/// A planner that is asked once per belief.
///
/// The planner decides on the belief that stands for all of one key ([`Posterior::rounded`]), so a
/// choice is a function of the key, whoever asks first and whatever was forgotten meanwhile. It is
/// asked once for the first step and once for all later ones, as [`dialogue::evaluate`] does: one
/// that draws random numbers is studied for these draws.
pub struct Memo {
    planner: Box<dyn Planner + Send>,
    first: HashMap<Vec<i64>, Choice>,
    later: HashMap<Vec<i64>, Choice>,
    key: Vec<i64>,
    decisions: u64,
}

/// Most beliefs that are remembered: some ten megabytes for six objects.
const BELIEFS_MAX: usize = 1 << 17;

impl Memo {
    /// A memory of that planner's decisions on one problem.
    pub fn new(planner: Box<dyn Planner + Send>) -> Self {
        Self {
            planner,
            first: HashMap::new(),
            later: HashMap::new(),
            key: Vec::new(),
            decisions: 0,
        }
    }

    /// How often the planner itself was asked.
    pub fn decisions(&self) -> u64 {
        self.decisions
    }

    /// What is believed before anything is said, by a policy that knows nobody.
    pub fn beginning(&self, problem: &DecisionProblem<'_>) -> Posterior {
        let person = || Person::new(problem.model.params());
        let prior = Belief::uniform(problem.model.hypotheses());
        Posterior::new(prior, self.planner.minds_the_person().then(person))
    }

    /// What the policy does about `posterior`; `step` counts its decisions in the interaction from
    /// 0. All calls must be about one problem.
    pub fn choose(
        &mut self,
        problem: &DecisionProblem<'_>,
        posterior: &Posterior,
        step: u32,
    ) -> Choice {
        posterior.key_into(&mut self.key);
        let known = if step == 0 { &mut self.first } else { &mut self.later };
        if let Some(choice) = known.get(&self.key) {
            return *choice;
        }
        let stands_for = posterior.rounded();
        let step = Step { interaction: 0, step: step.min(1) };
        let posterior = stands_for.as_ref().unwrap_or(posterior);
        let decision = posterior.decide(&mut *self.planner, problem, step);
        self.decisions += 1;
        let instead = decision.alternatives.iter().find_map(|(action, _)| match action {
            Action::Ask(question) => Some(*question),
            _ => None,
        });
        let choice = Choice { action: decision.action, instead };
        if known.len() >= BELIEFS_MAX {
            known.clear();
        }
        known.insert(self.key.clone(), choice);
        choice
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{bowls, yes_no};
    use dialogue::{Model, Params, registry};

    #[test]
    fn the_planner_is_asked_once_per_belief_and_kind_of_step() {
        let scene = bowls();
        let model = Model::new(&scene, Params::default());
        let problem = yes_no(&model);
        for name in registry::names() {
            let mut memo = Memo::new(registry::planner(name).unwrap());
            let beginning = memo.beginning(&problem);
            let choice = memo.choose(&problem, &beginning, 1);
            assert_eq!(memo.choose(&problem, &beginning, 7), choice, "{name}");
            assert_eq!(memo.decisions(), 1);
            let mut planner = registry::planner(name).unwrap();
            let step = Step { interaction: 0, step: 1 };
            let direct = beginning.rounded().unwrap().decide(&mut *planner, &problem, step);
            assert_eq!(choice.action, direct.action, "{name}");
            memo.choose(&problem, &beginning, 0);
            assert_eq!(memo.decisions(), 2);
        }
    }
}
