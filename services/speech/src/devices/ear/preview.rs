//! What is being said while it is being said, on a thread of its own.
//!
//! Invariant: it holds nothing up. It has a recogniser of its own, runs behind everything else, and
//! what it cannot take in time is left out.

use crossbeam_channel::{Receiver, Sender};

use super::EarEvent;
use crate::devices::recogniser::{Preview, PreviewOpener};

/// Pieces of sound that may wait: more than a second.
pub(super) const PIECES_MAX: usize = 4;
/// How far it stands back behind the threads that answer (nice).
const PATIENCE: i32 = 10;

/// Works until nobody has pieces to give or nobody takes events.
pub(super) fn run(
    open: PreviewOpener,
    pieces: &Receiver<(u64, Vec<i16>)>,
    events: &Sender<EarEvent>,
) {
    // Where it may not stand back it works all the same.
    let _ = rustix::process::setpriority_process(Some(rustix::thread::gettid()), PATIENCE);
    let Some(preview) = open() else { return };
    let mut going_on = GoingOn { preview, id: 0, text: String::new() };
    for (id, samples) in pieces {
        if let Some(text) = going_on.hear(id, &samples)
            && events.send(EarEvent::SoFar { id, text }).is_err()
        {
            return;
        }
    }
}

/// The utterance that is going on.
struct GoingOn {
    preview: Box<dyn Preview>,
    id: u64,
    text: String,
}

impl GoingOn {
    /// Returns the words so far where they have changed.
    fn hear(&mut self, id: u64, samples: &[i16]) -> Option<String> {
        // Of people who speak at a time the last to begin is followed: numbers rise.
        if id < self.id {
            return None;
        }
        if id > self.id {
            (self.id, self.text) = (id, String::new());
            self.preview.begin().ok()?;
        }
        let text = self.preview.hear(samples).ok()?;
        if text == self.text {
            return None;
        }
        self.text.clone_from(&text);
        Some(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::recogniser::RecogniseError;
    use crossbeam_channel::unbounded;

    /// Hears a word for every piece, the same one twice.
    struct Stub(usize);

    impl Preview for Stub {
        fn begin(&mut self) -> Result<(), RecogniseError> {
            self.0 = 0;
            Ok(())
        }

        fn hear(&mut self, _: &[i16]) -> Result<String, RecogniseError> {
            self.0 += 1;
            Ok(["", "the", "the", "the white"][self.0 - 1].to_owned())
        }
    }

    #[test]
    fn words_are_told_when_they_change_of_the_one_who_began_last() {
        let ((give, pieces), (events, told)) = (unbounded(), unbounded());
        for id in [5, 5, 5, 5, 7, 7, 5, 5] {
            give.send((id, vec![0; 10])).unwrap();
        }
        drop(give);
        run(Box::new(|| Some(Box::new(Stub(0)))), &pieces, &events);
        drop(events);
        let so_far = |id, text: &str| EarEvent::SoFar { id, text: text.to_owned() };
        let expected = [so_far(5, "the"), so_far(5, "the white"), so_far(7, "the")];
        assert_eq!(told.iter().collect::<Vec<_>>(), expected);
    }
}
