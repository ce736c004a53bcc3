//! Publication of joints, world and status, and its rates.

use crate::executor::{Executor, Purpose};
use crate::state::ArmState;
use crate::world::World;
use crate::{Fx, Out};
use arm_driver::{Measured, Source};
use manipulation::gripper::Gripper;
use manipulation::{JOINTS, Limb, Robot};
use messages::WireCode;
use messages::{ActId, ArmStatus, JOINT_STATE_LEN, JOINT_STATE_NAMES, JointStates, MotionInhibit};
use serde::{Deserialize, Serialize};
use service::{Span, Time};

/// Interval of an unchanged status. That of a standing arm waits for the next joint states, so that both wake it once.
const STATUS_EVERY: Span = Span::from_ms(250);
/// Shortest interval of the joint states of an arm at rest, which repeat themselves.
const REST_EVERY: Span = Span::from_ms(100);
/// Interval of the world view while the arm moves, and while it stands.
const WORLD_EVERY: (Span, Span) = (Span::from_ms(100), Span::from_ms(1_000));

/// Publishes joints, world and status when they are due.
pub(crate) struct Publisher {
    /// Limb and joint of each entry of a joint state; none for the head and the torso, which stay.
    sources: [Option<(Limb, usize)>; JOINT_STATE_LEN],
    grippers: [Gripper; 2],
    /// Simulated seconds per second.
    time_scale: f64,
    /// Period of a model's joint states while it is busy; sensors have their own.
    joints_every: Span,
    pub(crate) published: Published,
}

/// What was published last, and when the next is due.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Published {
    /// When a model's joint states were due last.
    joints_were_due: Time,
    /// Whether the joint states published last are those of an arm at rest.
    shows_rest: bool,
    /// Sensor time of the joints published last.
    joints_at: Time,
    world_sent: Option<Time>,
    status_due: Time,
    status: ArmStatus,
}

/// Inputs of a publication.
pub(crate) struct Facts<'a> {
    pub(crate) state: &'a ArmState,
    pub(crate) measured: &'a Measured,
    pub(crate) executor: &'a Executor,
    /// Nothing is commanded, and joints and fingers are measured to stand still.
    pub(crate) is_at_rest: bool,
    pub(crate) world: &'a World,
    pub(crate) aimed: Option<ActId>,
    pub(crate) inhibit: MotionInhibit,
}

/// Whether the arm has something to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Activity {
    /// It moves, plans, or has an open pick.
    Busy,
    /// It stands until the next order.
    AtRest,
}

impl Publisher {
    pub(crate) fn new(arm: &config::Arm, robot: &Robot) -> Self {
        Self {
            sources: JOINT_STATE_NAMES.map(source),
            grippers: Limb::BOTH.map(|limb| robot.arm(limb).gripper),
            time_scale: arm.time_scale,
            joints_every: Span::from_s(1.0 / arm.joint_rate_hz),
            published: Published {
                joints_were_due: Time(0),
                shows_rest: false,
                joints_at: Time(0),
                world_sent: None,
                status_due: Time(0),
                status: ArmStatus::default(),
            },
        }
    }

    /// Returns the next publication time of a standing arm, of its joints alone where status and world wait for the disk.
    /// A moving one is stepped more often anyway.
    pub(crate) fn deadline(&self, activity: Activity, only_joints: bool) -> Time {
        let joints_due = self.joints_due(activity);
        // Status and world go out with the joint states, unless these are rare.
        let latest = self.published.status_due + REST_EVERY;
        if only_joints { joints_due } else { joints_due.min(latest) }
    }

    /// Returns when a model's joint states are due. At rest they are rarer, once the rest itself has been
    /// published.
    fn joints_due(&self, activity: Activity) -> Time {
        let rests = activity == Activity::AtRest && self.published.shows_rest;
        let every = if rests { self.joints_every.max(REST_EVERY) } else { self.joints_every };
        self.published.joints_were_due + every
    }

    /// Returns the time of the joint states that are due: a model's periodically, those of sensors when
    /// there are new ones.
    pub(crate) fn due_joints(
        &self,
        measured: &Measured,
        activity: Activity,
        now: Time,
    ) -> Option<Time> {
        match measured.at {
            Source::Model => (now >= self.joints_due(activity)).then_some(now),
            Source::Sensors(at) => (at > self.published.joints_at).then_some(at),
            Source::Memory => None,
        }
    }

