//! Certified bounds on hard scenes, which do not meet, against time.

use super::scenes::{YES_NO, drawn};
use crate::arm::thread_s;
use crate::report::{Report, print};
use dialogue::{Belief, Costs, DecisionProblem, Lookahead, Optimal, Planner, Step, evaluate};
use std::time::Instant;

/// Objects of the scenes, of five attributes each.
const OBJECTS: [usize; 2] = [50, 100];
/// How many scenes of a size there are.
const DRAWS: u64 = 10;
/// Seconds of processor time that a column allows.
const SECONDS: [f64; 5] = [1.0, 5.0, 15.0, 30.0, 60.0];
/// Beliefs of the search in the first attempt, and of the easier problem that bounds it from above for each of
/// them; the next attempt may look at twice as many.
const FIRST: usize = 1_000;
const EASIER: usize = 20;
/// Most beliefs of the search: each takes one to four kilobytes.
const SEARCHED_MAX: usize = 100_000;
/// Dialogues less probable than this are cut short in the value of `lookahead`.
const CUT: f64 = 1e-5;

/// What an attempt has shown.
struct Attempt {
    /// Beliefs that the search could look at.
    searched: usize,
    lower: f64,
    upper: f64,
    processor_s: f64,
    elapsed_s: f64,
}

/// Measures with at most `limit_s` seconds of processor time for an attempt, and that many again for those
/// before it.
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
        let attempts = attempts(&problem, columns.last().copied().unwrap_or(limit_s));
        row.extend(columns.iter().map(|seconds| cell(&attempts, *seconds)));
        let belief = Belief::uniform(objects);
        let value = evaluate(&mut Lookahead::default(), &problem, &belief, CUT).value;
        row.push(format!("{value:.2}"));
        print(&row.join(" | "));
        rows.push(row);
    }
    let note = format!(
        "Bounds on the value of the best policy at the uniform belief, their gap, and the seconds of \
         processor / elapsed that took, on one thread; beside it the value of `lookahead`, dialogues less \
         probable than {CUT:e} cut short. Yes/no questions, costs in seconds. Each attempt begins anew \
         with twice the beliefs; a column has the best that those of at most its seconds have shown."
    );
    report.table("Certified bounds on hard scenes", note, heads, rows);
}

/// Attempts with more and more beliefs, the last of them expected to end in time.
fn attempts(problem: &DecisionProblem<'_>, limit_s: f64) -> Vec<Attempt> {
    let mut attempts: Vec<Attempt> = Vec::new();
    for doubled in 0.. {
        let searched = FIRST << doubled;
        let before_s = attempts.last().map_or(0.0, |attempt| attempt.processor_s);
        if attempts.len() > 1 && before_s * 2.0 > limit_s || is_exhausted(&attempts) {
            break;
        }
        attempts.push(attempt(problem, searched));
    }
    attempts
}

/// Returns whether twice the beliefs have shown nothing more, with all the memory that the search may have.
fn is_exhausted(attempts: &[Attempt]) -> bool {
    let Some([before, last]) = attempts.last_chunk() else { return false };
    let bounds = |attempt: &Attempt| (attempt.lower, attempt.upper);
    before.searched >= SEARCHED_MAX && bounds(before) == bounds(last)
}

fn attempt(problem: &DecisionProblem<'_>, beliefs: usize) -> Attempt {
    let mut planner = Optimal::default();
    // No gap is close enough: what is measured is how far the bounds can be tightened.
    planner.tolerance = 0.0;
    let searched = beliefs.min(SEARCHED_MAX);
    planner.beliefs_max = searched;
    planner.certify_max = beliefs * EASIER;
    let belief = Belief::uniform(problem.model.objects());
    let (begun, used) = (Instant::now(), thread_s());
    let bounds = planner.decide(problem, &belief, Step::default()).bounds;
    let (lower, upper) = bounds.unwrap_or((f64::NAN, f64::NAN));
    let (processor_s, elapsed_s) = (thread_s() - used, begun.elapsed().as_secs_f64());
    Attempt { searched, lower, upper, processor_s, elapsed_s }
}

fn cell(attempts: &[Attempt], seconds: f64) -> String {
    let mut within = attempts.iter().filter(|attempt| attempt.processor_s <= seconds);
    let Some(first) = within.next() else { return "–".to_owned() };
    let (mut lower, mut upper, mut last) = (first.lower, first.upper, first);
    for attempt in within {
        (lower, upper, last) = (lower.max(attempt.lower), upper.min(attempt.upper), attempt);
    }
    let Attempt { processor_s, elapsed_s, .. } = last;
    format!("{lower:.2}–{upper:.2}, {:.2}, {processor_s:.1} / {elapsed_s:.1}", upper - lower)
}
