//! What is to be done next. The goal follows from the state, the standing act and where the arm is;
//! when it changes under a motion, the arm halts and plans anew from there.

use crate::executor::{Executor, Program, Purpose};
use crate::program::{Planner, Refusal};
use crate::recover::{Next, next};
use crate::{ArmNode, Fx};
use manipulation::Limb;
use messages::{Hindrance, PickOutcome, PickPhase};
use scene::ObjectId;
use service::{Span, Time};

/// How long the arm stands where it finds no way to rest, before it looks for one again.
const RETRY_EVERY: Span = Span::from_ms(5_000);

/// What could not be done.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Setbacks {
    /// Not possible from where the arm stood; to be tried again from rest.
    from_rest: Option<Purpose>,
    /// Nothing can aim at it.
    aim: Option<ObjectId>,
    /// No way to rest was found; not to be looked for before.
    retry_rest: Option<Time>,
}

impl Setbacks {
    /// The policy asks about another object.
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
    /// Sets out for what is wanted, or halts what is not.
    pub(crate) fn decide(&mut self, now: Time, fx: &mut Fx) {
        let wanted = self.wanted(now);
        match &self.executor {
            Executor::Running { program, .. } if Some(program.purpose) != wanted => {
                self.executor.halt();
            }
            Executor::Running { .. } | Executor::Halting { .. } => {}
            // Plans begin where the joints are, so they have to be somewhere.
            Executor::Standing if !self.can_set_out() => {}
            Executor::Standing => {
                let restocks = self.config.arm.restock && !self.state.gone.is_empty();
                if restocks && self.limb_away().is_none() {
                    self.rest(now, fx);
                }
                if let Some(purpose) = wanted {
                    self.set_out(purpose, now, fx);
                }
            }
        }
    }

    /// A limb that is not at rest, or on its way there.
    pub(crate) fn limb_away(&self) -> Option<Limb> {
        let measured = self.driver.measured();
        let robot = &self.config.setup.robot;
        Limb::BOTH.into_iter().find(|limb| !measured.is_at_rest(robot, *limb))
    }

    fn can_set_out(&self) -> bool {
        self.driver.hindrance() == Hindrance::None && self.driver.is_still()
    }

    /// What the arm should be doing now; none: stand.
    fn wanted(&self, now: Time) -> Option<Purpose> {
        if self.state.stopped || self.ending || self.driver.hindrance() != Hindrance::None {
            return None;
        }
        let returning = self.executor.purpose() == Some(Purpose::Return);
        let away = returning || self.limb_away().is_some() && self.setbacks.way_to_rest(now);
        match self.goal() {
            Some(goal) if !(away && self.comes_after_rest(goal)) => Some(goal),
            None if self.state.waits_for_person => None,
            _ => away.then_some(Purpose::Return),
        }
    }

    /// What the arm is to do besides resting.
    fn goal(&self) -> Option<Purpose> {
        if let Some(pick) = self.state.open_pick() {
            return Some(Purpose::Pick(pick.id));
        }
        let aim = self.act.aim.filter(|object| self.setbacks.aim != Some(*object))?;
        let stands = self.config.arm.restock || !self.state.gone.contains(&aim);
        (stands && !self.state.waits_for_person).then_some(Purpose::Aim(aim))
    }

    /// Whether the arm is to rest first: no plan was found from elsewhere, or the object is still
    /// with the person, who puts it back once the arm is at rest.
    fn comes_after_rest(&self, goal: Purpose) -> bool {
        let object = match goal {
            Purpose::Pick(_) => self.state.open_pick().map(|pick| pick.object),
            Purpose::Aim(object) => Some(object),
            Purpose::Return => None,
        };
        let with_person = object.is_some_and(|object| self.state.gone.contains(&object));
        self.setbacks.from_rest == Some(goal) || self.config.arm.restock && with_person
    }

