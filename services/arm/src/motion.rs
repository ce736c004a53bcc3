//! Progress of the program in time, and of the pick from phase to phase.

use crate::executor::{Progress, Purpose};
use crate::publish::Activity;
use crate::state::{Cause, Offered};
use crate::{ArmNode, Fx};
use arm_driver::Fault;
use manipulation::Limb;
use messages::pick::Pick;
use messages::{MotionPhase, PickOutcome, PickPhase, Task};
use scene::ObjectId;
use service::{Span, Time};

/// Longest time step of a motion. A process that was suspended resumes
/// from the same point, as a robot does whose controller was silent.
const STRETCH_MAX: Span = Span::from_ms(50);
/// Distance from where objects are handed over within which a user may hold one out between the
/// fingers, metres.
const OFFERED_M: f64 = 0.05;
/// Interval between journal records of moving joints.
const PROGRESS_EVERY: Span = Span::from_ms(200);

impl ArmNode {
    /// Returns the simulated seconds since the last step.
    pub(crate) fn passed_s(&mut self, now: Time) -> f64 {
        let passed = now.since(self.stepped).min(STRETCH_MAX);
        self.stepped = now;
        passed.s() * self.config.arm.time_scale
    }

    /// Advances the motion, over as many steps as the time allows, but never into a phase that is
    /// not durable yet.
    pub(crate) fn step(&mut self, mut seconds: f64, now: Time, fx: &mut Fx) {
        loop {
            if self.enters_phase(now, fx) || self.phase_unsynced && self.executor.begins_step() {
                return;
            }
            let purpose = self.executor.purpose();
            match self.executor.advance(seconds, self.driver.as_mut()) {
                Progress::Under => return,
                Progress::Halted => return self.record(Cause::Moved, now, fx),
                Progress::Failed(fault) => return self.block(&fault, now, fx),
                Progress::Ended(kind, left_s) => {
                    self.ended(kind, purpose, now, fx);
                    seconds = left_s;
                }
            }
        }
    }

    /// Records the moving joints at intervals, between two joint states, so that none of them waits
    /// for the disk.
    pub(crate) fn record_progress(&mut self, now: Time, fx: &mut Fx) {
        if self.executor.is_standing() || now < self.recorded + PROGRESS_EVERY {
            return;
        }
        // On a slow or full disk they would only queue.
        if self.unsynced {
            return;
        }
        if self.publisher.due_joints(&self.driver.measured(), Activity::Busy, now).is_some() {
            self.urgent = true;
            return;
        }
        self.record(Cause::Moved, now, fx);
    }

    /// Returns whether the next step begins a phase that must become durable first. If so, it has been
    /// recorded and the step begins in a later tick.
    fn enters_phase(&mut self, now: Time, fx: &mut Fx) -> bool {
        let Some(program) = self.executor.program() else { return false };
        let limb = program.limb;
        let Some(phase) = program.steps.front().and_then(|step| step.phase) else { return false };
        let Some(pick) = self.state.open_pick() else { return false };
        if pick.phase >= phase && self.state.limb == Some(limb) {
            return self.begins_to_let_go(now, fx);
        }
        if phase == PickPhase::Holding {
            self.hold(limb, now, fx);
        } else {
            self.enter(phase, limb, now, fx);
        }
        true
    }

    /// Returns whether the fingers are about to open where the object is handed over. From then on it is
    /// too late to call it off, so that is recorded first.
    fn begins_to_let_go(&mut self, now: Time, fx: &mut Fx) -> bool {
        let step = self.executor.program().and_then(|program| program.steps.front());
        let opens = step.is_some_and(|step| step.kind == MotionPhase::Release);
        let ends_at_place = self.state.open_pick().is_none_or(Pick::ends_at_place);
        if !opens || ends_at_place || self.state.is_letting_go() {
            return false;
        }
        let Some(held) = self.state.held else { return false };
        self.state.offered = Some(self.world.offered(&held, &self.driver.measured()));
        self.urgent = true;
        self.record(Cause::Phase, now, fx);
        true
    }

    /// Handles closed fingers: either they hold the object, or they closed on nothing.
    pub(crate) fn hold(&mut self, limb: Limb, now: Time, fx: &mut Fx) {
        let measured = self.driver.measured();
        let Some(object) = self.state.open_pick().map(|pick| pick.object) else { return };
        // A gripper without a sensor is trusted as long as nothing has interrupted it.
        if measured.holds(limb) == Some(false) {
            return self.miss(now, fx);
        }
        self.state.held = match self.state.to_put_back() {
            None => self.world.grasped(object, limb, &measured),
            // The user gives it back as it was handed over.
            Some(_) => self.state.handed_over(object).copied(),
        };
        self.state.gone.retain(|gone| *gone != object);
        self.enter(PickPhase::Holding, limb, now, fx);
    }

