//! The node's publishers, subscriptions and services.

use crate::own_name;
use crate::types::{DiagnosticArray, Empty, JointState, MarkerArray, Text, TfMessage, Triggered};
use config::{Network, Ros2};
use ros2_client::qos::{Durability, History, WhenFull};
use ros2_client::{
    Context, Message, MessageInfo, MessageTypeName, Name, Node, NodeName, NodeOptions, Publisher,
    QosProfile, Server, ServiceMapping, ServiceTypeName, Subscription,
};
use rustdds::DomainParticipantBuilder;
use rustdds::mio1::{Events, Interest, Poll, Token, event::Source};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Debug;
use std::net::Ipv4Addr;
use std::os::fd::{AsRawFd, BorrowedFd};
use std::time::Duration;

/// Most messages of a topic that one pass takes.
const TAKEN_MAX: usize = 32;

impl Message for Empty {}
impl Message for Triggered {}

/// The node cannot be opened.
pub(crate) type Error = String;

/// A publisher that never waits.
pub(crate) struct Outlet<M: Serialize>(Publisher<M>);

impl<M: Serialize + Debug> Outlet<M> {
    /// Publishes, or counts the message as dropped where there is no room.
    pub(crate) fn publish(&self, message: M, dropped: &mut u64) {
        if let Err(error) = self.0.publish(message) {
            *dropped += 1;
            tracing::debug!(?error, "a message is dropped");
        }
    }
}

/// A subscription.
pub(crate) struct Inlet<M>(Subscription<M>);

impl<M: DeserializeOwned + 'static> Inlet<M> {
    /// Hands waiting messages to `take`, up to a bound. Returns whether there may be more.
    pub(crate) fn drain(
        &self,
        unreadable: &mut u64,
        mut take: impl FnMut(M, &MessageInfo),
    ) -> bool {
        for _ in 0..TAKEN_MAX {
            match self.0.take() {
                Ok(Some((message, info))) => take(message, &info),
                Ok(None) => return false,
                Err(error) => {
                    *unreadable += 1;
                    tracing::debug!(?error, "a message is not readable");
                }
            }
        }
        true
    }
}

/// A service of type `std_srvs/Trigger`.
pub(crate) struct Trigger(Server<Empty, Triggered>);

/// A call that waits for its response.
pub(crate) type Call = ros2_client::RmwRequestId;

impl Trigger {
    /// Returns waiting calls, up to a bound.
    pub(crate) fn calls(&self, unreadable: &mut u64) -> Vec<Call> {
        let mut calls = Vec::new();
        for _ in 0..TAKEN_MAX {
            match self.0.receive_request() {
                Ok(Some((call, _))) => calls.push(call),
                Ok(None) => break,
                Err(error) => {
                    *unreadable += 1;
                    tracing::debug!(?error, "a call is not readable");
                }
            }
        }
        calls
    }

    /// Responds to a call.
    pub(crate) fn respond(&self, call: Call, response: Triggered, dropped: &mut u64) {
        if let Err(error) = self.0.send_response(call, response) {
            *dropped += 1;
            tracing::debug!(?error, "a response is dropped");
        }
    }
}

/// Everything that the node publishes, hears and serves.
pub(crate) struct Dds {
    pub(crate) joint_states: Outlet<JointState>,
    pub(crate) robot_description: Outlet<Text>,
    pub(crate) say: Outlet<Text>,
    pub(crate) heard: Outlet<Text>,
    pub(crate) objects: Outlet<MarkerArray>,
    pub(crate) tf: Outlet<TfMessage>,
    pub(crate) state: Outlet<Text>,
    pub(crate) diagnostics: Outlet<DiagnosticArray>,
    pub(crate) hear: Inlet<Text>,
    pub(crate) stop_topic: Inlet<Empty>,
    pub(crate) stop: Trigger,
    pub(crate) resume: Trigger,
    pub(crate) cancel: Trigger,
    poll: Poll,
    events: Events,
    _node: Node,
}

fn reliable(depth: usize) -> QosProfile {
    let fail = QosProfile::publisher_default().reliability_reliable(WhenFull::Fail);
    fail.history(History::KeepLast { depth })
}

fn latched() -> QosProfile {
    reliable(1).durability(Durability::TransientLocal)
}

/// Opens what the node consists of.
struct Opening<'a> {
    node: Node,
    poll: Poll,
    settings: &'a Ros2,
}

