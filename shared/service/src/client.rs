//! A client of a running group: gives it things to hear, and sees what it does.
//!
//! Clients poll; they are few, short-lived, and must not cost the services anything.

use crate::bus::{
    Bus, BusError, EncodedReader, EncodedWriter, Identity, PortError, Reader, Writer,
};
use crate::clock;
use crate::group::GroupPaths;
use crate::lifecycle::Environment;
use crate::{Span, Time};
use messages::{
    ArmStatus, Epoch, Injection, MotionCommand, MotionOrder, PolicyView, Receipt, RequestKey,
    Sound, topics,
};
use std::time::Duration;

/// How often an unanswered injection is sent again.
const RESEND_EVERY: Span = Span::from_ms(250);
/// How often a client looks for an answer.
const POLL_EVERY: Duration = Duration::from_millis(2);

/// A client's access to the group.
#[derive(Debug)]
pub struct Client {
    bus: Bus,
}

/// A client's request was not answered.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ClientError {
    /// The group has no epoch: it never ran.
    #[error("no group {0} is running; start it with: whichone up --group {0}")]
    NoGroup(String),
    /// Its shared memory cannot be opened.
    #[error(transparent)]
    Bus(#[from] BusError),
    /// A topic failed.
    #[error(transparent)]
    Port(#[from] PortError),
    /// Nobody answered.
    #[error("{what}: no answer within {seconds} s; see: whichone status")]
    Timeout {
        /// What was asked.
        what: &'static str,
        /// How long was waited.
        seconds: f64,
    },
}

impl Client {
    /// Joins the group.
    ///
    /// # Errors
    /// It does not run, or its messages are of another build.
    pub fn join(paths: &GroupPaths) -> Result<Self, ClientError> {
        let none = || ClientError::NoGroup(paths.name().to_string());
        if !paths.ipc().is_dir() {
            return Err(none());
        }
        let epoch = std::fs::read_to_string(paths.epoch_file()).map_err(|_| none())?;
        let epoch = Epoch(epoch.trim().parse().map_err(|_| none())?);
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

    /// The group's shared memory, for other topics.
    pub fn bus(&self) -> &Bus {
        &self.bus
    }

    /// What the policy thinks.
    ///
    /// # Errors
    /// Another build.
    pub fn views(&self) -> Result<EncodedReader<PolicyView>, BusError> {
        self.bus.encoded_reader(&topics::VIEW)
    }

    /// Gives `sound` to the speech service and waits until it says what became of it: once for
    /// text, once for every utterance in a sound file. Sent again under the same key until then, so
    /// that a restart in between neither loses nor doubles it.
    ///
    /// # Errors
    /// No answer within `patience`.
    pub fn inject(&self, sound: Sound, patience: Span) -> Result<Vec<Receipt>, ClientError> {
        self.inject_said(sound, (clock::now(), Time(0)), patience)
    }

    /// As [`Client::inject`], with when the person began to say it and had ended (0: when it
    /// arrives).
    ///
    /// # Errors
    /// As [`Client::inject`].
    pub fn inject_said(
        &self,
        sound: Sound,
        said: (Time, Time),
        patience: Span,
    ) -> Result<Vec<Receipt>, ClientError> {
        let receipts = self.bus.reader::<Receipt>(&topics::RECEIPT)?;
        let writer = self.bus.encoded_writer::<Injection>(&topics::INJECTION)?;
        deliver(&writer, &receipts, sound, said, patience)
    }

    /// Points at a place, metres, frame `base`, as the person whom the robot sees; `words` is what is
    /// said meanwhile, empty for nothing. Otherwise as [`Client::inject`]: where gestures do not
    /// count the receipt is a refusal that names the setting.
    ///
    /// # Errors
    /// As [`Client::inject`].
    pub fn point(
        &self,
        target_m: [f64; 3],
        words: &str,
        patience: Span,
    ) -> Result<Vec<Receipt>, ClientError> {
        self.inject(Sound::Point { target_m, words: words.to_owned() }, patience)
    }

    /// As [`Client::inject`], with topics that are already open.
    ///
    /// # Errors
    /// As [`Client::inject`].
    pub fn inject_with(
        &self,
        writer: &EncodedWriter<Injection>,
        receipts: &Reader<Receipt>,
        sound: Sound,
        patience: Span,
    ) -> Result<Vec<Receipt>, ClientError> {
        deliver(writer, receipts, sound, (clock::now(), Time(0)), patience)
    }

    /// Latches or releases the motion stop and waits until the arm says so.
    ///
    /// # Errors
    /// No answer within `patience`.
    pub fn motion(&self, order: MotionOrder, patience: Span) -> Result<(), ClientError> {
        let statuses = self.bus.reader::<ArmStatus>(&topics::STATUS)?;
        let writer: Writer<MotionCommand> = self.bus.writer(&topics::MOTION)?;
        let started = clock::now();
        let command = MotionCommand {
            given_ns: started.ns(),
            order: order.code(),
            ..MotionCommand::default()
        };
        let wanted = u8::from(order == MotionOrder::Stop);
        let mut sent: Option<Time> = None;
        // A status from before the command is not an answer to it.
        statuses.latest()?;
        while clock::now() < started + patience {
            if sent.is_none_or(|at| clock::now() >= at + RESEND_EVERY) {
                writer.send(&command)?;
                sent = Some(clock::now());
            }
            if statuses.latest()?.is_some_and(|status| status.stopped == wanted) {
                return Ok(());
            }
            std::thread::sleep(POLL_EVERY);
        }
        Err(ClientError::Timeout { what: "arm", seconds: patience.s() })
    }
}

/// Sends a sound until it is answered.
fn deliver(
    writer: &EncodedWriter<Injection>,
    receipts: &Reader<Receipt>,
    sound: Sound,
    (began, ended): (Time, Time),
    patience: Span,
) -> Result<Vec<Receipt>, ClientError> {
    let started = clock::now();
    let (onset_ns, end_ns) = (began.ns(), ended.ns());
    let injection = Injection { key: random_key(), onset_ns, end_ns, sound };
    let mut answers: Vec<Receipt> = Vec::new();
    let mut sent: Option<Time> = None;
    while clock::now() < started + patience {
        if sent.is_none_or(|at| clock::now() >= at + RESEND_EVERY) {
            writer.send(&injection)?;
            sent = Some(clock::now());
        }
        receipts.drain(|receipt| {
            let new = answers.iter().all(|a| a.segment != receipt.segment);
            if receipt.request() == injection.key && new {
                answers.push(*receipt);
            }
        })?;
        if answers.first().is_some_and(|first| answers.len() >= first.segments as usize) {
            answers.sort_by_key(|receipt| receipt.segment);
            return Ok(answers);
        }
        std::thread::sleep(POLL_EVERY);
    }
    Err(ClientError::Timeout { what: "speech", seconds: patience.s() })
}

/// A key that no other request has.
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
