//! `whichone fleet --watch`: changes of the list of robots, as lines for the gateway.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, SyncSender, sync_channel};
use std::time::{Duration, Instant};

use roster::{Change, Name, Presence};
use service::exit::{Exit, Failure};
use zenoh::pubsub::Subscriber;
use zenoh::sample::{Sample, SampleKind};
use zenoh::{Session, Wait};

use crate::identity::Identity;
use crate::names::{Call, Keys, robot_of};
use crate::session::{close, connect_patiently, request};

/// Interval of an empty line, by which the end of the reader is noticed.
const BEAT_EVERY: Duration = Duration::from_secs(2);
/// Time for a robot to report its activity, before it is asked again.
const PATIENCE: Duration = Duration::from_secs(10);
/// News that wait.
const QUEUE: usize = 16_384;
/// Robots asked at a time: each is asked once it is connected, and reports the rest unasked.
const ASKED_MAX: usize = 64;

/// Events from the library's threads to the main one.
enum News {
    /// A link of a robot has come or gone.
    Alive(Name, String, bool),
    /// Presence of a robot.
    Presence(Vec<u8>),
}

/// A connected robot.
struct Robot {
    /// Its links: two for a moment when one is started again.
    starts: BTreeSet<String>,
    presence: Option<Presence>,
    asked: Option<Instant>,
    _presences: Option<Subscriber<()>>,
}

/// Follows the robots until the reader or this process ends.
///
/// # Errors
/// The keys are not a person's.
pub fn run(folder: &Path, out: &mut impl Write) -> Result<(), Failure> {
    let identity = Identity::load(folder)?;
    identity.require(false, folder)?;
    let is_ending = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT] {
        signal_hook::flag::register(signal, Arc::clone(&is_ending))
            .map_err(|error| Failure::new(Exit::NotReached, format!("signals: {error}")))?;
    }
    let ended = || is_ending.load(Ordering::Relaxed);
    let Some(session) = connect_patiently(&identity, folder, &ended) else { return Ok(()) };
    let (sender, news) = sync_channel(QUEUE);
    let all = match identity.robots.is_empty() {
        true => vec![Keys::of_all()],
        false => identity.robots.iter().map(Keys::of).collect(),
    };
    let failed = |error| Failure::new(Exit::NotReached, format!("subscriptions: {error}"));
    all.iter().try_for_each(|keys| follow(&session, keys, &sender)).map_err(failed)?;
    let mut robots: BTreeMap<Name, Robot> = BTreeMap::new();
    let mut beaten = Instant::now();
    let mut write = |line: &str| writeln!(out, "{line}").and_then(|()| out.flush());
    while !ended() {
        let change = match news.recv_timeout(BEAT_EVERY.saturating_sub(beaten.elapsed())) {
            Ok(News::Alive(robot, start, true)) => {
                let is_new = !robots.contains_key(&robot);
                let known = robots.entry(robot.clone()).or_insert_with(|| {
                    let presences = presences(&session, &robot, &sender);
                    Robot {
                        starts: BTreeSet::new(),
                        presence: None,
                        asked: None,
                        _presences: presences,
                    }
                });
                known.starts.insert(start);
                is_new.then_some(Change::Here { robot, presence: None })
            }
            Ok(News::Alive(robot, start, false)) => {
                let known = robots.get_mut(&robot);
                known
                    .is_some_and(|known| known.starts.remove(&start) && known.starts.is_empty())
                    .then(|| {
                        robots.remove(&robot);
                        Change::Gone { gone: robot }
                    })
            }
            Ok(News::Presence(bytes)) => said(&mut robots, &bytes),
            Err(RecvTimeoutError::Timeout) => {
                beaten = Instant::now();
                ask(&session, &mut robots, &sender);
                if write("").is_err() {
                    break;
                }
                None
            }
            Err(RecvTimeoutError::Disconnected) => break,
        };
        let line = change.and_then(|change| serde_json::to_string(&change).ok());
        // The channel has no reader any more.
        if line.is_some_and(|line| write(&line).is_err()) {
            break;
        }
        ask(&session, &mut robots, &sender);
    }
    robots.clear();
    close(session);
    Ok(())
}

/// Takes a robot's presence; returns the change, if it is one.
fn said(robots: &mut BTreeMap<Name, Robot>, bytes: &[u8]) -> Option<Change> {
    let presence: Presence = serde_json::from_slice(bytes).ok()?;
    let robot = Name::new(&presence.robot).ok()?;
    let known = robots.get_mut(&robot)?;
    if known.presence.as_ref() == Some(&presence) {
        return None;
    }
    known.presence = Some(presence.clone());
    Some(Change::Here { robot, presence: Some(presence) })
}

fn follow(session: &Session, keys: &Keys, sender: &SyncSender<News>) -> zenoh::Result<()> {
    let sender = sender.clone();
    let on_alive = move |sample: Sample| {
        let key = sample.key_expr().as_str();
        let start = key.rsplit('/').next().unwrap_or_default().to_owned();
        if let Some(robot) = robot_of(key) {
            let is_here = sample.kind() == SampleKind::Put;
            // The queue takes every robot that a router takes.
            let _ = sender.try_send(News::Alive(robot, start, is_here));
        }
    };
    let liveliness = session.liveliness();
    let alive = liveliness.declare_subscriber(keys.alive("*")).history(true);
    alive.callback(on_alive).background().wait()
}

/// Subscribes to one robot's presence: the router passes no subscription to all of them.
fn presences(session: &Session, robot: &Name, sender: &SyncSender<News>) -> Option<Subscriber<()>> {
    let sender = sender.clone();
    let take = move |sample: Sample| {
        // It is said again.
        let _ = sender.try_send(News::Presence(sample.payload().to_bytes().into_owned()));
    };
    let declared = session.declare_subscriber(Keys::of(robot).presence()).callback(take).wait();
    declared.inspect_err(|error| tracing::warn!(%robot, %error, "not followed")).ok()
}

/// Asks robots that have said nothing yet.
fn ask(session: &Session, robots: &mut BTreeMap<Name, Robot>, sender: &SyncSender<News>) {
    let silent = robots.iter_mut().filter(|(_, robot)| robot.presence.is_none());
    let mut room = ASKED_MAX;
    for (name, robot) in silent {
        let is_asked = robot.asked.is_some_and(|asked| asked.elapsed() < PATIENCE);
        if is_asked || room == 0 {
            room = room.saturating_sub(1);
            continue;
        }
        room -= 1;
        robot.asked = Some(Instant::now());
        let sender = sender.clone();
        let take = move |bytes: Vec<u8>| drop(sender.try_send(News::Presence(bytes)));
        request(session, &Keys::of(name), Call::Presence, Vec::new(), PATIENCE, take);
    }
}
