//! Convergence of the certified gap: bounds against expanded beliefs and time.

use super::scenes::{OPEN, YES_NO, configured, drawn, random};
use super::{Effort, micros};
use crate::report::{Report, percentile};
use dialogue::{
    Actions, Belief, Costs, DecisionProblem, Lookahead, Model, Optimal, Params, Planner, Step,
    evaluate,
};
use std::time::Instant;

/// Beliefs looked at.
const BELIEFS: [usize; 7] = [4, 16, 64, 256, 1_024, 4_096, 16_384];
/// Objects of the hard scenes, of five attributes each.
const HARD: [usize; 2] = [50, 100];
/// How many hard scenes of a size there are.
const DRAWS: u64 = 10;
/// Beliefs of the search, and of the easier problem that bounds it.
const EFFORTS: [(usize, usize); 4] =
    [(1_000, 3_000), (5_000, 30_000), (30_000, 300_000), (60_000, 2_000_000)];
/// Dialogues less probable than this are cut short in the value of `lookahead`.
const CUT: f64 = 1e-5;

pub(super) fn measure(report: &mut Report, effort: Effort) {
    let configured = |name| Model::new(&configured(name), Params::default());
    let places: [(&str, Model, Actions); 6] = [
        ("2 markers, yes/no", configured("markers"), YES_NO),
        ("6 bowls, yes/no", configured("bowls"), YES_NO),
        ("6 bowls, open too", configured("bowls"), OPEN),
        ("10 tools, yes/no", configured("tools"), YES_NO),
        ("12 random × 4, yes/no", random(12, 4), YES_NO),
        ("20 random × 5, open too", random(20, 5), OPEN),
    ];
    let most = if effort.quick { 1_024 } else { usize::MAX };
    let beliefs: Vec<usize> = BELIEFS.into_iter().filter(|count| *count <= most).collect();
    let mut heads = vec!["bounds, and milliseconds, by beliefs looked at".to_owned()];
    heads.extend(beliefs.iter().map(usize::to_string));
    let rows = (places.iter())
        .map(|(name, model, actions)| {
            let problem = DecisionProblem::new(model, Costs::SECONDS, *actions);
            let cells = beliefs.iter().map(|count| cell(&problem, *count, effort));
            std::iter::once((*name).to_owned()).chain(cells).collect()
        })
        .collect();
    let note = "Lower and upper bound on the value of the best policy at the uniform belief, costs \
                in seconds. The search ends where the value is known.";
    report.table("Certified gap against time", note, heads, rows);
    hard(report, effort);
}

/// Yes/no questions about many objects, where the bounds do not meet.
fn hard(report: &mut Report, effort: Effort) {
    let (draws, efforts) = if effort.quick { (1, &EFFORTS[..2]) } else { (DRAWS, &EFFORTS[..]) };
    let of = |(search, easier): &(usize, usize)| format!("{search} + {easier}");
    let mut heads = vec!["objects × attributes, scene".to_owned()];
    heads.extend(efforts.iter().map(of));
    heads.push("`lookahead`".to_owned());
    let mut rows = Vec::new();
    for (objects, draw) in HARD.into_iter().flat_map(|n| (0..draws).map(move |draw| (n, draw))) {
        let model = drawn(objects, 5, draw);
        let problem = DecisionProblem::new(&model, Costs::SECONDS, YES_NO);
        let mut row = vec![format!("{objects} × 5, {draw}")];
        row.extend(efforts.iter().map(|beliefs| certified(&problem, *beliefs)));
        let belief = Belief::uniform(objects);
        let cut = if effort.quick { effort.cut } else { CUT };
        let value = evaluate(&mut Lookahead::default(), &problem, &belief, cut).value;
        row.push(format!("{value:.2}"));
        rows.push(row);
    }
    let note = "Bounds on the value of the best policy at the uniform belief, their gap, and seconds, \
                by beliefs of the search plus beliefs of the easier problem that bounds it from \
                above; the exact value of `lookahead` beside it. Yes/no questions, costs in seconds.";
    report.table("Certified gap on hard scenes", note, heads, rows);
}

fn certified(problem: &DecisionProblem<'_>, (beliefs_max, certify_max): (usize, usize)) -> String {
    let mut planner = Optimal::default();
    (planner.beliefs_max, planner.certify_max) = (beliefs_max, certify_max);
    let belief = Belief::uniform(problem.model.objects());
    let begun = Instant::now();
    let bounds = planner.decide(problem, &belief, Step::default()).bounds;
    let seconds = begun.elapsed().as_secs_f64();
    let (lower, upper) = bounds.unwrap_or((f64::NAN, f64::NAN));
    format!("{lower:.2}–{upper:.2}, {:.2}, {seconds:.2}", upper - lower)
}

fn cell(problem: &DecisionProblem<'_>, beliefs_max: usize, effort: Effort) -> String {
    let belief = Belief::uniform(problem.model.objects());
    let mut bounds = None;
    let planner = || {
        let mut planner = Optimal::default();
        planner.beliefs_max = beliefs_max;
        planner
    };
    let few = Effort { repetitions: 5, ..effort };
    let samples = micros(few, planner, |mut planner| {
        bounds = planner.decide(problem, &belief, Step::default()).bounds;
    });
    let (lower, upper) = bounds.unwrap_or((f64::NAN, f64::NAN));
    format!("{lower:.4}–{upper:.4}, {:.2}", percentile(&samples, 0.5) / 1e3)
}
