//! The thread that a grounder runs on, so that the service beats while a model thinks.

use std::io::{Read, Write};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::net::UnixStream;
use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, TrySendError, sync_channel};

use messages::topics::WINDOW;
use messages::{Observation, Utterance};
use runtime::exit::{Exit, Failure};
use runtime::{Time, clock};
use scene::Scene;

use super::observation::{check, message};
use super::{Grounded, Grounder, Heard};
use crate::Interpretation;

/// An utterance with its observation; none where the utterance makes no sense.
pub(super) type Answer = (Box<Utterance>, Option<Box<Observation>>);

/// The thread, as the service's main loop sees it.
pub(super) struct Worker {
    work: SyncSender<Box<Utterance>>,
    answers: Receiver<Answer>,
    /// A byte for each answer.
    wake: UnixStream,
    /// Utterances that it has, oldest first, and when each arrived.
    pending: Vec<(u64, Time)>,
}

impl Worker {
    /// Starts the thread.
    ///
    /// # Errors
    /// The operating system has no thread or no descriptor.
    pub(super) fn start(
        grounder: impl Grounder + Send + 'static,
        scene: Scene,
    ) -> std::io::Result<Self> {
        let (work, waiting) = sync_channel(WINDOW);
        let (answered, answers) = sync_channel(WINDOW + 1);
        let (wake, bell) = UnixStream::pair()?;
        wake.set_nonblocking(true)?;
        bell.set_nonblocking(true)?;
        let work_through = move || ground_all(grounder, &scene, &waiting, &answered, &bell);
        std::thread::Builder::new().name("grounder".into()).spawn(work_through)?;
        Ok(Self { work, answers, wake, pending: Vec::new() })
    }

    /// Readable once there is an answer.
    pub(super) fn fd(&self) -> BorrowedFd<'_> {
        self.wake.as_fd()
    }

    /// Gives it an utterance, unless it has that one. One for which there is no room is sent again.
    pub(super) fn give(&mut self, utterance: &Utterance, now: Time) -> Result<(), Failure> {
        if self.pending.iter().any(|(seq, _)| *seq == utterance.seq) {
            return Ok(());
        }
        match self.work.try_send(Box::new(*utterance)) {
            Ok(()) => self.pending.push((utterance.seq, now)),
            Err(TrySendError::Full(_)) => {}
            Err(TrySendError::Disconnected(_)) => return Err(gone()),
        }
        Ok(())
    }

    /// Returns the next answer, if there is one.
    pub(super) fn take(&mut self) -> Result<Option<Answer>, Failure> {
        let mut bytes = [0; 64];
        while self.wake.read(&mut bytes).is_ok_and(|read| read == bytes.len()) {}
        match self.answers.try_recv() {
            Ok(answer) => {
                self.pending.retain(|(seq, _)| *seq != answer.0.seq);
                Ok(Some(answer))
            }
            Err(TryRecvError::Empty) => Ok(None),
            Err(TryRecvError::Disconnected) => Err(gone()),
        }
    }

    /// Returns the arrival of the oldest utterance that it has.
    pub(super) fn pending_since(&self) -> Option<Time> {
        self.pending.first().map(|(_, arrived)| *arrived)
    }
}

fn gone() -> Failure {
    Failure::new(Exit::Invariant, "the grounder has panicked; its message is above")
}

/// The thread: grounds one utterance after another until the service ends.
fn ground_all(
    mut grounder: impl Grounder,
    scene: &Scene,
    waiting: &Receiver<Box<Utterance>>,
    answered: &SyncSender<Answer>,
    mut bell: &UnixStream,
) {
    for utterance in waiting {
        let observation = ground(&mut grounder, scene, &utterance).map(Box::new);
        if answered.send((utterance, observation)).is_err() {
            return;
        }
        // A full pipe wakes as well.
        let _ = bell.write(&[1]);
    }
}

fn ground(
    grounder: &mut impl Grounder,
    scene: &Scene,
    utterance: &Utterance,
) -> Option<Observation> {
    let seq = utterance.seq;
    let heard = match Heard::new(utterance, scene) {
        Ok(heard) => heard,
        Err(error) => {
            tracing::warn!(seq, %error, "utterance refused");
            return None;
        }
    };
    let mut grounded = grounder.ground(&heard, scene);
    if let Err(error) = check(&grounded, &heard, scene) {
        tracing::error!(seq, %error, "the grounder's answer is invalid; nothing counts as understood");
        grounded = nothing(&heard);
    }
    Some(message(utterance, &heard, scene, &grounded, clock::now()))
}

/// The meaning of an utterance of which nothing is understood, so that the dialogue goes on.
fn nothing(heard: &Heard) -> Grounded {
    let places = (0..heard.questions.len()).map(Some).chain([None]);
    let interpretations = places.map(|answers| Interpretation {
        weight: 1.0,
        answers,
        reading: scene::Reading { intent: scene::Intent::None, ..scene::Reading::default() },
    });
    Grounded { interpretations: interpretations.collect(), unknown: None }
}
