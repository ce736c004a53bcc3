//! The objects that matter, merged where no question can tell them apart.

use std::collections::HashMap;
use std::ops::Range;

use scene::{AttributeId, ObjectId, Question};

use crate::{Action, Belief, DecisionProblem};

/// Equivalence classes of objects, in the scene's order.
pub(super) struct EquivalenceClasses {
    pub(super) mass: Vec<f64>,
    pub(super) best: Vec<ObjectId>,
    pub(super) share: Vec<f64>,
    pub(super) interchangeable: Vec<Range<usize>>,
}

/// Total probability of the objects that are left out. It moves values by less than this times
/// what is at stake in a pick.
const NEGLIGIBLE: f64 = 1e-9;

impl EquivalenceClasses {
    pub(super) fn of(problem: &DecisionProblem<'_>, belief: &Belief) -> Self {
        let probability = belief.probabilities();
        let floor = NEGLIGIBLE / probability.len() as f64;
        let mut kept: Vec<usize> =
            (0..probability.len()).filter(|i| probability[*i] > floor).collect();
        let total: f64 = kept.iter().map(|i| probability[*i]).sum();
        let group = groups(problem, &kept);
        let pick_s = |i: usize| problem.durations.and_then(|own| own.pick_s(i.into()));
        let quicker = |a: usize, b: usize| {
            pick_s(a).unwrap_or_default().total_cmp(&pick_s(b).unwrap_or_default())
        };
        // Stable, so that equals stay in the scene's order.
        kept.sort_by(|a, b| {
            let likelier = probability[*b].total_cmp(&probability[*a]);
            group[*a].cmp(&group[*b]).then(likelier).then_with(|| quicker(*a, *b))
        });
        let mut classes =
            Self { mass: vec![], best: vec![], share: vec![], interchangeable: vec![] };
        for run in kept.chunk_by(|a, b| group[*a] == group[*b]) {
            if problem.actions.point() {
                let first = classes.mass.len();
                run.iter().for_each(|&i| classes.push(i, probability[i] / total, 1.0));
                classes.interchangeable.push(first..classes.mass.len());
            } else {
                let together: f64 = run.iter().map(|i| probability[*i]).sum();
                classes.push(run[0], together / total, probability[run[0]] / together);
            }
        }
        classes.interchangeable.retain(|run| run.len() > 1);
        classes
    }

    fn push(&mut self, best: usize, mass: f64, share: f64) {
        self.best.push(ObjectId::from(best));
        self.mass.push(mass);
        self.share.push(share);
    }
}

/// The group of every kept object, numbered in the scene's order: objects of one group agree on
/// all attributes that can be asked about, and cost the same to point at.
fn groups(problem: &DecisionProblem<'_>, kept: &[usize]) -> Vec<usize> {
    let model = problem.model;
    let asked = if problem.actions.about_attributes() { model.attributes() } else { 0 };
    let columns: Vec<&[u16]> = (0..asked).map(|k| model.column(AttributeId::from(k))).collect();
    let point = problem.actions.point() && problem.durations.is_some();
    let cost = |i: usize| problem.cost(Action::Ask(Question::Point(i.into())));
    let point_at = |i: usize| if point { cost(i).to_bits() } else { 0 };
    let mut known = HashMap::new();
    let mut group = vec![0; model.hypotheses()];
    for &i in kept {
        let values: Vec<u16> = columns.iter().map(|column| column[i]).collect();
        let fresh = known.len();
        group[i] = *known.entry((values, point_at(i))).or_insert(fresh);
    }
    group
}
