//! Queues that forget their oldest items.

use std::collections::VecDeque;

/// Appends an item to at most `most` ones; drops the oldest for it.
pub fn push_bounded<T>(queue: &mut VecDeque<T>, most: usize, item: T) {
    if queue.len() >= most {
        queue.pop_front();
    }
    queue.push_back(item);
}
