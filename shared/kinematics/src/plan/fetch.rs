//! One grasp tried with one limb: where the arm would be above it, on the way down and at the
//! hand over.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use super::error::PlanError;
use super::situation::{Search, Situation};
use crate::grasp::Grasp;
use crate::limb::Joints;

/// How the arm holds the object: postures above the grasp and on the straight way down to it.
#[derive(Clone, Debug)]
pub(crate) struct Hold {
    /// From above the grasp down to it.
    pub(crate) descent: Vec<Joints>,
}

/// The carry from above the grasp to where the object is handed over.
#[derive(Clone, Debug)]
pub(crate) struct Carry {
    pub(crate) waypoints: Vec<Joints>,
    /// Whether the waypoints are a straight line of the gripper, 5 mm apart.
    pub(crate) straight: bool,
}

/// Postures tried for one pose of the gripper when the nearest is not clear.
const ALTERNATIVES: usize = 12;

/// Turns about the vertical tried for the hand over, radians, the unturned first.
const TURNS: [f64; 8] = [0.0, 0.5, -0.5, 1.0, -1.0, 2.0, -2.0, 3.0];

pub(crate) const ABOVE: &str = "the place above the object";
pub(crate) const GRASP: &str = "the grasp";
pub(crate) const HAND_OVER: &str = "the hand over";
pub(crate) const HOME: &str = "the neutral posture";

impl Hold {
    /// Holds `grasp` coming down from `above`, the posture nearest to the present one, or from one
    /// of the alternatives to it. Errors with how far the best attempt came.
    pub(crate) fn try_from_above(
        situation: &Situation<'_>,
        grasp: &Grasp,
        above: &Joints,
    ) -> Result<Self, (usize, PlanError)> {
        let nearest = Self::down(situation, grasp, above);
        let Err(mut furthest) = nearest else { return nearest };
        let target = grasp.raised(situation.settings.hover_m);
        for q in alternatives(situation, &target) {
            match Self::down(situation, grasp, &q) {
                Ok(hold) => return Ok(hold),
                Err(error) if error.0 > furthest.0 => furthest = error,
                Err(_) => {}
            }
        }
        Err(furthest)
    }

    fn down(
        situation: &Situation<'_>,
        grasp: &Grasp,
        above: &Joints,
    ) -> Result<Self, (usize, PlanError)> {
        let limb = situation.limb;
        if let Some(gap) = situation.blocked(above) {
            return Err((1, PlanError::Blocked { at: ABOVE, limb, gap }));
        }
        let descent = situation
            .chain
            .line(above, &grasp.gripper)
            .map_err(|line| (2, PlanError::Line { at: GRASP, limb, line }))?;
        match situation.blocked_along(&descent) {
            Some(gap) => Err((3, PlanError::Blocked { at: GRASP, limb, gap })),
            None => Ok(Self { descent }),
        }
    }

    /// The posture above the grasp.
    pub(crate) fn above(&self) -> &Joints {
        &self.descent[0]
    }

    /// The posture at the grasp.
    pub(crate) fn grasp(&self) -> &Joints {
        &self.descent[self.descent.len() - 1]
    }
}

impl Carry {
    /// From `from` to the hand over: straight with the gripper's orientation kept, else turned
    /// about the vertical and through joint space.
    pub(crate) fn find(
        situation: &Situation<'_>,
        from: &Joints,
        search: Search,
    ) -> Result<Self, PlanError> {
        let limb = situation.limb;
        let held = situation.chain.forward(from);
        let target = |turn: f64| {
            let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn);
            let place = Vector3::from(situation.settings.hand_over_m(limb));
            Isometry3::from_parts(place.into(), turn * held.rotation)
        };
        if let Some(waypoints) = straight(situation, from, &target(0.0)) {
            return Ok(Self { waypoints, straight: true });
        }
        let mut error = None;
        for turn in TURNS {
            match situation.chain.nearest(&target(turn), from) {
                Err(missed) => {
                    let distance_m = missed.position_error_m;
                    error.get_or_insert(PlanError::Unreachable { at: HAND_OVER, limb, distance_m });
                }
                Ok(end) => match situation.blocked(&end.q) {
                    Some(gap) => error = Some(PlanError::Blocked { at: HAND_OVER, limb, gap }),
                    None => match situation.way(from, &end.q, search) {
                        Some(waypoints) => return Ok(Self { waypoints, straight: false }),
                        None => error = Some(PlanError::NoWay { at: HAND_OVER, limb }),
                    },
                },
            }
        }
        Err(error.unwrap_or(PlanError::NoWay { at: HAND_OVER, limb }))
    }

    /// The posture at the hand over.
    pub(crate) fn end(&self) -> &Joints {
        &self.waypoints[self.waypoints.len() - 1]
    }
}

fn straight(
    situation: &Situation<'_>,
    from: &Joints,
    target: &Isometry3<f64>,
) -> Option<Vec<Joints>> {
    let waypoints = situation.chain.line(from, target).ok()?;
    situation.blocked_along(&waypoints).is_none().then_some(waypoints)
}

/// Clear postures for a pose, nearest to the present one first.
pub(crate) fn alternatives(situation: &Situation<'_>, target: &Isometry3<f64>) -> Vec<Joints> {
    let mut all = situation.chain.solutions(target);
    let seconds = |q: &Joints| situation.seconds_between(&situation.q, q);
    all.sort_by(|a, b| seconds(a).total_cmp(&seconds(b)));
    // Neighbours on one branch fare alike: every third keeps the choice wide.
    all.into_iter().step_by(3).filter(|q| situation.clear(q)).take(ALTERNATIVES).collect()
}
