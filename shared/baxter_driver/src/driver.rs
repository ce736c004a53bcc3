//! The driver keeps the newest reports of the robot and returns the orders to it. It is as
//! pure as the arm itself: time comes with each call, messages go out with the pass.
//!
//! Joints are commanded in position mode, which keeps the robot's own collision avoidance; raw
//! position mode is never used. Each limb gets a command in every pass, also while it stands: a
//! limb that hears none for 0.2 s takes over the position that it happens to have.

use arm_driver::{ArmDriver, Command, Fault, Fingers, Measured, Source, Start, furthest};
use manipulation::{Joints, Limb, PositionLimits, Robot};
use messages::MotionInhibit;
use messages::robot::{
    AssemblyState, JointCommand, JointMode, JointState, JointTrajectoryPoint, Order, Report,
    SpeedRatio,
};
use serde::{Deserialize, Serialize};
use service::{Span, Time};

use crate::Baxter;
use crate::gripper::{Condition, Gripper};

/// Longest time between two passes: a little more than between two joint states, which begin a pass
/// themselves.
const BEAT: Span = Span::from_ms(15);
/// Shortest time between two commands to a limb.
const COMMAND_EVERY: Span = Span::from_ms(5);
/// Age beyond which the robot's state is stale.
const STALE: Span = Span::from_ms(1_000);
/// Interval of the speed ratio command; a restarted robot has lost it.
const RATIO_EVERY: Span = Span::from_ms(1_000);
/// Timeout of a finger command, seconds: the SDK's own timeout.
const FINGERS_MAX_S: f64 = 5.0;
/// A joint measured at most this far outside its limits counts as on them, radians.
const LIMIT_SLACK_RAD: f64 = 0.03;
/// A joint state from further in the future than this has the stamp of another clock.
const CLOCK_SLACK: Span = Span::from_ms(100);

/// The driver.
#[derive(Clone, Debug)]
pub struct BaxterDriver {
    settings: Baxter,
    robot: Robot,
    /// The limbs whose grippers are used, left first.
    used: [bool; 2],
    measured: Measured,
    /// Time of the newest joint state.
    joints_at: Option<Time>,
    assembly: Option<(AssemblyState, Time)>,
    grippers: [Gripper; 2],
    limbs: [Set; 2],
    now: Time,
    inhibit: MotionInhibit,
    ratio_sent: Option<Time>,
    fresh: bool,
}

/// Command state of a limb.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct Set {
    /// Commanded positions; `None` before the first report, or while it accepts no commands.
    q: Option<Joints>,
    /// The command of this pass.
    command: Option<Command>,
    /// True if it was moving in the previous pass.
    moved: bool,
    sent: Option<Time>,
    /// The goal at which it has arrived.
    arrived: Option<Joints>,
}

impl BaxterDriver {
    /// Returns a driver before the first report: until then, the posture is the one that the
    /// journal remembers.
    pub fn new(settings: Baxter, start: &Start<'_>) -> Self {
        let Start { robot, limb, posture, .. } = *start;
        let mut used = [false; 2];
        for own in robot.limbs() {
            used[*own] = limb.is_none_or(|limb| limb == *own);
        }
        let measured = Measured::remembered(posture, 2.0 * settings.goal_tolerance_rad);
        Self {
            settings,
            robot: robot.clone(),
            used,
            measured,
            joints_at: None,
            assembly: None,
            grippers: Limb::BOTH.map(|limb| Gripper::new(&robot.arm(limb).gripper)),
            limbs: [Set::default(); 2],
            now: Time(0),
            inhibit: MotionInhibit::Unheard,
            ratio_sent: None,
            fresh: false,
        }
    }

    fn on_joints(&mut self, state: &JointState, now: Time) {
        let joints = match state.joints() {
            Ok(joints) => joints,
            Err(error) => return tracing::warn!(%error, "invalid joint state ignored"),
        };
        let mut posture = self.measured.posture.joints;
        let (mut velocity, mut effort) = (self.measured.velocity, self.measured.effort);
        let mut found = 0;
        for (name, [q, qd, torque]) in joints {
            let Some((limb, joint)) = self.place(name) else { continue };
            (posture[limb][joint], velocity[limb][joint]) = (q, qd);
            effort[limb][joint] = torque;
            found += 1;
        }
        // Messages of fingers, and of parts of the robot, do not update the arms.
        let limbs = self.robot.limbs().iter();
        if found < limbs.map(|limb| self.robot.arm(*limb).joint_names.len()).sum::<usize>() {
            return;
        }
        let stamp = Time(state.stamp_ns);
        if stamp > now + CLOCK_SLACK && self.joints_at.is_none() {
            tracing::warn!("joint states are stamped by another clock; their arrival counts");
        }
        for limb in self.robot.limbs().iter().copied() {
            let limits = &self.robot.arm(limb).limits.position;
            self.measured.posture.joints[limb] = on_limits(&posture[limb], limits);
        }
        (self.measured.velocity, self.measured.effort) = (velocity, effort);
        let at = stamp.min(now);
        self.measured.at = Source::Sensors(at);
        self.joints_at = Some(at);
        self.fresh = true;
    }

