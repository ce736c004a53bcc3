//! Orders to the arm: acts of the policy, and the motion stop.

use crate::program::Planner;
use crate::state::Cause;
use crate::{ArmNode, Fx};
use messages::pick::{Order, Pick, judge};
use messages::{ActId, ActKind, MotionOrder, PickId, PickOutcome, PickPhase, RobotAct, Task};
use scene::{ObjectId, Question};
use service::Time;
use service::stop_socket::StopOrder;

/// The relevant part of the policy's latest act.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct StandingAct {
    pub(crate) id: ActId,
    /// Object that a pointing question asks about.
    pub(crate) aim: Option<ObjectId>,
}

impl ArmNode {
    /// Handles the policy's act, which is republished while it stands.
    pub(crate) fn on_act(&mut self, act: &RobotAct, now: Time, fx: &mut Fx) {
        let id = ActId(act.act);
        // Object ids differ between scenes. The act is republished and counts once the
        // arm has been restarted with that scene.
        if id < self.act.id || act.scene_key != self.config.scene.key() {
            return;
        }
        let question = match act.judge() {
            Ok((question, _)) => question,
            Err(error) => {
                tracing::warn!(%id, %error, "act rejected");
                return;
            }
        };
        let is_new = id != self.act.id;
        let kind = act.kind.get();
        let aim = match (kind, question) {
            (ActKind::Ask, Question::Point(object)) => Some(object),
            _ => None,
        };
        if is_new {
            self.plan_failures.forget_aim(self.act.aim, aim);
            self.urgent = true;
        }
        self.act = StandingAct { id, aim };
        match (kind, u16::try_from(act.object).map(ObjectId)) {
            (ActKind::Pick, Ok(object)) => {
                self.order((act.pick_id(), object, Task::Fetch), is_new, now, fx);
            }
            (ActKind::PutBack, Ok(object)) => {
                self.order((act.pick_id(), object, Task::PutBack), is_new, now, fx);
            }
            (ActKind::Cancel, Ok(object)) => self.cancel(act.pick_id(), object, now, fx),
            _ => {}
        }
    }

    fn order(
        &mut self,
        (id, object, task): (PickId, ObjectId, Task),
        is_new: bool,
        now: Time,
        fx: &mut Fx,
    ) {
        match judge(self.state.pick.as_ref(), id, object, Some(task)) {
            Order::Accept => {
                let accepted = (PickPhase::Accepted, PickOutcome::Pending);
                self.take_on((id, object, task), accepted);
                // Whoever asks for it to be put back has it, whatever a simulated world restocks.
                if task == Task::PutBack && !self.state.gone.contains(&object) {
                    self.state.gone.push(object);
                }
                tracing::info!(%id, object = object.0, ?task, "pick accepted");
                self.record(Cause::Ordered, now, fx);
            }
            Order::Conflict if is_new => {
                tracing::error!(
                    %id,
                    object = object.0,
                    "pick id already used with another object or task"
                );
            }
            Order::Conflict | Order::Known | Order::Busy | Order::Obsolete => {}
        }
    }

    /// Cancels the pick. An object that the gripper holds goes back to its place first. Where the fingers
    /// still close on it, this follows with the next of the repeated orders.
    fn cancel(&mut self, id: PickId, object: ObjectId, now: Time, fx: &mut Fx) {
        match judge(self.state.pick.as_ref(), id, object, None) {
            Order::Known => {
                let phase = self.state.open_pick().map(|pick| pick.phase);
                match phase {
                    Some(PickPhase::Accepted | PickPhase::Moving) => {
                        self.end(PickOutcome::Cancelled, now, fx);
                    }
                    Some(PickPhase::Holding) => self.turn_back(now, fx),
                    _ => {}
                }
            }
            // The order itself has not arrived yet. It must be ignored when it does.
            Order::Accept => {
                let cancelled = (PickPhase::Done, PickOutcome::Cancelled);
                self.take_on((id, object, Task::Fetch), cancelled);
                tracing::info!(%id, "pick cancelled before its order arrived");
                self.record(Cause::Ordered, now, fx);
            }
            Order::Busy | Order::Obsolete | Order::Conflict => {}
        }
    }

    /// Carries the held object back to its place, unless the gripper is where it hands it over: the user
    /// may have it already. One that is put back goes there anyway.
    fn turn_back(&mut self, now: Time, fx: &mut Fx) {
        let (Some(pick), Some(limb)) = (self.state.open_pick().copied(), self.state.limb) else {
            return;
        };
        let measured = self.driver.measured();
        let planner = Planner::new(&self.config, &self.world, &self.state, &measured);
        if pick.ends_at_place() || planner.is_at_goal(&pick, limb) {
            return;
        }
        self.executor.halt();
        self.enter(PickPhase::Returning, limb, now, fx);
    }

    fn take_on(
        &mut self,
        (id, object, task): (PickId, ObjectId, Task),
        (phase, outcome): (PickPhase, PickOutcome),
    ) {
        self.acknowledge_interruption();
        self.state.pick = Some(Pick { id, object, task, phase, outcome });
        (self.state.limb, self.state.misses) = (None, 0);
        self.urgent = true;
    }

    /// Handles the motion stop and its release.
    pub(crate) fn on_stop_order(&mut self, order: &StopOrder, now: Time, fx: &mut Fx) {
        let (order, given) = (order.order, Time(order.given_ns));
        if given <= self.state.obeyed {
            return;
        }
        if order == MotionOrder::Resume && given > now {
            tracing::warn!("motion stop release with a future timestamp ignored");
            return;
        }
        // A time in the future would outrank every later order.
        self.state.obeyed = given.min(now);
        self.state.stopped = order == MotionOrder::Stop;
        match order {
            MotionOrder::Stop => self.executor.halt(),
            MotionOrder::Resume => self.acknowledge_interruption(),
        }
        tracing::info!(?order, "motion order applied");
        self.urgent = true;
        self.record(Cause::Motion(order), now, fx);
    }

    /// Clears an interruption that a person has handled; what the gripper held was taken out.
    fn acknowledge_interruption(&mut self) {
        if !std::mem::take(&mut self.state.waits_for_person) {
            return;
        }
        if let Some(held) = self.state.held.take() {
            self.state.gone.push(held.object);
        }
    }
}
