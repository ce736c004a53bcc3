//! The connection to the router, and the threads that send. Each has a bounded queue; messages
//! without room are dropped, as states are resent a second later, and lines are requested.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::time::Duration;

use messages::topics;
use roster::Presence;
use service::group::GroupPaths;
use service::status::GroupStatus;
use service::worker_channel::DeviceSender;
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::Publisher;
use zenoh::qos::{CongestionControl, Priority};
use zenoh::query::Query;
use zenoh::sample::Sample;
use zenoh::{Session, Wait};

use super::{Inbound, motion};
use crate::identity::Identity;
use crate::mirrored::TOPICS;
use crate::names::{Call, Keys, call_of};
use crate::session::{connect_patiently, reply};

/// Messages that wait for a thread that sends.
const QUEUE: usize = 64;
/// Interval at which it is found out who watches.
const WATCHED_EVERY: Duration = Duration::from_millis(250);
/// States other than the topics.
const GROUP: &str = "group";
const MOTION: &str = "motion";
const PRESENCE: &str = "presence";
const LINE: &str = "line";

/// Parameters for connecting.
pub(super) struct Connecting {
    pub(super) identity: Identity,
    pub(super) folder: PathBuf,
    pub(super) keys: Keys,
    pub(super) start: u64,
    pub(super) paths: GroupPaths,
}

/// An answer under way to the mirror.
pub(super) type Answer = (Call, Query, Vec<u8>);

/// Hands messages to the threads that send them. Never waits.
pub(super) struct Senders {
    states: Outlet,
    joints: Outlet,
    answers: SyncSender<Answer>,
    _token: LivelinessToken,
    _session: Session,
}

impl Connecting {
    /// Connects, and gives the senders to the main loop.
    pub(super) fn run(self, main_loop: &DeviceSender<Inbound>, is_ending: &AtomicBool) {
        let is_ending = || is_ending.load(Ordering::Relaxed);
        let Some(session) = connect_patiently(&self.identity, &self.folder, &is_ending) else {
            return;
        };
        match self.declare(session, main_loop) {
            Ok(senders) => {
                main_loop.send(Inbound::Connected(Box::new(senders)));
            }
            Err(error) => tracing::error!(%error, "nothing can be announced at the router"),
        }
    }

    fn declare(
        &self,
        session: Session,
        main_loop: &DeviceSender<Inbound>,
    ) -> zenoh::Result<Senders> {
        let keys = &self.keys;
        let names = TOPICS.into_iter().filter(|name| *name != topics::JOINTS.name);
        let states = names.chain([GROUP, MOTION]).map(|name| {
            // The motion stop's state and the arm's actions come before mere displays.
            let is_urgent = [MOTION, topics::STATUS.name].contains(&name);
            let priority = if is_urgent { Priority::InteractiveHigh } else { Priority::Data };
            publisher(&session, keys.state(name), priority).map(|publisher| (name, publisher))
        });
        let mut states = states.collect::<zenoh::Result<Vec<_>>>()?;
        states.push((PRESENCE, publisher(&session, keys.presence(), Priority::DataLow)?));
        // In one stream with the state that shows the line, so that it arrives before.
        states.push((LINE, publisher(&session, keys.line(), Priority::Data)?));
        let joints = publisher(&session, keys.joints(), Priority::DataLow)?;
        let states = Outlet::start("states", states)?;
        let joints = Outlet::start("joints", vec![(topics::JOINTS.name, joints)])?;
        let answers = answers("answers", keys)?;
        let orders = motion::start(&self.paths, states.clone(), answers_of_motion(keys)?)?;
        let main = main_loop.clone();
        let on_query = move |query: Query| {
            // Requests that find no room are not answered, and repeated.
            match call_of(query.key_expr().as_str()) {
                Some(Call::Motion) => drop(orders.offer(query)),
                Some(call) => drop(main.offer(Inbound::Asked(call, query))),
                None => tracing::debug!(key = %query.key_expr(), "no such request"),
            }
        };
        let all = keys.calls();
        session.declare_queryable(all).callback(on_query).background().wait()?;
        let main = main_loop.clone();
        let on_sound = move |sample: Sample| {
            // Lost sound is silence.
            let _ = main.offer(Inbound::Audio(sample.payload().to_bytes().into_owned()));
        };
        session.declare_subscriber(keys.audio()).callback(on_sound).background().wait()?;
        let token = keys.alive(&format!("{:016x}", self.start));
        let token = session.liveliness().declare_token(token).wait()?;
        Ok(Senders { states, joints, answers, _token: token, _session: session })
    }
}

fn publisher(
    session: &Session,
    key: String,
    priority: Priority,
) -> zenoh::Result<Publisher<'static>> {
    let publisher = session.declare_publisher(key).priority(priority);
    publisher.congestion_control(CongestionControl::Drop).wait()
}

