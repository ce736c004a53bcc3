//! Belief updates beside what the memory allows: a plain pass over the same bytes.

use super::scenes::random;
use super::{Effort, micros};
use crate::report::Report;
use dialogue::{Belief, Model};
use scene::{AttributeId, Question, Reading, Response, ValueId};

/// Objects; the largest is the most that a scene can hold (its indices have 16 bits).
const OBJECTS: [usize; 4] = [6, 1_000, 10_000, 65_535];
/// Passes over small arrays that make one sample, so that the clock's own cost does not count.
const PASSES_BYTES: usize = 1 << 20;

pub(super) fn measure(report: &mut Report, effort: Effort) {
    for objects in OBJECTS {
        let model = random(objects, 3);
        let peer = format!("plain pass, {objects} objects");
        let note = "reads the column (2 B), reads and writes the array (8 B)";
        report.add(&peer, "µs", &plain(model.column(AttributeId(1)), effort), note);
        let samples = answers(&model, effort);
        let bytes = objects as f64 * 18.0;
        let rate = bytes / 1e3 / crate::report::percentile(&samples, 0.5);
        let note = format!("yes or no to a question; {rate:.1} GB/s");
        report.add_beside(
            &format!("belief update, {objects} objects"),
            "µs",
            &samples,
            &peer,
            &note,
        );
    }
}

/// Updates with yes and no in turn, µs each.
fn answers(model: &Model, effort: Effort) -> Vec<f64> {
    let question = Question::Attribute(AttributeId(1), ValueId(2));
    let readings =
        [Response::Yes, Response::No].map(|response| Reading { response, ..Reading::default() });
    let mut belief = Belief::uniform(model.objects());
    per_pass(model.objects(), effort, |pass| {
        belief.update(model, question, &readings[pass % 2]);
        std::hint::black_box(&belief);
    })
}

/// The same traffic without the meaning, µs a pass.
fn plain(column: &[u16], effort: Effort) -> Vec<f64> {
    let mut array = vec![0.0_f64; column.len()];
    per_pass(column.len(), effort, |pass| {
        let step = if pass.is_multiple_of(2) { 1.0 } else { -1.0 };
        for (entry, value) in array.iter_mut().zip(column) {
            *entry += if *value == 2 { step } else { -step };
        }
        std::hint::black_box(&array);
    })
}

/// Microseconds of one pass, several to a sample where one is short.
fn per_pass(objects: usize, effort: Effort, mut pass: impl FnMut(usize)) -> Vec<f64> {
    let passes = (PASSES_BYTES / (objects * 18)).max(2);
    let samples = micros(effort, || (), |()| (0..passes).for_each(&mut pass));
    samples.into_iter().map(|sample| sample / passes as f64).collect()
}
