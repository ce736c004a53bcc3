//! Putting back what was handed over, the reverse of a pick: take it where it was handed over, close,
//! carry it over its place, down, release, up, return.

use nalgebra::{Isometry3, Translation3};

use super::choices::Choice;
use super::deliver::{CORNER, fingers, home, still_to_lift_m};
use super::error::PlanError;
use super::fetch::{ABOVE, Carry, GRASP, HAND_OVER, HOME};
use super::pick::{cheapest, planning_scene};
use super::planning_scene::{PlanSettings, PlanningScene, Search};
use crate::collision::Cuboid;
use crate::kinematics::limb::{Joints, Limb};
use crate::planning::grasp::{Grasp, ObjectPose};
use crate::robot::Robot;
use crate::trajectory::{Phase, Stage, Timeline, Trajectory};

/// Time for the user to put the object between the open fingers, seconds.
const OFFER_S: f64 = 2.0;

/// Largest horizontal distance of the gripper from the grasp that counts as over it, metres.
const BESIDE_M: f64 = 0.003;

/// Plans to put `object`, given as it stood, back in its place: `limb` takes it where it was handed
/// over, held at `object_in_gripper` as it was then. `arms` are both arms' postures, `others`
/// everything else that stands around; neither the arm nor what it holds touches any of it.
///
/// # Errors
/// [`PlanError`] of the attempt that came furthest.
pub fn plan_put_back(
    robot: &Robot,
    object: &ObjectPose,
    object_in_gripper: &Isometry3<f64>,
    limb: Limb,
    arms: &[Joints; 2],
    others: &[Cuboid],
    settings: &PlanSettings,
) -> Result<Timeline, PlanError> {
    let target = Target::new(robot, object, object_in_gripper, limb, arms, others, settings)?;
    target.cheapest(|choice, search| target.take(choice, search))
}

/// Plans the rest of it for an arm that already holds the object: carry it over its place unless it is
/// there, down, release, up, return.
///
/// # Errors
/// [`PlanError`] if the place cannot be reached from here.
pub fn plan_put_down(
    robot: &Robot,
    object: &ObjectPose,
    object_in_gripper: &Isometry3<f64>,
    limb: Limb,
    arms: &[Joints; 2],
    others: &[Cuboid],
    settings: &PlanSettings,
) -> Result<Timeline, PlanError> {
    let target = Target::new(robot, object, object_in_gripper, limb, arms, others, settings)?;
    if let Some(plan) = target.straight_down() {
        return plan;
    }
    target.cheapest(|choice, search| target.carry_on(choice, search))
}

/// The place that the object is put back to, with all that the arm must not touch.
struct Target<'a> {
    object: &'a ObjectPose,
    /// The gripper as it lets go.
    grasp: Grasp,
    /// With empty fingers, without the object.
    empty: [PlanningScene<'a>; 1],
    carrying: PlanningScene<'a>,
    /// With the object in its place.
    done: PlanningScene<'a>,
}

/// What went wrong, and how far the attempt came.
type Attempt<T> = Result<T, (usize, PlanError)>;

impl<'a> Target<'a> {
    fn new(
        robot: &'a Robot,
        object: &'a ObjectPose,
        in_gripper: &Isometry3<f64>,
        limb: Limb,
        arms: &[Joints; 2],
        others: &[Cuboid],
        settings: &'a PlanSettings,
    ) -> Result<Self, PlanError> {
        let empty = planning_scene(robot, object, limb, arms, others, settings)?;
        let with_object = [others, &[object.cuboid()]].concat();
        let done = planning_scene(robot, object, limb, arms, &with_object, settings)?;
        let gripper = object.isometry() * in_gripper.inverse();
        let grasp = Grasp { gripper, width_m: object.grasp_width_m };
        let carrying = empty.carrying(object, in_gripper);
        Ok(Self { object, grasp, empty: [empty], carrying, done })
    }

