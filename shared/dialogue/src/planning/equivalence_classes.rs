//! The objects that matter, merged if no question can distinguish them.

use std::cmp::Ordering;
use std::collections::HashMap;
use std::ops::Range;

use scene::{AttributeId, ObjectId, Question};
use vocabulary::Action;

use crate::{Belief, DecisionProblem};

/// Equivalence classes of objects, in the scene's order.
pub(super) struct EquivalenceClasses {
    pub(super) mass: Vec<f64>,
    pub(super) best: Vec<ObjectId>,
    pub(super) share: Vec<f64>,
    pub(super) interchangeable: Vec<Range<usize>>,
}

/// Total probability of the objects that are left out. It moves values by less than this times the
/// stake of a pick.
const NEGLIGIBLE: f64 = 1e-9;

/// Hypotheses that are equally right: one, except for attributes that do not matter to the user.
struct Wish {
    /// The most probable of them, of equals the quickest to pick.
    best: usize,
    /// Probability of all the hypotheses.
    probability: f64,
    group: usize,
}

impl EquivalenceClasses {
    pub(super) fn of(problem: &DecisionProblem<'_>, belief: &Belief) -> Self {
        let mut wishes = wishes(problem, &belief.probabilities());
        let total: f64 = wishes.iter().map(|wish| wish.probability).sum();
        group(problem, &mut wishes);
        // Stable, so that equals stay in the scene's order.
        wishes.sort_by(|a, b| {
            let likelier = b.probability.total_cmp(&a.probability);
            let quicker = || quicker(problem, a.best, b.best);
            a.group.cmp(&b.group).then(likelier).then_with(quicker)
        });
        let mut classes =
            Self { mass: vec![], best: vec![], share: vec![], interchangeable: vec![] };
        for run in wishes.chunk_by(|a, b| a.group == b.group) {
            if problem.actions.point() || !problem.announce.is_final() {
                let first = classes.mass.len();
                run.iter().for_each(|it| classes.push(it.best, it.probability / total, 1.0));
                classes.interchangeable.push(first..classes.mass.len());
            } else {
                let together: f64 = run.iter().map(|it| it.probability).sum();
                classes.push(run[0].best, together / total, run[0].probability / together);
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

/// The wishes that matter, in the scene's order.
fn wishes(problem: &DecisionProblem<'_>, probability: &[f64]) -> Vec<Wish> {
    let floor = NEGLIGIBLE / probability.len() as f64;
    let of = problem.concessions.wishes(problem.model);
    let mut place = vec![None; of.len()];
    let mut wishes: Vec<Wish> = Vec::new();
    for (i, &p) in probability.iter().enumerate().filter(|(_, p)| **p > floor) {
        let Some(known) = place[of[i]] else {
            place[of[i]] = Some(wishes.len());
            wishes.push(Wish { best: i, probability: p, group: 0 });
            continue;
        };
        let wish: &mut Wish = &mut wishes[known];
        let likelier = probability[wish.best].total_cmp(&p);
        if likelier.then_with(|| quicker(problem, i, wish.best)).is_lt() {
            wish.best = i;
        }
        wish.probability += p;
    }
    wishes
}

fn quicker(problem: &DecisionProblem<'_>, a: usize, b: usize) -> Ordering {
    let pick_s = |i: usize| problem.durations.and_then(|own| own.pick_s(i.into()));
    pick_s(a).unwrap_or_default().total_cmp(&pick_s(b).unwrap_or_default())
}

/// Groups the wishes, numbered in their order: those of one group agree on all attributes that can
/// be asked about, and cost the same to point at.
fn group(problem: &DecisionProblem<'_>, wishes: &mut [Wish]) {
    let model = problem.model;
    let asked = if problem.actions.about_attributes() { model.attributes() } else { 0 };
    let asked = (0..asked).map(AttributeId::from).filter(|k| !problem.concessions.bar(*k));
    let columns: Vec<&[u16]> = asked.map(|k| model.column(k)).collect();
    let point = problem.actions.point() && problem.durations.is_some();
    let cost = |i: usize| problem.cost(Action::Ask(Question::Point(i.into())));
    let point_at = |i: usize| if point { cost(i).to_bits() } else { 0 };
    let mut known = HashMap::new();
    for wish in wishes {
        let values: Vec<u16> = columns.iter().map(|column| column[wish.best]).collect();
        let fresh = known.len();
        wish.group = *known.entry((values, point_at(wish.best))).or_insert(fresh);
    }
}
