//! Working ahead: what a planner can know before anybody has said a word.

use super::Mind;
use crate::state::State;
use dialogue::{DecisionProblem, PolicyTable};

impl Mind {
    /// The decision problem that the planner is asked about.
    pub fn problem(&self) -> DecisionProblem<'_> {
        let Self { model, costs, durations, actions, .. } = self;
        let durations = durations.as_ref();
        DecisionProblem { model, costs: *costs, actions: *actions, durations }
    }

    /// Lets the planner work ahead from what is believed before anything was ever said or fetched,
    /// and tells what it knows then, if it is of the kind that keeps something.
    pub fn prepare(&mut self) -> Option<&PolicyTable> {
        let prior = self.prior(&State::default());
        let Self { model, costs, durations, actions, planner, .. } = self;
        let durations = durations.as_ref();
        let problem = DecisionProblem { model, costs: *costs, actions: *actions, durations };
        planner.table()?;
        planner.prepare(&problem, &prior);
        planner.table().filter(|table| !table.is_empty())
    }

    /// Takes what was worked out before, if it is of this problem; says whether it did.
    pub fn adopt(&mut self, table: PolicyTable) -> bool {
        let fits = self.planner.table().is_some() && table.fits(&self.problem());
        if fits {
            self.planner.adopt(table);
        }
        fits
    }

    /// The decisions that the planner has worked out and keeps.
    pub fn table(&self) -> Option<&PolicyTable> {
        self.planner.table()
    }
}
