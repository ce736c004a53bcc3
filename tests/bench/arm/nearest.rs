//! The posture nearest to a seed: how near, and how fast.

use super::Effort;
use super::inverse::{Outcome, Own, Seed, heads, run};
use super::judge::Rule;
use super::targets::Target;
use crate::report::{Report, Table};

pub(super) fn measure(
    report: &mut Report,
    targets: &[Target],
    python: &super::python::Measured,
    effort: Effort,
) {
    let few = &targets[..effort.peers];
    let mut rows = Vec::new();
    for (seed, from) in [(Seed::Middle, "middle"), (Seed::Random, "random")] {
        let own = run(&mut Own::Nearest, few, seed, Rule::OWN);
        let peers = python.outcomes(targets, true, seed);
        rows.extend(std::iter::once(&own).chain(&peers).map(|outcome: &Outcome| {
            let mut cells = outcome.cells(own.mean());
            cells.insert(1, from.to_owned());
            cells
        }));
    }
    let mut heads = heads();
    heads.insert(1, "seed".to_owned());
    let note = "The same targets; distances are means over what was solved. Peers look for better answers until their time is up.";
    report.tables.push(Table {
        title: "Inverse kinematics nearest to a seed".to_owned(),
        note: note.to_owned(),
        heads,
        rows,
    });
}
