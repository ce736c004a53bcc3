//! A policy's decisions, remembered by belief.

use std::collections::HashMap;

use dialogue::{Action, Belief, DecisionProblem, Planner, Step};
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
/// The planner decides on the belief that stands for all of one key ([`Belief::from_key`]), so a
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

    /// What the policy does at `belief`; `step` counts its decisions in the interaction from 0. All
    /// calls must be about one problem.
    pub fn choose(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, step: u32) -> Choice {
        belief.key_into(&mut self.key);
        let known = if step == 0 { &mut self.first } else { &mut self.later };
        if let Some(choice) = known.get(&self.key) {
            return *choice;
        }
        let stands_for = Belief::from_key(&self.key);
        let step = Step { interaction: 0, step: step.min(1) };
        let belief = stands_for.as_ref().unwrap_or(belief);
        let decision = self.planner.decide(problem, belief, step);
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
            let belief = Belief::uniform(6);
            let choice = memo.choose(&problem, &belief, 1);
            assert_eq!(memo.choose(&problem, &belief, 7), choice, "{name}");
            assert_eq!(memo.decisions(), 1);
            let direct = registry::planner(name).unwrap().decide(
                &problem,
                &Belief::from_key(&belief.key()).unwrap(),
                Step { interaction: 0, step: 1 },
            );
            assert_eq!(choice.action, direct.action, "{name}");
            memo.choose(&problem, &belief, 0);
            assert_eq!(memo.decisions(), 2);
        }
    }
}
