//! Candidates for fetching an object, cheapest first: limb, grasp and posture.

use super::error::{Furthest, PlanError};
use super::fetch::{ABOVE, GRASP, LIFT};
use super::planning_scene::PlanningScene;
use crate::kinematics::limb::Joints;
use crate::planning::grasp::{Grasp, GraspError, ObjectPose};
use crate::robot::Arm;

/// A limb, a grasp for it, and a clear posture above it.
#[derive(Clone, Copy)]
pub(crate) struct Choice<'a> {
    pub(crate) scene: &'a PlanningScene<'a>,
    pub(crate) grasp: Grasp,
    /// The posture.
    pub(crate) above: Joints,
    /// Number of the option that it is of.
    option: usize,
}

/// A grasp with a limb, and the postures above it.
struct Choosable<'a> {
    scene: &'a PlanningScene<'a>,
    grasp: Grasp,
    /// Those that wait, cheapest first.
    postures: std::vec::IntoIter<(f64, Joints)>,
    /// The one whose turn it is; none while it is tried.
    turn: Option<Turn>,
}

#[derive(Clone, Copy)]
struct Turn {
    /// A lower bound until its surroundings are checked.
    cost_s: f64,
    looked: bool,
    above: Joints,
}

/// All that can be tried.
pub(crate) struct Choices<'a>(Vec<Choosable<'a>>);

impl<'a> Choices<'a> {
    /// Every limb of `scenes` with every one of its `grasps` that it reaches; the others are added to
    /// `furthest`.
    pub(crate) fn new(
        grasps: impl Fn(&Arm) -> Result<Vec<Grasp>, GraspError>,
        scenes: &'a [PlanningScene<'a>],
        furthest: &mut Furthest,
    ) -> Self {
        let mut options = Vec::new();
        for scene in scenes {
            let grasps = grasps(scene.arm).unwrap_or_else(|error| {
                furthest.add(0, error.into());
                Vec::new()
            });
            for grasp in grasps {
                match scene.postures(&grasp.raised(scene.settings.hover_m), &scene.q) {
                    Ok(postures) => {
                        let postures = postures.into_iter();
                        let mut option = Choosable { scene, grasp, postures, turn: None };
                        option.advance();
                        options.push(option);
                    }
                    Err(missed) => {
                        let (limb, distance_m) = (scene.limb, missed.position_error_m);
                        furthest.add(0, PlanError::Unreachable { at: ABOVE, limb, distance_m });
                    }
                }
            }
        }
        Self(options)
    }

    /// Returns the cheapest choice that has not been tried. A grasp comes back with its next
    /// posture only after [`Choices::failed`].
    pub(crate) fn next(&mut self, furthest: &mut Furthest) -> Option<Choice<'a>> {
        loop {
            let turns = self.0.iter().enumerate().filter_map(|(i, own)| Some((i, own.turn?)));
            let (option, turn) = turns.min_by(|a, b| a.1.cost_s.total_cmp(&b.1.cost_s))?;
            let own = &mut self.0[option];
            let (scene, above) = (own.scene, turn.above);
            if turn.looked {
                own.turn = None;
                return Some(Choice { scene, grasp: own.grasp, above, option });
            }
            match scene.crowding_s(&above) {
                Ok(more_s) => {
                    own.turn = Some(Turn { cost_s: turn.cost_s + more_s, looked: true, above });
                }
                Err(gap) => {
                    furthest.add(1, PlanError::Blocked { at: ABOVE, limb: scene.limb, gap });
                    own.advance();
                }
            }
        }
    }

    /// The choice led nowhere: its grasp may be tried from another posture.
    pub(crate) fn failed(&mut self, choice: &Choice<'_>) {
        self.0[choice.option].advance();
    }
}

impl Choosable<'_> {
    fn advance(&mut self) {
        let next = self.postures.next();
        self.turn = next.map(|(cost_s, above)| Turn { cost_s, looked: false, above });
    }
}

impl<'a> Choice<'a> {
    /// Returns the way straight down to the grasp, which is clear, also upwards with the object:
    /// `carrying` it. Errors with how far the attempt came.
    pub(crate) fn descent(
        &self,
        carrying: &PlanningScene<'_>,
    ) -> Result<Vec<Joints>, (usize, PlanError)> {
        let (scene, limb) = (self.scene, self.scene.limb);
        if let Some(gap) = scene.blocked(&self.above) {
            return Err((1, PlanError::Blocked { at: ABOVE, limb, gap }));
        }
        let descent = scene.chain.line(&self.above, &self.grasp.gripper);
        let descent = descent.map_err(|line| (2, PlanError::Line { at: GRASP, limb, line }))?;
        if let Some(gap) = scene.blocked_along(&descent) {
            return Err((3, PlanError::Blocked { at: GRASP, limb, gap }));
        }
        match carrying.blocked_along(&descent) {
            Some(gap) => Err((4, PlanError::Blocked { at: LIFT, limb, gap })),
            None => Ok(descent),
        }
    }

    /// Returns the scene once the object is held.
    pub(crate) fn carrying(&self, object: &ObjectPose) -> PlanningScene<'a> {
        let in_gripper = object.in_gripper(&self.grasp.gripper, &self.scene.arm.gripper);
        self.scene.carrying(object, &in_gripper)
    }
}
