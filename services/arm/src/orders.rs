//! What the arm is told: acts of the policy, and the motion stop.

use crate::state::Cause;
use crate::{ArmNode, Fx};
use messages::pick::{Order, Pick, judge};
use messages::{
    ActId, ActKind, MotionCommand, MotionOrder, PickId, PickOutcome, PickPhase, RobotAct,
};
use scene::{ObjectId, Question};
use service::Time;

/// What matters of the policy's latest act.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StandingAct {
    pub(crate) id: ActId,
    /// The object that it asks about by pointing.
    pub(crate) aim: Option<ObjectId>,
}

impl ArmNode {
    /// Takes the policy's act, which is sent again and again while it stands.
    pub(crate) fn hear(&mut self, act: &RobotAct, now: Time, fx: &mut Fx) {
        let id = ActId(act.act);
        // Objects have numbers of their own in each scene. The act comes again, and counts once the
        // arm has been restarted with that scene.
        if id < self.act.id || act.scene_key != self.config.scene.key() {
            return;
        }
        let is_new = id != self.act.id;
        let (Ok(kind), Ok(question)) = (act.kind(), Question::try_from(act.question)) else {
            if is_new {
                tracing::warn!(%id, "an act that makes no sense is ignored");
            }
            self.act = StandingAct { id, aim: None };
            return;
        };
        let aim = match (kind, question) {
            (ActKind::Ask, Question::Point(object)) => Some(object),
            _ => None,
        };
        if is_new {
            self.setbacks.forget_aim(self.act.aim, aim);
            self.urgent = true;
        }
        self.act = StandingAct { id, aim };
        match (kind, u16::try_from(act.object).map(ObjectId)) {
            (ActKind::Pick, Ok(object)) => self.order(act.pick_id(), object, is_new, now, fx),
            (ActKind::Cancel, Ok(object)) => self.cancel(act.pick_id(), object, now, fx),
            _ => {}
        }
    }

    fn order(&mut self, id: PickId, object: ObjectId, is_new: bool, now: Time, fx: &mut Fx) {
        match judge(self.state.pick.as_ref(), id, object) {
            Order::Accept => {
                self.take_on(id, object, (PickPhase::Accepted, PickOutcome::Pending));
                tracing::info!(?id, object = object.0, "pick accepted");
                self.record(Cause::Ordered, now, fx);
            }
            Order::Conflict if is_new => {
                tracing::error!(?id, object = object.0, "the pick is known with another object");
            }
            Order::Conflict | Order::Known | Order::Busy | Order::Obsolete => {}
        }
    }

    /// Gives the pick up, unless the gripper closes on the object already: then it is delivered.
    fn cancel(&mut self, id: PickId, object: ObjectId, now: Time, fx: &mut Fx) {
        match judge(self.state.pick.as_ref(), id, object) {
            Order::Known => {
                let phase = self.state.open_pick().map(|pick| pick.phase);
                if matches!(phase, Some(PickPhase::Accepted | PickPhase::Moving)) {
                    self.end(PickOutcome::Cancelled, now, fx);
                }
            }
            // The order itself never came through. It must not be obeyed when it does.
            Order::Accept => {
                self.take_on(id, object, (PickPhase::Done, PickOutcome::Cancelled));
                tracing::info!(?id, "pick given up before it was known");
                self.record(Cause::Ordered, now, fx);
            }
            Order::Busy | Order::Obsolete | Order::Conflict => {}
        }
    }

    fn take_on(
        &mut self,
        id: PickId,
        object: ObjectId,
        (phase, outcome): (PickPhase, PickOutcome),
    ) {
        self.person_has_looked();
        self.state.pick = Some(Pick { id, object, phase, outcome });
        (self.state.limb, self.state.misses) = (None, 0);
        self.urgent = true;
    }

    /// Obeys the motion stop, and its release.
    pub(crate) fn obey(&mut self, command: &MotionCommand, now: Time, fx: &mut Fx) {
        let given = Time(command.given_ns);
        let order = command.order.get();
        if given <= self.state.obeyed {
            return;
        }
        if order == MotionOrder::Resume && given > now {
            tracing::warn!("a release of the motion stop from the future is ignored");
            return;
        }
        // A time in the future would outrank every honest order that follows.
        self.state.obeyed = given.min(now);
        self.state.stopped = order == MotionOrder::Stop;
        match order {
            MotionOrder::Stop => self.executor.halt(),
            MotionOrder::Resume => self.person_has_looked(),
        }
        tracing::info!(?order, "motion order obeyed");
        self.urgent = true;
        self.record(Cause::Motion(order), now, fx);
    }

    /// A person has looked at what was interrupted, and has taken what the gripper held.
    fn person_has_looked(&mut self) {
        if !std::mem::take(&mut self.state.waits_for_person) {
            return;
        }
        if let Some(held) = self.state.held.take() {
            self.state.gone.push(held.object);
        }
    }
}
