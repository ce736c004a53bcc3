//! Parts of a service: its reducer, and the shell of topics and devices around it.

use std::os::fd::BorrowedFd;

use config::Settings;
use messages::Service;

use crate::bus::{Bus, PortError};
use crate::exit::Failure;
use crate::flight::Decision;
use crate::inspection::{Finding, Part, SharedFacts};
use crate::journal_record::JournalRecord;
use crate::lifecycle::Environment;
use crate::worker_channel::DeviceSender;
use crate::{Node, Time};

/// Journal record of a program's node.
pub type Record<P> = <<P as Program>::Node as Node>::Record;
/// A service: a node and the shell around it.
pub trait Program: Sized {
    /// The service.
    const SERVICE: Service;
    /// Kind of record in the journal, if any. A changed record type needs a changed name.
    const RECORD: Option<&'static str>;
    /// Kinds of record of earlier versions that decode as records of this one.
    const OLDER_RECORDS: &'static [&'static str] = &[];
    /// One paragraph for `--help`.
    const ABOUT: &'static str;
    /// Whether flights are recorded: not if the reducer only passes things on.
    const RECORDS_FLIGHTS: bool = true;
    /// The reducer.
    type Node: Node;
    /// Topics and devices of the service.
    type Shell: Shell<Self::Node>;

    /// The node's configuration.
    ///
    /// # Errors
    /// Arguments that the service does not know.
    fn config(
        environment: &Environment,
        settings: &Settings,
    ) -> Result<<Self::Node as Node>::Config, Failure>;

    /// Takes the arguments of the service that has written the inspected journal.
    ///
    /// # Errors
    /// Arguments that the service does not know.
    fn prepare(_arguments: &[String]) -> Result<(), Failure> {
        Ok(())
    }

    /// Returns when a journal record was written.
    fn recorded_at(_record: &Record<Self>) -> Time {
        Time(0)
    }

    /// Renders a journal record as one line for `whichone journal`, without its time, with the
    /// settings that were in force, newest first.
    fn describe(_settings: &[Settings], _record: &Record<Self>) -> String {
        String::new()
    }

    /// Returns a journal record as `whichone journal --json` prints it, with the settings that were
    /// in force, newest first; `None` for a stateless service.
    fn explain(_settings: &[Settings], _record: &Record<Self>) -> Option<JournalRecord> {
        None
    }

    /// Returns the decision of a journal record, if replays with other settings should compare it.
    fn decision(_settings: &Settings, _record: &Record<Self>) -> Option<Decision> {
        None
    }

    /// Checks the invariants of the journal, oldest part first, with the settings that were in
    /// force, newest first. Returns the verified facts.
    ///
    /// # Errors
    /// The first broken invariant, or settings of which none fit.
    fn verify(
        _settings: &[Settings],
        _parts: &[Part<Record<Self>>],
    ) -> Result<Vec<String>, Failure> {
        Ok(Vec::new())
    }

    /// Returns the facts that the journals of the others must agree with.
    fn shared_facts(_parts: &[Part<Record<Self>>]) -> SharedFacts {
        SharedFacts::default()
    }

    /// Examines the devices that the service needs, for `whichone doctor`.
    fn doctor(_settings: &Settings) -> Vec<Finding> {
        Vec::new()
    }
}

/// The topics and devices of one node.
pub trait Shell<N: Node>: Sized {
    /// Opens topics and devices.
    ///
    /// # Errors
    /// A topic of another schema, or a device that is needed and missing.
    fn open(context: &Context<'_, N::In<'static>>) -> Result<Self, Failure>;

    /// Hands every pending urgent message to `take`, in place: inputs that precede all others, even
    /// while the service waits for storage. `is_readable` is that of [`Shell::urgent_fd`].
    ///
    /// # Errors
    /// A topic cannot be read.
    fn drain_urgent(
        &mut self,
        _is_readable: bool,
        _take: &mut dyn FnMut(N::In<'_>),
    ) -> Result<(), PortError> {
        Ok(())
    }

    /// Returns a descriptor, besides the topics, that is readable while an urgent message waits.
    fn urgent_fd(&self) -> Option<BorrowedFd<'_>> {
        None
    }

    /// Hands every other pending message to `take`, in place.
    ///
    /// # Errors
    /// A topic cannot be read.
    fn drain(&mut self, take: &mut dyn FnMut(N::In<'_>)) -> Result<(), PortError>;

    /// Sends one output or gives it to a device.
    ///
    /// # Errors
    /// A topic cannot be written.
    fn publish(&mut self, output: N::Out) -> Result<(), PortError>;
}

/// Resources of a shell.
#[derive(Debug)]
pub struct Context<'a, In> {
    /// The group's shared memory.
    pub bus: &'a Bus,
    /// The settings in force.
    pub settings: &'a Settings,
    /// For device threads.
    pub devices: DeviceSender<In>,
    /// Environment of the process: group, epoch and incarnation.
    pub environment: &'a Environment,
}
