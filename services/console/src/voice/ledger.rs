//! Which streams of sound there are, and whether a frame goes on with one of them.

use crate::hub::ViewerId;

/// Streams at a time, those included whose end is not told yet.
pub(super) const STREAMS_MAX: usize = 6;
/// Longest loss in the middle of a stream, samples: a minute.
const GAP_MAX: u64 = 960_000;

/// Names a stream: its viewer, and the number that the page gave it.
pub(super) type Name = (ViewerId, u32);

/// What a frame comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// A stream begins with it.
    Begin,
    /// It goes on with its stream, so many samples of which are missing before it.
    GoOn(u64),
    /// It was heard before, or comes behind its stream's end.
    Ignore,
}

/// The streams that go on or have ended of late.
#[derive(Debug, Default)]
pub(super) struct Ledger(Vec<Entry>);

#[derive(Debug)]
struct Entry {
    name: Name,
    next: u64,
    ends: bool,
}

impl Ledger {
    /// Takes in a frame: `count` samples with `before` samples of the stream before them.
    ///
    /// # Errors
    /// Why it cannot be taken, in words for the viewer.
    pub(super) fn take(&mut self, name: Name, before: u64, count: usize) -> Result<Step, String> {
        let next = before.checked_add(count as u64).ok_or("a stream of sound is too long")?;
        let Some(entry) = self.0.iter_mut().find(|entry| entry.name == name) else {
            if self.0.len() >= STREAMS_MAX {
                return Err("too many people talk at a time; wait a moment".to_owned());
            }
            self.0.push(Entry { name, next, ends: false });
            return Ok(Step::Begin);
        };
        let Some(gap) = before.checked_sub(entry.next).filter(|_| !entry.ends) else {
            return Ok(Step::Ignore);
        };
        if gap > GAP_MAX {
            return Err(format!("{gap} samples of a stream are missing; begin a new one"));
        }
        entry.next = next;
        Ok(Step::GoOn(gap))
    }

    /// The streams of a viewer that go on, but for one.
    pub(super) fn others(&self, (viewer, number): Name) -> Vec<Name> {
        let other =
            |entry: &&Entry| !entry.ends && entry.name.0 == viewer && entry.name.1 != number;
        self.0.iter().filter(other).map(|entry| entry.name).collect()
    }

    /// The streams of a viewer that go on.
    pub(super) fn of(&self, viewer: ViewerId) -> Vec<Name> {
        let own = |entry: &&Entry| !entry.ends && entry.name.0 == viewer;
        self.0.iter().filter(own).map(|entry| entry.name).collect()
    }

    /// A stream ends: nothing that comes behind is taken.
    pub(super) fn end(&mut self, name: Name) {
        self.0.iter_mut().filter(|entry| entry.name == name).for_each(|entry| entry.ends = true);
    }

    /// A stream is over: everything about it is known.
    pub(super) fn forget(&mut self, name: Name) {
        self.0.retain(|entry| entry.name != name);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ANNA: ViewerId = ViewerId(1);
    const BEN: ViewerId = ViewerId(2);

    #[test]
    fn frames_follow_each_other_and_what_is_missing_is_counted() {
        let mut ledger = Ledger::default();
        assert_eq!(ledger.take((ANNA, 1), 0, 800), Ok(Step::Begin));
        assert_eq!(ledger.take((ANNA, 1), 800, 800), Ok(Step::GoOn(0)));
        assert_eq!(ledger.take((ANNA, 1), 3_200, 800), Ok(Step::GoOn(1_600)));
        assert_eq!(ledger.take((ANNA, 1), 800, 800), Ok(Step::Ignore));
        assert!(ledger.take((ANNA, 1), 1 << 40, 800).is_err());
        assert!(ledger.take((ANNA, 1), u64::MAX, 800).is_err());
        assert_eq!(ledger.take((ANNA, 1), 4_000, 0), Ok(Step::GoOn(0)), "and it goes on");
    }

    #[test]
    fn what_comes_behind_the_end_is_left_out_until_the_stream_is_forgotten() {
        let mut ledger = Ledger::default();
        ledger.take((ANNA, 1), 0, 800).unwrap();
        ledger.end((ANNA, 1));
        assert_eq!(ledger.take((ANNA, 1), 800, 800), Ok(Step::Ignore));
        ledger.forget((ANNA, 1));
        assert_eq!(ledger.take((ANNA, 1), 1_600, 800), Ok(Step::Begin));
    }

    #[test]
    fn viewers_have_streams_of_their_own_and_one_goes_on_for_each() {
        let mut ledger = Ledger::default();
        for name in [(ANNA, 1), (ANNA, 2), (BEN, 1)] {
            assert_eq!(ledger.take(name, 0, 800), Ok(Step::Begin));
        }
        assert_eq!(ledger.others((ANNA, 2)), [(ANNA, 1)]);
        ledger.end((ANNA, 1));
        assert_eq!((ledger.others((ANNA, 2)), ledger.of(BEN)), (vec![], vec![(BEN, 1)]));
        for number in 10..13 {
            assert_eq!(ledger.take((BEN, number), 0, 800), Ok(Step::Begin));
        }
        let full = ledger.take((BEN, 20), 0, 800).unwrap_err();
        assert!(full.contains("wait"), "{full}");
    }
}
