//! A ROS 1 node: its registration at the master, and the calls that it answers.
//!
//! A master forgets everything when it is restarted, and tells nobody. So the node asks it every second
//! whether it is still registered there, and registers all topics where it is not. Connections between
//! nodes do not depend on the master and go on without it.

use crate::address::{Address, with_port};
use crate::guarded;
use crate::publication::{self, Publication};
use crate::slots::{Slot, Slots};
use crate::subscription::Subscription;
use crate::xmlrpc::{self, CallError, Value, call};
use std::io;
use std::net::{TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

/// Name of the bridge's node.
pub const NAME: &str = "/whichone";

/// Interval at which the master is asked.
const ASK_EVERY: Duration = Duration::from_secs(1);
/// Questions between two renewals of the subscriptions: a master that could not reach us once does not
/// tell us of a publisher again.
const RENEW_EVERY: u32 = 10;
/// Patience with the master.
const PATIENCE: Duration = Duration::from_secs(1);
/// Patience with whoever calls us or connects to us.
const CALLER_PATIENCE: Duration = Duration::from_secs(5);
/// Calls that are answered at a time.
const CALLS_MAX: usize = 16;
/// Subscribers whose headers are exchanged at a time.
const HEADERS_MAX: usize = 32;

/// The topics of a node.
#[derive(Debug, Default)]
pub struct Topics {
    /// Published ones.
    pub published: Vec<Arc<Publication>>,
    /// Subscribed ones.
    pub subscribed: Vec<Arc<Subscription>>,
}

/// A node. Dropping it unregisters it.
#[derive(Debug)]
pub struct Node(Arc<Shared>);

struct Shared {
    address: Address,
    topics: Topics,
    /// URI of our API, once there is one; held locked while the registration changes.
    registered: Mutex<Option<String>>,
    has_ended: AtomicBool,
    on_shutdown: Box<dyn Fn(&str) + Send + Sync>,
}

impl std::fmt::Debug for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shared").field("address", &self.address).finish_non_exhaustive()
    }
}

impl Node {
    /// Starts a node that registers as soon as the master is reached. `on_shutdown` is called with the
    /// reason when the master asks the node to end, because another one has taken its name.
    pub fn start(
        address: Address,
        topics: Topics,
        on_shutdown: impl Fn(&str) + Send + Sync + 'static,
    ) -> Self {
        let shared = Arc::new(Shared {
            address,
            topics,
            registered: Mutex::default(),
            has_ended: AtomicBool::new(false),
            on_shutdown: Box::new(on_shutdown),
        });
        let own = Arc::clone(&shared);
        thread::spawn(move || own.keep());
        Self(shared)
    }
}

impl Drop for Node {
    fn drop(&mut self) {
        self.0.has_ended.store(true, Ordering::Release);
        self.0.unregister();
    }
}

/// What is open to others.
struct Listening {
    uri: String,
    api: TcpListener,
    data: TcpListener,
    host: String,
}

impl Shared {
    /// Opens the node and keeps it registered for life.
    fn keep(self: Arc<Self>) {
        let mut complained = false;
        let Listening { uri, api, data, host } = loop {
            match self.listen() {
                Ok(listening) => break listening,
                Err(error) if !complained => {
                    complained = true;
                    tracing::warn!(%error, "not reachable for the robot yet; trying again");
                }
                Err(_) => {}
            }
            thread::sleep(ASK_EVERY);
        };
        tracing::info!(uri, master = self.address.master, "node open");
        let port = data.local_addr().map_or(0, |address| address.port());
        self.accept(api, CALLS_MAX, move |shared, stream, slot| {
            let answered = shared.answer(stream, &host, port);
            drop(slot);
            answered
        });
        self.accept(data, HEADERS_MAX, |shared, stream, slot| {
            publication::accept(stream, NAME, &shared.topics.published, slot)
        });
        let (mut rounds, mut is_away, mut is_complete) = (0, false, false);
        while !self.has_ended.load(Ordering::Acquire) {
            let asked = self.ask(&uri, rounds, is_complete);
            is_complete = asked.is_ok();
            match asked {
                Err(CallError::Connection(_, error)) => {
                    if !std::mem::replace(&mut is_away, true) {
                        let help = "start the robot; running connections go on";
                        let master = &self.address.master;
                        tracing::warn!(%error, master, "no ROS master; help: {help}");
                    }
                }
                other => {
                    is_away = false;
                    if let Err(error) = other {
                        tracing::warn!(%error, "the ROS master refuses");
                    }
                }
            }
            rounds = (rounds + 1) % RENEW_EVERY;
            thread::sleep(ASK_EVERY);
        }
    }

    fn listen(&self) -> io::Result<Listening> {
        let (host, ip) = self.address.own()?;
        let (api, data) = (TcpListener::bind((ip, 0))?, TcpListener::bind((ip, 0))?);
        let uri = format!("http://{}/", with_port(&host, api.local_addr()?.port()));
        Ok(Listening { uri, api, data, host })
    }

    /// Asks the master for our own node, and registers where it knows none, another one, or not all of
    /// its topics.
    fn ask(self: &Arc<Self>, uri: &str, rounds: u32, is_complete: bool) -> Result<(), CallError> {
        let mut registered = guarded(&self.registered);
        if self.has_ended.load(Ordering::Acquire) {
            return Ok(());
        }
        let known = match self.call("lookupNode", vec![NAME.into()]) {
            Err(CallError::Answer(..)) => None,
            other => Some(other?),
        };
        if is_complete && known.as_ref().and_then(Value::as_text) == Some(uri) {
            return if rounds == 0 { self.subscribe(uri) } else { Ok(()) };
        }
        *registered = Some(uri.to_owned());
        for publication in &self.topics.published {
            let topic = &publication.topic;
            let what = vec![topic.name.as_str().into(), topic.kind.into(), uri.into()];
            self.call("registerPublisher", what)?;
        }
        self.subscribe(uri)?;
        tracing::info!(master = self.address.master, "registered");
        self.report_robot();
        Ok(())
    }

