//! Convergence of the certified gap: bounds against expanded beliefs and time.

use super::scenes::{OPEN, YES_NO, configured, random};
use super::{Effort, micros};
use crate::report::{Report, percentile};
use dialogue::{Belief, DecisionProblem, Model, Optimal, Planner, Step};
use vocabulary::{Actions, Costs, Params};

/// Beliefs looked at.
const BELIEFS: [usize; 7] = [4, 16, 64, 256, 1_024, 4_096, 16_384];
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