    fn set_out(&mut self, purpose: Purpose, now: Time, fx: &mut Fx) {
        if purpose == self.aimed.map_or(Purpose::Return, Purpose::Aim) && self.aimed.is_some() {
            return;
        }
        let program = match purpose {
            Purpose::Pick(_) => self.plan_pick(now, fx),
            Purpose::Aim(object) => Some(self.planner_with(|planner| planner.aim(object))),
            Purpose::Return => {
                self.limb_away().map(|limb| self.planner_with(|planner| planner.rest(limb)))
            }
        };
        match program {
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
            .map(|step| format!("{:?} {:.2} s", step.kind, step.motion.duration_s()))
            .collect();
        let (purpose, limb) = (program.purpose, program.limb);
        tracing::info!(?purpose, %limb, seconds, steps = steps.join(", "), "planned");
        self.aimed = None;
        if purpose != Purpose::Return {
            self.setbacks.from_rest = None;
        }
        let object = match purpose {
            Purpose::Pick(_) => self.state.open_pick().map(|pick| pick.object),
            Purpose::Aim(object) => Some(object),
            Purpose::Return => None,
        };
        self.course.begin(&program, object, &self.config);
        self.executor.start(program);
    }

    /// The program for the open pick, if it is to move; what needs no motion is done at once.
    fn plan_pick(&mut self, now: Time, fx: &mut Fx) -> Option<Result<Program, Refusal>> {
        let pick = *self.state.open_pick()?;
        let (limb, held) = (self.state.limb, self.state.held);
        let holding = limb.and_then(|limb| self.driver.measured().holds(limb));
        let at_hand_over =
            limb.is_some_and(|limb| self.planner_with(|planner| planner.is_at_hand_over(limb)));
        match (next(pick.phase, holding, at_hand_over), held, limb) {
            (Next::Fetch, ..) => Some(self.planner_with(|planner| planner.fetch(&pick))),
            (Next::Deliver, Some(held), _) => {
                Some(self.planner_with(|planner| planner.deliver(pick.id, &held)))
            }
            (Next::Release, Some(held), _) => {
                Some(Ok(self.planner_with(|planner| planner.release(pick.id, &held))))
            }
            (Next::Deliver, None, Some(limb)) if pick.phase == PickPhase::Closing => {
                self.hold(limb, now, fx);
                None
            }
            (Next::Interrupt | Next::Deliver | Next::Release, ..) => {
                self.end(PickOutcome::Interrupted, now, fx);
                None
            }
        }
    }

    fn planner_with<R>(&self, plan: impl FnOnce(&Planner<'_>) -> R) -> R {
        plan(&Planner {
            robot: &self.config.setup.robot,
            settings: &self.config.setup.plan,
            grasps: &self.config.arm.grasp,
            limb: self.config.setup.limb,
            world: &self.world,
            state: &self.state,
            measured: &self.driver.measured(),
        })
    }

    /// Goes on where there is no program: from rest, or not at all.
    fn refuse(&mut self, purpose: Purpose, refusal: Refusal, now: Time, fx: &mut Fx) {
        let from_rest = self.limb_away().is_some() && self.setbacks.way_to_rest(now);
        match purpose {
            Purpose::Return => {
                tracing::error!(%refusal, "no way to rest; the arm stands where it is");
                self.setbacks.retry_rest = Some(now + RETRY_EVERY);
            }
            _ if from_rest => {
                tracing::info!(?purpose, %refusal, "not from here; the arm goes to rest first");
                self.setbacks.from_rest = Some(purpose);
                self.urgent = true;
            }
            Purpose::Aim(object) => {
                let name = self.name(object);
                tracing::warn!(name, %refusal, "cannot point at the object");
                self.setbacks.aim = Some(object);
            }
            Purpose::Pick(_) => {
                let Some(pick) = self.state.open_pick().copied() else { return };
                let name = self.name(pick.object);
                tracing::error!(name, %refusal, "cannot fetch the object");
                let holds = pick.phase == PickPhase::Holding;
                let outcome =
                    if holds { PickOutcome::Interrupted } else { PickOutcome::Unreachable };
                self.end(outcome, now, fx);
            }
        }
    }

    fn name(&self, object: ObjectId) -> &str {
        let objects = self.config.scene.objects();
        objects.get(object.index()).map_or("an object that the scene lacks", |o| &o.name)
    }
}
