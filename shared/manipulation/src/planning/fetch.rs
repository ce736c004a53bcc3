//! The way of a held object to where it is handed over.

use std::f64::consts::PI;

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use super::error::PlanError;
use super::planning_scene::{PlanSettings, PlanningScene, Search};
use super::tilt::tilted_at;
use crate::kinematics::chain::Chain;
use crate::kinematics::limb::{Joints, Limb};

/// The carry from above the grasp to where the object is handed over.
#[derive(Clone, Debug)]
pub(crate) struct Carry {
    pub(crate) waypoints: Vec<Joints>,
    /// `true` if the waypoints are a straight line of the gripper, 5 mm apart.
    pub(crate) straight: bool,
}

/// Postures tried at the hand over for one turn.
const ENDS: usize = 3;

/// Turns about the vertical at the hand over: every 2°, the smallest first. Beside other objects a
/// wide one may have no more room than that.
const TURNS: usize = 180;

/// Turns tried at which what is held is clear of everything, and how far apart they are, radians.
const TURNS_TRIED: usize = 10;
const TURNS_APART_RAD: f64 = 0.3;

/// Heights above the handover position that are tried, metres, lowest first.
const RAISED_M: [f64; 4] = [0.0, 0.04, 0.08, 0.12];

pub(crate) const ABOVE: &str = "the place above the object";
pub(crate) const GRASP: &str = "the grasp";
pub(crate) const LIFT: &str = "the lift";
pub(crate) const HAND_OVER: &str = "the hand over";
pub(crate) const WITHDRAWAL: &str = "clear of what was handed over";
pub(crate) const HOME: &str = "the neutral posture";

impl PlanSettings {
    /// Returns whether a gripper at `tip_m` (frame `base`) is where `limb` hands objects over: at
    /// the place, or straight above it where a pick had to go higher; to within `within_m` metres.
    pub fn is_hand_over(&self, limb: Limb, tip_m: &Vector3<f64>, within_m: f64) -> bool {
        let place = Vector3::from(self.hand_over_m(limb));
        RAISED_M.iter().any(|up| (place + Vector3::z() * *up - tip_m).norm() < within_m)
    }
}

impl Carry {
    /// From `from` to the hand over, or straight above it where what is held or the hand would touch
    /// something there.
    pub(crate) fn find(
        scene: &PlanningScene<'_>,
        from: &Joints,
        search: Search,
    ) -> Result<Self, PlanError> {
        let [lowest, higher @ ..] = RAISED_M;
        let first = Self::to(scene, from, lowest, search);
        let Err(PlanError::Blocked { .. }) = first else { return first };
        let raised = higher.into_iter().find_map(|up| Self::to(scene, from, up, search).ok());
        raised.map_or(first, Ok)
    }

    /// To `raised_m` above the hand over, where what is held is upright: straight, else turned about
    /// the vertical and through joint space; of five joints tilted too.
    fn to(
        scene: &PlanningScene<'_>,
        from: &Joints,
        raised_m: f64,
        search: Search,
    ) -> Result<Self, PlanError> {
        let limb = scene.limb;
        let place = Vector3::from(scene.settings.hand_over_m(limb)) + Vector3::z() * raised_m;
        let rotation = scene.upright(&scene.chain.forward(from));
        let upright = Isometry3::from_parts(place.into(), rotation);
        if let Some(waypoints) = straight(scene, from, &upright) {
            return Ok(Self { waypoints, straight: true });
        }
        let mut error = None;
        let mut tried = Vec::with_capacity(TURNS_TRIED);
        for (turn, target) in targets(scene.chain, &upright) {
            if tried.iter().any(|other: &f64| (other - turn).abs() < TURNS_APART_RAD) {
                continue;
            }
            if let Some(gap) = scene.held_blocked(&target) {
                error.get_or_insert(PlanError::Blocked { at: HAND_OVER, limb, gap });
                continue;
            }
            let ends = match scene.postures(&target, from) {
                Ok(ends) => ends,
                Err(missed) => {
                    let distance_m = missed.position_error_m;
                    error.get_or_insert(PlanError::Unreachable { at: HAND_OVER, limb, distance_m });
                    continue;
                }
            };
            for (_, end) in ends.into_iter().take(ENDS) {
                match way_to_end(scene, from, &end, search) {
                    Ok(waypoints) => return Ok(Self { waypoints, straight: false }),
                    Err(blocked) => error = Some(blocked),
                }
            }
            if turn.abs() <= PI {
                tried.push(turn);
            }
            if tried.len() >= TURNS_TRIED {
                break;
            }
        }
        Err(error.unwrap_or(PlanError::NoPath { at: HAND_OVER, limb, gap: None }))
    }

    /// Returns the posture at the hand over.
    pub(crate) fn end(&self) -> &Joints {
        &self.waypoints[self.waypoints.len() - 1]
    }
}

/// Returns the upright gripper turned about the vertical, with the turns; of five joints tilted as well.
fn targets(chain: &Chain, upright: &Isometry3<f64>) -> impl Iterator<Item = (f64, Isometry3<f64>)> {
    let upright = *upright;
    let turned = move |turn: f64| {
        let rotation = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn) * upright.rotation;
        (turn, Isometry3::from_parts(upright.translation, rotation))
    };
    let tilted = chain.five().map(|arm| tilted_at(arm, &upright));
    (0..TURNS).map(turn_of).map(turned).chain(tilted.into_iter().flatten())
}

/// 0, then to either side further and further, radians.
fn turn_of(k: usize) -> f64 {
    let side = if k % 2 == 1 { 1.0 } else { -1.0 };
    side * k.div_ceil(2) as f64 * 2.0 * PI / TURNS as f64
}

/// Returns the way through joint space to a posture at the hand over.
fn way_to_end(
    scene: &PlanningScene<'_>,
    from: &Joints,
    end: &Joints,
    search: Search,
) -> Result<Vec<Joints>, PlanError> {
    if let Some(gap) = scene.blocked(end) {
        return Err(PlanError::Blocked { at: HAND_OVER, limb: scene.limb, gap });
    }
    scene.way(from, end, search).ok_or_else(|| scene.no_path(HAND_OVER, from, end))
}

fn straight(
    scene: &PlanningScene<'_>,
    from: &Joints,
    target: &Isometry3<f64>,
) -> Option<Vec<Joints>> {
    let waypoints = scene.chain.line(from, target).ok()?;
    scene.blocked_along(&waypoints).is_none().then_some(waypoints)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_object_is_handed_over_at_the_place_or_straight_above_it() {
        let settings = PlanSettings::default();
        for limb in Limb::BOTH {
            let place = Vector3::from(settings.hand_over_m(limb));
            let is_there = |x: f64, y: f64, z: f64| {
                settings.is_hand_over(limb, &(place + Vector3::new(x, y, z)), 0.005)
            };
            assert!(is_there(0.0, 0.0, 0.0) && is_there(0.001, -0.001, 0.08));
            assert!(!is_there(0.02, 0.0, 0.08) && !is_there(0.0, 0.0, -0.02));
            assert!(!is_there(0.0, 0.0, 0.3));
        }
    }
}
