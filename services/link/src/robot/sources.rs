//! The topics that mirrors see, each with the messages to send.

use config::Settings;
use messages::{
    Activity, ArmStatus, Hearing, JointStates, Observation, Partial, PolicyView, Presented,
    Receipt, RobotAct, TableView, TrajectoryView, WireMessage, WorldView,
};
use service::Time;
use service::bus::{Bus, BusError, EncodedReader, PortError, Reader};

use super::senders::Senders;
use crate::frame::Outgoing;
use crate::mirrored::Mirrored;

/// A reader of a topic, of fixed or variable size.
trait Drain<T> {
    fn drain(&self, take: &mut dyn FnMut(T)) -> Result<(), PortError>;
}

impl<T: WireMessage> Drain<T> for Reader<T> {
    fn drain(&self, take: &mut dyn FnMut(T)) -> Result<(), PortError> {
        self.drain(|message| take(*message))
    }
}

impl<T: Mirrored> Drain<T> for EncodedReader<T> {
    fn drain(&self, take: &mut dyn FnMut(T)) -> Result<(), PortError> {
        self.drain_in_turn(take)
    }
}

/// A topic: its reader, the messages to send, and the latest one.
struct Source<T> {
    reader: Box<dyn Drain<T>>,
    outgoing: Outgoing<T>,
    latest: Option<T>,
}

impl<T: Mirrored> Source<T> {
    fn new(reader: impl Drain<T> + 'static, start: u64) -> Self {
        Self { reader: Box::new(reader), outgoing: Outgoing::new(start), latest: None }
    }
}

/// Operations of the loop on every topic.
trait AnySource {
    fn name(&self) -> &'static str;
    fn look(&mut self);
    fn due(&mut self, now: Time) -> Option<Vec<u8>>;
}

impl<T: Mirrored> AnySource for Source<T> {
    fn name(&self) -> &'static str {
        T::TOPIC.name
    }

    fn look(&mut self) {
        let Self { reader, outgoing, latest } = self;
        let taken = reader.drain(&mut |message| {
            *latest = Some(message.clone());
            outgoing.take(message);
        });
        if let Err(error) = taken {
            tracing::debug!(%error, "not read; tried again");
        }
    }

    fn due(&mut self, now: Time) -> Option<Vec<u8>> {
        self.outgoing.due(now)
    }
}

/// All sources. Policy and arm are also read for the presence, and lines for their sound.
pub(super) struct TopicSources {
    view: Source<PolicyView>,
    status: Source<ArmStatus>,
    presented: Source<Presented>,
    others: Vec<Box<dyn AnySource>>,
}

impl TopicSources {
    pub(super) fn open(bus: &Bus, settings: &Settings, start: u64) -> Result<Self, BusError> {
        fn fixed<T: Mirrored + WireMessage>(bus: &Bus, start: u64) -> Result<Source<T>, BusError> {
            Ok(Source::new(bus.reader::<T>(&T::TOPIC)?, start))
        }
        fn encoded<T: Mirrored + 'static>(bus: &Bus, start: u64) -> Result<Source<T>, BusError> {
            Ok(Source::new(bus.encoded_reader::<T>(&T::TOPIC)?, start))
        }
        let mut others: Vec<Box<dyn AnySource>> = vec![
            Box::new(fixed::<Receipt>(bus, start)?),
            Box::new(fixed::<Activity>(bus, start)?),
            Box::new(fixed::<Hearing>(bus, start)?),
            Box::new(fixed::<Partial>(bus, start)?),
            Box::new(fixed::<Observation>(bus, start)?),
            Box::new(fixed::<RobotAct>(bus, start)?),
            Box::new(fixed::<JointStates>(bus, start)?),
            Box::new(encoded::<WorldView>(bus, start)?),
            Box::new(encoded::<TrajectoryView>(bus, start)?),
        ];
        if settings.group.perception.enabled {
            others.push(Box::new(encoded::<TableView>(bus, start)?));
        }
        let (view, status, presented) =
            (encoded(bus, start)?, fixed(bus, start)?, fixed(bus, start)?);
        Ok(Self { view, status, presented, others })
    }

    fn all(&mut self) -> impl Iterator<Item = &mut dyn AnySource> {
        let Self { view, status, presented, others } = self;
        let first: [&mut dyn AnySource; 3] = [status, presented, view];
        first.into_iter().chain(others.iter_mut().map(|it| &mut **it as &mut dyn AnySource))
    }

    /// Takes the new messages.
    pub(super) fn look(&mut self) {
        self.all().for_each(|source| source.look());
    }

    /// Sends due messages to watchers.
    pub(super) fn send(&mut self, senders: &Senders, now: Time) {
        for source in self.all() {
            let name = source.name();
            if senders.is_state_watched(name)
                && let Some(bytes) = source.due(now)
            {
                senders.state(name, bytes);
            }
        }
    }

    pub(super) fn view(&self) -> Option<&PolicyView> {
        self.view.latest.as_ref()
    }

    pub(super) fn presented(&self) -> Option<&Presented> {
        self.presented.latest.as_ref()
    }

    pub(super) fn status(&self) -> Option<&ArmStatus> {
        self.status.latest.as_ref()
    }
}
