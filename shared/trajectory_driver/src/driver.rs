//! The driver keeps the newest report of the bridge and returns the arm's standing order. It is as pure as the arm
//! itself: time comes with each call, messages go out with the pass.

mod sequence;

use arm_driver::{ArmDriver, Command, Fault, Fingers, Measured, Source, Start, furthest};
use manipulation::{Joints, Limb, Robot, Trajectory};
use messages::MotionInhibit;
use messages::robot::{Order, Report};
use serde::{Deserialize, Serialize};
use service::{Span, Time};

use crate::fingers::FingerState;
use crate::{ArmOrder, Condition, ControllerReport, Controllers, Ending, Motion, ORDER_EVERY_MS};
use sequence::{Next, Sequence};

/// Longest time between two passes.
const BEAT: Span = Span::from_ms(20);
/// Timeout of a finger command, seconds.
const FINGERS_MAX_S: f64 = 8.0;

/// The driver.
#[derive(Clone, Debug)]
pub struct TrajectoryDriver {
    settings: Controllers,
    robot: Robot,
    limb: Limb,
    measured: Measured,
    state: DriverState,
}

/// What changes.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct DriverState {
    report: ControllerReport,
    fingers: FingerState,
    /// The motion whose windows are being sent.
    sequence: Option<Sequence>,
    /// The stop that the joints have not followed yet, since when.
    stopping: Option<(u64, Time)>,
    /// Number of the latest window or stop.
    number: u64,
    /// Windows up to this one are void: their ends say nothing.
    void: u64,
    /// The latest order, and when it was sent.
    sent: Option<(Motion, Time)>,
    now: Time,
    inhibit: MotionInhibit,
    fresh: bool,
}

impl TrajectoryDriver {
    /// Returns a driver before the first report: until then the posture is the one that the journal remembers.
    pub fn new(settings: Controllers, start: &Start<'_>) -> Self {
        let Start { robot, limb, posture, .. } = *start;
        let limb = limb.unwrap_or(robot.limbs()[0]);
        let measured = Measured::remembered(posture, 2.0 * settings.goal_tolerance_rad);
        let state = DriverState {
            report: ControllerReport::default(),
            fingers: FingerState::new(&robot.arm(limb).gripper),
            sequence: None,
            stopping: None,
            number: 0,
            void: 0,
            sent: None,
            now: Time(0),
            inhibit: MotionInhibit::Unheard,
            fresh: false,
        };
        Self { settings, robot: robot.clone(), limb, measured, state }
    }

    fn q(&self) -> &Joints {
        &self.measured.posture.joints[self.limb]
    }

    fn joints(&self) -> usize {
        self.robot.arm(self.limb).joint_names.len()
    }

    fn next_number(&mut self) -> u64 {
        // A number that a process before this one cannot have used.
        self.state.number = (self.state.number + 1).max(self.state.now.ns() / 1_000_000);
        self.state.number
    }

    fn take(&mut self, report: ControllerReport) {
        let limb = self.limb;
        if let Some(joints) = report.joints.as_ref().filter(|it| it.q.len() == self.joints()) {
            let own = |values: &[f64], before: &Joints| -> Joints {
                std::array::from_fn(|j| values.get(j).copied().unwrap_or(before[j]))
            };
            let Measured { posture, velocity, effort, .. } = &mut self.measured;
            posture.joints[limb] = own(&joints.q, &posture.joints[limb]);
            velocity[limb] = own(&joints.qd, &[0.0; 7]);
            effort[limb] = own(&joints.effort, &[0.0; 7]);
            let at = Source::Sensors(Time(joints.at_ns));
            self.state.fresh |= self.measured.at != at;
            self.measured.at = at;
        }
        let position = report.joints.as_ref().and_then(|joints| joints.fingers);
        let gripper = &self.settings.gripper;
        if let Some(width_m) = self.state.fingers.on_report(report.fingers, position, gripper) {
            self.measured.posture.width_m[limb] = width_m;
        }
        if report.condition != self.state.report.condition {
            log(report.condition);
        }
        if let Some(sequence) = &mut self.state.sequence {
            sequence.on_accepted(report.accepted);
        }
        if let Some((number, _)) = self.state.stopping
            && report.stopped >= number
        {
            self.state.stopping = None;
        }
        self.state.report = report;
    }

    fn joints_are_fresh(&self) -> bool {
        let Source::Sensors(at) = self.measured.at else { return false };
        self.state.now.since(at) <= Span::from_s(self.settings.stale_s)
    }

    fn find_inhibit(&self) -> MotionInhibit {
        match self.state.report.condition {
            _ if self.measured.at == Source::Memory => MotionInhibit::Unheard,
            Condition::Unheard => MotionInhibit::Unheard,
            Condition::Silent => MotionInhibit::Stale,
            Condition::Foreign => MotionInhibit::Error,
            Condition::NoGripper => MotionInhibit::Gripper,
            Condition::Ready if !self.joints_are_fresh() => MotionInhibit::Stale,
            // Its windows have run out: the arm has come to rest where none of its plans begins.
            Condition::Ready if self.state.sequence.as_ref().is_some_and(Sequence::is_lost) => {
                MotionInhibit::Stale
            }
            Condition::Ready => MotionInhibit::None,
        }
    }

