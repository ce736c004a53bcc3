//! Plans programs for the arm's goals, from any posture.

use crate::Config;
use crate::executor::{Program, Purpose, Step};
use crate::state::{ArmState, Held};
use crate::world::World;
use arm_driver::{Fingers, Grip, Measured};
use config::Grasps;
use manipulation::pose_array::from_array;
use manipulation::{
    ArmShape, Cuboid, Joints, Limb, MotionLimits, Phase, PlanError, PlanSettings, Robot, Stage,
    Trajectory, gripper, plan_delivery, plan_pick, plan_point, plan_put_back, plan_put_down,
    plan_retreat, plan_return, plan_withdrawal,
};
use messages::pick::Pick;
use messages::{MotionPhase, PickId, PickPhase, Task};
use nalgebra::Translation3;
use scene::ObjectId;
use std::collections::VecDeque;
use vocabulary::Rng;

/// Inputs of a plan.
pub(crate) struct Planner<'a> {
    robot: &'a Robot,
    settings: &'a PlanSettings,
    /// Settings of grasps.
    grasps: &'a Grasps,
    /// Configured limb; `None` means the better one.
    limb: Option<Limb>,
    world: &'a World,
    state: &'a ArmState,
    measured: &'a Measured,
}

/// Reason for a missing program.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub(crate) enum Refusal {
    /// The scene has no place for the object.
    #[error("it has no place in the scene")]
    NoPlace,
    /// A user took it.
    #[error("it was handed over and has not been put back (arm.restock is off)")]
    Gone,
    /// It cannot be put back.
    #[error("it is not known how it was handed over")]
    NotHandedOver,
    /// The other limb is away from rest and must return first.
    #[error("the other limb is away from rest")]
    OtherLimb,
    /// No motion was found.
    #[error(transparent)]
    Plan(#[from] PlanError),
}

/// Start of a plan.
struct Start {
    /// Steps before it.
    steps: VecDeque<Step>,
    /// Arms after those steps.
    arms: [Joints; 2],
    obstacles: Vec<Cuboid>,
}

/// Last seconds of an approach, in which the fingers must already be open.
const DESCENT_S: f64 = 1.0;
/// Pause after opening the fingers, seconds.
const SETTLE_S: f64 = 0.2;
/// Largest distance from where the object is let go that counts as there, metres.
const AT_GOAL_M: f64 = 0.005;
/// Largest motion of the gripper with a joint, metres per radian.
const REACH_M: f64 = 1.2;
/// Rises of the gripper before it returns to rest, tried in turn until a path is found, metres.
const RISES_M: [f64; 2] = [0.05, 0.15];
/// Distance before and after a waypoint at which a corner is rounded, radians of joint distance.
const BLEND_RAD: f64 = 0.15;

impl<'a> Planner<'a> {
    pub(crate) fn new(
        config: &'a Config,
        world: &'a World,
        state: &'a ArmState,
        measured: &'a Measured,
    ) -> Self {
        Self {
            robot: &config.setup.robot,
            settings: &config.setup.plan,
            grasps: &config.arm.grasp,
            limb: config.setup.limb,
            world,
            state,
            measured,
        }
    }
}

