//! Closed form of arms with six joints: all postures that reach a pose.
//!
//! Two families cover most arms that are built. In both the second and the third axis are parallel.
//!
//! * `Elbow`: the fourth is parallel to them as well, and the fifth and the sixth meet (Universal
//!   Robots).
//! * `Wrist`: the last three axes meet (most industrial arms).
//!
//! The first joint follows from the component of the wrist point along the second axis, which the
//! joints behind it cannot change; the rest are rotations of one vector into another and a triangle
//! (Paden 1986; Elias and Wen, *IK-Geo*, 2022). An arm that deviates a little from its family, as one
//! with calibrated joint frames does, is solved as if it did not; refinement does the rest.

use std::f64::consts::TAU;

use nalgebra::{Isometry3, Rotation3, Unit, UnitQuaternion, Vector3};

use super::zero::{Axis, ZeroPosture};
use crate::kinematics::limb::Joints;

/// Deviations from a family that refinement removes, radians and metres.
const SKEW: f64 = 0.01;
const OFFSET_M: f64 = 0.002;

/// The same of an arm that the closed form solves by itself.
const EXACT: f64 = 1e-9;

/// Sine of the fifth joint below which the wrist counts as straight, and distance below which a point
/// counts as on an axis, metres.
const STRAIGHT: f64 = 1e-3;
const ON_AXIS_M: f64 = 1e-3;

/// Length of a projection below which its direction means nothing.
const SINGULAR: f64 = 1e-7;

/// Excess over reach, as a share of it, that still counts as stretched.
const STRETCHED: f64 = 1e-6;

/// An arm of one of the families in its zero posture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Six {
    axes: [Axis; 6],
    /// Inverse of the tool's pose.
    untool: Isometry3<f64>,
    /// The wrist point.
    wrist: Vector3<f64>,
    /// `true` for `Elbow`.
    elbow: bool,
    /// `true` if the arm does not deviate from its family.
    exact: bool,
}

/// A posture, and whether it reaches the target. One that does not is stretched towards it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub(crate) q: Joints,
    pub(crate) reaches: bool,
}

impl Six {
    /// Returns the closed form of an arm with six joints, if it belongs to a family.
    pub(crate) fn of(posture: &ZeroPosture) -> Option<Self> {
        let mut axes: [Axis; 6] = posture.axes[..6].try_into().ok()?;
        let skew = |a: &Axis, b: &Axis| a.direction.cross(&b.direction).norm();
        let parallel = |a: &Axis, b: &Axis| skew(a, b) < SKEW;
        if !parallel(&axes[1], &axes[2]) || skew(&axes[0], &axes[1]) < 0.1 {
            return None;
        }
        let wrist = meeting(&axes[4], &axes[5])?;
        let elbow = parallel(&axes[1], &axes[3]);
        let off = |axis: &Axis| (axis.foot(&wrist) - wrist).norm();
        if !elbow && (off(&axes[3]) > OFFSET_M || parallel(&axes[3], &axes[4])) {
            return None;
        }
        let fourth = if elbow { skew(&axes[1], &axes[3]) } else { off(&axes[3]) };
        let deviations = [skew(&axes[1], &axes[2]), off(&axes[4]), off(&axes[5]), fourth];
        let exact = deviations.iter().all(|deviation| *deviation < EXACT);
        // Exactly parallel from here on, in the sense in which each turns.
        let along = axes[1].direction;
        for axis in axes[2..].iter_mut().take(if elbow { 2 } else { 1 }) {
            axis.direction = along * axis.direction.dot(&along).signum();
        }
        Some(Self { axes, untool: posture.tool.inverse(), wrist, elbow, exact })
    }

