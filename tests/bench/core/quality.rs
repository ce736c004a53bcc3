//! Quality of the decisions: the exact value of every planner's policy beside certified bounds
//! on the best one.

use super::Effort;
use super::scenes::{OPEN, POINTING, PRESENT, PRESENT_OPEN, YES_NO, configured, random};
use crate::report::Report;
use dialogue::{Belief, DecisionProblem, Model, Optimal, Planner, Step, evaluate, registry};
use std::time::Instant;
use vocabulary::{Actions, Costs, Params};

const ACTIONS: [(&str, Actions); 5] = [
    ("remote, yes/no", YES_NO),
    ("remote, open too", OPEN),
    ("present, yes/no", PRESENT),
    ("present, open too", PRESENT_OPEN),
    ("present, pointing alone", POINTING),
];

/// Costs of a wrong pick; 100 is the default.
const WRONG: [f64; 4] = [50.0, 100.0, 200.0, 500.0];
/// Random scenes, objects and attributes, larger than what is known to the last digit.
const LARGER: [(usize, usize); 3] = [(12, 4), (20, 5), (50, 5)];
/// Dialogues on larger scenes that are less probable than this are cut short: their beliefs are
/// many.
const CUT_LARGER: f64 = 2e-5;
/// Decisions that an evaluation of a larger scene takes, for judging whether it can be awaited.
const DECISIONS_LARGER: f64 = 100.0;

pub(super) fn measure(report: &mut Report, effort: Effort) {
    let mut rows = Vec::new();
    for scene in ["markers", "bowls"] {
        let model = Model::new(&configured(scene), Params::default());
        for (shown, actions) in ACTIONS {
            for (preset, costs) in Costs::PRESETS {
                let problem = DecisionProblem::new(&model, costs, actions);
                let mut row = vec![format!("{scene}, {shown}, {preset}"), best(&problem)];
                row.extend(registry::names().map(|name| value(&problem, name, effort.cut)));
                rows.push(row);
            }
        }
    }
    let note = format!(
        "Expected discounted return from the uniform belief, by following every dialogue that \
         is more probable than {:e}; the best policy's value lies between the two bounds. \
         sparse-sampling is followed for one set of draws.",
        effort.cut
    );
    let heads = ["scene, questions, costs", "best policy"];
    report.table("Exact values", note, heads.into_iter().chain(registry::names()), rows);
    wrong_picks(report, effort);
    larger(report, effort);
}

/// How certain the robot makes itself before a pick, by what a wrong one costs.
fn wrong_picks(report: &mut Report, effort: Effort) {
    let model = Model::new(&configured("bowls"), Params::default());
    let cells = |wrong: f64, actions| {
        let problem = DecisionProblem::new(&model, Costs { wrong, ..Costs::SECONDS }, actions);
        let belief = Belief::uniform(model.objects());
        let found = evaluate(&mut Optimal::default(), &problem, &belief, effort.cut);
        let success = format!("{:.2} %", 100.0 * found.success);
        [format!("{:.2}", found.value), success, format!("{:.2}", found.questions)]
    };
    let row = |wrong: f64| {
        let cells = [YES_NO, OPEN].map(|actions| cells(wrong, actions)).concat();
        std::iter::once(wrong.to_string()).chain(cells).collect()
    };
    let heads = [
        "`costs.wrong`",
        "yes/no: value",
        "success",
        "questions",
        "open too: value",
        "success with open",
        "questions with open",
    ];
    let note = "Six bowls in another room, the policy of `optimal` from the uniform belief.";
    let rows = WRONG.map(row).to_vec();
    report.table("Costs of a wrong pick", note, heads, rows);
}

fn larger(report: &mut Report, effort: Effort) {
    let mut rows = Vec::new();
    for (objects, attributes) in LARGER {
        let model = random(objects, attributes);
        for (shown, actions) in [("yes/no", YES_NO), ("open too", OPEN)] {
            let problem = DecisionProblem::new(&model, Costs::SECONDS, actions);
            let name = format!("{objects} × {attributes}, {shown}");
            let mut row = vec![name, best(&problem)];
            row.extend(registry::names().map(|name| {
                let awaited = first_s(&problem, name) * DECISIONS_LARGER <= effort.budget_s;
                if awaited { value(&problem, name, CUT_LARGER) } else { "–".to_owned() }
            }));
            rows.push(row);
        }
    }
    let note = format!(
        "Random scenes in another room, costs in seconds. Dialogues less probable than \
         {CUT_LARGER:e} end with a pick at once, which takes up to a tenth or so from every \
         column. A dash: its decisions would take longer than this table is worth.",
    );
    let heads = ["objects × attributes, questions", "best policy"];
    report.table("Values on larger scenes", note, heads.into_iter().chain(registry::names()), rows);
}

/// Certified bounds on the best policy's value.
fn best(problem: &DecisionProblem<'_>) -> String {
    let belief = Belief::uniform(problem.model.objects());
    let bounds = Optimal::default().decide(problem, &belief, Step::default()).bounds;
    let (lower, upper) = bounds.unwrap_or((f64::NAN, f64::NAN));
    format!("{lower:.4}–{upper:.4}")
}

fn value(problem: &DecisionProblem<'_>, name: &str, cut: f64) -> String {
    let belief = Belief::uniform(problem.model.objects());
    format!("{:.4}", evaluate(&mut *planner(name), problem, &belief, cut).value)
}

/// Seconds that a first decision takes.
fn first_s(problem: &DecisionProblem<'_>, name: &str) -> f64 {
    let belief = Belief::uniform(problem.model.objects());
    let begun = Instant::now();
    planner(name).decide(problem, &belief, Step::default());
    begun.elapsed().as_secs_f64()
}

fn planner(name: &str) -> Box<dyn Planner + Send> {
    registry::planner(name).expect("a planner of the registry")
}
