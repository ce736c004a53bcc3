//! Choice of the next goal, from the state, the standing act and the arm's posture;
//! when it changes during a motion, the arm halts and replans from there. The arm stands while its next
//! motion is being planned; a goal that changes meanwhile is planned instead.

use crate::executor::{Executor, Program, Purpose};
use crate::plan::Motion;
use crate::program::{Planner, Refusal};
use crate::recover::{Next, next};
use crate::{ArmNode, Fx};
use manipulation::Limb;
use messages::{MotionInhibit, PickOutcome, PickPhase};
use scene::ObjectId;
use service::{Span, Time};

/// Delay before another search for a path to rest.
const RETRY_EVERY: Span = Span::from_ms(5_000);

/// Goals for which planning failed.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct PlanFailures {
    /// Not possible from the arm's posture; to be retried from rest.
    from_rest: Option<Purpose>,
    /// Object that no limb can aim at.
    aim: Option<ObjectId>,
    /// Earliest time of another search for a path to rest.
    retry_rest: Option<Time>,
}

impl PlanFailures {
    /// Forgets the failed aim when the policy asks about another object.
    pub(crate) fn forget_aim(&mut self, before: Option<ObjectId>, after: Option<ObjectId>) {
        if before != after {
            self.aim = None;
        }
    }

    fn way_to_rest(&self, now: Time) -> bool {
        self.retry_rest.is_none_or(|retry| now >= retry)
    }
}

impl ArmNode {
    /// Starts the wanted goal, or halts a motion for another one.
    pub(crate) fn decide(&mut self, now: Time, fx: &mut Fx) {
        let wanted = self.wanted(now);
        match &self.executor {
            Executor::Running { program, .. } if Some(program.purpose) != wanted => {
                self.executor.halt();
            }
            Executor::Running { .. } | Executor::Halting { .. } => {}
            // A plan starts at the present posture, so the joints must stand still.
            Executor::Standing if !self.can_start() => {}
            Executor::Standing => {
                if self.restocks() && self.limb_away().is_none() {
                    self.rest(now, fx);
                }
                match wanted {
                    Some(purpose) => self.start_goal(purpose, now, fx),
                    None => self.planning.cancel(),
                }
            }
        }
    }

    /// Returns a limb that is not at rest.
    pub(crate) fn limb_away(&self) -> Option<Limb> {
        let measured = self.driver.measured();
        let robot = &self.config.setup.robot;
        robot.limbs().iter().copied().find(|limb| !measured.is_at_rest(robot, *limb))
    }

    fn can_start(&self) -> bool {
        self.driver.inhibit() == MotionInhibit::None && self.driver.is_still()
    }

    /// Returns the present goal; `None` means standing.
    fn wanted(&self, now: Time) -> Option<Purpose> {
        let may_move = !self.state.stopped && self.driver.inhibit() == MotionInhibit::None;
        if may_move && !self.ending { self.intended(now) } else { None }
    }

    /// Returns the goal of an arm that may move.
    pub(crate) fn intended(&self, now: Time) -> Option<Purpose> {
        let returning = self.executor.purpose() == Some(Purpose::Return);
        let away = returning || self.limb_away().is_some() && self.plan_failures.way_to_rest(now);
        match self.goal() {
            Some(goal) if !(away && self.comes_after_rest(goal)) => Some(goal),
            None if self.state.waits() => None,
            _ => away.then_some(Purpose::Return),
        }
    }

    /// Returns the goal other than resting.
    fn goal(&self) -> Option<Purpose> {
        if let Some(pick) = self.state.open_pick() {
            return self.knows_target().then_some(Purpose::Pick(pick.id));
        }
        let aim = self.act.aim.filter(|object| self.plan_failures.aim != Some(*object))?;
        let stands = self.config.arm.restock || !self.state.gone.contains(&aim);
        (stands && !self.state.waits()).then_some(Purpose::Aim(aim))
    }

    /// Returns whether the arm must rest first: no plan was found from elsewhere, it leaves what a user
    /// may still hold between its fingers, or the object is still with the person, who puts it back by
    /// hand once the arm is at rest.
    fn comes_after_rest(&self, goal: Purpose) -> bool {
        let object = self.object_of(goal);
        let with_person = object.is_some_and(|object| self.state.gone.contains(&object));
        let restocked =
            self.config.arm.restock && with_person && object != self.state.to_put_back();
        let is_offered = self.state.offered.is_some() && !self.state.is_letting_go();
        self.plan_failures.from_rest == Some(goal) || is_offered || restocked
    }

