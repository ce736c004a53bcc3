//! Choices that threads share: a planner that thinks long is not asked twice.

use std::collections::HashMap;
use std::sync::{PoisonError, RwLock};

use evaluation::simulation::{Choice, Shared, Situation};

/// The choices of one policy. Each thread looks into its own memory first, so locks are seldom
/// waited for.
#[derive(Default)]
pub(super) struct Board(RwLock<HashMap<Situation, Choice>>);

/// Most choices that are kept; the first ones stay, as they are the ones that come again.
const CHOICES_MAX: usize = 1 << 19;

impl Shared for Board {
    fn find(&self, situation: &Situation) -> Option<Choice> {
        // Every entry is whole, also where a thread has panicked.
        self.0.read().unwrap_or_else(PoisonError::into_inner).get(situation).copied()
    }

    fn keep(&self, situation: &Situation, choice: Choice) {
        let mut choices = self.0.write().unwrap_or_else(PoisonError::into_inner);
        if choices.len() < CHOICES_MAX {
            choices.insert(situation.clone(), choice);
        }
    }
}