    /// Publishes the joint states when they are due: measurements, which wait for no record.
    pub(crate) fn publish_joints(
        &mut self,
        measured: &Measured,
        activity: Activity,
        now: Time,
        fx: &mut Fx,
    ) {
        let at = self.due_joints(measured, activity, now);
        let due = self.joints_due(activity);
        if now >= due {
            // A late one is not caught up with.
            self.published.joints_were_due = if due + self.joints_every > now { due } else { now };
            self.published.shows_rest = activity == Activity::AtRest;
        }
        if let Some(at) = at {
            self.published.joints_at = at;
            fx.publish_urgent(Out::Joints(Box::new(self.joint_states(measured, at))));
        }
    }

    /// Has the joint states published in this pass: the last ones show the rest.
    pub(crate) fn hurry_joints(&mut self) {
        self.published.joints_were_due = Time(0);
    }

    /// Publishes world and status when they are due.
    pub(crate) fn tick(&mut self, facts: &Facts<'_>, now: Time, fx: &mut Fx) {
        let (moving, standing) = WORLD_EVERY;
        let world_every = if facts.executor.is_standing() { standing } else { moving };
        if self.published.world_sent.is_none_or(|sent| now >= sent + world_every) {
            self.send_world(facts, now, fx);
        }
        self.publish_status(facts, now, fx);
    }

    /// Publishes the status when changed or due, and the world when the held object has changed.
    pub(crate) fn publish_status(&mut self, facts: &Facts<'_>, now: Time, fx: &mut Fx) {
        let status = self.status(facts);
        let changed = ArmStatus { remaining_s: self.published.status.remaining_s, ..status }
            != self.published.status;
        if changed && status.phase != self.published.status.phase {
            self.send_world(facts, now, fx);
        }
        if changed || now >= self.published.status_due {
            self.published.status = status;
            self.published.status_due = now + STATUS_EVERY;
            fx.publish(Out::Status(status));
        }
    }

    fn send_world(&mut self, facts: &Facts<'_>, now: Time, fx: &mut Fx) {
        self.published.world_sent = Some(now);
        let view = facts.world.view(facts.state, facts.measured, now);
        fx.publish(Out::World(Box::new(view)));
    }

    fn status(&self, facts: &Facts<'_>) -> ArmStatus {
        let Facts { state, executor, .. } = facts;
        let fetching = matches!(executor.purpose(), Some(Purpose::Pick(_)));
        let seconds = if fetching { executor.seconds_to_release() } else { 0.0 };
        let status = ArmStatus {
            aimed_act: facts.aimed.map_or(0, |act| act.0),
            stopped: state.stopped.into(),
            moving: (!facts.is_at_rest).into(),
            hindrance: facts.inhibit.code(),
            remaining_s: seconds / self.time_scale,
            stop: state.stop().0,
            ..ArmStatus::default()
        };
        let Some(pick) = &state.pick else { return status };
        ArmStatus {
            interaction: pick.id.interaction.0,
            attempt: pick.id.attempt,
            object: pick.object.0.into(),
            phase: pick.phase.code(),
            outcome: pick.outcome.code(),
            task: pick.task.code(),
            ..status
        }
    }

    fn joint_states(&self, measured: &Measured, at: Time) -> JointStates {
        let mut states = JointStates { at_ns: at.ns(), ..JointStates::default() };
        for (entry, source) in self.sources.iter().enumerate() {
            let Some((limb, joint)) = *source else { continue };
            states.position[entry] = measured.posture.joints[limb][joint];
            states.velocity[entry] = measured.velocity[limb][joint] * self.time_scale;
            states.effort[entry] = measured.effort[limb][joint];
        }
        states.gripper_percent =
            Limb::BOTH.map(|limb| self.grippers[limb].percent(measured.posture.width_m[limb]));
        states
    }
}

/// Returns limb and joint of a joint state's name.
fn source(name: &str) -> Option<(Limb, usize)> {
    let (limb, joint) = name.split_once('_')?;
    let joint = JOINTS.iter().position(|own| *own == joint)?;
    Some((Limb::named(limb)?, joint))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joint_states_list_every_joint_of_both_limbs() {
        let sources: Vec<_> = JOINT_STATE_NAMES.into_iter().filter_map(source).collect();
        for limb in Limb::BOTH {
            for joint in 0..JOINTS.len() {
                assert!(sources.contains(&(limb, joint)));
            }
        }
        assert_eq!(source("left_w2"), Some((Limb::Left, 6)));
        assert_eq!(source("right_s0"), Some((Limb::Right, 0)));
        assert_eq!(source("torso_t0"), None);
        assert_eq!(sources.len(), 14);
    }
}
