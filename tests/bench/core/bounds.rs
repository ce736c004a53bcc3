//! Certified bounds on hard scenes, which do not meet, against time.

use super::scenes::{YES_NO, drawn};
use crate::report::{Report, print};
use dialogue::{Belief, DecisionProblem, Lookahead, Optimal, Planner, Step, evaluate};
use std::time::Instant;
use vocabulary::Costs;

/// Objects of the scenes, of five attributes each.
const OBJECTS: [usize; 2] = [50, 100];
/// How many scenes of a size there are.
const DRAWS: u64 = 10;
/// Seconds that a column allows.
const SECONDS: [f64; 5] = [1.0, 5.0, 15.0, 30.0, 60.0];
/// Beliefs of the search before a plan is improved.
const SEARCHED: usize = 4_000;
/// Beliefs that the plan is improved with in the first attempt.
const FIRST: usize = 2_000;
/// Beliefs of the easier problem, which bounds the value from above, for each of them.
const EASIER: usize = 10;
/// An attempt is expected to take this share of the time that its column allows.
const EXPECTED: f64 = 0.8;
/// Most beliefs that the plan is improved with: each takes one to four kilobytes.
const PLAN_MAX: usize = 250_000;
/// Dialogues less probable than this are cut short in the value of `lookahead`.
const CUT: f64 = 1e-5;

/// What an attempt has shown.
struct Attempt {
    /// Beliefs that the plan might be improved with, but for [`PLAN_MAX`].
    beliefs: usize,
    lower: f64,
    upper: f64,
    processor_s: f64,
    elapsed_s: f64,
}

/// Measures with at most about `limit_s` seconds for an attempt.
pub(crate) fn measure(report: &mut Report, limit_s: f64, quick: bool) {
    let columns: Vec<f64> = SECONDS.into_iter().filter(|seconds| *seconds <= limit_s).collect();
    let mut heads = vec!["objects × attributes, scene".to_owned()];
    heads.extend(columns.iter().map(|seconds| format!("{seconds} s")));
    heads.push("`lookahead`".to_owned());
    let draws = if quick { 1 } else { DRAWS };
    let scenes = OBJECTS.into_iter().flat_map(|n| (0..draws).map(move |draw| (n, draw)));
    let mut rows = Vec::new();
    for (objects, draw) in scenes {
        let model = drawn(objects, 5, draw);
        let problem = DecisionProblem::new(&model, Costs::SECONDS, YES_NO);
        let mut row = vec![format!("{objects} × 5, {draw}")];
        let attempts = attempts(&problem, &columns);
        row.extend(columns.iter().map(|seconds| cell(&attempts, *seconds)));
        let belief = Belief::uniform(objects);
        let value = evaluate(&mut Lookahead::default(), &problem, &belief, CUT).value;
        row.push(format!("{value:.2}"));
        print(&row.join(" | "));
        rows.push(row);
    }
    let note = format!(
        "Bounds on the value of the best policy at the uniform belief, their gap, and the seconds of \
         processor / elapsed that took, on two threads; beside it the value of `lookahead`, dialogues less \
         probable than {CUT:e} cut short. Yes/no questions, costs in seconds. Each column has an attempt that begins \
         anew, with as many beliefs as are expected to fit, and shows the best of those that have ended in time."
    );
    report.table("Certified bounds on hard scenes", note, heads, rows);
}

/// A first attempt, and one for each column.
fn attempts(problem: &DecisionProblem<'_>, columns: &[f64]) -> Vec<Attempt> {
    let mut attempts = vec![attempt(problem, FIRST)];
    for seconds in columns {
        let last = &attempts[attempts.len() - 1];
        let beliefs = last.beliefs as f64 * EXPECTED * seconds / last.elapsed_s;
        if beliefs as usize > last.beliefs && !is_exhausted(&attempts) {
            attempts.push(attempt(problem, beliefs as usize));
        }
    }
    attempts
}

/// Returns whether more beliefs have shown nothing more, with all the memory that the plan may have.
fn is_exhausted(attempts: &[Attempt]) -> bool {
    let Some([before, last]) = attempts.last_chunk() else { return false };
    let bounds = |attempt: &Attempt| (attempt.lower, attempt.upper);
    before.beliefs >= PLAN_MAX && bounds(before) == bounds(last)
}

fn attempt(problem: &DecisionProblem<'_>, beliefs: usize) -> Attempt {
    let mut planner = Optimal::default();
    // No gap is close enough: what is measured is how far the bounds can be tightened.
    planner.tolerance = 0.0;
    planner.beliefs_max = SEARCHED;
    planner.plan_max = beliefs.min(PLAN_MAX);
    planner.easier_max = beliefs * EASIER;
    let belief = Belief::uniform(problem.model.objects());
    let (begun, used) = (Instant::now(), process_s());
    let bounds = planner.decide(problem, &belief, Step::default()).bounds;
    let (lower, upper) = bounds.unwrap_or((f64::NAN, f64::NAN));
    let (processor_s, elapsed_s) = (process_s() - used, begun.elapsed().as_secs_f64());
    Attempt { beliefs, lower, upper, processor_s, elapsed_s }
}

/// Seconds of processor that this process has used.
fn process_s() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

fn cell(attempts: &[Attempt], seconds: f64) -> String {
    let mut within = attempts.iter().filter(|attempt| attempt.elapsed_s <= seconds);
    let Some(first) = within.next() else { return "–".to_owned() };
    let (mut lower, mut upper, mut last) = (first.lower, first.upper, first);
    for attempt in within {
        (lower, upper, last) = (lower.max(attempt.lower), upper.min(attempt.upper), attempt);
    }
    let Attempt { processor_s, elapsed_s, .. } = last;
    format!("{lower:.2}–{upper:.2}, {:.2}, {processor_s:.1} / {elapsed_s:.1}", upper - lower)
}
