//! The audio streams, and the assignment of frames to them.

use crate::hub::ViewerId;

/// Most streams at a time, those included whose end is not confirmed yet.
pub(super) const STREAMS_MAX: usize = 6;
/// Longest loss in the middle of a stream, samples: a minute.
const GAP_MAX: u64 = 960_000;

/// Names a stream: its viewer, and the number that the page gave it.
pub(super) type Name = (ViewerId, u32);

/// A frame's relation to its stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FrameKind {
    /// The frame begins a stream.
    Begin,
    /// The frame continues its stream after this many lost samples.
    Next(u64),
    /// The frame is a repetition, or comes after the end of its stream.
    Ignore,
}

/// The open streams and those that have ended recently.
#[derive(Debug, Default)]
pub(super) struct StreamTable(Vec<Entry>);

#[derive(Debug)]
struct Entry {
    name: Name,
    next: u64,
    ends: bool,
}

impl StreamTable {
    /// Takes in a frame of `count` samples after `before` samples of the stream.
    pub(super) fn take(
        &mut self,
        name: Name,
        before: u64,
        count: usize,
    ) -> Result<FrameKind, String> {
        let next = before.checked_add(count as u64).ok_or("a stream of sound is too long")?;
        let Some(entry) = self.0.iter_mut().find(|entry| entry.name == name) else {
            if self.0.len() >= STREAMS_MAX {
                return Err("too many streams are open; help: wait a moment".to_owned());
            }
            self.0.push(Entry { name, next, ends: false });
            return Ok(FrameKind::Begin);
        };
        let Some(gap) = before.checked_sub(entry.next).filter(|_| !entry.ends) else {
            return Ok(FrameKind::Ignore);
        };
        if gap > GAP_MAX {
            let gap = scene::count(gap, "sample");
            return Err(format!("a stream lacks {gap}; help: begin a new stream"));
        }
        entry.next = next;
        Ok(FrameKind::Next(gap))
    }

    /// Returns the other open streams of a viewer.
    pub(super) fn others(&self, (viewer, number): Name) -> Vec<Name> {
        let other =
            |entry: &&Entry| !entry.ends && entry.name.0 == viewer && entry.name.1 != number;
        self.0.iter().filter(other).map(|entry| entry.name).collect()
    }

    pub(super) fn of(&self, viewer: ViewerId) -> Vec<Name> {
        let own = |entry: &&Entry| !entry.ends && entry.name.0 == viewer;
        self.0.iter().filter(own).map(|entry| entry.name).collect()
    }

    /// Ends a stream: later frames are ignored.
    pub(super) fn end(&mut self, name: Name) {
        self.0.iter_mut().filter(|entry| entry.name == name).for_each(|entry| entry.ends = true);
    }

    /// Forgets a stream whose end is confirmed.
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
    fn stream_table_counts_lost_samples() {
        let mut table = StreamTable::default();
        assert_eq!(table.take((ANNA, 1), 0, 800), Ok(FrameKind::Begin));
        assert_eq!(table.take((ANNA, 1), 800, 800), Ok(FrameKind::Next(0)));
        assert_eq!(table.take((ANNA, 1), 3_200, 800), Ok(FrameKind::Next(1_600)));
        assert_eq!(table.take((ANNA, 1), 800, 800), Ok(FrameKind::Ignore));
        assert!(table.take((ANNA, 1), 1 << 40, 800).is_err());
        assert!(table.take((ANNA, 1), u64::MAX, 800).is_err());
        assert_eq!(table.take((ANNA, 1), 4_000, 0), Ok(FrameKind::Next(0)), "the stream continues");
    }

    #[test]
    fn stream_table_ignores_frames_after_the_end() {
        let mut table = StreamTable::default();
        table.take((ANNA, 1), 0, 800).unwrap();
        table.end((ANNA, 1));
        assert_eq!(table.take((ANNA, 1), 800, 800), Ok(FrameKind::Ignore));
        table.forget((ANNA, 1));
        assert_eq!(table.take((ANNA, 1), 1_600, 800), Ok(FrameKind::Begin));
    }

    #[test]
    fn stream_table_keeps_viewers_apart_and_is_bounded() {
        let mut table = StreamTable::default();
        for name in [(ANNA, 1), (ANNA, 2), (BEN, 1)] {
            assert_eq!(table.take(name, 0, 800), Ok(FrameKind::Begin));
        }
        assert_eq!(table.others((ANNA, 2)), [(ANNA, 1)]);
        table.end((ANNA, 1));
        assert_eq!((table.others((ANNA, 2)), table.of(BEN)), (vec![], vec![(BEN, 1)]));
        for number in 10..13 {
            assert_eq!(table.take((BEN, number), 0, 800), Ok(FrameKind::Begin));
        }
        let full = table.take((BEN, 20), 0, 800).unwrap_err();
        assert!(full.contains("wait"), "{full}");
    }
}
