//! Opening topics: the same bounds and the same schema check for every payload kind.

use super::port::{self, TopicPorts};
use super::wake::{self, WakeNotifier};
use super::{Bus, BusError, Ipc, segment_error};
use iceoryx2::prelude::*;
use iceoryx2::service::attribute::{AttributeKey, AttributeValue};
use iceoryx2::service::builder::publish_subscribe::{
    PublishSubscribeOpenError, PublishSubscribeOpenOrCreateError,
};
use iceoryx2::service::port_factory::event::PortFactory;
use messages::layout::Layout;
use messages::schema::Schema;
use messages::topics::{self, NODES_MAX, Topic};
use std::rc::Rc;

/// Opens the topic, creating it if this process is the first.
pub(super) fn open_topic(bus: &Bus, topic: &Topic) -> Result<TopicPorts, BusError> {
    let failed = |cause: String| BusError::ipc(topic.name, cause);
    let name = ServiceName::new(topic.name).map_err(|e| failed(format!("{e:?}")))?;
    let required = schema_attribute(topic).map_err(failed)?;
    segment_error::take();
    let builder = bus
        .node()
        .service_builder(&name)
        .publish_subscribe()
        .user_header()
        .max_publishers(topic.writers_max)
        .max_subscribers(topic.readers_max)
        .max_nodes(NODES_MAX)
        .subscriber_max_buffer_size(topic.buffer_max())
        .subscriber_max_borrowed_samples(1)
        .history_size(topic.history)
        .enable_safe_overflow(true);
    let builder = port::with_layout(builder, (topic.layout)()).map_err(failed)?;
    builder.open_or_create_with_attributes(&required).map_err(|error| refused(topic, &error))
}

/// Fails unless the topic has messages of this type and layout: others would be misread.
pub(super) fn has_messages<T: Schema>(topic: &Topic) -> Result<(), BusError> {
    let size = |layout: Option<Layout>| layout.map(|layout| layout.size);
    if topic.payload == T::NAME && size((topic.layout)()) == size(T::layout()) {
        return Ok(());
    }
    let cause = format!("expected messages {}, found {}", topic.payload, T::NAME);
    Err(BusError::Ipc { what: topic.name.to_owned(), cause })
}

fn schema_attribute(topic: &Topic) -> Result<AttributeVerifier, String> {
    let key = AttributeKey::new(b"schema").map_err(|e| format!("{e:?}"))?;
    let schema = (topic.schema)().to_string();
    let value = AttributeValue::new(schema.as_bytes()).map_err(|e| format!("{e:?}"))?;
    AttributeVerifier::new().require(&key, &value).map_err(|e| format!("{e:?}"))
}

fn refused(topic: &Topic, error: &PublishSubscribeOpenOrCreateError) -> BusError {
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
    _topics: Vec<TopicPorts>,
    _notifiers: Vec<PortFactory<Ipc>>,
}

impl Topics {
    /// Opens (or, if this process is the first, creates) every topic and wake-up. The robot's are
    /// among them: a bridge in another language can only open what exists.
    ///
    /// # Errors
    /// iceoryx2 fails, or a topic with another schema exists.
    pub fn create(bus: &Bus) -> Result<Self, BusError> {
        let topics = topics::ALL.iter().chain(&topics::robot::ALL);
        let topics = topics.map(|topic| open_topic(bus, topic)).collect::<Result<_, _>>()?;
        let notifiers = bus.woken().into_iter().map(|service| wake::open(bus.node(), service));
        Ok(Self { _topics: topics, _notifiers: notifiers.collect::<Result<_, _>>()? })
    }
}

impl Bus {
    /// Returns the services that are woken by some topic, each once.
    pub fn woken(&self) -> Vec<messages::Service> {
        let mut woken = topics::woken();
        woken.extend(self.wakes.services().into_iter().filter(|it| !topics::woken().contains(it)));
        woken
    }
}

/// The notifiers of a topic's readers.
pub(super) fn notifiers(bus: &Bus, topic: &Topic) -> Result<Vec<Rc<WakeNotifier>>, BusError> {
    let services = topic.readers.iter().copied().chain(bus.wakes.readers(topic));
    services.map(|service| bus.notifier(service)).collect()
}
