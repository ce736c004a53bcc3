//! A policy's decisions, remembered by belief.

use std::collections::HashMap;

use dialogue::user_model::Person;
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

/// What a choice depends on: whether it is the interaction's first, and the belief's key.
pub type Situation = (bool, Vec<i64>);

/// Choices that several memories of one policy share, so that what one has worked out the others
/// need not. It may forget, and must never answer with another situation's choice.
pub trait Shared {
    /// The choice, if somebody has made it.
    fn find(&self, situation: &Situation) -> Option<Choice>;

    /// Keeps a choice for the others.
    fn keep(&self, situation: &Situation, choice: Choice);
}

/// A planner that is asked once per belief.
///
/// The planner decides on the belief that stands for all of one key ([`Posterior::rounded`]), so a
/// choice is a function of the key, whoever asks first and whatever was forgotten meanwhile. It is
/// asked once for the first step and once for all later ones, as [`dialogue::evaluate`] does: one
/// that draws random numbers is studied for these draws.
pub struct Memo<'a> {
    planner: Box<dyn Planner + Send>,
    shared: Option<&'a dyn Shared>,
    known: HashMap<Situation, Choice>,
    situation: Situation,
    decisions: u64,
}

/// Most beliefs that are remembered: some tens of megabytes for six objects.
const BELIEFS_MAX: usize = 1 << 18;

impl<'a> Memo<'a> {
    /// A memory of that planner's decisions on one problem.
    pub fn new(planner: Box<dyn Planner + Send>) -> Self {
        let (known, situation) = (HashMap::new(), (true, Vec::new()));
        Self { planner, shared: None, known, situation, decisions: 0 }
    }

    /// The same, with what others have worked out on the same problem with such a planner.
    #[must_use]
    pub fn sharing(self, shared: &'a dyn Shared) -> Self {
        Self { shared: Some(shared), ..self }
    }

    /// How often the planner itself was asked.
    pub fn decisions(&self) -> u64 {
        self.decisions
    }

    /// What is believed before anything is said, by a policy that knows nobody.
    pub fn beginning(&self, problem: &DecisionProblem<'_>) -> Posterior {
        let person = || Person::new(problem.model.params());
        let prior = Belief::uniform(problem.model.hypotheses());
        Posterior::new(prior, self.planner.uses_user_model().then(person))
    }

    /// What the policy does about `posterior`; `step` counts its decisions in the interaction from
    /// 0. All calls must be about one problem.
    pub fn choose(
        &mut self,
        problem: &DecisionProblem<'_>,
        posterior: &Posterior,
        step: u32,
    ) -> Choice {
        self.situation.0 = step == 0;
        posterior.key_into(&mut self.situation.1);
        if let Some(choice) = self.known.get(&self.situation) {
            return *choice;
        }
        let others = self.shared.and_then(|shared| shared.find(&self.situation));
        let choice = others.unwrap_or_else(|| self.decide(problem, posterior));
        if self.known.len() >= BELIEFS_MAX {
            self.known.clear();
        }
        self.known.insert(self.situation.clone(), choice);
        choice
    }

    fn decide(&mut self, problem: &DecisionProblem<'_>, posterior: &Posterior) -> Choice {
        let stands_for = posterior.rounded();
        let step = Step { interaction: 0, step: u32::from(!self.situation.0) };
        let posterior = stands_for.as_ref().unwrap_or(posterior);
        let decision = posterior.decide(&mut *self.planner, problem, step);
        self.decisions += 1;
        let instead = decision.alternatives.iter().find_map(|(action, _)| match action {
            Action::Ask(question) => Some(*question),
            _ => None,
        });
        let choice = Choice { action: decision.action, instead };
        if let Some(shared) = self.shared {
            shared.keep(&self.situation, choice);
        }
        choice
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::testing::{bowls, yes_no};
    use dialogue::{Model, Params, registry};
    use std::cell::RefCell;

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

    #[derive(Default)]
    struct Board(RefCell<HashMap<Situation, Choice>>);

    impl Shared for Board {
        fn find(&self, situation: &Situation) -> Option<Choice> {
            self.0.borrow().get(situation).copied()
        }

        fn keep(&self, situation: &Situation, choice: Choice) {
            self.0.borrow_mut().insert(situation.clone(), choice);
        }
    }

    #[test]
    fn what_one_has_worked_out_the_others_need_not() {
        let scene = bowls();
        let model = Model::new(&scene, Params::default());
        let problem = yes_no(&model);
        let board = Board::default();
        let memo = || Memo::new(registry::planner("lookahead").unwrap()).sharing(&board);
        let (mut one, mut other) = (memo(), memo());
        let beginning = one.beginning(&problem);
        let choice = one.choose(&problem, &beginning, 0);
        assert_eq!(other.choose(&problem, &beginning, 0), choice);
        assert_eq!((one.decisions(), other.decisions()), (1, 0));
        other.choose(&problem, &beginning, 1);
        assert_eq!(other.decisions(), 1, "a later step is another situation");
    }
}
