//! The local topics that the robot's frames are written to.

use std::collections::BTreeMap;

use messages::{
    Activity, ArmStatus, Hearing, JointStates, Observation, Partial, PolicyView, Presented,
    Receipt, RobotAct, TableView, TrajectoryView, WireMessage, WorldView,
};
use serde::Serialize;
use service::Time;
use service::bus::{Bus, BusError, EncodedWriter, PortError, Writer};

use crate::frame::{self, FrameError, Incoming};
use crate::mirrored::Mirrored;
use crate::offset::Offset;

/// A writer of a topic, of fixed or variable size.
trait Post<T> {
    fn send(&self, message: &T) -> Result<(), PortError>;
}

impl<T: WireMessage> Post<T> for Writer<T> {
    fn send(&self, message: &T) -> Result<(), PortError> {
        Writer::send(self, message)
    }
}

impl<T: Mirrored + Serialize> Post<T> for EncodedWriter<T> {
    fn send(&self, message: &T) -> Result<(), PortError> {
        EncodedWriter::send(self, message)
    }
}

/// A topic: its new messages, and its local writer.
pub(super) struct Inlet<T> {
    incoming: Incoming<T>,
    writer: Box<dyn Post<T>>,
}

impl<T: Mirrored> Inlet<T> {
    /// Returns the news of a frame, in local time.
    pub(super) fn news(
        &mut self,
        bytes: &[u8],
        now: Time,
        offset: &mut Offset,
    ) -> Result<Vec<T>, FrameError> {
        Ok(self.incoming.take(frame::read(bytes)?, now, offset))
    }

    /// Writes a message to the local topic.
    pub(super) fn write(&self, message: &T) {
        if let Err(error) = self.writer.send(message) {
            tracing::warn!(%error, "a message of the robot is not passed on");
        }
    }
}

/// Operations of the loop on most topics.
trait AnyInlet {
    fn pass(&mut self, bytes: &[u8], now: Time, offset: &mut Offset) -> Result<(), FrameError>;
}

impl<T: Mirrored> AnyInlet for Inlet<T> {
    fn pass(&mut self, bytes: &[u8], now: Time, offset: &mut Offset) -> Result<(), FrameError> {
        let news = self.news(bytes, now, offset)?;
        news.iter().for_each(|message| self.write(message));
        Ok(())
    }
}

/// All inlets. Lines of the robot wait for their sound, receipts also come as answers.
pub(super) struct Inlets {
    pub(super) presented: Inlet<Presented>,
    pub(super) receipts: Inlet<Receipt>,
    others: BTreeMap<&'static str, Box<dyn AnyInlet>>,
}

impl Inlets {
    pub(super) fn open(bus: &Bus) -> Result<Self, BusError> {
        fn fixed<T: Mirrored + WireMessage>(bus: &Bus) -> Result<Inlet<T>, BusError> {
            let writer = Box::new(bus.writer::<T>(&T::TOPIC)?);
            Ok(Inlet { incoming: Incoming::default(), writer })
        }
        fn encoded<T: Mirrored + 'static>(bus: &Bus) -> Result<Inlet<T>, BusError> {
            let writer = Box::new(bus.encoded_writer::<T>(&T::TOPIC)?);
            Ok(Inlet { incoming: Incoming::default(), writer })
        }
        let others: [(&str, Box<dyn AnyInlet>); 11] = [
            (Activity::TOPIC.name, Box::new(fixed::<Activity>(bus)?)),
            (Hearing::TOPIC.name, Box::new(fixed::<Hearing>(bus)?)),
            (Partial::TOPIC.name, Box::new(fixed::<Partial>(bus)?)),
            (Observation::TOPIC.name, Box::new(fixed::<Observation>(bus)?)),
            (RobotAct::TOPIC.name, Box::new(fixed::<RobotAct>(bus)?)),
            (ArmStatus::TOPIC.name, Box::new(fixed::<ArmStatus>(bus)?)),
            (JointStates::TOPIC.name, Box::new(fixed::<JointStates>(bus)?)),
            (PolicyView::TOPIC.name, Box::new(encoded::<PolicyView>(bus)?)),
            (TableView::TOPIC.name, Box::new(encoded::<TableView>(bus)?)),
            (WorldView::TOPIC.name, Box::new(encoded::<WorldView>(bus)?)),
            (TrajectoryView::TOPIC.name, Box::new(encoded::<TrajectoryView>(bus)?)),
        ];
        let (presented, receipts) = (fixed(bus)?, fixed(bus)?);
        Ok(Self { presented, receipts, others: others.into() })
    }

    /// Writes the news of a frame of any other topic.
    pub(super) fn pass(
        &mut self,
        topic: &str,
        bytes: &[u8],
        now: Time,
        offset: &mut Offset,
    ) -> Result<(), FrameError> {
        let Some(inlet) = self.others.get_mut(topic) else { return Ok(()) };
        inlet.pass(bytes, now, offset)
    }
}
