//! Planner that remembers its decisions by belief.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Arc, PoisonError, RwLock};

use dialogue::user_model::Joint;
use dialogue::{Belief, Decision, DecisionProblem, Planner, Posterior, Step};

/// The inputs of a decision: whether it is the interaction's first, and the posterior's key.
type Situation = (bool, Vec<i64>);

/// Decisions that several caches of one planner share, in several threads: a slow planner is not
/// asked twice. Each cache looks into its own memory first, so locks are rarely contended.
#[derive(Debug, Default)]
pub struct SharedDecisions(RwLock<HashMap<Situation, Arc<Decision>>>);

/// Most decisions that are shared; the first ones stay, as they are the most frequent.
const SHARED_MAX: usize = 1 << 19;

impl SharedDecisions {
    fn find(&self, situation: &Situation) -> Option<Arc<Decision>> {
        // Every entry is whole, even after a panic of a thread.
        self.0.read().unwrap_or_else(PoisonError::into_inner).get(situation).cloned()
    }

    fn add(&self, situation: &Situation, decision: &Arc<Decision>) {
        let mut decisions = self.0.write().unwrap_or_else(PoisonError::into_inner);
        if decisions.len() < SHARED_MAX {
            decisions.insert(situation.clone(), Arc::clone(decision));
        }
    }
}

/// A planner that is asked once per belief.
///
/// It decides on the belief that represents all of one key ([`Posterior::rounded`]), so a decision
/// is a function of the key. The planner is asked once for the first step and once for all later
/// ones, as [`dialogue::evaluate`] does: one that draws random numbers is studied for these draws.
pub struct CachedPlanner {
    planner: Box<dyn Planner + Send>,
    shared: Option<Arc<SharedDecisions>>,
    known: HashMap<Situation, Arc<Decision>>,
    situation: Situation,
}

/// Most beliefs that are remembered.
const BELIEFS_MAX: usize = 1 << 17;

impl CachedPlanner {
    /// Returns a cache of that planner's decisions on one problem.
    pub fn new(planner: Box<dyn Planner + Send>) -> Self {
        let (known, situation) = (HashMap::new(), (true, Vec::new()));
        Self { planner, shared: None, known, situation }
    }

    /// Adds the decisions of other caches of the same planner on the same problem.
    #[must_use]
    pub fn sharing(self, shared: Arc<SharedDecisions>) -> Self {
        Self { shared: Some(shared), ..self }
    }

    /// Returns the decision at `self.situation`; `posterior` makes the posterior that has its key.
    fn cached(
        &mut self,
        problem: &DecisionProblem<'_>,
        posterior: impl FnOnce() -> Posterior,
    ) -> Decision {
        if let Some(known) = self.known.get(&self.situation) {
            return Decision::clone(known);
        }
        let others = self.shared.as_ref().and_then(|shared| shared.find(&self.situation));
        let decision = others.unwrap_or_else(|| {
            let posterior = posterior();
            let step = Step { interaction: 0, step: u32::from(!self.situation.0) };
            let posterior = posterior.rounded().unwrap_or(posterior);
            let decision = Arc::new(posterior.decide(&mut *self.planner, problem, step));
            self.shared.iter().for_each(|shared| shared.add(&self.situation, &decision));
            decision
        });
        if self.known.len() >= BELIEFS_MAX {
            self.known.clear();
        }
        self.known.insert(self.situation.clone(), Arc::clone(&decision));
        Decision::clone(&decision)
    }
}

/// Appends the parts of the problem that change in an interaction, and between people.
fn problem_into(problem: &DecisionProblem<'_>, key: &mut Vec<i64>) {
    let params = problem.model.params();
    let own = [params.open, params.choice].into_iter().flatten().map(|own| own.epsilon);
    key.extend(own.chain([params.epsilon]).map(|epsilon| epsilon.to_bits().cast_signed()));
    problem.model.doubts_into(key);
    let mut hasher = DefaultHasher::new();
    let (concessions, spent) = (problem.concessions, problem.spent);
    (&concessions.unknown, &concessions.indifferent, spent).hash(&mut hasher);
    key.push(hasher.finish().cast_signed());
}

impl Planner for CachedPlanner {
    fn name(&self) -> &'static str {
        self.planner.name()
    }

    fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, step: Step) -> Decision {
        self.situation.0 = step.step == 0;
        belief.key_into(&mut self.situation.1);
        problem_into(problem, &mut self.situation.1);
        self.cached(problem, || Posterior::Object(belief.clone()))
    }

    fn decide_with(
        &mut self,
        problem: &DecisionProblem<'_>,
        joint: &Joint,
        step: Step,
    ) -> Decision {
        self.situation.0 = step.step == 0;
        joint.key_into(&mut self.situation.1);
        problem_into(problem, &mut self.situation.1);
        self.cached(problem, || Posterior::ObjectAndPerson(joint.clone()))
    }

    fn uses_user_model(&self) -> bool {
        self.planner.uses_user_model()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::testing::{House, planner};
    use dialogue::registry;

    #[test]
    fn cached_planner_decides_like_its_planner_and_shares_its_decisions() {
        let house = House::new();
        let problem = house.problem();
        let belief = Belief::uniform(6);
        for name in registry::names() {
            let shared = Arc::new(SharedDecisions::default());
            let cache = || planner(name).sharing(Arc::clone(&shared));
            let (mut one, mut other) = (cache(), cache());
            for step in [0, 1] {
                let step = Step { interaction: 0, step };
                let mut planner = registry::planner(name).unwrap();
                let rounded = Belief::from_key(&belief.key()).unwrap();
                let direct = planner.decide(&problem, &rounded, step);
                assert_eq!(one.decide(&problem, &belief, step), direct, "{name}");
                let later = Step { interaction: 9, step: 7 * step.step };
                assert_eq!(other.decide(&problem, &belief, later), direct, "{name}");
            }
            assert_eq!(shared.0.read().unwrap().len(), 2, "{name}: asked once per situation");
        }
    }
}
