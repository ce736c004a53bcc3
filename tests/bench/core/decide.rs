//! Time per decision of every planner, from six bowls to very large scenes.

use super::scenes::{OPEN, YES_NO, beliefs, configured, in_doubt, random};
use super::{Effort, micros};
use crate::report::{Report, percentile};
use dialogue::{DecisionProblem, Model, Step, registry};
use vocabulary::{Actions, Costs, Params};

/// A scene, its size (objects times attributes), and its model.
struct Place {
    name: &'static str,
    size: usize,
    model: Model,
    actions: Actions,
}

pub(super) fn measure(report: &mut Report, effort: Effort) {
    let small = |name: &'static str, shown, actions| {
        let model = Model::new(&configured(name), Params::default());
        Place { name: shown, size: model.objects() * model.attributes(), model, actions }
    };
    let doubtful = Model::new(&in_doubt(&configured("bowls")), Params::default());
    let large = |name, objects, attributes| Place {
        name,
        size: objects * attributes,
        model: random(objects, attributes),
        actions: OPEN,
    };
    let places = [
        small("markers", "2 markers", YES_NO),
        small("bowls", "6 bowls, yes/no", YES_NO),
        small("bowls", "6 bowls, open too", OPEN),
        Place { name: "6 bowls in doubt", size: 30, model: doubtful, actions: OPEN },
        large("1,000 × 10", 1_000, 10),
        large("10,000 × 20", 10_000, 20),
    ];
    let heads = ["planner, µs per decision: first / p50 / p99"];
    let heads = heads.into_iter().chain(places.iter().map(|place| place.name));
    let rows = registry::names().iter().map(|name| row(name, &places, effort, report)).collect();
    let note = format!(
        "A new planner for each decision, so that nothing is remembered: the first is at the \
         uniform belief, the others at beliefs that dialogues lead to. Costs in seconds. A \
         planner is left out of a scene where it would need more than {} s, judged by the \
         smaller scene before it.",
        effort.budget_s
    );
    report.table("Decisions", note, heads, rows);
}

fn row(name: &str, places: &[Place], effort: Effort, report: &mut Report) -> Vec<String> {
    let mut row = vec![name.to_owned()];
    let mut before: Option<(usize, f64)> = None;
    for place in places {
        let grows = |(size, micros): (usize, f64)| micros * (place.size as f64 / size as f64);
        let expected_s = before.map_or(0.0, grows) / 1e6;
        if expected_s > effort.budget_s {
            row.push(format!("left out: {expected_s:.0} s expected"));
            continue;
        }
        let (first, samples) = samples(name, place, effort);
        let [p50, p99] = [0.5, 0.99].map(|share| percentile(&samples, share));
        row.push(format!("{first:.1} / {p50:.1} / {p99:.1}"));
        report.add(&format!("decision of {name}, {}", place.name), "µs", &samples, "");
        before = Some((place.size, first.max(p50)));
    }
    row
}

/// The time at the uniform belief, best of a few, and the times at others.
fn samples(name: &str, place: &Place, effort: Effort) -> (f64, Vec<f64>) {
    let (model, actions) = (&place.model, place.actions);
    let problem = DecisionProblem::new(model, Costs::SECONDS, actions);
    let beliefs = beliefs(&problem, if place.size > 1_000 { 3 } else { 20 });
    let planner = || registry::planner(name).expect("a planner of the registry");
    let decide = |mut planner: Box<dyn dialogue::Planner + Send>, belief| {
        std::hint::black_box(planner.decide(&problem, belief, Step { interaction: 1, step: 1 }));
    };
    let few = Effort { repetitions: 5, ..effort };
    let first = micros(few, planner, |planner| decide(planner, &beliefs[0]));
    let mut others = beliefs.iter().cycle();
    let prepare = || (planner(), others.next().unwrap_or(&beliefs[0]));
    let samples = micros(effort, prepare, |(planner, belief)| decide(planner, belief));
    (percentile(&first, 0.0), samples)
}