    fn object_of(&self, purpose: Purpose) -> Option<ObjectId> {
        match purpose {
            Purpose::Pick(_) => self.state.open_pick().map(|pick| pick.object),
            Purpose::Aim(object) => Some(object),
            Purpose::Return => None,
        }
    }

    fn start_goal(&mut self, purpose: Purpose, now: Time, fx: &mut Fx) {
        if purpose == self.aimed.map_or(Purpose::Return, Purpose::Aim) && self.aimed.is_some() {
            return self.planning.cancel();
        }
        let motion = match purpose {
            Purpose::Pick(_) => self.motion_of_pick(now, fx),
            Purpose::Aim(object) => Some(Motion::Aim(object)),
            Purpose::Return => self.limb_away().map(Motion::Rest),
        };
        match motion.and_then(|motion| self.plan(motion, now, fx)) {
            None => {}
            Some(Ok(program)) => self.start(program),
            Some(Err(refusal)) => self.refuse(purpose, refusal, now, fx),
        }
    }

    fn start(&mut self, program: Program) {
        let seconds = program.duration_s();
        let steps: Vec<String> = program
            .steps
            .iter()
            .map(|step| format!("{} {:.2} s", step.kind, step.motion.duration_s()))
            .collect();
        let (purpose, limb) = (program.purpose, program.limb);
        tracing::info!(%purpose, %limb, seconds, steps = steps.join(", "), "planned");
        self.aimed = None;
        if purpose != Purpose::Return {
            self.plan_failures.from_rest = None;
        }
        let object = self.object_of(purpose);
        self.motion_view.begin(&program, object, &self.config);
        self.executor.start(program);
    }

    /// Returns the motion that the open pick needs next; what needs none is done at once.
    fn motion_of_pick(&mut self, now: Time, fx: &mut Fx) -> Option<Motion> {
        let pick = *self.state.open_pick()?;
        let (limb, held) = (self.state.limb, self.state.held);
        let measured = self.driver.measured();
        let holding = limb.and_then(|limb| measured.holds(limb));
        let planner = Planner::new(&self.config, &self.world, &self.state, &measured);
        let at_goal = limb.is_some_and(|limb| planner.is_at_goal(&pick, limb));
        match (next(pick.phase, holding, at_goal), held, limb) {
            (Next::Take, ..) => Some(Motion::Take(pick)),
            (Next::Carry, Some(held), _) => Some(Motion::Carry(pick, held)),
            (Next::Release, Some(held), _) => Some(Motion::Release(pick, held)),
            (Next::Carry, None, Some(limb)) if pick.phase == PickPhase::Closing => {
                self.hold(limb, now, fx);
                None
            }
            (Next::Interrupt | Next::Carry | Next::Release, ..) => {
                self.end(PickOutcome::Interrupted, now, fx);
                None
            }
        }
    }

    /// Handles a goal without a program: retry from rest, or give up.
    fn refuse(&mut self, purpose: Purpose, refusal: Refusal, now: Time, fx: &mut Fx) {
        let from_rest = self.limb_away().is_some() && self.plan_failures.way_to_rest(now);
        match purpose {
            Purpose::Return => {
                tracing::error!(%refusal, "no way to rest; the arm stands where it is");
                self.plan_failures.retry_rest = Some(now + RETRY_EVERY);
            }
            _ if from_rest && !self.is_called_off() => {
                tracing::info!(%purpose, %refusal, "not from here; the arm goes to rest first");
                self.plan_failures.from_rest = Some(purpose);
                self.urgent = true;
            }
            Purpose::Aim(object) => {
                let name = self.name(object);
                tracing::warn!(name, %refusal, "cannot point at the object");
                self.plan_failures.aim = Some(object);
            }
            Purpose::Pick(_) => {
                let Some(pick) = self.state.open_pick().copied() else { return };
                let name = self.name(pick.object);
                tracing::error!(name, task = ?pick.task, %refusal, "no way with the object");
                let outcome = match pick.phase {
                    PickPhase::Returning => PickOutcome::Kept,
                    PickPhase::Holding => PickOutcome::Interrupted,
                    _ => PickOutcome::Unreachable,
                };
                self.end(outcome, now, fx);
            }
        }
    }

    fn name(&self, object: ObjectId) -> &str {
        let objects = self.config.scene.objects();
        let unnamed = if self.config.perceives {
            "a perceived object"
        } else {
            "an object that the scene lacks"
        };
        objects.get(object.index()).map_or(unnamed, |o| &o.name)
    }
}