    /// Returns whether [`Six::postures`] are all that there are, with `q` one of them: not if the arm
    /// deviates from its family, nor if some joints can turn against each other, as with a straight wrist.
    pub(crate) fn is_isolated(&self, q: &Joints) -> bool {
        let [first, second, third, fourth, fifth, sixth] = &self.axes;
        let last = turned(fifth, q[4]).rotation * sixth.direction;
        let corner = if self.elbow { fourth.point } else { self.wrist };
        let corner = turned(second, q[1]) * turned(third, q[2]) * nalgebra::Point3::from(corner);
        let off = |axis: &Axis| (axis.foot(&corner.coords) - corner.coords).norm() > ON_AXIS_M;
        let is_bent = fourth.direction.cross(&last).norm() > STRAIGHT;
        self.exact && is_bent && off(second) && (self.elbow || off(first))
    }

    /// Returns every posture that takes the tool to `target`, each joint from −π to π. Where the last
    /// joint is free it stands at `last_rad`.
    pub(crate) fn postures(&self, target: &Isometry3<f64>, last_rad: f64) -> Vec<Found> {
        let whole = target * self.untool;
        let along = self.axes[1].direction;
        let mut found = Vec::with_capacity(8);
        let (first, from) = (&self.axes[0], whole * nalgebra::Point3::from(self.wrist));
        let goal = along.dot(&(self.wrist - first.point));
        // The first joint backwards takes the wrist point to where the others leave its component.
        let (turns, near) = turns(first, &(from.coords - first.point), &along, goal);
        for turn in turns {
            let rest = turned(first, turn) * whole;
            let mut add = |q: [f64; 5], reaches: bool| {
                let all = [-turn, q[0], q[1], q[2], q[3], q[4], 0.0];
                found.push(Found { q: all.map(within_half_turn), reaches: near && reaches });
            };
            if self.elbow {
                self.elbow(&rest, last_rad, &mut add);
            } else {
                self.wrist(&rest, last_rad, &mut add);
            }
        }
        found
    }

    fn elbow(&self, rest: &Isometry3<f64>, last_rad: f64, add: &mut impl FnMut([f64; 5], bool)) {
        let along = self.axes[1].direction;
        for (fifth, sixth, near) in self.last_two(&along, &rest.rotation, last_rad) {
            let before =
                rest * (turned(&self.axes[4], fifth) * turned(&self.axes[5], sixth)).inverse();
            let sum = angle_of(&before.rotation, &along);
            let corner = self.axes[3].point;
            let at = before * nalgebra::Point3::from(corner);
            let sense = |joint: usize| self.axes[joint].direction.dot(&along);
            for (second, third, reaches) in
                triangle(&self.axes[1], &self.axes[2], &corner, &at.coords)
            {
                let fourth = sense(3) * (sum - second - sense(2) * third);
                add([second, third, fourth, fifth, sixth], near && reaches);
            }
        }
    }

    fn wrist(&self, rest: &Isometry3<f64>, last_rad: f64, add: &mut impl FnMut([f64; 5], bool)) {
        let at = rest * nalgebra::Point3::from(self.wrist);
        let along = self.axes[3].direction;
        for (second, third, reaches) in
            triangle(&self.axes[1], &self.axes[2], &self.wrist, &at.coords)
        {
            let before = turned(&self.axes[1], second) * turned(&self.axes[2], third);
            let hand = before.rotation.inverse() * rest.rotation;
            for (fifth, sixth, near) in self.last_two(&along, &hand, last_rad) {
                let last = turned(&self.axes[4], fifth) * turned(&self.axes[5], sixth);
                let fourth = angle_of(&(hand * last.rotation.inverse()), &along);
                add([second, third, fourth, fifth, sixth], near && reaches);
            }
        }
    }

    /// Returns fifth and sixth joint that leave `along` where the rotation `hand`, seen from the last
    /// link, has it.
    fn last_two(
        &self,
        along: &Vector3<f64>,
        hand: &UnitQuaternion<f64>,
        last_rad: f64,
    ) -> impl Iterator<Item = (f64, f64, bool)> {
        let (fifth, sixth) = (self.axes[4], self.axes[5]);
        let goal = along.dot(&(hand * sixth.direction));
        let (turns, near) = turns(&fifth, &sixth.direction, along, goal);
        let seen = hand.inverse() * along;
        let along = *along;
        turns.into_iter().map(move |turn| {
            let before = turned(&fifth, turn).rotation.inverse() * along;
            let last = angle_between(&before, &seen, &sixth.direction).map_or(last_rad, |a| -a);
            (turn, last, near)
        })
    }
}

