//! Decisions that threads share: a slow planner is not asked twice.

use std::collections::HashMap;
use std::sync::{Arc, PoisonError, RwLock};

use dialogue::Decision;
use evaluation::simulation::{SharedDecisions, Situation};

/// Decisions of one planner. Each thread looks into its own cache first, so locks are rarely
/// contended.
#[derive(Default)]
pub(super) struct Board(RwLock<HashMap<Situation, Arc<Decision>>>);

/// Most decisions that are kept; the first ones stay, as they are the most frequent.
const DECISIONS_MAX: usize = 1 << 19;

impl SharedDecisions for Board {
    fn find(&self, situation: &Situation) -> Option<Arc<Decision>> {
        // Every entry is whole, also where a thread has panicked.
        self.0.read().unwrap_or_else(PoisonError::into_inner).get(situation).cloned()
    }

    fn add(&self, situation: &Situation, decision: &Arc<Decision>) {
        let mut decisions = self.0.write().unwrap_or_else(PoisonError::into_inner);
        if decisions.len() < DECISIONS_MAX {
            decisions.insert(situation.clone(), Arc::clone(decision));
        }
    }
}
