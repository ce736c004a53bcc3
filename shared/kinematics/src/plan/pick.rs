//! Fetching an object: approach, close, lift, hand over, release, return.

use nalgebra::Isometry3;
use serde::{Deserialize, Serialize};

use super::deliver::{CORNER, deliver, fingers};
use super::error::{Furthest, PlanError};
use super::fetch::{ABOVE, Carry, GRASP, Hold};
use super::situation::{Arms, PlanSettings, Search, Situation};
use crate::grasp::{Grasp, ObjectPose};
use crate::gripper;
use crate::inverse::IkSolution;
use crate::limb::{Joints, Limb};
use crate::robot::Robot;
use crate::shape::Cuboid;
use crate::timeline::{Moment, Stage, Timeline};
use crate::trajectory::{Trajectory, refuse_outside};

/// The stages of a pick, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PickPhase {
    /// To above the object and straight down to it, fingers opening.
    Approach,
    /// The fingers close.
    Close,
    /// Straight up.
    Lift,
    /// To where the person takes the object.
    HandOver,
    /// The fingers open.
    Release,
    /// Back to the neutral posture.
    Return,
}

/// A pick, from the arm's present posture to neutral, checked along its whole length.
#[derive(Clone, Debug, PartialEq)]
pub struct PickPlan {
    /// The stages in time.
    pub timeline: Timeline<PickPhase>,
    /// How the object is held; none for a plan that only returns.
    pub grasp: Option<Grasp>,
    /// The object's pose in the gripper's frame from the end of `Close` to the start of `Release`.
    pub object_in_gripper: Isometry3<f64>,
}

impl PickPlan {
    /// The limb that fetches.
    pub fn limb(&self) -> Limb {
        self.timeline.limb()
    }

    /// How long the whole takes, seconds.
    pub fn duration_s(&self) -> f64 {
        self.timeline.duration_s()
    }

    /// The state `t_s` seconds after the start.
    pub fn at(&self, t_s: f64) -> Moment<PickPhase> {
        self.timeline.at(t_s)
    }

    /// Whether the object moves with the gripper in this phase.
    pub fn carries(phase: PickPhase) -> bool {
        matches!(phase, PickPhase::Lift | PickPhase::HandOver)
    }
}

/// Choices tried to the end; they are ranked by how soon the arm could be there.
const TRIES: usize = 16;

/// Complete plans among which the shortest is taken.
const COMPARED: usize = 5;

/// Plans to fetch `object` with the arms at `arms`: with `limb`, or with the one that is there
/// sooner. `others` is everything else that stands around; none of it is touched.
///
/// # Errors
/// [`PlanError`] of the attempt that came furthest.
pub fn plan_pick(
    robot: &Robot,
    object: &ObjectPose,
    limb: Option<Limb>,
    arms: &Arms,
    others: &[Cuboid],
    settings: &PlanSettings,
) -> Result<PickPlan, PlanError> {
    let situations = situations(robot, object, limb, arms, others, settings)?;
    let mut furthest = Furthest::default();
    let choices = choices(object, &situations, &mut furthest)?;
    for search in [Search::No, Search::Yes] {
        let plans = choices.iter().filter_map(|choice| {
            let tried = choice.plan(object, search);
            tried.map_err(|(progress, error)| furthest.add(progress, error)).ok()
        });
        let compared = if search == Search::No { COMPARED } else { 1 };
        let shortest =
            plans.take(compared).min_by(|a, b| a.duration_s().total_cmp(&b.duration_s()));
        if let Some(plan) = shortest {
            return Ok(plan);
        }
    }
    Err(furthest.report())
}

pub(crate) fn situations<'a>(
    robot: &'a Robot,
    object: &ObjectPose,
    limb: Option<Limb>,
    arms: &Arms,
    others: &[Cuboid],
    settings: &'a PlanSettings,
) -> Result<Vec<Situation<'a>>, PlanError> {
    let mut limbs: Vec<Limb> =
        Limb::BOTH.into_iter().filter(|side| limb.is_none_or(|limb| limb == *side)).collect();
    // The arm on the object's own side first.
    limbs.sort_by(|a, b| (b.side() * object.xyz_m[1]).total_cmp(&(a.side() * object.xyz_m[1])));
    limbs.into_iter().map(|limb| situation(robot, object, limb, arms, others, settings)).collect()
}

