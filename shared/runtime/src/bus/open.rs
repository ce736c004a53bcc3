//! Opening topics: the same bounds and the same schema check for every payload kind.

use super::wake::{self, WakeNotifier};
use super::{Bus, BusError, Ipc};
use iceoryx2::prelude::*;
use iceoryx2::service::attribute::{AttributeKey, AttributeValue};
use iceoryx2::service::builder::publish_subscribe::{
    PublishSubscribeOpenError, PublishSubscribeOpenOrCreateError,
};
use iceoryx2::service::port_factory::event::PortFactory;
use messages::topics::{self, Topic};
use std::rc::Rc;

/// Opens the topic, creating it where this process is the first. A macro, because iceoryx2's
/// builders for structs and for slices are different types without a common trait.
macro_rules! open_topic {
    ($bus:expr, $topic:expr, $payload:ty) => {{
        use iceoryx2::prelude::ServiceName;
        use messages::topics::NODES_MAX;
        let (bus, topic): (&$crate::bus::Bus, &messages::topics::Topic) = ($bus, $topic);
        let failed = |cause: String| $crate::bus::BusError::ipc(topic.name, cause);
        let name = ServiceName::new(topic.name).map_err(|e| failed(format!("{e:?}")))?;
        let required = $crate::bus::open::schema_attribute(topic).map_err(failed)?;
        $crate::bus::segment_error::take();
        bus.node()
            .service_builder(&name)
            .publish_subscribe::<$payload>()
            .user_header::<messages::Stamp>()
            .max_publishers(topic.writers_max)
            .max_subscribers(topic.readers_max)
            .max_nodes(NODES_MAX)
            .subscriber_max_buffer_size(topic.buffer_max())
            .subscriber_max_borrowed_samples(1)
            .history_size(topic.history)
            .enable_safe_overflow(true)
            .open_or_create_with_attributes(&required)
            .map_err(|error| $crate::bus::open::refused(topic, &error))
    }};
}
pub(super) use open_topic;

/// Does something with the payload's type of a topic that has a fixed layout, which is found by its name;
/// something else with the topics that have none.
macro_rules! of_type {
    ($topic:expr, $T:ident => $fixed:expr, else $encoded:expr) => {
        $crate::bus::open::of_type!(@ $topic, $T => $fixed, else $encoded,
            messages::Receipt, messages::Utterance, messages::Presented, messages::Activity,
            messages::Hearing, messages::Partial, messages::AudioChunk, messages::Observation,
            messages::AppliedMark, messages::RobotAct, messages::ArmStatus, messages::JointStates,
            messages::MotionCommand, messages::robot::JointState, messages::robot::AssemblyState,
            messages::robot::JointCommand, messages::robot::JointTrajectoryPoint,
            messages::robot::SpeedRatio, messages::robot::EndpointState,
            messages::robot::EndEffectorCommand, messages::robot::EndEffectorState,
            messages::robot::EndEffectorProperties, messages::robot::Drill)
    };
    (@ $topic:expr, $T:ident => $fixed:expr, else $encoded:expr, $($payload:ty),+) => {
        match $topic.payload {
            $(name if name == <$payload as messages::schema::Schema>::NAME => {
                type $T = $payload;
                $fixed
            })+
            _ => $encoded,
        }
    };
}
pub(super) use of_type;

pub(super) fn schema_attribute(topic: &Topic) -> Result<AttributeVerifier, String> {
    let key = AttributeKey::new(b"schema").map_err(|e| format!("{e:?}"))?;
    let schema = (topic.schema)().to_string();
    let value = AttributeValue::new(schema.as_bytes()).map_err(|e| format!("{e:?}"))?;
    AttributeVerifier::new().require(&key, &value).map_err(|e| format!("{e:?}"))
}

pub(super) fn refused(topic: &Topic, error: &PublishSubscribeOpenOrCreateError) -> BusError {
    use PublishSubscribeOpenError::{IncompatibleAttributes, IncompatibleTypes};
    let cause = format!("{error:?}");
    match error {
        PublishSubscribeOpenOrCreateError::PublishSubscribeOpenError(
            IncompatibleAttributes | IncompatibleTypes,
        ) => BusError::Schema {
            topic: topic.name.to_owned(),
            payload: topic.payload,
            ours: (topic.schema)().to_string(),
            cause,
        },
        _ => BusError::ipc(topic.name, cause),
    }
}

/// Everything of a group held open, so that it outlives any single service.
#[derive(Debug)]
pub struct Topics {
    _topics: Vec<Box<dyn std::fmt::Debug>>,
    _notifiers: Vec<PortFactory<Ipc>>,
}

impl Topics {
    /// Opens (or, where this process is the first, creates) every topic and wake-up. The robot's are
    /// among them: a bridge in another language can only open what exists.
    ///
    /// # Errors
    /// iceoryx2 fails, or a topic with another schema exists.
    pub fn create(bus: &Bus) -> Result<Self, BusError> {
        let topics = topics::ALL.iter().chain(&topics::robot::ALL);
        let topics = topics.map(|topic| keep(bus, topic)).collect::<Result<_, _>>()?;
        let mut woken = topics::woken();
        woken.extend(bus.wakes.services().into_iter().filter(|it| !topics::woken().contains(it)));
        let notifiers = woken.into_iter().map(|service| wake::open(bus, service));
        Ok(Self { _topics: topics, _notifiers: notifiers.collect::<Result<_, _>>()? })
    }
}

/// Holds a topic open without reading or writing it; its type is found by its payload's name.
fn keep(bus: &Bus, topic: &Topic) -> Result<Box<dyn std::fmt::Debug>, BusError> {
    Ok(of_type!(topic,
        T => Box::new(open_topic!(bus, topic, T)?),
        else Box::new(open_topic!(bus, topic, [u8])?)))
}

/// The notifiers of a topic's readers.
pub(super) fn notifiers(bus: &Bus, topic: &Topic) -> Result<Vec<Rc<WakeNotifier>>, BusError> {
    let services = topic.readers.iter().copied().chain(bus.wakes.readers(topic));
    services.map(|service| bus.notifier(service)).collect()
}
