//! Growth of the time of decisions and updates with the numbers of objects and attributes.

use super::scenes::{OPEN, random};
use super::{Effort, micros, update};
use crate::report::{Plot, Report, Series, percentile};
use dialogue::{Belief, Costs, DecisionProblem, Model, Step, registry};

/// Planners that are made for large scenes.
const PLANNERS: [&str; 2] = ["lookahead", "entropy"];
const OBJECTS: [usize; 8] = [10, 30, 100, 300, 1_000, 3_000, 10_000, 30_000];
const ATTRIBUTES: [usize; 6] = [2, 4, 8, 16, 32, 64];

pub(super) fn measure(report: &mut Report, effort: Effort) {
    let few = Effort { repetitions: effort.repetitions.min(20), ..effort };
    let skip = if effort.quick { 2 } else { 1 };
    let objects: Vec<usize> = OBJECTS.into_iter().step_by(skip).collect();
    let attributes: Vec<usize> = ATTRIBUTES.into_iter().step_by(skip).collect();
    let by_objects = objects.iter().map(|n| (*n, random(*n, 10)));
    let by_objects: Vec<(usize, Model)> = by_objects.collect();
    let by_attributes: Vec<(usize, Model)> =
        attributes.iter().map(|k| (*k, random(1_000, *k))).collect();
    report.plots.push(Plot {
        file: "objects",
        over: "objects, at 10 attributes",
        series: series(&by_objects, few),
    });
    report.plots.push(Plot {
        file: "attributes",
        over: "attributes, at 1,000 objects",
        series: series(&by_attributes, few),
    });
}

fn series(models: &[(usize, Model)], effort: Effort) -> Vec<Series> {
    let points = |cost: &dyn Fn(&Model) -> Vec<f64>| {
        models.iter().map(|(n, model)| (*n as f64, percentile(&cost(model), 0.5))).collect()
    };
    let mut all: Vec<Series> = (PLANNERS.iter())
        .map(|name| Series {
            name: format!("decision of {name}"),
            points: points(&|model| first_decision(name, model, effort)),
        })
        .collect();
    all.push(Series {
        name: "belief update".to_owned(),
        points: points(&|model| update::answers(model, effort)),
    });
    all
}

/// Microseconds of deciding at the uniform belief.
fn first_decision(name: &str, model: &Model, effort: Effort) -> Vec<f64> {
    let problem = DecisionProblem::new(model, Costs::SECONDS, OPEN);
    let belief = Belief::uniform(model.objects());
    let planner = || registry::planner(name).expect("a planner of the registry");
    micros(effort, planner, |mut planner| {
        std::hint::black_box(planner.decide(&problem, &belief, Step::default()));
    })
}
