//! Closed form of arms with five joints: pan, three parallel joints across it, and roll about the approach.
//!
//! The approach lies in the plane of the three parallel joints, which the pan joint turns. So a position leaves the
//! approach its elevation and its roll; straight down or up, where a plane through the approach may be turned, every
//! yaw of the gripper is possible. Any other approach is missed by an angle.
//!
//! Pan follows from the component of the tip along the parallel axes, which only the roll changes; the rest is a
//! triangle. An approach that is a little off the plane, since a description rounds its angles, is taken as it is: the
//! position is exact.

use nalgebra::{Isometry3, Point3, Unit, UnitQuaternion, Vector3};

use super::six::{Found, angle_between, triangle, turned, turns, within_half_turn};
use super::zero::{Axis, ZeroPosture};

/// Deviations from the family that its descriptions have, radians.
const SKEW: f64 = 1e-4;

/// Sine of the angle to the vertical below which an approach is vertical.
const VERTICAL: f64 = 1e-4;

/// An arm of the family in its zero posture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Five {
    axes: [Axis; 5],
    tool: Isometry3<f64>,
    /// The pan axis, upwards.
    up: Axis,
    /// The parallel axes, through the pan axis.
    across: Axis,
    /// The axis of the last joint, in the sense of the tool's z axis.
    approach: Vector3<f64>,
}

impl Five {
    /// Returns the closed form of an arm with five joints, if it belongs to the family.
    pub(crate) fn of(posture: &ZeroPosture) -> Option<Self> {
        let mut axes: [Axis; 5] = posture.axes[..5].try_into().ok()?;
        let [pan, along, .., roll] = axes;
        let is_parallel = |axis: &Axis| axis.direction.cross(&along.direction).norm() < SKEW;
        let is_across = |axis: &Axis| axis.direction.dot(&along.direction).abs() < SKEW;
        let fits =
            is_parallel(&axes[2]) && is_parallel(&axes[3]) && is_across(&pan) && is_across(&roll);
        for axis in &mut axes[2..4] {
            axis.direction = along.direction * axis.direction.dot(&along.direction).signum();
        }
        let direction = if pan.direction.z < 0.0 { -pan.direction } else { pan.direction };
        let across = Axis { point: pan.point, ..along };
        let sense = roll.direction.dot(&(posture.tool.rotation * Vector3::z()));
        let approach = if sense < 0.0 { -roll.direction } else { roll.direction };
        let up = Axis { direction, ..pan };
        fits.then_some(Self { axes, tool: posture.tool, up, across, approach })
    }

    /// Returns every posture that takes the tool to `target`, each joint from −π to π. One whose approach is off the
    /// arm's plane has the right position.
    pub(crate) fn postures(&self, target: &Isometry3<f64>) -> Vec<Found> {
        let ([pan, .., roll], across) = (&self.axes, &self.across.direction);
        let on_roll = target * self.tool.inverse() * Point3::from(roll.point);
        let side = across.dot(&(roll.point - pan.point));
        let hand = target.rotation * self.tool.rotation.inverse();
        let mut found = Vec::with_capacity(8);
        for turn in turns(pan, &(on_roll.coords - pan.point), across, side).0 {
            let rest = turned(pan, turn).rotation * hand;
            let pitch = angle_between(&roll.direction, &(rest * roll.direction), across);
            let rolled = angle_between(across, &(rest.inverse() * across), &roll.direction);
            let (Some(pitch), Some(rolled)) = (pitch, rolled) else { continue };
            // The position decides about the pan joint, to the last bit.
            let (again, _) = self.pans(&target.translation.vector, -rolled);
            let off = |own: &f64| within_half_turn(own - turn).abs();
            let Some(turn) = again.into_iter().min_by(|a, b| off(a).total_cmp(&off(b))) else {
                continue;
            };
            found.extend(self.in_plane(&target.translation.vector, turn, pitch, -rolled));
        }
        found
    }

