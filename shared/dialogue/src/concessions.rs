//! Concessions about attributes in an interaction: not being able to tell, or not minding.

use std::collections::HashMap;

use scene::AttributeId;
use serde::{Deserialize, Serialize};

use crate::{Belief, Model};

/// Statements about attributes rather than values. By default there are none.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Concessions {
    /// Attributes that the user does not know: no question is about them.
    pub unknown: Vec<AttributeId>,
    /// Attributes that do not matter to the user: nothing is asked about them, and objects that
    /// agree in all other attributes are equally right.
    pub indifferent: Vec<AttributeId>,
}

impl Concessions {
    /// Nothing was conceded.
    pub const NONE: Self = Self { unknown: Vec::new(), indifferent: Vec::new() };

    /// Whether nothing was conceded.
    pub fn is_empty(&self) -> bool {
        self.unknown.is_empty() && self.indifferent.is_empty()
    }

    /// Whether questions about an attribute are out of place.
    pub fn bar(&self, k: AttributeId) -> bool {
        self.unknown.contains(&k) || self.indifferent.contains(&k)
    }

    /// The wish of each hypothesis: those of one number are equally right. Numbered in the model's
    /// order; every hypothesis has its own if nothing is indifferent. The absent object agrees with
    /// no other.
    pub fn wishes(&self, model: &Model) -> Vec<usize> {
        if self.indifferent.is_empty() {
            return (0..model.hypotheses()).collect();
        }
        let matters = |k: &AttributeId| !self.indifferent.contains(k);
        let attributes = (0..model.attributes()).map(AttributeId::from).filter(matters);
        let columns: Vec<&[u16]> = attributes.map(|k| model.column(k)).collect();
        let mut known = HashMap::new();
        let wish = |i: usize| {
            let values: Vec<u16> = columns.iter().map(|column| column[i]).collect();
            let fresh = known.len();
            *known.entry((values, i >= model.objects())).or_insert(fresh)
        };
        (0..model.hypotheses()).map(wish).collect()
    }

    /// Probability for every hypothesis that picking it is right.
    ///
    /// # Panics
    /// If the belief is not about the model's scene.
    pub fn chances(&self, model: &Model, belief: &Belief) -> Vec<f64> {
        let probabilities = belief.probabilities();
        if self.indifferent.is_empty() {
            return probabilities;
        }
        let wishes = self.wishes(model);
        let mut sums = vec![0.0; wishes.len()];
        wishes.iter().zip(probabilities).for_each(|(wish, p)| sums[*wish] += p);
        wishes.into_iter().map(|wish| sums[wish]).collect()
    }

    /// Reports everything that decisions depend on, as numbers; nothing without concessions.
    pub(crate) fn identify(&self, tell: &mut dyn FnMut(u64)) {
        if self.is_empty() {
            return;
        }
        for list in [&self.unknown, &self.indifferent] {
            let mut list = list.clone();
            list.sort_unstable();
            list.dedup();
            tell(list.len() as u64);
            list.iter().for_each(|k| tell(k.index() as u64));
        }
    }
}

#[cfg(test)]
mod tests {
    use scene::{ObjectId, Scene};
    use serde_json::json;
    use vocabulary::{Action, Actions, Costs, Mode, Params, Rng};

    use super::*;
    use crate::testing::{drawn, random_scene, scene_of};
    use crate::{DecisionProblem, Step, evaluate, registry};

    const ALL: [Actions; 3] = [
        Actions { mode: Mode::Remote, attribute: true, which: false, choice: false },
        Actions { mode: Mode::Remote, attribute: true, which: true, choice: false },
        Actions { mode: Mode::Present, attribute: true, which: true, choice: false },
    ];

    /// The scene without an attribute and its doubles, with the number of objects behind each one.
    fn without(scene: &Scene, k: AttributeId) -> (Scene, Vec<f64>) {
        let mut kept: Vec<(serde_json::Map<_, _>, f64)> = Vec::new();
        for object in scene.objects() {
            let named = scene.attributes().iter().zip(&object.values).enumerate();
            let others = named.filter(|(at, _)| *at != k.index());
            let attributes: serde_json::Map<_, _> = others
                .filter_map(|(_, (attribute, value))| {
                    let value = &attribute.values[(*value)?.index()];
                    Some((attribute.name.clone(), json!(value.name)))
                })
                .collect();
            match kept.iter_mut().find(|(known, _)| *known == attributes) {
                Some((_, count)) => *count += 1.0,
                None => kept.push((attributes, 1.0)),
            }
        }
        let values = scene.attributes().iter().enumerate().filter(|(at, _)| *at != k.index());
        let values: serde_json::Map<_, _> = values
            .map(|(_, a)| {
                let names: Vec<_> = a.values.iter().map(|value| json!(value.name)).collect();
                (a.name.clone(), json!(names))
            })
            .collect();
        let objects: Vec<_> = (kept.iter().enumerate())
            .map(|(i, (attributes, _))| json!({"name": format!("o{i}"), "attributes": attributes}))
            .collect();
        let scene = scene_of(&json!({"objects": objects, "values": values}));
        (scene, kept.into_iter().map(|(_, count)| count).collect())
    }