    /// Begins a stop by the bridge, unless one is under way.
    fn begin_stop(&mut self) {
        let number = match self.state.stopping {
            Some((number, _)) => number,
            None => self.next_number(),
        };
        self.state.stopping = Some((number, self.state.now));
        self.abandon();
    }

    /// Gives up the motion and the fingers' command: their ends say nothing any more.
    fn abandon(&mut self) {
        let state = &mut self.state;
        (state.sequence, state.void) = (None, state.number);
        state.fingers.forget(state.now);
    }

    /// The latest end that counts for the motion under way.
    fn ending(&self) -> Option<(u64, Ending)> {
        self.state.report.ended.filter(|(number, _)| *number > self.state.void)
    }

    fn velocity_is_low(&self) -> bool {
        let velocity = &self.measured.velocity[self.limb];
        velocity.iter().all(|v| v.abs() < self.settings.still_rad_s)
    }

    fn begins_here(&self, motion: &Trajectory) -> bool {
        let (_, off) = furthest(&self.robot, self.limb, &motion.start(), self.q());
        off <= 4.0 * self.settings.goal_tolerance_rad
    }

    /// Returns whether the controller has ended the motion's last window as it should.
    fn is_confirmed(&self) -> bool {
        match &self.state.sequence {
            None => true,
            Some(sequence) => {
                sequence.is_complete()
                    && self.ending() == Some((sequence.number(), Ending::Succeeded))
            }
        }
    }
}

impl ArmDriver for TrajectoryDriver {
    fn checkpoint(&self) -> Option<Vec<u8>> {
        postcard::to_stdvec(&(&self.measured, &self.state)).ok()
    }

    fn resume(&mut self, checkpoint: &[u8]) -> Option<()> {
        (self.measured, self.state) = postcard::from_bytes(checkpoint).ok()?;
        Some(())
    }

    fn measured(&self) -> Measured {
        self.measured
    }

    fn command(&mut self, command: &Command, _: f64) {
        if self.state.inhibit != MotionInhibit::None || self.state.stopping.is_some() {
            return;
        }
        if command.limb == self.limb {
            self.state.fingers.want(command.fingers, &self.settings.gripper, self.state.now);
        }
    }

    fn look_ahead(&mut self, limb: Limb, motion: &Trajectory, t_s: f64) {
        let is_barred = self.state.inhibit != MotionInhibit::None || self.state.stopping.is_some();
        if is_barred || limb != self.limb {
            return;
        }
        let (now, joints) = (self.state.now, self.joints());
        let begins = Sequence::may_begin(motion, t_s) && self.begins_here(motion);
        let next = match &mut self.state.sequence {
            Some(sequence) => sequence.next(motion, t_s, now),
            None if begins => Next::Window(0.0),
            None => return,
        };
        let Next::Window(ahead_s) = next else { return };
        let number = self.next_number();
        match &mut self.state.sequence {
            Some(sequence) => sequence.send(motion, (t_s, ahead_s), (number, now), joints),
            None => {
                self.state.void = number - 1;
                self.state.sequence = Some(Sequence::begin(motion, t_s, (number, now), joints));
            }
        }
    }

    fn stop(&mut self) -> bool {
        self.begin_stop();
        true
    }

    fn on_report(&mut self, report: &Report<'_>, now: Time) {
        let Report::Own(bytes) = report else { return };
        self.state.now = self.state.now.max(now);
        match postcard::from_bytes(bytes) {
            Ok(report) => self.take(report),
            Err(error) => tracing::warn!(%error, "invalid report of the bridge ignored"),
        }
    }

    fn begin_pass(&mut self, now: Time, _: [bool; 2]) {
        (self.state.now, self.state.fresh) = (now, false);
        self.state.inhibit = self.find_inhibit();
        self.measured.holding[self.limb] = self.state.fingers.holding(now);
        if self.state.inhibit != MotionInhibit::None && self.state.sequence.is_some() {
            self.begin_stop();
        }
    }