pub(crate) fn situation<'a>(
    robot: &'a Robot,
    object: &ObjectPose,
    limb: Limb,
    arms: &Arms,
    others: &[Cuboid],
    settings: &'a PlanSettings,
) -> Result<Situation<'a>, PlanError> {
    refuse_outside(robot.arm(limb).chain.limits(), arms.of(limb))?;
    let bottom = object.bottom_z_m();
    let situation = Situation::new(robot, limb, arms, others, (object.xyz_m, bottom), settings);
    Ok(situation.with_board_under(&object.cuboid()))
}

/// A grasp, the limb for it, and the posture above it that is nearest to the present one.
pub(crate) struct Choice<'a> {
    pub(crate) situation: &'a Situation<'a>,
    grasp: Grasp,
    above: Joints,
    seconds: f64,
}

/// The reachable choices, soonest first.
fn choices<'a>(
    object: &ObjectPose,
    situations: &'a [Situation<'a>],
    furthest: &mut Furthest,
) -> Result<Vec<Choice<'a>>, PlanError> {
    let grasps = object.grasps()?;
    let mut choices = Vec::new();
    for situation in situations {
        for grasp in &grasps {
            match Choice::new(situation, *grasp) {
                Ok(choice) => choices.push(choice),
                Err((progress, error)) => furthest.add(progress, error),
            }
        }
    }
    choices.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    choices.truncate(TRIES);
    Ok(choices)
}

impl<'a> Choice<'a> {
    pub(crate) fn new(
        situation: &'a Situation<'a>,
        grasp: Grasp,
    ) -> Result<Self, (usize, PlanError)> {
        let above = grasp.raised(situation.settings.hover_m);
        match situation.chain.nearest(&above, &situation.q) {
            Ok(IkSolution { q, .. }) => {
                let seconds = situation.seconds_between(&situation.q, &q);
                Ok(Self { situation, grasp, above: q, seconds })
            }
            Err(missed) => {
                let (limb, distance_m) = (situation.limb, missed.position_error_m);
                Err((0, PlanError::Unreachable { at: ABOVE, limb, distance_m }))
            }
        }
    }

    pub(crate) fn hold(&self) -> Result<Hold, (usize, PlanError)> {
        Hold::try_from_above(self.situation, &self.grasp, &self.above)
    }

    pub(crate) fn carry(&self, hold: &Hold, search: Search) -> Result<Carry, (usize, PlanError)> {
        Carry::find(self.situation, hold.above(), search).map_err(|error| (4, error))
    }

    fn plan(&self, object: &ObjectPose, search: Search) -> Result<PickPlan, (usize, PlanError)> {
        let situation = self.situation;
        let hold = self.hold()?;
        let limb = situation.limb;
        let way = situation
            .way(&situation.q, hold.above(), search)
            .ok_or_else(|| (5, situation.no_way(ABOVE)))?;
        let width_m = gripper::closed_on(self.grasp.width_m);
        let lift: Vec<Joints> = hold.descent.iter().rev().copied().collect();
        let delivery = deliver(situation, lift, width_m, search).map_err(|error| (4, error))?;
        let approach = approach(situation, &way, &hold).map_err(|error| (6, error))?;
        let open_m = situation.settings.open_width_m;
        let mut stages = vec![
            Stage { phase: PickPhase::Approach, motion: approach, width_m: (open_m, open_m) },
            fingers(situation, PickPhase::Close, hold.grasp(), (open_m, width_m)),
        ];
        stages.extend(delivery);
        Ok(PickPlan {
            timeline: Timeline::new(limb, stages),
            grasp: Some(self.grasp),
            object_in_gripper: self.grasp.object_in_gripper(object),
        })
    }
}

/// To above the grasp and straight down in one motion, with no stop between.
fn approach(
    situation: &Situation<'_>,
    way: &[Joints],
    hold: &Hold,
) -> Result<Trajectory, PlanError> {
    let mut waypoints = way.to_vec();
    waypoints.extend(hold.descent.iter().skip(CORNER.min(hold.descent.len() - 1)));
    situation.motion(GRASP, &waypoints)
}
