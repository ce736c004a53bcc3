//! Light robots for measurements of scale (scripts/fleet): each has a session of its own, makes a
//! robot's declarations, shows presence and state, and answers words and orders. None has a group.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use messages::topics;
use messages::{ArmStatus, FixedText, MotionOrder, PolicyView, Receipt, RequestKey, Sound};
use roster::{Name, Presence};
use service::bounded::push_bounded;
use service::exit::{Exit, Failure};
use service::stop_socket::StopState;
use service::{Time, clock};
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::Publisher;
use zenoh::qos::{CongestionControl, Priority};
use zenoh::query::Query;
use zenoh::{Session, Wait};

use crate::frame::Outgoing;
use crate::identity::Identity;
use crate::mirrored::TOPICS;
use crate::motion::{Answer, Register, Request, Stamped};
use crate::names::{Call, Keys, call_of};
use crate::presence::{Hello, PRESENCE_EVERY};
use crate::say::{Receipts, Said, Sent};
use crate::session::{connect_patiently, reply};

/// Sessions that are opened at a time.
const OPENERS: usize = 16;
/// Requests that wait for an answer.
const QUEUE: usize = 16_384;
/// Receipts that a robot remembers.
const RECEIPTS: usize = 16;
/// Interval at which a watched robot shows its states.
const STATES_EVERY: Duration = Duration::from_secs(1);

/// Robots to simulate.
#[derive(Clone, Debug)]
pub struct Fleet {
    /// Folder `robots` of the keys.
    pub keys: PathBuf,
    /// Their names.
    pub names: Vec<Name>,
    /// Time over which they join, at random.
    pub spread: Duration,
    /// Settings that mirrors get.
    pub settings: String,
}

/// Counts of the robots' actions, as others see them.
#[derive(Debug, Default)]
pub struct Counts {
    /// Robots that have joined.
    pub joined: AtomicUsize,
    /// Requests that were answered.
    pub answered: AtomicUsize,
    /// Set to end.
    pub is_ending: AtomicBool,
}

/// A robot.
struct Robot {
    name: Name,
    keys: Keys,
    session: Session,
    presence: Publisher<'static>,
    states: Vec<(&'static str, Publisher<'static>)>,
    _token: LivelinessToken,
    start: u64,
    mind: Mutex<Mind>,
}

/// State of a simulated robot.
struct Mind {
    view: PolicyView,
    view_out: Outgoing<PolicyView>,
    arm: ArmStatus,
    arm_out: Outgoing<ArmStatus>,
    register: Register,
    receipts: VecDeque<(RequestKey, Receipt)>,
}

type Asked = (usize, Call, Query);

/// Runs the robots until `counts` says that they end.
///
/// # Errors
/// A robot has no keys.
pub fn run(fleet: &Fleet, counts: &Arc<Counts>) -> Result<(), Failure> {
    let identities = fleet.names.iter().map(|name| {
        let folder = fleet.keys.join(name.as_str());
        Identity::load(&folder).map(|identity| (identity, folder))
    });
    let identities = identities.collect::<Result<Vec<_>, Failure>>()?;
    let (asked, questions) = sync_channel::<Asked>(QUEUE);
    let robots: Arc<Mutex<Vec<Option<Arc<Robot>>>>> =
        Arc::new(Mutex::new((0..identities.len()).map(|_| None).collect()));
    let next = AtomicUsize::new(0);
    let began = Instant::now();
    std::thread::scope(|scope| {
        let answering = Arc::clone(&robots);
        scope.spawn(move || answer_all(&questions, &answering, &fleet.settings, counts));
        for _ in 0..OPENERS {
            let (next, identities, robots, asked) = (&next, &identities, &robots, asked.clone());
            scope.spawn(move || {
                while let Some((number, (identity, folder))) = {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    identities.get(number).map(|known| (number, known))
                } {
                    wait_until(began + moment(number, identities.len(), fleet.spread), counts);
                    let Some(robot) = join(number, identity, folder, &asked, counts) else { break };
                    lock(robots)[number] = Some(Arc::new(robot));
                    counts.joined.fetch_add(1, Ordering::Relaxed);
                }
            });
        }
        drop(asked);
        show_all(&robots, counts);
        // Sessions say goodbye, and the queue of questions ends with the last one.
        lock(&robots).clear();
    });
    Ok(())
}

