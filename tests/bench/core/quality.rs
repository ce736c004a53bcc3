//! How good the decisions are: the exact value of every planner's policy beside certified bounds
//! on the best one.

use super::Effort;
use super::scenes::{OPEN, POINTING, PRESENT, PRESENT_OPEN, YES_NO, configured};
use crate::report::{Report, Table};
use dialogue::{
    Actions, Belief, Costs, DecisionProblem, Model, Optimal, Params, Planner, Step, evaluate,
    registry,
};

const ACTIONS: [(&str, Actions); 5] = [
    ("remote, yes/no", YES_NO),
    ("remote, open too", OPEN),
    ("present, yes/no", PRESENT),
    ("present, open too", PRESENT_OPEN),
    ("present, pointing alone", POINTING),
];

pub(super) fn measure(report: &mut Report, effort: Effort) {
    let mut heads: Vec<String> =
        ["scene", "questions", "costs", "best policy"].map(str::to_owned).to_vec();
    heads.extend(registry::names().map(str::to_owned));
    let mut rows = Vec::new();
    for scene in ["markers", "bowls"] {
        let model = Model::new(&configured(scene), Params::default());
        for (shown, actions) in ACTIONS {
            for (preset, costs) in Costs::PRESETS {
                let problem = DecisionProblem { model: &model, costs, actions };
                let mut row = [scene, shown, preset].map(str::to_owned).to_vec();
                row.extend(values(&problem, effort));
                rows.push(row);
            }
        }
    }
    report.tables.push(Table {
        title: "Exact values".to_owned(),
        note: format!(
            "Expected discounted return from the uniform belief, by following every dialogue that \
             is more probable than {:e}; the best policy's value lies between the two bounds. \
             sparse-sampling is followed for one set of draws.",
            effort.cut
        ),
        heads,
        rows,
    });
}

fn values(problem: &DecisionProblem<'_>, effort: Effort) -> Vec<String> {
    let belief = Belief::uniform(problem.model.objects());
    let bounds = Optimal::default().decide(problem, &belief, Step::default()).bounds;
    let (lower, upper) = bounds.unwrap_or((f64::NAN, f64::NAN));
    let value = |name: &&'static str| {
        let mut planner = registry::planner(name).expect("a planner of the registry");
        format!("{:.4}", evaluate(&mut *planner, problem, &belief, effort.cut).value)
    };
    let bounds = format!("{lower:.4}–{upper:.4}");
    std::iter::once(bounds).chain(registry::names().iter().map(value)).collect()
}