    /// Handles a missed grasp. The gripper goes up and comes down again, as often
    /// as configured; then the pick ends with an empty gripper.
    fn miss(&mut self, now: Time, fx: &mut Fx) {
        self.state.misses += 1;
        let (misses, attempts) = (self.state.misses, self.config.arm.grasp.attempts);
        self.executor.stand();
        if misses < attempts {
            tracing::warn!(misses, attempts, "missed grasp; retrying");
            self.urgent = true;
            return self.record(Cause::Missed, now, fx);
        }
        tracing::error!(misses, "missed grasp; giving up");
        self.end(PickOutcome::Missed, now, fx);
    }

    /// Holds a robot that does not follow its commands until an operator has checked it.
    pub(crate) fn block(&mut self, fault: &Fault, now: Time, fx: &mut Fx) {
        tracing::error!(
            %fault,
            "motion blocked; halting; help: clear the obstacle, then: whichone resume-motion"
        );
        self.executor.stand();
        self.driver.hold_here();
        // Neither the next order nor a part that works again moves it on.
        if matches!(fault, Fault::Part { .. }) {
            self.latch_new_stop(now, fx);
        }
        if self.state.open_pick().is_some() {
            self.end(PickOutcome::Blocked, now, fx);
        } else {
            self.state.waits_for_person = true;
            self.record(Cause::Blocked, now, fx);
        }
    }

    pub(crate) fn enter(&mut self, phase: PickPhase, limb: Limb, now: Time, fx: &mut Fx) {
        let Some(pick) = &mut self.state.pick else { return };
        if pick.phase < phase {
            pick.phase = phase;
        }
        tracing::info!(id = ?pick.id, ?phase, %limb, "pick phase");
        self.state.limb = Some(limb);
        if phase == PickPhase::Moving {
            self.state.offered = None;
        }
        self.urgent = true;
        self.record(Cause::Phase, now, fx);
    }

    /// Ends the open pick.
    pub(crate) fn end(&mut self, outcome: PickOutcome, now: Time, fx: &mut Fx) {
        let Some(pick) = &mut self.state.pick else { return };
        let was = std::mem::replace(pick, Pick { phase: PickPhase::Done, outcome, ..*pick });
        tracing::info!(id = ?pick.id, object = pick.object.0, ?outcome, "pick ended");
        let asks_for_person = [PickOutcome::Interrupted, PickOutcome::Blocked];
        self.state.waits_for_person = asks_for_person.contains(&outcome);
        if was.task == Task::PutBack && outcome != PickOutcome::PutBack {
            self.state.offered = self.put_between_fingers(was.object);
        }
        self.urgent = true;
        self.record(Cause::Ended, now, fx);
    }

    /// Returns the object that was to be taken from the user, where it is between the fingers already:
    /// `None` if the gripper is elsewhere.
    fn put_between_fingers(&self, object: ObjectId) -> Option<Offered> {
        let (held, measured) = (self.state.handed_over(object)?, self.driver.measured());
        let tip = self.world.gripper(held.limb, &measured).translation.vector;
        let is_there = self.config.setup.plan.is_hand_over(held.limb, &tip, OFFERED_M);
        is_there.then(|| self.world.offered(held, &measured))
    }

    fn ended(&mut self, kind: MotionPhase, purpose: Option<Purpose>, now: Time, fx: &mut Fx) {
        match (kind, purpose) {
            (MotionPhase::Release, Some(Purpose::Pick(_))) => {
                self.executor.change_purpose(Purpose::Return);
                self.let_go(now, fx);
            }
            (MotionPhase::Aim, Some(Purpose::Aim(object))) => {
                self.aimed = Some(object);
                self.record(Cause::Moved, now, fx);
            }
            (MotionPhase::Return, _) => {
                self.urgent = true;
                self.rest(now, fx);
            }
            _ => {}
        }
    }

    /// Handles fingers that have opened where the object was to be let go.
    fn let_go(&mut self, now: Time, fx: &mut Fx) {
        let held = self.state.held.take();
        let outcome = match self.state.to_put_back() {
            Some(object) => {
                self.state.handed_over.retain(|other| other.object != object);
                PickOutcome::PutBack
            }
            // It stands in its place again.
            None if self.is_called_off() => PickOutcome::Cancelled,
            None => {
                self.state.gone.extend(held.map(|held| held.object));
                held.into_iter().for_each(|held| self.state.remember(held));
                PickOutcome::Delivered
            }
        };
        self.end(outcome, now, fx);
    }

    /// Returns whether the open pick was called off while its object was held.
    pub(crate) fn is_called_off(&self) -> bool {
        self.state.open_pick().is_some_and(|pick| pick.phase == PickPhase::Returning)
    }

    /// Returns whether people may put objects back by themselves.
    pub(crate) fn restocks(&self) -> bool {
        let given_back = self.state.to_put_back();
        self.config.arm.restock && self.state.gone.iter().any(|gone| Some(*gone) != given_back)
    }

    /// Handles the arm at rest: with restocking, people have put the objects back, except one that
    /// the arm is to put back.
    pub(crate) fn rest(&mut self, now: Time, fx: &mut Fx) {
        if self.limb_away().is_none() {
            self.state.offered = None;
        }
        if self.restocks() && self.limb_away().is_none() {
            let given_back = self.state.to_put_back();
            self.state.gone.retain(|gone| Some(*gone) == given_back);
        }
        self.record(Cause::Rested, now, fx);
    }
}
