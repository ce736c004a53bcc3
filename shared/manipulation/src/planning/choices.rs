//! Candidates for fetching an object, cheapest first: limb, grasp and posture.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::error::{Furthest, PlanError};
use super::fetch::{ABOVE, Hold, LIFT};
use super::planning_scene::PlanningScene;
use crate::kinematics::limb::Joints;
use crate::planning::grasp::{Grasp, GraspError, ObjectPose};

/// A limb, a grasp for it, and a clear posture above it.
#[derive(Clone, Copy)]
pub(crate) struct Choice<'a> {
    pub(crate) scene: &'a PlanningScene<'a>,
    pub(crate) grasp: Grasp,
    above: Joints,
    at: At,
}

/// Number of an option and of one of its postures.
#[derive(Clone, Copy)]
struct At {
    option: usize,
    posture: usize,
}

/// A grasp with a limb, and the postures above it, cheapest first.
struct Choosable<'a> {
    scene: &'a PlanningScene<'a>,
    grasp: Grasp,
    postures: Vec<(f64, Joints)>,
}

/// All that can be tried, in order of cost.
pub(crate) struct Choices<'a> {
    options: Vec<Choosable<'a>>,
    queue: BinaryHeap<Waiting>,
}

/// A posture that waits for its turn.
struct Waiting {
    /// A lower bound until its surroundings are checked.
    cost_s: f64,
    looked: bool,
    at: At,
}

impl<'a> Choices<'a> {
    /// Every limb of `scenes` with every grasp of `object` that it reaches; the others are
    /// added to `furthest`.
    pub(crate) fn new(
        object: &ObjectPose,
        scenes: &'a [PlanningScene<'a>],
        furthest: &mut Furthest,
    ) -> Result<Self, GraspError> {
        let grasps = object.grasps()?;
        let mut choices = Self { options: Vec::new(), queue: BinaryHeap::new() };
        for scene in scenes {
            for grasp in &grasps {
                let above = grasp.raised(scene.settings.hover_m);
                match scene.postures(&above, &scene.q) {
                    Ok(postures) => {
                        let option = choices.options.len();
                        choices.options.push(Choosable { scene, grasp: *grasp, postures });
                        choices.wait(At { option, posture: 0 });
                    }
                    Err(missed) => {
                        let (limb, distance_m) = (scene.limb, missed.position_error_m);
                        furthest.add(0, PlanError::Unreachable { at: ABOVE, limb, distance_m });
                    }
                }
            }
        }
        Ok(choices)
    }

    /// Returns the cheapest choice that has not been tried. A grasp comes back with its next
    /// posture only after [`Choices::failed`].
    pub(crate) fn next(&mut self, furthest: &mut Furthest) -> Option<Choice<'a>> {
        while let Some(Waiting { cost_s, looked, at }) = self.queue.pop() {
            let Choosable { scene, grasp, postures } = &self.options[at.option];
            let (scene, above) = (*scene, postures[at.posture].1);
            if looked {
                return Some(Choice { scene, grasp: *grasp, above, at });
            }
            match scene.crowding_s(&above) {
                Ok(more_s) => {
                    self.queue.push(Waiting { cost_s: cost_s + more_s, looked: true, at });
                }
                Err(gap) => {
                    let limb = scene.limb;
                    furthest.add(1, PlanError::Blocked { at: ABOVE, limb, gap });
                    self.wait(at.next());
                }
            }
        }
        None
    }

    /// The choice led nowhere: its grasp may be tried from another posture.
    pub(crate) fn failed(&mut self, choice: &Choice<'_>) {
        self.wait(choice.at.next());
    }

    fn wait(&mut self, at: At) {
        if let Some((cost_s, _)) = self.options[at.option].postures.get(at.posture) {
            self.queue.push(Waiting { cost_s: *cost_s, looked: false, at });
        }
    }
}

impl<'a> Choice<'a> {
    /// Straight down to the grasp, and straight up again with the object: `carrying` it.
    pub(crate) fn hold(&self, carrying: &PlanningScene<'_>) -> Result<Hold, (usize, PlanError)> {
        let hold = Hold::down(self.scene, &self.grasp, &self.above)?;
        match carrying.blocked_along(&hold.descent) {
            Some(gap) => Err((4, PlanError::Blocked { at: LIFT, limb: carrying.limb, gap })),
            None => Ok(hold),
        }
    }

    /// Returns the scene once the object is held.
    pub(crate) fn carrying(&self, object: &ObjectPose) -> PlanningScene<'a> {
        self.scene.carrying(object, &self.grasp.object_in_gripper(object))
    }
}

impl At {
    fn next(self) -> Self {
        Self { posture: self.posture + 1, ..self }
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Waiting {}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The cheapest is the greatest, so that it is the first of a heap; ties go by number.
impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        let number = |waiting: &Self| (waiting.at.option, waiting.at.posture);
        other.cost_s.total_cmp(&self.cost_s).then_with(|| number(other).cmp(&number(self)))
    }
}