    /// Limb and joint of a joint's name.
    fn place(&self, name: &str) -> Option<(Limb, usize)> {
        self.robot.limbs().iter().copied().find_map(|limb| {
            let names = &self.robot.arm(limb).joint_names;
            Some((limb, names.iter().position(|own| own == name)?))
        })
    }

    fn find_inhibit(&self, now: Time) -> MotionInhibit {
        let Some((assembly, heard)) = &self.assembly else { return MotionInhibit::Unheard };
        let Some(joints_at) = self.joints_at else { return MotionInhibit::Unheard };
        if assembly.stopped != 0 {
            return MotionInhibit::Stopped;
        }
        if assembly.error != 0 {
            return MotionInhibit::Error;
        }
        if assembly.enabled == 0 {
            return MotionInhibit::Disabled;
        }
        let stale = now.since(joints_at) > Span::from_s(self.settings.stale_s);
        if stale || now.since(*heard) > STALE {
            return MotionInhibit::Stale;
        }
        let used = self.grippers.iter().zip(self.used).filter(|(_, used)| *used);
        match used.map(|(gripper, _)| gripper.condition(now)).max() {
            None | Some(Condition::Ready) => MotionInhibit::None,
            Some(Condition::Uncalibrated) => MotionInhibit::Calibrating,
            Some(Condition::Faulty) => MotionInhibit::Gripper,
            Some(Condition::Stale) => MotionInhibit::Stale,
            Some(Condition::Unheard) => MotionInhibit::Unheard,
        }
    }

    /// Returns whether the robot accepts commands.
    fn accepts_commands(&self) -> bool {
        use MotionInhibit::{Calibrating, Gripper, None, Stale};
        matches!(self.inhibit, None | Stale | Gripper | Calibrating)
    }

    fn measured_of(&self, limb: Limb) -> Joints {
        self.measured.posture.joints[limb]
    }

    /// The commands to one limb in this pass.
    fn command_limb(&mut self, limb: Limb, now: Time, orders: &mut Vec<Order<'static>>) {
        let q = self.measured_of(limb);
        let (path, moving) = (self.settings.path_tolerance_rad, self.limbs[limb].command.is_some());
        let set = &mut self.limbs[limb];
        set.moved = moving;
        let hold = set.q.unwrap_or(q);
        // A person moved a limb at rest by its cuff: it stays where it was put.
        let hold =
            if !moving && furthest(&self.robot, limb, &hold, &q).1 > path { q } else { hold };
        set.q = Some(hold);
        if set.sent.is_some_and(|sent| now.since(sent) < COMMAND_EVERY) {
            return;
        }
        set.sent = Some(now);
        let command = set.command.take();
        if let Some(command) = command.filter(|_| self.settings.feed_forward) {
            let point = JointTrajectoryPoint {
                positions: command.q,
                velocities: command.qd,
                accelerations: command.qdd,
                time_from_start_s: command.t_s,
            };
            orders.push(Order::FeedForward(limb.index(), point.into()));
        }
        let names = &self.robot.arm(limb).joint_names;
        let joints: Vec<(&str, f64)> = names.iter().map(String::as_str).zip(hold).collect();
        match JointCommand::new(JointMode::Position, &joints) {
            Ok(message) => orders.push(Order::Joints(limb.index(), message.into())),
            Err(error) => tracing::error!(%error, "a limb cannot be commanded"),
        }
    }

    fn send_ratio(&mut self, now: Time, orders: &mut Vec<Order<'static>>) {
        if self.ratio_sent.is_some_and(|sent| now.since(sent) < RATIO_EVERY) {
            return;
        }
        self.ratio_sent = Some(now);
        let ratio = SpeedRatio { data: self.settings.speed_ratio };
        let limbs = self.robot.limbs().iter();
        orders.extend(limbs.map(|limb| Order::SpeedRatio(limb.index(), ratio)));
    }
}

impl ArmDriver for BaxterDriver {
    fn checkpoint(&self) -> Option<Vec<u8>> {
        let Self { settings: _, robot: _, used: _, measured, joints_at, assembly, .. } = self;
        let Self { grippers, limbs, now, inhibit, ratio_sent, fresh, .. } = self;
        let heard = (measured, joints_at, assembly, grippers);
        postcard::to_stdvec(&(heard, (limbs, now, inhibit, ratio_sent, fresh))).ok()
    }

    fn resume(&mut self, checkpoint: &[u8]) -> Option<()> {
        let (heard, said) = postcard::from_bytes(checkpoint).ok()?;
        (self.measured, self.joints_at, self.assembly, self.grippers) = heard;
        (self.limbs, self.now, self.inhibit, self.ratio_sent, self.fresh) = said;
        Some(())
    }

    fn measured(&self) -> Measured {
        self.measured
    }

    fn command(&mut self, command: &Command, _: f64) {
        if !self.accepts_commands() {
            return;
        }
        let set = &mut self.limbs[command.limb];
        (set.q, set.command) = (Some(command.q), Some(*command));
        self.grippers[command.limb].want(command.fingers, self.now);
    }