/// Starts a thread that answers.
fn answers(name: &str, keys: &Keys) -> zenoh::Result<SyncSender<Answer>> {
    let (sender, receiver) = sync_channel::<Answer>(QUEUE);
    let keys = keys.clone();
    let answer = move || {
        for (call, query, bytes) in receiver {
            reply(&query, bytes, &keys, call);
        }
    };
    std::thread::Builder::new().name(name.into()).spawn(answer)?;
    Ok(sender)
}

/// Answers to orders have a thread of their own: another answer may wait for room.
fn answers_of_motion(keys: &Keys) -> zenoh::Result<SyncSender<Answer>> {
    answers("stop-answers", keys)
}

impl Senders {
    /// Returns whether any state has watchers.
    pub(super) fn is_watched(&self) -> bool {
        self.states
            .is_watched
            .iter()
            .any(|(name, is)| ![PRESENCE, LINE].contains(name) && is.load(Ordering::Relaxed))
    }

    /// Returns whether the topic has watchers.
    pub(super) fn is_state_watched(&self, topic: &str) -> bool {
        self.of(topic).is_watched_at(topic)
    }

    /// Sends a topic's frame.
    pub(super) fn state(&self, topic: &'static str, bytes: Vec<u8>) {
        self.of(topic).send(topic, bytes);
    }

    /// Sends the group's status.
    pub(super) fn group(&self, status: &GroupStatus) {
        if self.states.is_watched_at(GROUP) {
            self.states.send(GROUP, serde_json::to_vec(status).unwrap_or_default());
        }
    }

    /// Returns whether the robot's lines have listeners.
    pub(super) fn is_line_watched(&self) -> bool {
        self.states.is_watched_at(LINE)
    }

    /// Sends the sound of a line that begins.
    pub(super) fn line(&self, line: Vec<u8>) {
        self.states.send(LINE, line);
    }

    /// Publishes the robot's presence.
    pub(super) fn presence(&self, presence: &Presence) {
        self.states.send(PRESENCE, serde_json::to_vec(presence).unwrap_or_default());
    }

    /// Answers a request.
    pub(super) fn answer(&self, call: Call, query: Query, bytes: Vec<u8>) {
        if self.answers.try_send((call, query, bytes)).is_err() {
            tracing::debug!(?call, "no room for an answer; it is asked again");
        }
    }

    fn of(&self, topic: &str) -> &Outlet {
        if topic == topics::JOINTS.name { &self.joints } else { &self.states }
    }
}

/// A thread that sends, from outside.
#[derive(Clone)]
pub(super) struct Outlet {
    queue: SyncSender<(&'static str, Vec<u8>)>,
    is_watched: Arc<Vec<(&'static str, AtomicBool)>>,
}

impl Outlet {
    fn start(
        name: &str,
        publishers: Vec<(&'static str, Publisher<'static>)>,
    ) -> std::io::Result<Self> {
        let (queue, receiver) = sync_channel(QUEUE);
        let flags = publishers.iter().map(|(name, _)| (*name, AtomicBool::new(false)));
        let is_watched = Arc::new(flags.collect::<Vec<_>>());
        let flags = Arc::clone(&is_watched);
        let send = move || send_all(&receiver, &publishers, &flags);
        std::thread::Builder::new().name(name.into()).spawn(send)?;
        Ok(Self { queue, is_watched })
    }

    fn is_watched_at(&self, name: &str) -> bool {
        let found = self.is_watched.iter().find(|(known, _)| *known == name);
        found.is_some_and(|(_, is_watched)| is_watched.load(Ordering::Relaxed))
    }

    /// Sends the motion stop's state.
    pub(super) fn motion(&self, bytes: Vec<u8>) {
        self.send(MOTION, bytes);
    }

    /// Returns whether the motion stop's state has watchers.
    pub(super) fn is_motion_watched(&self) -> bool {
        self.is_watched_at(MOTION)
    }

    fn send(&self, name: &'static str, bytes: Vec<u8>) {
        if self.queue.try_send((name, bytes)).is_err() {
            tracing::debug!(name, "no room; it is sent again");
        }
    }
}

/// Sends until the other end is gone, and notes who watches.
fn send_all(
    queue: &Receiver<(&'static str, Vec<u8>)>,
    publishers: &[(&'static str, Publisher<'static>)],
    flags: &[(&'static str, AtomicBool)],
) {
    let mut looked: Option<std::time::Instant> = None;
    loop {
        if looked.is_none_or(|at| at.elapsed() >= WATCHED_EVERY) {
            looked = Some(std::time::Instant::now());
            for ((_, publisher), (_, flag)) in publishers.iter().zip(flags) {
                let status = publisher.matching_status().wait();
                flag.store(status.is_ok_and(|status| status.matching()), Ordering::Relaxed);
            }
        }
        match queue.recv_timeout(WATCHED_EVERY) {
            Ok((name, bytes)) => {
                let found = publishers.iter().find(|(known, _)| *known == name);
                if let Some((_, publisher)) = found
                    && let Err(error) = publisher.put(bytes).wait()
                {
                    tracing::debug!(name, %error, "not sent; it is sent again");
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return,
        }
    }
}
