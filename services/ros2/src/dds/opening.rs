//! Opening of publishers, subscriptions and services.

use super::{Error, Inlet, Outlet, Trigger};
use crate::settings::{self, Network, Ros2};
use ros2_client::qos::{Durability, History, WhenFull};
use ros2_client::{Context, MessageTypeName, Name, Node, NodeName, NodeOptions, QosProfile};
use ros2_client::{ServiceMapping, ServiceTypeName};
use rustdds::DomainParticipantBuilder;
use rustdds::mio1::{Interest, Poll, Token, event::Source};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Debug;
use std::net::Ipv4Addr;

pub(crate) fn reliable(depth: usize) -> QosProfile {
    let fail = QosProfile::publisher_default().reliability_reliable(WhenFull::Fail);
    fail.history(History::KeepLast { depth })
}

pub(crate) fn latched() -> QosProfile {
    reliable(1).durability(Durability::TransientLocal)
}

/// Of detectors and joint states. Those that publish reliably match it, too.
pub(crate) fn best_effort(depth: usize) -> QosProfile {
    let qos = QosProfile::subscription_default().reliability_best_effort();
    qos.history(History::KeepLast { depth })
}

/// Opens what the node consists of.
pub(crate) struct Opening<'a> {
    pub(crate) node: Node,
    pub(crate) poll: Poll,
    pub(crate) settings: &'a Ros2,
}

impl<'a> Opening<'a> {
    /// Joins the domain as a node of this name.
    pub(crate) fn join(settings: &'a Ros2, name: &str) -> Result<Self, Error> {
        let mut participant = DomainParticipantBuilder::new(settings.domain_id);
        participant = match settings.network {
            Network::Loopback => participant.with_only_networks([Ipv4Addr::LOCALHOST]),
            Network::Interface(address) => participant.with_only_networks([address]),
            Network::All => participant,
        };
        let participant = participant.build().map_err(|error| format!("DDS: {error:?}"))?;
        let context = Context::from_domain_participant(participant);
        let context = context.map_err(|error| format!("DDS: {error:?}"))?;
        let name = NodeName::new(&settings.namespace, name);
        let name = name.map_err(|error| format!("node name: {error:?}"))?;
        let node = context.new_node(name, NodeOptions::new().enable_rosout(false));
        let node = node.map_err(|error| format!("node: {error:?}"))?;
        let poll = Poll::new().map_err(|error| format!("poll: {error}"))?;
        Ok(Self { node, poll, settings })
    }

    /// Returns how services, and those of actions, are mapped to topics.
    pub(crate) fn service_mapping(&self) -> ServiceMapping {
        match self.settings.services {
            settings::ServiceMapping::Enhanced => ServiceMapping::Enhanced,
            settings::ServiceMapping::Cyclone => ServiceMapping::Cyclone,
        }
    }
}

impl Opening<'_> {
    pub(super) fn outlet<M: Serialize>(
        &mut self,
        (namespace, name): (&str, &str),
        (package, kind): (&str, &str),
        qos: &QosProfile,
    ) -> Result<Outlet<M>, Error> {
        let failed = |error: &dyn Debug| format!("publisher of {name}: {error:?}");
        let full = Name::new(namespace, name).map_err(|e| failed(&e))?;
        let topic = self.node.create_topic(&full, MessageTypeName::new(package, kind), qos);
        let topic = topic.map_err(|e| failed(&e))?;
        let publisher = self.node.create_publisher(&topic, Some(qos.clone()));
        publisher.map(Outlet).map_err(|e| failed(&e))
    }

    pub(super) fn own_outlet<M: Serialize>(
        &mut self,
        name: &str,
        kind: (&str, &str),
        qos: &QosProfile,
    ) -> Result<Outlet<M>, Error> {
        let (namespace, name) = self.settings.own_name(name);
        self.outlet((&namespace, &name), kind, qos)
    }

    pub(super) fn own_inlet<M: DeserializeOwned + 'static>(
        &mut self,
        name: &str,
        kind: (&str, &str),
    ) -> Result<Inlet<M>, Error> {
        let (namespace, name) = self.settings.own_name(name);
        self.inlet(&format!("{namespace}/{name}"), kind, reliable(16))
    }

    /// Subscribes to a topic of a detector, if it is configured.
    pub(super) fn detector<M: DeserializeOwned + 'static>(
        &mut self,
        topic: Option<&String>,
        kind: (&str, &str),
        depth: usize,
    ) -> Result<Option<Inlet<M>>, Error> {
        topic.map(|topic| self.inlet(topic, kind, best_effort(depth))).transpose()
    }

    pub(crate) fn inlet<M: DeserializeOwned + 'static>(
        &mut self,
        name: &str,
        (package, kind): (&str, &str),
        qos: QosProfile,
    ) -> Result<Inlet<M>, Error> {
        let failed = |error: &dyn Debug| format!("subscription of {name}: {error:?}");
        let full = Name::parse(name).map_err(|e| failed(&e))?;
        let topic = self.node.create_topic(&full, MessageTypeName::new(package, kind), &qos);
        let topic = topic.map_err(|e| failed(&e))?;
        let subscription = self.node.create_subscription(&topic, Some(qos));
        let mut subscription = subscription.map_err(|e| failed(&e))?;
        self.wake_by(&mut subscription)?;
        Ok(Inlet(subscription))
    }

    pub(super) fn trigger(&mut self, name: &str) -> Result<Trigger, Error> {
        let (namespace, name) = self.settings.own_name(name);
        let failed = |error: &dyn Debug| format!("service {name}: {error:?}");
        let full = Name::new(&namespace, &name).map_err(|e| failed(&e))?;
        let mapping = self.service_mapping();
        let kind = ServiceTypeName::new("std_srvs", "Trigger");
        let server = self.node.create_server(mapping, &full, &kind, reliable(16), reliable(16));
        let mut server = server.map_err(|e| failed(&e))?;
        self.wake_by(&mut server)?;
        Ok(Trigger(server))
    }

    fn wake_by(&self, source: &mut impl Source) -> Result<(), Error> {
        // Every source is drained in each pass, whichever is ready.
        let registered = self.poll.registry().register(source, Token(0), Interest::READABLE);
        registered.map_err(|error| format!("poll: {error}"))
    }
}
