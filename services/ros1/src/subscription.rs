//! A topic that the bridge subscribes to.

use crate::address::with_port;
use crate::connection::{self, LARGE_BYTES_MAX, MessageBuffer, Topic, Until};
use crate::guarded;
use crate::xmlrpc::{Value, call, connect};
use ros::wire::{Message, Unreadable};
use service::{Time, clock};
use std::collections::BTreeMap;
use std::io;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

/// First and longest pause before a publisher is tried again.
const PAUSE_MIN: Duration = Duration::from_millis(50);
const PAUSE_MAX: Duration = Duration::from_secs(1);
/// Publishers of a topic that are followed at a time, with a thread each.
const PUBLISHERS_MAX: usize = 16;
/// Patience with a publisher that is called.
const PATIENCE: Duration = Duration::from_secs(2);

/// Takes the messages of one connection, with their arrival.
pub type Sink = Box<dyn FnMut(&[u8], Time) -> Result<(), Unreadable> + Send>;

/// A topic that the bridge subscribes to, with a thread for each publisher.
pub struct Subscription {
    /// The topic.
    pub topic: Topic,
    /// Makes what takes the messages of a new connection.
    sink: Box<dyn Fn() -> Sink + Send + Sync>,
    /// The publishers, by the URI of their node.
    publishers: Mutex<BTreeMap<String, Publisher>>,
}

#[derive(Debug)]
struct Publisher {
    /// Whether the master knows it. One that it has forgotten is heard until it ends: a master that was
    /// restarted knows no publisher of before.
    is_listed: bool,
    /// Name of the node while it is connected.
    connected: Option<String>,
}

impl std::fmt::Debug for Subscription {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Subscription").field("topic", &self.topic.name).finish_non_exhaustive()
    }
}

impl Subscription {
    /// Returns the topic `name` of messages `M`.
    pub fn new<M: Message>(name: &str, sink: impl Fn() -> Sink + Send + Sync + 'static) -> Self {
        let sink = Box::new(sink);
        Self { topic: Topic::of::<M>(name), sink, publishers: Mutex::default() }
    }

    /// Admits messages as large as those of cameras.
    #[must_use]
    pub fn of_large_messages(mut self) -> Self {
        self.topic.bytes_max = LARGE_BYTES_MAX;
        self
    }

    /// Connects to the publishers that the master lists.
    pub fn update(self: &Arc<Self>, node: &'static str, uris: &[String]) {
        let mut publishers = guarded(&self.publishers);
        for (uri, publisher) in publishers.iter_mut() {
            publisher.is_listed = uris.contains(uri);
        }
        for uri in uris {
            if publishers.contains_key(uri) {
                continue;
            }
            if publishers.len() >= PUBLISHERS_MAX {
                let (topic, listed) = (&self.topic.name, uris.len());
                tracing::warn!(topic, listed, "more publishers than are followed");
                break;
            }
            let (own, of) = (Arc::clone(self), uri.clone());
            match thread::Builder::new().spawn(move || own.follow(node, &of)) {
                Ok(_) => {
                    let publisher = Publisher { is_listed: true, connected: None };
                    publishers.insert(uri.clone(), publisher);
                }
                Err(error) => tracing::warn!(uri, %error, "no thread for a publisher"),
            }
        }
    }

    /// Receives from a publisher, again after each end of its connection, while the master lists it.
    fn follow(&self, node: &str, uri: &str) {
        let mut pause = PAUSE_MIN;
        loop {
            let ended = self.receive(node, uri);
            let was_connected = self.connected(uri, None);
            let topic = &self.topic.name;
            match ended {
                Ok(never) => match never {},
                Err(error) if was_connected => tracing::info!(topic, uri, %error, "publisher gone"),
                Err(error) if pause == PAUSE_MIN => {
                    let help = "its host must be known to this machine by the name that it gives";
                    tracing::warn!(topic, uri, %error, "publisher not reached; help: {help}");
                }
                Err(error) => tracing::debug!(topic, uri, %error, "publisher not reached"),
            }
            if was_connected {
                pause = PAUSE_MIN;
            }
            thread::sleep(pause);
            pause = (2 * pause).min(PAUSE_MAX);
            let mut publishers = guarded(&self.publishers);
            if !publishers.get(uri).is_some_and(|publisher| publisher.is_listed) {
                publishers.remove(uri);
                return;
            }
        }
    }

    fn receive(&self, node: &str, uri: &str) -> io::Result<std::convert::Infallible> {
        // Ports change with each start of a publisher, so they are asked for each time.
        let protocols = Value::List(vec![Value::List(vec!["TCPROS".into()])]);
        let wanted = [node.into(), self.topic.name.as_str().into(), protocols];
        let answer = call(uri, "requestTopic", &wanted, PATIENCE).map_err(io::Error::other)?;
        let (host, port) = match answer.as_list() {
            Some([_, Value::Text(host), Value::Int(port), ..]) => (host, port),
            _ => return Err(io::Error::other("expected TCPROS with host and port")),
        };
        let mut stream = connect(&with_port(host, *port), PATIENCE)?;
        connection::tune(&stream)?;
        let mut fields = self.topic.fields(node);
        // Else the publisher collects small messages, and a stall leaves a delay of 40 ms behind.
        fields.push(("tcp_nodelay", "1"));
        connection::write_header(&mut stream, &fields)?;
        let header = connection::read_header(&mut Until::new(&stream, PATIENCE))?;
        self.topic.check(&header).map_err(|error| {
            tracing::warn!(uri, error, "publisher refused");
            io::Error::other(error)
        })?;
        stream.set_read_timeout(None)?;
        self.connected(uri, Some(header.get("callerid").map_or(uri, String::as_str)));
        let (mut sink, mut buffer, mut rejected) = ((self.sink)(), MessageBuffer::default(), 0_u64);
        loop {
            let message = buffer.read(&mut stream, self.topic.bytes_max)?;
            if let Err(error) = sink(message, clock::now()) {
                rejected += 1;
                // At any rate of messages some lines a day.
                if rejected.is_power_of_two() {
                    tracing::warn!(topic = self.topic.name, %error, rejected, "message dropped");
                }
            }
        }
    }

    /// Notes that a publisher is connected as node `name`, or no more. Returns whether it was before.
    fn connected(&self, uri: &str, name: Option<&str>) -> bool {
        let mut publishers = guarded(&self.publishers);
        let Some(publisher) = publishers.get_mut(uri) else { return false };
        let before = std::mem::replace(&mut publisher.connected, name.map(str::to_owned));
        if name.is_some() {
            let names: Vec<&str> =
                publishers.values().filter_map(|p| p.connected.as_deref()).collect();
            let (topic, nodes) = (&self.topic.name, names.join(", "));
            if names.len() > 1 {
                let help = "stop all but one";
                tracing::warn!(
                    topic,
                    nodes,
                    "more than one publisher: their messages mix; help: {help}"
                );
            } else {
                tracing::info!(topic, nodes, "publisher connected");
            }
        }
        before.is_some()
    }
}