    fn subscribe(self: &Arc<Self>, uri: &str) -> Result<(), CallError> {
        for subscription in &self.topics.subscribed {
            let topic = &subscription.topic;
            let what = vec![topic.name.as_str().into(), topic.kind.into(), uri.into()];
            let publishers = self.call("registerSubscriber", what)?;
            subscription.update(NAME, &publishers.texts());
        }
        Ok(())
    }

    /// Logs what the master's parameters say about the robot.
    fn report_robot(&self) {
        let parameter = |name: &str| self.call("getParam", vec![name.into()]).ok();
        if let Some(Value::Text(version)) = parameter("/rethink/software_version") {
            tracing::info!(version, "the robot's software");
        }
        if parameter("/use_sim_time") == Some(Value::Bool(true)) {
            let help =
                "run the simulator in real time, else its joint states are too old for the arm";
            tracing::warn!("the robot's time is simulated (/use_sim_time); help: {help}");
        }
    }

    fn unregister(&self) {
        let Some(uri) = guarded(&self.registered).take() else { return };
        let published = self.topics.published.iter().map(|p| ("unregisterPublisher", &p.topic));
        let subscribed = self.topics.subscribed.iter().map(|s| ("unregisterSubscriber", &s.topic));
        for (method, topic) in published.chain(subscribed) {
            if let Err(error) =
                self.call(method, vec![topic.name.as_str().into(), uri.as_str().into()])
            {
                return tracing::warn!(%error, "not unregistered");
            }
        }
        tracing::info!("unregistered");
    }

    fn call(&self, method: &str, mut parameters: Vec<Value>) -> Result<Value, CallError> {
        parameters.insert(0, NAME.into());
        call(&self.address.master, method, &parameters, PATIENCE)
    }

    /// Hands each connection to `handle` on a thread of its own, with one of `most` slots.
    fn accept(
        self: &Arc<Self>,
        listener: TcpListener,
        most: usize,
        handle: impl Fn(&Arc<Self>, TcpStream, Slot) -> io::Result<()> + Send + Sync + 'static,
    ) {
        let (shared, handle, slots) = (Arc::clone(self), Arc::new(handle), Slots::new(most));
        thread::spawn(move || {
            for stream in listener.incoming() {
                let Ok(stream) = stream else {
                    // No descriptor is left; one may be soon.
                    thread::sleep(Duration::from_millis(100));
                    continue;
                };
                let from = stream.peer_addr().ok().map(|address| address.ip());
                let Some(slot) = from.and_then(|from| slots.take(from)) else { continue };
                let (shared, handle) = (Arc::clone(&shared), Arc::clone(&handle));
                let work = move || {
                    let timed = stream.set_read_timeout(Some(CALLER_PATIENCE));
                    if let Err(error) = timed.and_then(|()| handle(&shared, stream, slot)) {
                        tracing::debug!(%error, "a connection failed");
                    }
                };
                if let Err(error) = thread::Builder::new().spawn(work) {
                    tracing::warn!(%error, "no thread for a connection");
                }
            }
        });
    }

    fn answer(self: &Arc<Self>, mut stream: TcpStream, host: &str, port: u16) -> io::Result<()> {
        xmlrpc::serve(&mut stream, CALLER_PATIENCE, |method, parameters| {
            let done = |value| (1, String::new(), value);
            match (method, parameters) {
                ("publisherUpdate", [_, Value::Text(topic), uris]) => {
                    let found = self.topics.subscribed.iter().find(|s| s.topic.name == *topic);
                    found.inspect(|subscription| subscription.update(NAME, &uris.texts()));
                    done(Value::Int(0))
                }
                ("requestTopic", [_, Value::Text(topic), ..]) => {
                    let mut published = self.topics.published.iter();
                    if published.any(|p| p.topic.name == *topic) {
                        let port = Value::Int(port.into());
                        done(Value::List(vec!["TCPROS".into(), host.into(), port]))
                    } else {
                        (0, format!("{NAME} does not publish {topic}"), Value::Int(0))
                    }
                }
                ("getPid", _) => done(Value::Int(std::process::id() as i32)),
                ("getMasterUri", _) => done(self.address.master.as_str().into()),
                ("getSubscriptions", _) => {
                    done(list(self.topics.subscribed.iter().map(|s| &s.topic)))
                }
                ("getPublications", _) => {
                    done(list(self.topics.published.iter().map(|p| &p.topic)))
                }
                ("getBusInfo" | "getBusStats", _) => done(Value::List(Vec::new())),
                ("paramUpdate", _) => done(Value::Int(0)),
                ("shutdown", [_, rest @ ..]) => {
                    let reason = rest.first().and_then(Value::as_text).unwrap_or("no reason given");
                    (self.on_shutdown)(reason);
                    done(Value::Int(0))
                }
                _ => (-1, format!("unknown call `{method}`"), Value::Int(0)),
            }
        })
    }
}

/// Names and types of topics.
fn list<'a>(topics: impl Iterator<Item = &'a crate::connection::Topic>) -> Value {
    let pair = |topic: &crate::connection::Topic| {
        Value::List(vec![topic.name.as_str().into(), topic.kind.into()])
    };
    Value::List(topics.map(pair).collect())
}
