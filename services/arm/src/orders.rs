//! Orders to the arm: acts of the policy, and the motion stop.

use crate::state::Cause;
use crate::{ArmNode, Fx};
use manipulation::Limb;
use messages::pick::{Order, Pick, judge};
use messages::{
    ActId, ActKind, MotionOrder, MotionPhase, PickId, PickOutcome, PickPhase, RobotAct, StopId,
    Task,
};
use scene::ObjectId;
use service::Time;
use service::stop_socket::{RELEASE_PATIENCE, RESUME_AFTER, StopOrder};

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
        if let Err(error) = act.judge() {
            return tracing::warn!(%id, %error, "act rejected");
        }
        let is_new = id != self.act.id;
        let aim = act.pointed_at();
        if is_new {
            self.plan_failures.forget_aim(self.act.aim, aim);
            self.urgent = true;
        }
        self.act = StandingAct { id, aim };
        match (act.kind.get(), u16::try_from(act.object).map(ObjectId)) {
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
                let keeps = self.state.keeps(object);
                let accepted = (PickPhase::Accepted, PickOutcome::Pending);
                let progress = self.beginning(object, PickPhase::Holding, accepted);
                self.take_on((id, object, task), progress);
                // Whoever asks for it to be put back has it, whatever a simulated world restocks.
                if task == Task::PutBack && !keeps && !self.state.gone.contains(&object) {
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

    /// Cancels the pick. An object that the gripper holds, or closes on, goes back to its place first.
    fn cancel(&mut self, id: PickId, object: ObjectId, now: Time, fx: &mut Fx) {
        match judge(self.state.pick.as_ref(), id, object, None) {
            Order::Known => {
                let phase = self.state.open_pick().map(|pick| pick.phase);
                match phase {
                    Some(PickPhase::Accepted | PickPhase::Moving) => {
                        self.end(PickOutcome::Cancelled, now, fx);
                    }
                    Some(PickPhase::Closing | PickPhase::Holding) => self.turn_back(now, fx),
                    _ => {}
                }
            }
            // The order itself has not arrived yet, and must be ignored when it does; or the arm is to
            // try once more to put back what the gripper has kept.
            Order::Accept => {
                let cancelled = (PickPhase::Done, PickOutcome::Cancelled);
                let progress = self.beginning(object, PickPhase::Returning, cancelled);
                self.take_on((id, object, Task::Fetch), progress);
                tracing::info!(%id, "pick cancelled before its order arrived");
                self.record(Cause::Ordered, now, fx);
            }
            Order::Busy | Order::Obsolete | Order::Conflict => {}
        }
    }

    /// Carries the held object back to its place, unless the gripper has begun to let go of it where it
    /// hands it over: the user may have it already. One that is put back goes there anyway.
    fn turn_back(&mut self, now: Time, fx: &mut Fx) {
        let (Some(pick), Some(limb)) = (self.state.open_pick().copied(), self.state.limb) else {
            return;
        };
        if pick.ends_at_place() || self.state.is_letting_go() {
            return;
        }
        if pick.phase == PickPhase::Closing {
            if !self.may_hold(limb) {
                return self.end(PickOutcome::Cancelled, now, fx);
            }
            // The fingers open where they are.
            self.state.held = self.world.grasped(pick.object, limb, &self.driver.measured());
        }
        self.executor.halt();
        self.enter(PickPhase::Returning, limb, now, fx);
    }

    /// Returns whether the fingers may hold an object, or close on it.
    fn may_hold(&self, limb: Limb) -> bool {
        let step = self.executor.program().and_then(|program| program.steps.front());
        let closes = step.is_some_and(|step| step.kind == MotionPhase::Close);
        closes || self.driver.measured().holds(limb) != Some(false)
    }

    /// Returns how an order begins: `held` if the gripper has kept its object, else as given. While it
    /// keeps another one, a person must look: the fingers would drop that.
    fn beginning(
        &self,
        object: ObjectId,
        held: PickPhase,
        otherwise: (PickPhase, PickOutcome),
    ) -> (PickPhase, PickOutcome) {
        match self.state.kept() {
            None => otherwise,
            Some(_) if self.state.keeps(object) => (held, PickOutcome::Pending),
            Some(_) => (PickPhase::Done, PickOutcome::Interrupted),
        }
    }

    fn take_on(
        &mut self,
        (id, object, task): (PickId, ObjectId, Task),
        (phase, outcome): (PickPhase, PickOutcome),
    ) {
        self.acknowledge_interruption();
        self.state.limb = self.state.kept().filter(|held| held.object == object).map(|it| it.limb);
        self.state.pick = Some(Pick { id, object, task, phase, outcome });
        self.state.misses = 0;
        self.state.waits_for_person = outcome == PickOutcome::Interrupted;
        self.urgent = true;
    }

    /// Handles the motion stop and its release.
    pub(crate) fn on_stop_order(&mut self, order: &StopOrder, now: Time, fx: &mut Fx) {
        let (order, given, stop) = (order.order, Time(order.given_ns), order.stop);
        if given <= self.state.obeyed {
            return;
        }
        if order == MotionOrder::Resume && given > now {
            tracing::warn!("motion stop release with a future timestamp ignored");
            return;
        }
        // Its giver has given it up; it has waited here, in a queue that was not read.
        if order == MotionOrder::Resume && now.since(given) > RELEASE_PATIENCE && given > Time(0) {
            tracing::warn!("motion stop release ignored: too old");
            return;
        }
        // Its giver has not seen the stop in force.
        if order == MotionOrder::Resume && stop > StopId(0) && stop != self.state.stop() {
            tracing::warn!("release of the motion stop ignored: meant for another stop");
            return;
        }
        // Where the stop is of an earlier boot, its time is not known, and long ago.
        let stopped_at = Some(self.state.obeyed).filter(|at| self.state.stopped && *at > Time(0));
        if order == MotionOrder::Resume && stopped_at.is_some_and(|at| given < at + RESUME_AFTER) {
            tracing::warn!("release of the motion stop ignored: too soon after the stop");
            return;
        }
        // A time in the future would outrank every later order.
        self.state.obeyed = given.min(now);
        self.state.stopped = order == MotionOrder::Stop;
        match order {
            MotionOrder::Stop => self.stop_motion(),
            MotionOrder::Resume => self.acknowledge_interruption(),
        }
        tracing::info!(?order, "motion order applied");
        self.urgent = true;
        self.record(Cause::Motion(order), now, fx);
    }

    fn stop_motion(&mut self) {
        if self.driver.stop() {
            self.executor.stand();
        } else {
            self.executor.halt();
        }
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