/// Returns the turns of two parallel axes that take the point `corner`, carried by the second, to `at`.
pub(super) fn triangle(
    first: &Axis,
    second: &Axis,
    corner: &Vector3<f64>,
    at: &Vector3<f64>,
) -> impl Iterator<Item = (f64, f64, bool)> + use<> {
    let along = first.direction;
    let flat = |v: Vector3<f64>| v - along * along.dot(&v);
    let upper = flat(second.point - first.point);
    let lower = flat(corner - second.point);
    let goal = flat(at - first.point);
    let square = 0.5 * (goal.norm_squared() - upper.norm_squared() - lower.norm_squared());
    let (turns, near) = turns(second, &lower, &upper, square);
    let second = *second;
    turns.into_iter().map(move |turn| {
        let reached = upper + turned(&second, turn).rotation * lower;
        (angle_between(&reached, &goal, &along).unwrap_or(0.0), turn, near)
    })
}

/// Returns the point where two axes meet, if they do and are not parallel.
fn meeting(a: &Axis, b: &Axis) -> Option<Vector3<f64>> {
    let normal = a.direction.cross(&b.direction);
    if normal.norm() < 0.1 {
        return None;
    }
    let between = b.point - a.point;
    let along = between.cross(&b.direction).dot(&normal) / normal.norm_squared();
    let here = a.point + a.direction * along;
    let there = b.foot(&here);
    ((here - there).norm() < OFFSET_M).then_some((here + there) * 0.5)
}

/// Returns the turns about `axis` after which the component of `v` along `direction` is `goal`, and
/// whether there are any. If not, the turn that comes nearest.
pub(super) fn turns(
    axis: &Axis,
    v: &Vector3<f64>,
    direction: &Vector3<f64>,
    goal: f64,
) -> (Vec<f64>, bool) {
    let h = &axis.direction;
    let still = h * h.dot(v);
    let (a, b) = (direction.dot(&(v - still)), direction.dot(&h.cross(v)));
    let (reach, wanted) = (a.hypot(b), goal - direction.dot(&still));
    let middle = b.atan2(a);
    let ratio = if reach > 1e-12 { wanted / reach } else { f64::INFINITY.copysign(wanted) };
    if ratio.abs() >= 1.0 {
        let turn = if ratio > 0.0 { middle } else { middle + TAU / 2.0 };
        return (vec![turn], ratio.abs() < 1.0 + STRETCHED || wanted.abs() < 1e-9);
    }
    let aside = ratio.acos();
    (vec![middle + aside, middle - aside], true)
}

/// Returns the motion of a turn about an axis.
pub(super) fn turned(axis: &Axis, angle: f64) -> Isometry3<f64> {
    let rotation = UnitQuaternion::from_axis_angle(&Unit::new_unchecked(axis.direction), angle);
    let translation = axis.point - rotation * axis.point;
    Isometry3::from_parts(translation.into(), rotation)
}

/// Returns the turn about `axis` that takes `a` over `b`; none where either lies along the axis.
pub(super) fn angle_between(
    a: &Vector3<f64>,
    b: &Vector3<f64>,
    axis: &Vector3<f64>,
) -> Option<f64> {
    let (a, b) = (a - axis * axis.dot(a), b - axis * axis.dot(b));
    let sound = a.norm() > SINGULAR && b.norm() > SINGULAR;
    sound.then(|| axis.dot(&a.cross(&b)).atan2(a.dot(&b)))
}

/// Returns the angle of a rotation about `axis`.
fn angle_of(rotation: &UnitQuaternion<f64>, axis: &Vector3<f64>) -> f64 {
    let aside = if axis.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
    let across = aside.cross(axis).normalize();
    let rotation: Rotation3<f64> = (*rotation).into();
    angle_between(&across, &(rotation * across), axis).unwrap_or(0.0)
}

/// Returns the same turn from −π to π.
pub(super) fn within_half_turn(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}