/// When a robot joins: spread evenly, in the order of numbers, with a share of chance.
fn moment(number: usize, all: usize, spread: Duration) -> Duration {
    let chance = f64::from(u16::try_from(mix(number) % 1_000).unwrap_or(0)) / 1_000.0;
    spread.mul_f64(((number as f64 + chance) / all.max(1) as f64).min(1.0))
}

fn mix(number: usize) -> u64 {
    (number as u64).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32
}

fn wait_until(moment: Instant, counts: &Counts) {
    while Instant::now() < moment && !counts.is_ending.load(Ordering::Relaxed) {
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Connects a robot and makes the declarations of a robot's link.
fn join(
    number: usize,
    identity: &Identity,
    folder: &Path,
    asked: &SyncSender<Asked>,
    counts: &Counts,
) -> Option<Robot> {
    let is_ending = || counts.is_ending.load(Ordering::Relaxed);
    let session = connect_patiently(identity, folder, &is_ending)?;
    let robot = declare(number, identity.name.clone(), session, asked);
    robot.inspect_err(|error| tracing::error!(%error, "robot not declared")).ok()
}

fn declare(
    number: usize,
    name: Name,
    session: Session,
    asked: &SyncSender<Asked>,
) -> zenoh::Result<Robot> {
    let keys = Keys::of(&name);
    let start = mix(number) | 1;
    let publisher = |key: String, priority| {
        let publisher = session.declare_publisher(key).priority(priority);
        publisher.congestion_control(CongestionControl::Drop).wait()
    };
    let names = TOPICS.into_iter().filter(|name| *name != topics::JOINTS.name);
    let states = names
        .chain(["group", "motion"])
        .map(|name| publisher(keys.state(name), Priority::Data).map(|publisher| (name, publisher)));
    let states = states.collect::<zenoh::Result<Vec<_>>>()?;
    let presence = publisher(keys.presence(), Priority::DataLow)?;
    let asked = asked.clone();
    let on_query = move |query: Query| {
        if let Some(call) = call_of(query.key_expr().as_str()) {
            // Requests that find no room are repeated.
            let _ = asked.try_send((number, call, query));
        }
    };
    session.declare_queryable(keys.calls()).callback(on_query).background().wait()?;
    session.declare_subscriber(keys.audio()).callback(drop).background().wait()?;
    let token = session.liveliness().declare_token(keys.alive(&format!("{start:016x}"))).wait()?;
    let mind = Mind {
        view: PolicyView::default(),
        view_out: Outgoing::new(start),
        arm: ArmStatus::default(),
        arm_out: Outgoing::new(start),
        register: Register::default(),
        receipts: VecDeque::new(),
    };
    let mind = Mutex::new(mind);
    Ok(Robot { name, keys, session, presence, states, _token: token, start, mind })
}

/// Shows every robot's presence and, to watchers, its states, until the end.
fn show_all(robots: &Mutex<Vec<Option<Arc<Robot>>>>, counts: &Counts) {
    let mut round = 0_u32;
    let rounds = u32::try_from(PRESENCE_EVERY.0 / STATES_EVERY.as_nanos() as u64).unwrap_or(1);
    while !counts.is_ending.load(Ordering::Relaxed) {
        let began = Instant::now();
        let present: Vec<Arc<Robot>> = lock(robots).iter().flatten().cloned().collect();
        for (number, robot) in present.iter().enumerate() {
            if number as u32 % rounds == round % rounds {
                let bytes = serde_json::to_vec(&robot.presence_now()).unwrap_or_default();
                note(robot.presence.put(bytes).wait());
            }
            robot.show();
        }
        round += 1;
        while began.elapsed() < STATES_EVERY && !counts.is_ending.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

fn note(put: zenoh::Result<()>) {
    if let Err(error) = put {
        tracing::debug!(%error, "not sent");
    }
}

impl Robot {
    fn presence_now(&self) -> Presence {
        let mind = lock(&self.mind);
        Presence {
            robot: self.name.to_string(),
            version: build_info::full_version(),
            state: "ready".to_owned(),
            scene: "bowls".to_owned(),
            dialogue: "idle".to_owned(),
            line: mind.view.text.clone(),
            likeliest: None,
            arm: "rest".to_owned(),
            stopped: mind.arm.stopped != 0,
        }
    }

    /// Shows the states to those who watch.
    fn show(&self) {
        for (name, publisher) in &self.states {
            let is_shown = [topics::VIEW.name, topics::STATUS.name].contains(name);
            if !is_shown || !publisher.matching_status().wait().is_ok_and(|it| it.matching()) {
                continue;
            }
            let mut mind = lock(&self.mind);
            let now = clock::now();
            let frame = if *name == topics::VIEW.name {
                let view = mind.view.clone();
                mind.view_out.take(view);
                mind.view_out.due(now)
            } else {
                let arm = mind.arm;
                mind.arm_out.take(arm);
                mind.arm_out.due(now)
            };
            drop(mind);
            if let Some(frame) = frame {
                note(publisher.put(frame).wait());
            }
        }
    }

    fn answer(&self, call: Call, query: &Query, settings: &str) -> Option<Vec<u8>> {
        let payload = query.payload().map(|payload| payload.to_bytes().into_owned());
        let payload = payload.unwrap_or_default();
        match call {
            Call::Presence => serde_json::to_vec(&self.presence_now()).ok(),
            Call::Hello => {
                let version = build_info::full_version();
                let settings = settings.to_owned();
                postcard::to_stdvec(&Hello { version, epoch: self.start, settings }).ok()
            }
            Call::Say => self.hear(&postcard::from_bytes(&payload).ok()?),
            Call::Motion => self.obey(&postcard::from_bytes(&payload).ok()?),
            Call::Line => None,
        }
    }

    /// Accepts words once, under their key.
    fn hear(&self, said: &Said) -> Option<Vec<u8>> {
        let mut mind = lock(&self.mind);
        let known = mind.receipts.iter().find(|(key, _)| *key == said.key).map(|(_, it)| *it);
        let receipt = known.unwrap_or_else(|| {
            let Sent::Sound(Sound::Text(text)) = &said.sound else {
                return Receipt { key: said.key.0, segments: 1, ..Receipt::default() };
            };
            let applied = mind.view.applied + 1;
            mind.view.applied = applied;
            mind.view.text = format!("I heard: {text}");
            let receipt = Receipt {
                key: said.key.0,
                seq: applied,
                segments: 1,
                note: FixedText::truncated(text),
                ..Receipt::default()
            };
            push_bounded(&mut mind.receipts, RECEIPTS, (said.key, receipt));
            receipt
        });
        let receipts = Receipts { sent_ns: clock::now().ns(), receipts: vec![receipt] };
        postcard::to_stdvec(&receipts).ok()
    }

    /// Carries an order to the motion stop out at once.
    fn obey(&self, request: &Request) -> Option<Vec<u8>> {
        let mut mind = lock(&self.mind);
        let answer = match mind.register.stamp(request, clock::now()) {
            Err(why) => Answer::Refused(why),
            Ok((order, Time(stamp))) => {
                let stopped = order == MotionOrder::Stop;
                mind.arm.stopped = stopped.into();
                Answer::State(Stamped(StopState {
                    given_ns: stamp,
                    in_force_ns: stamp,
                    stopped,
                    at_rest: true,
                    durable: true,
                    inhibit: messages::MotionInhibit::None,
                    stop: messages::StopId(0),
                }))
            }
        };
        postcard::to_stdvec(&answer).ok()
    }
}

fn answer_all(
    questions: &Receiver<Asked>,
    robots: &Mutex<Vec<Option<Arc<Robot>>>>,
    settings: &str,
    counts: &Counts,
) {
    while let Ok((number, call, query)) = questions.recv() {
        let robot = lock(robots).get(number).cloned().flatten();
        let Some(robot) = robot.filter(|robot| !robot.session.is_closed()) else { continue };
        if let Some(bytes) = robot.answer(call, &query, settings) {
            reply(&query, bytes, &robot.keys, call);
            counts.answered.fetch_add(1, Ordering::Relaxed);
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    // Every change leaves a consistent value.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Name of the robot with a number: `sim-0001` and so on.
///
/// # Errors
/// The number has too many digits.
pub fn name(number: usize) -> Result<Name, Failure> {
    Name::new(&format!("sim-{number:04}"))
        .map_err(|error| Failure::new(Exit::Usage, error.to_string()))
}
