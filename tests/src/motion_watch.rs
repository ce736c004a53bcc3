//! Records what an arm does and what the robot says of it, across restarts of services and of the group.

use crate::wait_for;
use messages::{ArmStatus, JOINT_STATE_LEN, JointStates, RobotAct, topics};
use service::client::Client;
use service::group::GroupPaths;
use service::{Span, Time, clock};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// Interval of looks; an arm reports its joints a hundred times a second.
const LOOK_EVERY: Duration = Duration::from_millis(3);
/// A change of a joint below it is no movement, radians; of a gripper, its whole width.
const STILL_RAD: f64 = 1e-6;
/// A velocity below it is rest, radians per second.
const STILL_RAD_S: f64 = 1e-3;
/// A joint state so long after the former one is of another incarnation of the arm.
const GAP: Span = Span::from_ms(300);

/// The joints of a state, and both grippers as parts of their widths.
type Joints = [f64; JOINT_STATE_LEN + 2];

#[derive(Debug, Default)]
struct Seen {
    latest: Option<(Time, Joints)>,
    /// The latest state of the joints has velocities.
    has_velocity: bool,
    /// Movements, each with the times of the joint states before and after it.
    movements: Vec<(Time, Time)>,
    status: ArmStatus,
    /// When the robot last began to say that it has stopped.
    said_stopped: Option<Time>,
    line: String,
}

/// Watches an arm in a thread until dropped.
#[derive(Debug)]
pub struct MotionWatch {
    seen: Arc<Mutex<Seen>>,
    over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl MotionWatch {
    /// Begins to watch the group, which may start later.
    pub fn start(paths: &GroupPaths) -> Self {
        let (seen, over) = (Arc::default(), Arc::default());
        let thread = std::thread::spawn({
            let (seen, over, paths) = (Arc::clone(&seen), Arc::clone(&over), paths.clone());
            move || watch(&paths, &seen, &over)
        });
        Self { seen, over, thread: Some(thread) }
    }

    fn read<T>(&self, read: impl FnOnce(&mut Seen) -> T) -> T {
        read(&mut self.seen.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Forgets what was seen.
    pub fn clear(&self) {
        self.read(|seen| {
            seen.movements.clear();
            seen.said_stopped = None;
        });
    }

    /// Waits until the arm moves.
    ///
    /// # Panics
    /// If it does not.
    pub fn wait_moving(&self) {
        let begun = clock::now();
        wait_for("a movement", 20.0, || {
            self.read(|seen| seen.movements.iter().any(|(from, _)| *from > begun).then_some(()))
        });
    }

    /// Waits until the arm reports that the motion stop is latched and the arm at rest.
    ///
    /// # Panics
    /// If it does not.
    pub fn wait_stopped(&self, what: &str) {
        wait_for(what, 15.0, || {
            self.read(|seen| (seen.status.stopped == 1 && seen.status.moving == 0).then_some(()))
        });
    }

    /// Waits until so much time of joint states has passed since `from`.
    ///
    /// # Panics
    /// If none arrive.
    pub fn wait_states(&self, from: Time, seconds: f64) {
        let until = from + Span::from_s(seconds);
        wait_for("joint states", 15.0, || {
            self.read(|seen| seen.latest.is_some_and(|(at, _)| at > until).then_some(()))
        });
    }

    /// Returns how many movements began after `from`.
    pub fn movements_since(&self, from: Time) -> usize {
        self.read(|seen| seen.movements.iter().filter(|(before, _)| *before > from).count())
    }

    /// Returns when the robot last began to say that it has stopped.
    pub fn said_stopped(&self) -> Option<Time> {
        self.read(|seen| seen.said_stopped)
    }

    /// Returns the latest status of the arm.
    pub fn status(&self) -> ArmStatus {
        self.read(|seen| seen.status)
    }

    /// Returns whether no joint had a velocity at last.
    pub fn rests(&self) -> bool {
        self.read(|seen| !seen.has_velocity)
    }

    /// Returns the robot's latest line.
    pub fn line(&self) -> String {
        self.read(|seen| seen.line.clone())
    }
}

impl Drop for MotionWatch {
    fn drop(&mut self) {
        self.over.store(true, Ordering::Relaxed);
        self.thread.take().into_iter().for_each(|thread| drop(thread.join()));
    }
}

fn watch(paths: &GroupPaths, seen: &Mutex<Seen>, over: &AtomicBool) {
    while !over.load(Ordering::Relaxed) {
        if let Ok(client) = Client::join(paths) {
            // It ends with the group's shared memory.
            let _ = follow(paths, &client, seen, over);
        }
        std::thread::sleep(10 * LOOK_EVERY);
    }
}

/// Follows one epoch of the group.
fn follow(
    paths: &GroupPaths,
    client: &Client,
    seen: &Mutex<Seen>,
    over: &AtomicBool,
) -> Result<(), Box<dyn std::error::Error>> {
    let bus = client.bus();
    let joints = bus.reader::<JointStates>(&topics::JOINTS)?;
    let status = bus.reader::<ArmStatus>(&topics::STATUS)?;
    let acts = bus.reader::<RobotAct>(&topics::ACT)?;
    let memory = paths.shm_name()?;
    while !over.load(Ordering::Relaxed) {
        // Read before it is judged: the last states of a group that ends count, too.
        let mut seen = seen.lock().unwrap_or_else(PoisonError::into_inner);
        joints.drain(|states| seen.on_joints(states))?;
        status.drain(|status| seen.status = *status)?;
        acts.drain(|act| seen.on_act(act))?;
        drop(seen);
        if paths.shm_name()? != memory {
            return Ok(());
        }
        std::thread::sleep(LOOK_EVERY);
    }
    Ok(())
}

impl Seen {
    fn on_joints(&mut self, states: &JointStates) {
        let mut joints = [0.0; JOINT_STATE_LEN + 2];
        joints[..JOINT_STATE_LEN].copy_from_slice(&states.position);
        let grippers = states.gripper_percent.map(|percent| percent / 100.0);
        joints[JOINT_STATE_LEN..].copy_from_slice(&grippers);
        let at = Time(states.at_ns);
        self.has_velocity = states.velocity.iter().any(|velocity| velocity.abs() > STILL_RAD_S);
        if let Some((before, former)) = self.latest.replace((at, joints)) {
            let moves = former.iter().zip(&joints).any(|(a, b)| (a - b).abs() > STILL_RAD);
            if moves && at < before + GAP {
                self.movements.push((before, at));
            }
        }
    }

    fn on_act(&mut self, act: &RobotAct) {
        let line = act.text.as_str().unwrap_or_default();
        if line == self.line {
            return;
        }
        line.clone_into(&mut self.line);
        if line.contains("I have stopped") {
            self.said_stopped = Some(clock::now());
        }
    }
}