    fn on_report(&mut self, report: &Report<'_>, now: Time) {
        match report {
            Report::Joints(state) => self.on_joints(state, now),
            Report::Assembly(state) => self.assembly = Some((*state, now)),
            Report::Gripper(limb, state) => {
                let gripper = &mut self.grippers[*limb];
                gripper.on_state(state, now);
                if let Some(width_m) = gripper.width_m() {
                    self.measured.posture.width_m[*limb] = width_m;
                }
            }
            Report::Properties(limb, properties) => {
                self.grippers[*limb].on_properties(properties);
            }
            // The chain of the joints says the same.
            Report::Endpoint(..) | Report::Own(_) => {}
        }
    }

    fn begin_pass(&mut self, now: Time, may_calibrate: [bool; 2]) {
        (self.now, self.fresh) = (now, false);
        self.inhibit = self.find_inhibit(now);
        self.measured.holding = std::array::from_fn(|i| self.grippers[i].holding(now));
        if !self.accepts_commands() {
            self.hold_here();
            self.grippers.iter_mut().for_each(Gripper::forget);
            return;
        }
        for (i, gripper) in self.grippers.iter_mut().enumerate() {
            let uncalibrated = gripper.condition(now) == Condition::Uncalibrated;
            if self.used[i] && may_calibrate[i] && uncalibrated {
                gripper.calibrate(now);
            }
        }
    }

    fn end_pass(&mut self, now: Time) -> Vec<Order<'static>> {
        let mut orders = Vec::new();
        if !self.accepts_commands() {
            return orders;
        }
        self.send_ratio(now, &mut orders);
        for limb in self.robot.limbs().iter().copied() {
            self.command_limb(limb, now, &mut orders);
        }
        for limb in self.robot.limbs().iter().copied() {
            let due = self.grippers[limb].due(now);
            orders.extend(due.map(|message| Order::Gripper(limb.index(), message.into())));
        }
        orders
    }

    fn inhibit(&self) -> MotionInhibit {
        self.inhibit
    }

    fn remedy_for_silence(&self) -> &'static str {
        "start the robot's bridge, or the simulated robot (profile baxter); with one gripper only, set arm.limb"
    }

    fn fault(&self) -> Option<Fault> {
        self.robot.limbs().iter().copied().find_map(|limb| {
            let set = &self.limbs[limb];
            let (joint, error_rad) = furthest(&self.robot, limb, &set.q?, &self.measured_of(limb));
            let tolerance_rad = self.settings.path_tolerance_rad;
            let left = set.moved && error_rad > tolerance_rad;
            let setting = "arm.baxter.path_tolerance_rad";
            left.then(|| Fault::Path { joint: joint.to_owned(), error_rad, tolerance_rad, setting })
        })
    }

    fn has_arrived(&mut self, command: &Command, late_s: f64) -> Result<bool, Fault> {
        let limb = command.limb;
        let (joint, error_rad) = furthest(&self.robot, limb, &command.q, &self.measured_of(limb));
        let tolerance_rad = self.settings.goal_tolerance_rad;
        let velocity = &self.measured.velocity[limb];
        let still = velocity.iter().all(|v| v.abs() < self.settings.still_rad_s);
        // Once it has arrived only the fingers are waited for: noise takes nothing back.
        let there =
            error_rad <= tolerance_rad && still || self.limbs[limb].arrived == Some(command.q);
        self.limbs[limb].arrived = there.then_some(command.q);
        if !there && late_s > self.settings.goal_time_s {
            let settings = "arm.baxter.goal_tolerance_rad, goal_time_s";
            let joint = joint.to_owned();
            return Err(Fault::Goal { joint, error_rad, tolerance_rad, late_s, settings });
        }
        let gripper = &self.grippers[limb];
        let done = command.fingers == Fingers::Stay || gripper.has_settled(self.now);
        if there && !done && late_s > FINGERS_MAX_S {
            return Err(Fault::Fingers { limb, late_s });
        }
        Ok(there && done)
    }

    fn is_still(&self) -> bool {
        let joints = self.measured.velocity.iter().flatten();
        let fingers = self.grippers.iter().any(Gripper::is_moving);
        joints.into_iter().all(|v| v.abs() < self.settings.still_rad_s) && !fingers
    }

    fn hold_here(&mut self) {
        for set in &mut self.limbs {
            (set.q, set.command, set.moved) = (None, None, false);
        }
    }

    fn is_fresh(&self) -> bool {
        self.fresh
    }

    fn beat(&self) -> Option<Span> {
        Some(BEAT)
    }
}

/// Returns the posture with joints on their limits that are measured a little beyond them.
fn on_limits(q: &Joints, limits: &PositionLimits) -> Joints {
    let clamped = limits.clamp(q);
    std::array::from_fn(|j| {
        if (clamped[j] - q[j]).abs() <= LIMIT_SLACK_RAD { clamped[j] } else { q[j] }
    })
}