impl Opening<'_> {
    fn outlet<M: Serialize>(
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

    fn own_outlet<M: Serialize>(
        &mut self,
        name: &str,
        kind: (&str, &str),
        qos: &QosProfile,
    ) -> Result<Outlet<M>, Error> {
        let (namespace, name) = own_name(self.settings, name);
        self.outlet((&namespace, &name), kind, qos)
    }

    fn inlet<M: DeserializeOwned + 'static>(
        &mut self,
        name: &str,
        (package, kind): (&str, &str),
    ) -> Result<Inlet<M>, Error> {
        let qos = reliable(16);
        let (namespace, name) = own_name(self.settings, name);
        let failed = |error: &dyn Debug| format!("subscription of {name}: {error:?}");
        let full = Name::new(&namespace, &name).map_err(|e| failed(&e))?;
        let topic = self.node.create_topic(&full, MessageTypeName::new(package, kind), &qos);
        let topic = topic.map_err(|e| failed(&e))?;
        let subscription = self.node.create_subscription(&topic, Some(qos));
        let mut subscription = subscription.map_err(|e| failed(&e))?;
        self.wake_by(&mut subscription)?;
        Ok(Inlet(subscription))
    }

    fn trigger(&mut self, name: &str) -> Result<Trigger, Error> {
        let (namespace, name) = own_name(self.settings, name);
        let failed = |error: &dyn Debug| format!("service {name}: {error:?}");
        let full = Name::new(&namespace, &name).map_err(|e| failed(&e))?;
        let mapping = match self.settings.services {
            config::ServiceMapping::Enhanced => ServiceMapping::Enhanced,
            config::ServiceMapping::Cyclone => ServiceMapping::Cyclone,
        };
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

impl Dds {
    /// Joins the domain.
    pub(crate) fn open(settings: &Ros2) -> Result<Self, Error> {
        let mut participant = DomainParticipantBuilder::new(settings.domain_id);
        participant = match settings.network {
            Network::Loopback => participant.with_only_networks([Ipv4Addr::LOCALHOST]),
            Network::Interface(address) => participant.with_only_networks([address]),
            Network::All => participant,
        };
        let participant = participant.build().map_err(|error| format!("DDS: {error:?}"))?;
        let context = Context::from_domain_participant(participant);
        let context = context.map_err(|error| format!("DDS: {error:?}"))?;
        let name = NodeName::new(&settings.namespace, &settings.node);
        let name = name.map_err(|error| format!("node name: {error:?}"))?;
        let node = context.new_node(name, NodeOptions::new().enable_rosout(false));
        let node = node.map_err(|error| format!("node: {error:?}"))?;
        let poll = Poll::new().map_err(|error| format!("poll: {error}"))?;
        let mut opening = Opening { node, poll, settings };
        let o = &mut opening;
        let text = ("std_msgs", "String");
        let namespace = settings.namespace.as_str();
        let joints = ("sensor_msgs", "JointState");
        let markers = ("visualization_msgs", "MarkerArray");
        let diagnostics = ("diagnostic_msgs", "DiagnosticArray");
        let empty = ("std_msgs", "Empty");
        // What stops the robot is there first.
        let (stop_topic, stop) = (o.inlet("stop", empty)?, o.trigger("stop")?);
        let (resume, cancel) = (o.trigger("resume")?, o.trigger("cancel")?);
        Ok(Self {
            stop_topic,
            stop,
            resume,
            cancel,
            hear: o.inlet("hear", text)?,
            joint_states: o.outlet((namespace, "joint_states"), joints, &reliable(10))?,
            robot_description: o.outlet((namespace, "robot_description"), text, &latched())?,
            say: o.own_outlet("say", text, &reliable(10))?,
            heard: o.own_outlet("heard", text, &reliable(10))?,
            objects: o.own_outlet("objects", markers, &latched())?,
            tf: o.outlet(("/", "tf"), ("tf2_msgs", "TFMessage"), &reliable(100))?,
            state: o.own_outlet("state", text, &latched())?,
            diagnostics: o.outlet(("/", "diagnostics"), diagnostics, &reliable(10))?,
            poll: opening.poll,
            events: Events::with_capacity(32),
            _node: opening.node,
        })
    }

    /// Readable while something may wait to be taken.
    pub(crate) fn fd(&self) -> BorrowedFd<'_> {
        // SAFETY: the descriptor belongs to `self.poll`, which the result borrows.
        #[allow(unsafe_code)]
        unsafe {
            BorrowedFd::borrow_raw(self.poll.as_raw_fd())
        }
    }

    /// Resets the descriptor; to be called before anything is taken, so that nothing is missed.
    pub(crate) fn clear(&mut self) {
        // Interrupted or not: everything is taken.
        let _ = self.poll.poll(&mut self.events, Some(Duration::ZERO));
    }
}