    fn cheapest(
        &self,
        plan: impl Fn(&Choice<'_>, Search) -> Attempt<Timeline>,
    ) -> Result<Timeline, PlanError> {
        cheapest(|_| Ok(vec![self.grasp]), &self.empty, plan)
    }

    /// From anywhere, with empty fingers.
    fn take(&self, choice: &Choice<'_>, search: Search) -> Attempt<Timeline> {
        let scene = choice.scene;
        let descent = choice.descent(&self.carrying)?;
        let carry =
            Carry::find(&self.carrying, &choice.above, search).map_err(|error| (5, error))?;
        let way = scene
            .way(&scene.q, carry.end(), search)
            .ok_or_else(|| (6, scene.no_path(HAND_OVER, &scene.q, carry.end())))?;
        let take = scene.motion(HAND_OVER, &way).map_err(|error| (6, error))?;
        let offer = Trajectory::hold(carry.end(), OFFER_S, &scene.limits);
        let open_m = scene.open_m();
        let open = |motion| Stage { phase: Phase::Take, motion, width_m: (open_m, open_m) };
        let mut stages = vec![
            open(take),
            open(offer),
            fingers(scene, Phase::Close, carry.end(), (open_m, self.closed_m())),
        ];
        let mut back = vec![*carry.end()];
        let corner = if carry.straight { CORNER } else { 1 };
        back.extend(carry.waypoints.iter().skip(corner).rev());
        stages.extend(self.put_down(&back, &choice.above, &descent, search)?);
        Ok(Timeline::new(scene.limb, stages))
    }

    /// From anywhere, with the object.
    fn carry_on(&self, choice: &Choice<'_>, search: Search) -> Attempt<Timeline> {
        let carrying = &self.carrying;
        let descent = choice.descent(carrying)?;
        let way = carrying
            .way(&carrying.q, &choice.above, search)
            .ok_or_else(|| (5, carrying.no_path(ABOVE, &carrying.q, &choice.above)))?;
        let stages = self.put_down(&way[..way.len() - 1], &choice.above, &descent, search)?;
        Ok(Timeline::new(choice.scene.limb, stages))
    }

    /// From straight above the place, where the arm already is; none elsewhere.
    fn straight_down(&self) -> Option<Result<Timeline, PlanError>> {
        let carrying = &self.carrying;
        let at = carrying.chain.forward(&carrying.q);
        let off = at.translation.vector - self.grasp.gripper.translation.vector;
        let turned = at.rotation.angle_to(&self.grasp.gripper.rotation);
        let hover_m = carrying.settings.hover_m;
        if off.xy().norm() > BESIDE_M || turned > BESIDE_M || !(0.0..=hover_m).contains(&off.z) {
            return None;
        }
        let descent = carrying.chain.line(&carrying.q, &self.grasp.gripper).ok()?;
        let stages = self.put_down(&[], &carrying.q, &descent, Search::Yes).map_err(|(_, e)| e);
        Some(stages.map(|stages| Timeline::new(carrying.limb, stages)))
    }

    /// Over `way` to `above` the place, down `descent`, release, up again, and return.
    fn put_down(
        &self,
        way: &[Joints],
        above: &Joints,
        descent: &[Joints],
        search: Search,
    ) -> Attempt<Vec<Stage>> {
        let (empty, carrying) = (&self.empty[0], &self.carrying);
        let low = descent[descent.len() - 1];
        let corner = if way.is_empty() { 1 } else { CORNER };
        let mut waypoints = way.to_vec();
        waypoints.push(*above);
        waypoints.extend(&descent[corner.min(descent.len() - 1)..]);
        let whole = carrying.motion(GRASP, &waypoints).map_err(|error| (7, error))?;
        let (carry, lower) = whole.split(whole.time_nearest(above));
        let up = self.up(&low).map_err(|error| (8, error))?;
        let raise = empty.motion(ABOVE, &up).map_err(|error| (8, error))?;
        let top = up[up.len() - 1];
        let home = home(&self.done, &top, search).map_err(|error| (9, error))?;
        let home = self.done.motion(HOME, &home).map_err(|error| (9, error))?;
        let open_m = empty.open_m();
        let (closed, open) = ((self.closed_m(), self.closed_m()), (open_m, open_m));
        Ok(vec![
            Stage { phase: Phase::CarryBack, motion: carry, width_m: closed },
            Stage { phase: Phase::Lower, motion: lower, width_m: closed },
            fingers(empty, Phase::Release, &low, (self.closed_m(), open_m)),
            Stage { phase: Phase::Raise, motion: raise, width_m: open },
            Stage { phase: Phase::Return, motion: home, width_m: open },
        ])
    }

    /// Straight up from the grasp, clear of the object.
    fn up(&self, low: &Joints) -> Result<Vec<Joints>, PlanError> {
        let scene = &self.empty[0];
        let at = scene.chain.forward(low);
        let rise_m = still_to_lift_m(self.object, &at, scene.settings);
        let above = Translation3::new(0.0, 0.0, rise_m) * at;
        let line = scene.chain.line(low, &above);
        line.map_err(|line| PlanError::Line { at: ABOVE, limb: scene.limb, line })
    }

    fn closed_m(&self) -> f64 {
        self.carrying.arm.gripper.closed_on(self.grasp.width_m)
    }
}
