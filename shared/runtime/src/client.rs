//! A client of a running group: submits utterances and reads its topics. Orders to the motion stop
//! have a path of their own, [`crate::stop_socket`].
//!
//! Clients poll; they are few, short-lived, and must not cost the services anything.

use crate::bus::{Bus, BusError, EncodedWriter, Identity, PortError, Reader};
use crate::group::GroupPaths;
use crate::lifecycle::Environment;
use crate::submission::Submission;
use crate::{Span, Time};
use crate::{clock, epoch};
use messages::{ClientId, Injection, Receipt, RequestKey, Sound, topics};
use std::sync::OnceLock;
use std::time::Duration;
use vocabulary::PERSON_BYTES_MAX;

/// First and longest pause of a client that polls.
const POLL_EVERY: (Duration, Duration) = (Duration::from_micros(100), Duration::from_millis(2));

/// Most bytes of an [`Injection`] besides its sound: key, two times, number, name with length.
const INJECTION_BYTES: usize = 16 + 3 * 10 + 1 + PERSON_BYTES_MAX;

/// Pauses of a client that polls topics: short at first, because services answer within a
/// millisecond or two, then longer.
#[derive(Debug)]
pub struct Polling {
    pause: Duration,
}

impl Default for Polling {
    fn default() -> Self {
        Self { pause: POLL_EVERY.0 }
    }
}

impl Polling {
    /// Sleeps until the next look is due.
    pub fn pause(&mut self) {
        std::thread::sleep(self.pause);
        self.pause = (self.pause * 9 / 8).min(POLL_EVERY.1);
    }
}

/// A client's access to the group.
#[derive(Debug)]
pub struct Client {
    bus: Bus,
}

/// Failure of a client's request.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ClientError {
    /// The group is not running.
    #[error("group {0} is not running; help: start it with `whichone up --group {0}`")]
    NoGroup(String),
    /// The group's shared memory cannot be opened.
    #[error(transparent)]
    Bus(#[from] BusError),
    /// A topic failed.
    #[error(transparent)]
    Port(#[from] PortError),
    /// Timeout.
    #[error("{what}: no answer within {seconds} s; help: see `whichone status`")]
    Timeout {
        /// The service.
        what: &'static str,
        /// The timeout, seconds.
        seconds: f64,
    },
    /// A service that the answer needs does nothing for now; the reason.
    #[error("not confirmed: {0}")]
    Standstill(String),
}

impl Client {
    /// Joins the group.
    ///
    /// # Errors
    /// The group is not running, or its messages are of another build.
    pub fn join(paths: &GroupPaths) -> Result<Self, ClientError> {
        let none = || ClientError::NoGroup(paths.name().to_string());
        paths.shm_name().map_err(|_| none())?;
        let epoch = epoch::read(paths).ok().flatten().ok_or_else(none)?;
        let bus = Bus::open(paths, "client", Identity { epoch, ..Identity::default() })?;
        Ok(Self { bus })
    }

    /// Joins the group as one of its services that writes no topic of its own: the console.
    ///
    /// # Errors
    /// The group's shared memory cannot be opened.
    pub fn of_service(environment: &Environment, name: &str) -> Result<Self, BusError> {
        let Environment { paths, epoch, incarnation, .. } = environment;
        let identity = Identity { epoch: *epoch, incarnation: *incarnation };
        Ok(Self { bus: Bus::open(paths, name, identity)? })
    }

    /// The group's shared memory.
    pub fn bus(&self) -> &Bus {
        &self.bus
    }

    /// Opens the topics by which [`deliver`] submits utterances.
    ///
    /// # Errors
    /// They cannot be opened.
    pub fn submissions(&self) -> Result<(EncodedWriter<Injection>, Reader<Receipt>), BusError> {
        self.submissions_of(None)
    }

    /// Opens the topics by which [`deliver`] submits this sound alone, half a millisecond faster.
    ///
    /// # Errors
    /// They cannot be opened.
    pub fn submission(
        &self,
        sound: &Sound,
    ) -> Result<(EncodedWriter<Injection>, Reader<Receipt>), BusError> {
        let bytes = postcard::serialize_with_flavor(sound, postcard::ser_flavors::Size::default());
        self.submissions_of(bytes.ok().map(|bytes| bytes + INJECTION_BYTES))
    }

    fn submissions_of(
        &self,
        bytes_max: Option<usize>,
    ) -> Result<(EncodedWriter<Injection>, Reader<Receipt>), BusError> {
        let receipts = self.bus.reader(&topics::RECEIPT)?;
        Ok((self.bus.encoded_writer_of(&topics::INJECTION, bytes_max)?, receipts))
    }
}

/// Submits `sound`, with the start and end of the utterance (0: its arrival), to the speech service
/// and returns its receipts: one for text, one for every utterance in a sound file.
///
/// # Errors
/// No answer within `patience`, or before `standstill` returns why there will be none.
pub fn deliver(
    writer: &EncodedWriter<Injection>,
    receipts: &Reader<Receipt>,
    sound: Sound,
    said: (Time, Time),
    patience: Span,
    standstill: impl FnMut() -> Option<String>,
) -> Result<Vec<Receipt>, ClientError> {
    let mut submission = Submission::new(sound, said, clock::now(), patience);
    submit(writer, receipts, &mut submission, standstill)
}

/// As [`deliver`], with a request that may have been sent before, perhaps to an earlier run of the
/// group: its key stays, so that it is accepted once.
///
/// # Errors
/// As [`deliver`].
pub fn submit(
    writer: &EncodedWriter<Injection>,
    receipts: &Reader<Receipt>,
    submission: &mut Submission,
    mut standstill: impl FnMut() -> Option<String>,
) -> Result<Vec<Receipt>, ClientError> {
    let mut polling = Polling::default();
    while !submission.is_expired(clock::now()) {
        if let Some(request) = submission.due(clock::now()) {
            writer.send(request)?;
        }
        receipts.drain(|receipt| submission.on_receipt(receipt))?;
        if let Some(receipts) = submission.receipts() {
            return Ok(receipts.to_vec());
        }
        if let Some(why) = standstill() {
            return Err(ClientError::Standstill(why));
        }
        polling.pause();
    }
    Err(ClientError::Timeout { what: "speech", seconds: submission.patience().s() })
}

/// Returns the identity of this process among the clients of the speech service, which gives each
/// its share.
pub fn own_id() -> ClientId {
    static OWN: OnceLock<ClientId> = OnceLock::new();
    *OWN.get_or_init(|| random_key().client())
}

/// Returns the key of a new request of `client`.
pub fn request_key(client: ClientId) -> RequestKey {
    RequestKey::new(client, random_key().client().0)
}

/// Returns a number at random, the key of a sighting.
pub fn random_number() -> u64 {
    let RequestKey(key) = random_key();
    let mut number = [0; 8];
    number.copy_from_slice(&key[..8]);
    u64::from_le_bytes(number)
}

/// Returns a unique key.
pub fn random_key() -> RequestKey {
    let mut key = [0; 16];
    let filled = rustix::rand::getrandom(&mut key, rustix::rand::GetRandomFlags::empty());
    if filled.is_err() {
        // Unique on this machine all the same: process and time.
        key[..8].copy_from_slice(&clock::now().ns().to_le_bytes());
        key[8..12].copy_from_slice(&std::process::id().to_le_bytes());
    }
    RequestKey(key)
}