    /// Returns every posture with the tip at a point in `base`, the approach at an elevation above the horizon, and the
    /// last joint at `roll`; radians.
    pub(crate) fn reach(&self, at: &Vector3<f64>, elevation: f64, roll: f64) -> Vec<Found> {
        let (pitches, rises) =
            turns(&self.across, &self.approach, &self.up.direction, elevation.sin());
        let (pans, near) = self.pans(at, roll);
        let all = pans.iter().flat_map(|pan| pitches.iter().map(move |pitch| (*pan, *pitch)));
        let all = all.filter(|_| near && rises);
        all.flat_map(|(pan, pitch)| self.in_plane(at, pan, pitch, roll)).collect()
    }

    /// Returns the turns about the vertical after which the arm can hold the rotation of a gripper with a `point` of
    /// its frame `at` a place; none where it can hold all, straight up or down.
    pub(crate) fn yaws(
        &self,
        at: &Vector3<f64>,
        rotation: &UnitQuaternion<f64>,
        point: &Vector3<f64>,
    ) -> Option<Vec<f64>> {
        let level = self.up.direction.cross(&self.approach_of(rotation));
        let level = level.try_normalize(VERTICAL)?;
        let roll = self.tool.inverse() * Point3::from(self.axes[4].point);
        let from_roll = rotation * (point - roll.coords);
        let side = self.across.direction.dot(&(self.axes[4].point - self.axes[0].point));
        let both = [side, -side].map(|side| {
            let goal = side + level.dot(&from_roll);
            let (turns, near) = turns(&self.up, &level, &(at - self.up.point), goal);
            turns.into_iter().filter(move |_| near)
        });
        Some(both.into_iter().flatten().map(within_half_turn).collect())
    }

    /// Returns whether the last joint turns about the tool's z axis.
    pub(crate) fn approaches(&self) -> bool {
        (self.tool.rotation * Vector3::z()).dot(&self.approach) > 1.0 - SKEW
    }

    /// Returns the approach of a gripper of this rotation.
    pub(crate) fn approach_of(&self, rotation: &UnitQuaternion<f64>) -> Vector3<f64> {
        rotation * self.tool.rotation.inverse() * self.approach
    }

    /// Returns the turns that take a point into the plane of the tip with the last joint at `roll`, and whether any
    /// does.
    fn pans(&self, at: &Vector3<f64>, roll: f64) -> (Vec<f64>, bool) {
        let (pan, across) = (&self.axes[0], &self.across.direction);
        let side = across.dot(&(self.hand(roll) - pan.point));
        turns(pan, &(at - pan.point), across, side)
    }

    /// Returns the tip with nothing but the last joint turned.
    fn hand(&self, roll: f64) -> Vector3<f64> {
        (turned(&self.axes[4], roll) * self.tool).translation.vector
    }

    /// Returns the postures once a turn takes the tip into the plane: the three parallel joints turn by `pitch`
    /// together.
    fn in_plane(
        &self,
        at: &Vector3<f64>,
        turn: f64,
        pitch: f64,
        roll: f64,
    ) -> impl Iterator<Item = Found> {
        let [pan, second, third, fourth, _] = &self.axes;
        let along = Unit::new_unchecked(self.across.direction);
        let pitched = UnitQuaternion::from_axis_angle(&along, pitch);
        let at = (turned(pan, turn) * Point3::from(*at)).coords;
        let wrist = at - pitched * (self.hand(roll) - fourth.point);
        let sense = |axis: &Axis| axis.direction.dot(&along);
        let (of_third, of_fourth) = (sense(third), sense(fourth));
        triangle(second, third, &fourth.point, &wrist).map(move |(second, third, reaches)| {
            let fourth = of_fourth * (pitch - second - of_third * third);
            let all = [-turn, second, third, fourth, roll, 0.0, 0.0];
            Found { q: all.map(within_half_turn), reaches }
        })
    }
}