impl Planner<'_> {
    /// Takes the object of a pick: from its place to hand it over, or from the user to put it back.
    pub(crate) fn take(&self, pick: &Pick) -> Result<Program, Refusal> {
        match pick.task {
            Task::Fetch => self.fetch(pick),
            Task::PutBack => self.take_back(pick),
        }
    }

    /// Carries the held object on to where it is let go.
    pub(crate) fn carry(&self, pick: &Pick, held: &Held) -> Result<Program, Refusal> {
        let object = self.world.place(held.object).ok_or(Refusal::NoPlace)?;
        let in_gripper = from_array(&held.in_gripper);
        let others = self.world.obstacles(self.state, None);
        let (robot, limb, arms) = (self.robot, held.limb, &self.measured.posture.joints);
        let plan = self.with_reduced_margin(|settings| {
            let carry = if pick.ends_at_place() { plan_put_down } else { plan_delivery };
            carry(robot, object, &in_gripper, limb, arms, &others, settings)
        })?;
        let steps = plan.stages().iter().map(|stage| self.step(stage)).collect();
        Ok(Program { purpose: Purpose::Pick(pick.id), limb, steps })
    }

    /// Fetches `pick.object`: clear of what the arm touches, approach, close, lift, hand over,
    /// release, return.
    fn fetch(&self, pick: &Pick) -> Result<Program, Refusal> {
        let object = self.world.place(pick.object).ok_or(Refusal::NoPlace)?;
        if self.state.gone.contains(&pick.object) {
            return Err(Refusal::Gone);
        }
        let start = self.start(Some(pick.object), 0.0)?;
        let plan = self.with_reduced_margin(|settings| {
            plan_pick(self.robot, object, self.limb, &start.arms, &start.obstacles, settings)
        })?;
        self.refuse_other(plan.limb())?;
        let mut steps = start.steps;
        let stages = plan.stages();
        if steps.is_empty() {
            steps.extend(self.open_first(plan.limb(), stages[0].motion.duration_s()));
        }
        steps.iter_mut().for_each(|step| step.phase = Some(PickPhase::Moving));
        steps.extend(stages.iter().map(|stage| self.step(stage)));
        Ok(Program { purpose: Purpose::Pick(pick.id), limb: plan.limb(), steps })
    }

    /// Takes `pick.object` from the user, with the gripper that handed it over, and puts it back:
    /// clear of what the arm touches, take, close, carry back, lower, release, raise, return.
    fn take_back(&self, pick: &Pick) -> Result<Program, Refusal> {
        let object = self.world.place(pick.object).ok_or(Refusal::NoPlace)?;
        let held = self.state.handed_over(pick.object).ok_or(Refusal::NotHandedOver)?;
        let (limb, in_gripper) = (held.limb, from_array(&held.in_gripper));
        self.refuse_other(limb)?;
        let start = self.start(Some(pick.object), 0.0)?;
        let plan = self.with_reduced_margin(|settings| {
            let Start { arms, obstacles, .. } = &start;
            plan_put_back(self.robot, object, &in_gripper, limb, arms, obstacles, settings)
        })?;
        let mut steps = start.steps;
        steps.iter_mut().for_each(|step| step.phase = Some(PickPhase::Moving));
        steps.extend(plan.stages().iter().map(|stage| self.step(stage)));
        Ok(Program { purpose: Purpose::Pick(pick.id), limb, steps })
    }

    /// Opens the fingers where the gripper is.
    pub(crate) fn release(&self, pick: PickId, held: &Held) -> Program {
        let steps = VecDeque::from([Step {
            kind: MotionPhase::Release,
            phase: Some(PickPhase::Holding),
            ..self.opening(held.limb, &self.measured.posture.joints[held.limb])
        }]);
        Program { purpose: Purpose::Pick(pick), limb: held.limb, steps }
    }

    pub(crate) fn aim(&self, object: ObjectId) -> Result<Program, Refusal> {
        let place = self.world.place(object).ok_or(Refusal::NoPlace)?;
        let start = self.start(None, 0.0)?;
        let plan = self.with_reduced_margin(|settings| {
            plan_point(self.robot, place.xyz_m, self.limb, &start.arms, &start.obstacles, settings)
        })?;
        self.refuse_other(plan.limb())?;
        let mut steps = start.steps;
        steps.push_back(self.step(&plan.stages()[0]));
        Ok(Program { purpose: Purpose::Aim(object), limb: plan.limb(), steps })
    }

    /// Brings `limb` to rest, with whatever it holds: as it stands, or else from higher up.
    pub(crate) fn rest(&self, limb: Limb) -> Result<Program, Refusal> {
        self.rest_from(limb, 0.0).or_else(|refusal| {
            RISES_M.iter().find_map(|rise_m| self.rest_from(limb, *rise_m).ok()).ok_or(refusal)
        })
    }

    fn rest_from(&self, limb: Limb, rise_m: f64) -> Result<Program, Refusal> {
        let start = self.start(None, rise_m)?;
        let plan = self.with_reduced_margin(|settings| {
            plan_return(self.robot, limb, &start.arms, &start.obstacles, settings)
        })?;
        let holds = self.state.held.is_some_and(|held| held.limb == limb);
        let mut steps = start.steps;
        steps.extend(plan.stages().iter().map(|stage| Step {
            fingers: if holds { Fingers::Stay } else { Fingers::Open(stage.width_m.1) },
            ..self.step(stage)
        }));
        Ok(Program { purpose: Purpose::Return, limb, steps })
    }

    /// Returns whether the gripper of `limb` is where the pick's object is let go.
    pub(crate) fn is_at_goal(&self, pick: &Pick, limb: Limb) -> bool {
        let within_m = AT_GOAL_M + REACH_M * self.measured.accuracy_rad;
        let tip = self.tip(limb).vector;
        if !pick.ends_at_place() {
            return self.settings.is_hand_over(limb, &tip, within_m);
        }
        let held = self.state.held.as_ref().filter(|held| held.limb == limb);
        let goal = held
            .zip(self.world.place(pick.object))
            .map(|(held, place)| place.isometry() * from_array(&held.in_gripper).inverse());
        goal.is_some_and(|goal| (goal.translation.vector - tip).norm() < within_m)
    }

    /// Plans with the configured margin or, if something blocks a limb that is away
    /// from rest, without one: an arm that was halted between two of the points at which its motion
    /// was checked, or that is measured a little beside them, may stand a hair inside the margin.
    fn with_reduced_margin<T>(
        &self,
        plan: impl Fn(&PlanSettings) -> Result<T, PlanError>,
    ) -> Result<T, PlanError> {
        let rests = |limb| self.measured.is_at_rest(self.robot, limb);
        match plan(self.settings) {
            Err(PlanError::Blocked { .. }) if !self.robot.limbs().iter().copied().all(rests) => {
                plan(&PlanSettings { margin_m: 0.0, ..*self.settings })
            }
            plan => plan,
        }
    }

    fn refuse_other(&self, limb: Limb) -> Result<(), Refusal> {
        let rests = |other| self.measured.is_at_rest(self.robot, other);
        if limb.other().is_none_or(rests) { Ok(()) } else { Err(Refusal::OtherLimb) }
    }

    /// Returns the limb's motion limits at the configured speed.
    fn limits(&self, limb: Limb) -> MotionLimits {
        self.robot.arm(limb).limits.at_speed_ratio(self.settings.speed_ratio)
    }

    fn tip(&self, limb: Limb) -> Translation3<f64> {
        self.robot.arm(limb).chain.forward(&self.measured.posture.joints[limb]).translation
    }

    /// Returns a pause before an approach in which fingers that start now would not open in time.
    fn open_first(&self, limb: Limb, approach_s: f64) -> Option<Step> {
        let short_s = self.opening_s(limb) + DESCENT_S - approach_s;
        let q = &self.measured.posture.joints[limb];
        (short_s > 0.0 && self.opening_s(limb) > 0.0).then(|| Step {
            motion: Trajectory::hold(q, short_s, &self.limits(limb)),
            ..self.opening(limb, q)
        })
    }

    /// Width to which the gripper opens, metres.
    fn open_m(&self, limb: Limb) -> f64 {
        self.robot.arm(limb).gripper.width_m(self.settings.open_percent)
    }

    fn opening_s(&self, limb: Limb) -> f64 {
        let width_m = self.measured.posture.width_m[limb];
        gripper::seconds_between(width_m, self.open_m(limb))
    }

    /// Stands at `q` until the fingers are open.
    fn opening(&self, limb: Limb, q: &Joints) -> Step {
        let travel_s = self.opening_s(limb);
        let seconds = if travel_s > 0.0 { travel_s + SETTLE_S } else { 0.0 };
        let motion = Trajectory::hold(q, seconds, &self.limits(limb));
        let fingers = Fingers::Open(self.open_m(limb));
        Step { kind: MotionPhase::Clear, phase: None, motion, fingers }
    }

    /// Returns the start of a plan: with a limb that is away from rest within its joint limits, clear of
    /// every object, and `rise_m` higher than it is. It may stand among them, stopped or killed on its
    /// way down, or where a person moved it; what it then touches it leaves as it came, straight up
    /// with open fingers. So it does where a user may hold something between the fingers, but back along
    /// them.
    fn start(&self, fetched: Option<ObjectId>, rise_m: f64) -> Result<Start, Refusal> {
        let mut arms = self.measured.posture.joints;
        let mut steps = VecDeque::new();
        let limbs = self.robot.limbs().iter().copied();
        let away = limbs.into_iter().find(|limb| !self.measured.is_at_rest(self.robot, *limb));
        let mut others = self.world.obstacles(self.state, fetched);
        let Some(limb) = away else { return Ok(Start { steps, arms, obstacles: others }) };
        others.extend(self.offered(fetched));
        let holds = self.state.held.is_some();
        let step =
            |motion, fingers| Step { kind: MotionPhase::Clear, phase: None, motion, fingers };
        let untouched = self.without_touched(limb, &arms[limb], others.clone());
        let retreat = plan_retreat(self.robot, limb, &arms, &untouched, self.settings)?;
        if let Some(retreat) = retreat {
            tracing::info!(%limb, "the limb stands outside its limits or in collision; retreating");
            arms[limb] = retreat.end();
            steps.push_back(step(retreat, Fingers::Stay));
        }
        let withdrawal = self.withdrawal(limb, &arms[limb]).filter(|_| rise_m == 0.0);
        if let Some(leave) = withdrawal.or_else(|| self.up(limb, &arms[limb], rise_m)) {
            let opening = self.opening(limb, &arms[limb]);
            let fingers = if holds { Fingers::Stay } else { opening.fingers };
            arms[limb] = leave.end();
            steps.extend((!holds && opening.motion.duration_s() > 0.0).then_some(opening));
            steps.push_back(step(leave, fingers));
        }
        // An object that it still touches cannot be an obstacle.
        let obstacles = self.without_touched(limb, &arms[limb], others);
        Ok(Start { steps, arms, obstacles })
    }

    fn without_touched(&self, limb: Limb, q: &Joints, mut others: Vec<Cuboid>) -> Vec<Cuboid> {
        let shape = ArmShape::at(self.robot.arm(limb), q);
        others.retain(|cuboid| !touches(&shape, cuboid));
        others
    }

    /// Back along the fingers from what a user may hold between them.
    fn withdrawal(&self, limb: Limb, q: &Joints) -> Option<Trajectory> {
        let offered =
            self.state.offered.filter(|it| it.limb == limb && self.state.held.is_none())?;
        let object = self.world.place(offered.object)?;
        let gripper = self.robot.arm(limb).chain.forward(q);
        let in_gripper = gripper.inverse() * from_array(&offered.pose);
        plan_withdrawal(self.robot, object, &in_gripper, (limb, q), self.settings)
    }

    /// Returns the box around what a user may hold, unless that is to be taken.
    fn offered(&self, taken: Option<ObjectId>) -> Option<Cuboid> {
        let offered = self.state.offered.filter(|it| Some(it.object) != taken)?;
        let object = self.world.place(offered.object)?;
        Some(object.cuboid_at(&from_array(&offered.pose)))
    }

    /// Straight up from the objects that the limb touches, and at least by `rise_m`, as far as the
    /// limb can.
    fn up(&self, limb: Limb, q: &Joints, rise_m: f64) -> Option<Trajectory> {
        let shape = ArmShape::at(self.robot.arm(limb), q);
        let chain = &self.robot.arm(limb).chain;
        let pose = chain.forward(q);
        let touched =
            self.world.standing(self.state, None).filter(|o| touches(&shape, &o.cuboid()));
        let up_m = touched
            .map(|object| object.top_z_m() + self.settings.hover_m - pose.translation.z)
            .fold(rise_m, f64::max);
        let line = [1.0, 0.6, 0.3].into_iter().filter(|_| up_m > 0.0).find_map(|share| {
            chain.line(q, &(Translation3::new(0.0, 0.0, share * up_m) * pose)).ok()
        })?;
        Trajectory::through(&line, BLEND_RAD, &self.limits(limb)).ok()
    }

    fn step(&self, stage: &Stage) -> Step {
        let (_, width_m) = stage.width_m;
        let (grip, open) = (Fingers::Grip(self.grip(width_m)), Fingers::Open(width_m));
        let (kind, phase, fingers) = match stage.phase {
            Phase::Approach => (MotionPhase::Approach, Some(PickPhase::Moving), open),
            Phase::Close => (MotionPhase::Close, Some(PickPhase::Closing), grip),
            Phase::Lift => (MotionPhase::Lift, Some(PickPhase::Holding), grip),
            Phase::HandOver => (MotionPhase::HandOver, Some(PickPhase::Holding), grip),
            Phase::Release => (MotionPhase::Release, Some(PickPhase::Holding), open),
            Phase::Take => (MotionPhase::Take, Some(PickPhase::Moving), open),
            Phase::CarryBack => (MotionPhase::CarryBack, Some(PickPhase::Holding), grip),
            Phase::Lower => (MotionPhase::Lower, Some(PickPhase::Holding), grip),
            Phase::Raise => (MotionPhase::Clear, None, open),
            Phase::Aim | Phase::Hold => (MotionPhase::Aim, None, open),
            Phase::Return => (MotionPhase::Return, None, open),
        };
        Step { kind, phase, motion: stage.motion.clone(), fingers }
    }

    /// Returns the object between the fingers. Its offset is drawn from the pick and the attempt
    /// at it, so that a killed arm finds it in the same place.
    fn grip(&self, object_m: f64) -> Grip {
        let key = self
            .state
            .pick
            .map_or(0, |pick| (pick.id.interaction.0 << 16) ^ (u64::from(pick.id.attempt) << 8));
        let mut random = Rng::new(key ^ u64::from(self.state.misses));
        Grip { object_m, offset_m: self.grasps.error_m * random.normal() }
    }
}

fn touches(shape: &ArmShape<'_>, cuboid: &Cuboid) -> bool {
    shape.to_cuboid("object", cuboid, 0.0).is_some()
}
