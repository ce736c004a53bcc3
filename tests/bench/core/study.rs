//! Simulated interactions: how many a study holds in a second.

use super::Effort;
use super::scenes::{YES_NO, configured};
use crate::arm::thread_s;
use crate::report::Report;
use dialogue::{DecisionProblem, Model, registry};
use evaluation::simulation::{CHUNK, CachedPlanner, Room, UserKind, interactions};
use language::Reader;
use preflight::{Pace, Voice};
use vocabulary::{Acquaintance, Costs, Language, Params, TurnTaking};

/// Chunks of interactions that are timed, after one that fills the planner's memory.
const CHUNKS: u64 = 20;

pub(super) fn measure(report: &mut Report, effort: Effort) {
    let scene = configured("bowls");
    let model = Model::new(&scene, Params::default());
    let (reader, pace) = (Reader::new(&scene, Language::Careful), Pace::default());
    let room = Room {
        scene: &scene,
        reader: &reader,
        problem: DecisionProblem::new(&model, Costs::SECONDS, YES_NO),
        turns: TurnTaking::default(),
        voice: Voice::default(),
        pace: &pace,
        motions: None,
        people: Acquaintance::default(),
        request: true,
        denials: true,
    };
    let chunks = if effort.quick { 1 } else { CHUNKS };
    for (name, kind) in [("model", UserKind::Model), ("human", UserKind::Human)] {
        let planner = registry::planner("lookahead").expect("a planner of that name");
        let mut manager = room.manager(CachedPlanner::new(planner));
        let mut rate = |chunk: u64| {
            let begun = thread_s();
            let numbers = chunk * CHUNK..(chunk + 1) * CHUNK;
            let tally = interactions(&room, &mut manager, kind, 1, numbers);
            tally.interactions() as f64 / (thread_s() - begun)
        };
        rate(0);
        let rates: Vec<f64> = (1..=chunks).map(rate).collect();
        let what = format!("interactions of a study, users `{name}`, one core");
        report.add(&what, "1/s", &rates, "six bowls, lookahead; decisions remembered");
    }
}