    fn end_pass(&mut self, now: Time) -> Vec<Order<'static>> {
        let motion = match (&self.state.stopping, &self.state.sequence) {
            (Some((number, _)), _) => Motion::Stop(*number),
            (None, Some(sequence)) => Motion::Follow(sequence.window().clone()),
            (None, None) => Motion::Rest,
        };
        let every = Span::from_ms(ORDER_EVERY_MS / 2);
        let is_due = |(before, at): &(Motion, Time)| *before != motion || now.since(*at) >= every;
        if !self.state.sent.as_ref().is_none_or(is_due) {
            return Vec::new();
        }
        self.state.sent = Some((motion.clone(), now));
        let fingers = self.state.fingers.order();
        let order = ArmOrder { at_ns: now.ns(), motion, fingers };
        postcard::to_stdvec(&order).into_iter().map(Order::Own).collect()
    }

    fn inhibit(&self) -> MotionInhibit {
        self.state.inhibit
    }

    fn remedy_for_silence(&self) -> &'static str {
        "start the controllers and their joint states; the log of the service trajectory names what is missing"
    }

    fn fault(&self) -> Option<Fault> {
        let limb = self.limb;
        let sequence = self.state.sequence.as_ref()?;
        let why =
            self.ending().and_then(|(number, ending)| why(ending, number == sequence.number()));
        if let Some(why) = why {
            return Some(Fault::Controller { limb, why });
        }
        let Source::Sensors(at) = self.measured.at else { return None };
        let mut expected = self.measured.posture.joints[limb];
        expected.iter_mut().zip(sequence.expected(at)?).for_each(|(own, q)| *own = q);
        let (joint, error_rad) = furthest(&self.robot, limb, &expected, self.q());
        let tolerance_rad = self.settings.path_tolerance_rad;
        let setting = "arm.trajectory.path_tolerance_rad";
        (error_rad > tolerance_rad).then(|| Fault::Path {
            joint: joint.to_owned(),
            error_rad,
            tolerance_rad,
            setting,
        })
    }

    fn has_arrived(&mut self, command: &Command, late_s: f64) -> Result<bool, Fault> {
        let limb = command.limb;
        let here = self.measured.posture.joints[limb];
        let (joint, error_rad) = furthest(&self.robot, limb, &command.q, &here);
        let tolerance_rad = self.settings.goal_tolerance_rad;
        let measured_there = error_rad <= tolerance_rad && self.velocity_is_low();
        let there = measured_there && self.is_confirmed();
        if there {
            self.state.sequence = None;
        } else if late_s > self.settings.goal_time_s && measured_there {
            let why = "has not reported the end of a motion; help: look at its log";
            return Err(Fault::Controller { limb, why });
        } else if late_s > self.settings.goal_time_s {
            let settings = "arm.trajectory.goal_tolerance_rad, goal_time_s";
            let joint = joint.to_owned();
            return Err(Fault::Goal { joint, error_rad, tolerance_rad, late_s, settings });
        }
        if command.fingers == Fingers::Stay {
            return Ok(there);
        }
        let Ok(done) = self.state.fingers.has_settled(&self.settings.gripper) else {
            let why = "has a gripper that did not carry out its command; help: look at its log";
            return Err(Fault::Controller { limb, why });
        };
        if there && !done && late_s > FINGERS_MAX_S {
            return Err(Fault::Fingers { limb, late_s });
        }
        Ok(there && done)
    }

    /// By joint states alone, whatever the controller has answered.
    fn is_still(&self) -> bool {
        self.state.stopping.is_none()
            && self.joints_are_fresh()
            && self.velocity_is_low()
            && !self.state.fingers.is_moving(self.state.now)
    }

    fn hold_here(&mut self) {
        self.begin_stop();
    }

    fn is_fresh(&self) -> bool {
        self.state.fresh
    }

    fn beat(&self) -> Option<Span> {
        Some(BEAT)
    }
}

/// The reason why a motion is given up, if this end is one. The ends of windows that newer ones have replaced say
/// nothing: the bridge reports none of them but a violated tolerance.
fn why(ending: Ending, is_newest: bool) -> Option<&'static str> {
    match ending {
        Ending::Succeeded => None,
        Ending::Aborted(-4) => {
            Some("aborted a motion: a joint left its path (PATH_TOLERANCE_VIOLATED)")
        }
        Ending::Aborted(-5) => Some(
            "aborted a motion: a joint did not reach its goal in time (GOAL_TOLERANCE_VIOLATED)",
        ),
        _ if !is_newest => None,
        Ending::Refused => Some(
            "refused a motion; help: is it active, and are the joints those of arm.trajectory.joints? Its log says more",
        ),
        Ending::Cancelled => Some("ended a motion that another client has cancelled or replaced"),
        Ending::Aborted(_) => Some(
            "aborted a motion: another client has replaced it, or the controller was deactivated",
        ),
    }
}

fn log(condition: Condition) {
    match condition {
        Condition::Ready => tracing::info!("the controllers answer"),
        Condition::Unheard => tracing::warn!("the controllers have not answered yet"),
        Condition::Silent => tracing::warn!(
            "the arm's controller does not answer any more, or the bridge has stopped the arm; its log says which"
        ),
        Condition::NoGripper => tracing::warn!("the gripper's controller does not answer"),
        Condition::Foreign => tracing::warn!(
            "another client moves the arm; help: end its goal, which the bridge's log names"
        ),
    }
}
