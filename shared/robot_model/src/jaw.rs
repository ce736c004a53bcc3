//! A gripper of one jaw: it turns towards a finger that does not move.

use crate::{JointKind, Robot};

/// Furthest that a jaw opens, radians from where it is closed. Between faces that stand further apart than twice the
/// angle of friction, here of 0.4, what is gripped slips out.
const OPEN_MAX_RAD: f64 = 0.76;

/// Least share of the jaw's axis along the gripper's x axis.
const ALIGNED: f64 = 0.99;

/// A jaw in the frame of its gripper, which lies on the inner face of the fixed finger at its tip: z out of the
/// fingers, y towards the jaw. The jaw's tip moves on an arc about x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jaw {
    /// The link that turns.
    pub link: usize,
    /// Axis in y and z, metres.
    pivot_m: [f64; 2],
    /// Distance of the tip from the axis, metres.
    radius_m: f64,
    /// Angle of the tip from y about x with the joint at zero, radians, and the sense in which the joint turns about x.
    zero_rad: f64,
    sense: f64,
    /// Positions of the joint, closed and open, radians.
    closed_rad: f64,
    open_rad: f64,
    /// Limits of its joint, radians: the closed one, then the other, which the open gripper may not reach.
    pub range_rad: (f64, f64),
}

impl Jaw {
    /// Returns a jaw by its axis and by its tip at zero (both y and z, metres), the sense in which it turns about x,
    /// and its limits (radians).
    pub fn new(
        link: usize,
        pivot_m: [f64; 2],
        tip_m: [f64; 2],
        sense: f64,
        limits: (f64, f64),
    ) -> Self {
        let [y, z] = [tip_m[0] - pivot_m[0], tip_m[1] - pivot_m[1]];
        let (radius_m, zero_rad) = (y.hypot(z), z.atan2(y));
        let whole = Self {
            link,
            pivot_m,
            radius_m,
            zero_rad,
            sense,
            closed_rad: limits.0,
            open_rad: limits.1,
            range_rad: limits,
        };
        let (closed_rad, end_rad) = match whole.opening_m(limits.0) < whole.opening_m(limits.1) {
            true => limits,
            false => (limits.1, limits.0),
        };
        let met_rad = Self { closed_rad, open_rad: end_rad, ..whole }
            .angle_rad(whole.opening_m(closed_rad).max(0.0));
        let way_rad = (end_rad - met_rad).clamp(-OPEN_MAX_RAD, OPEN_MAX_RAD);
        Self { closed_rad, open_rad: met_rad + way_rad, range_rad: (closed_rad, end_rad), ..whole }
    }

    /// Position of its joint in the open gripper, radians.
    pub fn open_rad(&self) -> f64 {
        self.open_rad
    }

    /// Distance of its tip from its axis, metres.
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// Distances of the tip from the fixed finger: closed (negative if they meet before) and open, metres.
    pub fn ends_m(&self) -> (f64, f64) {
        (self.opening_m(self.closed_rad), self.opening_m(self.open_rad))
    }

    /// Returns the distance of the tip from the fixed finger with the joint at an angle, metres.
    pub fn opening_m(&self, angle_rad: f64) -> f64 {
        self.pivot_m[0] + self.radius_m * (self.zero_rad + self.sense * angle_rad).cos()
    }

    /// Returns the joint's angle at an opening, radians, between closed and open.
    pub fn angle_rad(&self, opening_m: f64) -> f64 {
        let share = ((opening_m - self.pivot_m[0]) / self.radius_m).clamp(-1.0, 1.0);
        let (low, high) = (self.closed_rad.min(self.open_rad), self.closed_rad.max(self.open_rad));
        let off = |angle: &f64| (angle - angle.clamp(low, high)).abs();
        let turn = std::f64::consts::TAU;
        let angles = [share.acos(), -share.acos()].map(|at| self.sense * (at - self.zero_rad));
        let near = angles.map(|at| at - turn * ((at - 0.5 * (low + high)) / turn).round());
        let [a, b] = near;
        if off(&a) <= off(&b) { a } else { b }.clamp(low, high)
    }

    /// Returns the furthest that the tip reaches out beyond the fixed finger's on its way, metres.
    pub fn beyond_m(&self) -> f64 {
        const LOOKS: i32 = 32;
        let at = |k: i32| {
            self.closed_rad + (self.open_rad - self.closed_rad) * f64::from(k) / f64::from(LOOKS)
        };
        let out = |angle: f64| {
            self.pivot_m[1] + self.radius_m * (self.zero_rad + self.sense * angle).sin()
        };
        (0..=LOOKS).map(|k| out(at(k))).fold(0.0, f64::max)
    }
}

impl Robot {
    /// Returns the jaw of a limb: the link `<limb>_jaw` at its tip moves with one revolute joint that moves
    /// `<limb>_gripper` not.
    pub fn jaw(&self, limb: &str) -> Option<Jaw> {
        let frame = self.link_index(&format!("{limb}_gripper"))?;
        let tip = self.link_index(&format!("{limb}_jaw"))?;
        let mut joint = self.carrier(tip)?;
        while joint.kind == JointKind::Fixed {
            joint = self.carrier(joint.parent)?;
        }
        let limits =
            joint.limits.filter(|_| joint.kind == JointKind::Revolute && joint.mimic.is_none())?;
        let is_arm = self
            .chain(&format!("{limb}_gripper"))
            .ok()?
            .movable()
            .any(|own| own.child == joint.child);
        let poses = self.poses(|_| 0.0);
        let to_frame = poses[frame].inverse();
        let at = |link: usize| (to_frame * poses[link]).translation.vector;
        let axis = to_frame.rotation * poses[joint.child].rotation * joint.axis.into_inner();
        let (pivot, tip) = (at(joint.child), at(tip));
        (!is_arm && axis.x.abs() > ALIGNED).then(|| {
            let limits = (limits.lower, limits.upper);
            Jaw::new(joint.child, [pivot.y, pivot.z], [tip.y, tip.z], axis.x.signum(), limits)
        })
    }
}