    /// An attribute that does not matter is treated as missing.
    #[test]
    fn indifference_merges_objects() {
        let seed = 141;
        let mut rng = Rng::new(seed);
        for draw in 0..4 {
            let scene = random_scene(&mut rng, 7, &[3, 2, 3], 5 * (draw % 2));
            let k = AttributeId::from(rng.below(3));
            let (small, counts) = without(&scene, k);
            let [model, merged] = [&scene, &small].map(|it| Model::new(it, Params::default()));
            let concessions = Concessions { indifferent: vec![k], ..Concessions::NONE };
            for actions in ALL {
                let label = format!("seed {seed} draw {draw} {actions:?}");
                let plain = DecisionProblem::new(&model, Costs::SECONDS, actions);
                let problem = DecisionProblem { concessions: &concessions, ..plain };
                let same = DecisionProblem::new(&merged, Costs::SECONDS, actions);
                let prior = Belief::from_probabilities(&counts).unwrap();
                let value = |problem: &DecisionProblem<'_>, belief: &Belief| {
                    let mut planner = registry::planner("optimal").unwrap();
                    evaluate(&mut *planner, problem, belief, 1e-7)
                };
                let found = value(&problem, &Belief::uniform(7));
                let expected = value(&same, &prior);
                let off = (found.value - expected.value).abs();
                assert!(off < 1e-3, "{label}: {found:?} not {expected:?}");
                assert!((found.success - expected.success).abs() < 1e-3, "{label}");
            }
        }
    }

    #[test]
    fn no_planner_asks_about_what_was_conceded() {
        let seed = 142;
        let mut rng = Rng::new(seed);
        for draw in 0..4 {
            let scene = random_scene(&mut rng, 8, &[3, 2, 2, 2], 4);
            let model = Model::new(&scene, Params::default());
            let model = if draw % 2 == 1 { model.with_absent() } else { model };
            let [a, b] = [0, 0].map(|_| AttributeId::from(rng.below(4)));
            let concessions = Concessions { unknown: vec![a], indifferent: vec![b] };
            for actions in ALL {
                let plain = DecisionProblem::new(&model, Costs::SECONDS, actions);
                let problem = DecisionProblem { concessions: &concessions, ..plain };
                for name in registry::names() {
                    let label = format!("seed {seed} draw {draw} {name} {actions:?}");
                    drive(&problem, name, rng.next_u64(), &label);
                }
            }
        }
    }

    /// Also among the alternatives.
    fn drive(problem: &DecisionProblem<'_>, planner: &str, seed: u64, label: &str) {
        let mut planner = registry::planner(planner).unwrap();
        let mut rng = Rng::new(seed);
        let wanted = rng.below(problem.model.objects()).into();
        let mut belief = Belief::uniform(problem.model.hypotheses());
        let allowed = problem.questions();
        for step in 0..100 {
            let decision = planner.decide(problem, &belief, Step { interaction: seed, step });
            let others = decision.alternatives.iter().map(|(action, _)| *action);
            for action in others.chain([decision.action]) {
                if let Action::Ask(question) = action {
                    assert!(allowed.contains(&question), "{label}: {question:?}");
                }
            }
            let Action::Ask(question) = decision.action else { return };
            let answer = drawn(&mut rng, problem.model, question, wanted);
            belief.update(problem.model, question, &answer.reading(problem.model));
        }
        panic!("{label} asks for ever");
    }

    #[test]
    fn who_minds_nothing_gets_something_at_once() {
        let mut rng = Rng::new(143);
        let scene = random_scene(&mut rng, 6, &[3, 3], 4);
        let model = Model::new(&scene, Params::default());
        let indifferent = vec![AttributeId(0), AttributeId(1)];
        let concessions = Concessions { indifferent, ..Concessions::NONE };
        let belief = Belief::from_probabilities(&[1.0, 1.0, 2.0, 1.0, 1.0, 1.0]).unwrap();
        for actions in ALL {
            let plain = DecisionProblem::new(&model, Costs::SECONDS, actions);
            let problem = DecisionProblem { concessions: &concessions, ..plain };
            for name in registry::names() {
                let mut planner = registry::planner(name).unwrap();
                let decision = planner.decide(&problem, &belief, Step::default());
                assert_eq!(decision.action, Action::Pick(ObjectId(2)), "{name} {actions:?}");
                assert!((decision.value - 50.0).abs() < 1e-9, "{name} {actions:?}");
            }
        }
    }

    #[test]
    fn what_is_not_here_is_no_match_for_anything() {
        let mut rng = Rng::new(144);
        let model = Model::new(&random_scene(&mut rng, 3, &[2], 0), Params::default());
        let model = model.with_absent();
        let concessions = Concessions { indifferent: vec![AttributeId(0)], ..Concessions::NONE };
        assert_eq!(concessions.wishes(&model), [0, 0, 0, 1]);
        let chances = concessions.chances(&model, &Belief::uniform(4));
        assert!((chances[0] - 0.75).abs() < 1e-12 && (chances[3] - 0.25).abs() < 1e-12);
    }

    /// Tables of decisions are of one problem; nothing conceded is the problem as it was.
    #[test]
    fn concessions_are_part_of_the_problems_key() {
        let mut rng = Rng::new(145);
        let model = Model::new(&random_scene(&mut rng, 3, &[2, 2], 0), Params::default());
        let plain = DecisionProblem::new(&model, Costs::SECONDS, ALL[0]);
        let key = |unknown: &[u16], indifferent: &[u16]| {
            let list = |of: &[u16]| of.iter().map(|k| AttributeId(*k)).collect();
            let concessions =
                Concessions { unknown: list(unknown), indifferent: list(indifferent) };
            DecisionProblem { concessions: &concessions, ..plain }.key()
        };
        assert_eq!(key(&[], &[]), plain.key());
        assert_eq!(key(&[0, 1], &[]), key(&[1, 0, 1], &[]));
        let keys = [key(&[], &[]), key(&[0], &[]), key(&[], &[0]), key(&[1], &[]), key(&[0], &[1])];
        for (i, one) in keys.iter().enumerate() {
            assert!(keys[..i].iter().all(|other| other != one), "{keys:?}");
        }
    }
}
