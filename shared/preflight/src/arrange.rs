//! What the arm can fetch among other objects, and the nearest place for what it cannot.

use std::f64::consts::TAU;
use std::time::Instant;

use manipulation::{Cuboid, Limb, ObjectPose, PlanError, fetching_limb};

use crate::ArmSetup;

/// Distances at which a nearer place is looked for, centimetres.
const RINGS_CM: [f64; 22] = [
    1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0, 25.0, 30.0, 35.0, 40.0,
    50.0, 60.0, 80.0, 100.0, 120.0,
];

/// Directions in which it is looked for; the first four are those of the axes.
const DIRECTIONS: usize = 16;

/// Distance between boxes of objects below which a place is not tried, metres.
pub const GAP_M: f64 = 0.02;

/// Farthest distance at which an object is asked whether it is in the way, metres, and most objects
/// that are asked.
const NEIGHBOUR_M: f64 = 0.6;
const NEIGHBOURS_MAX: usize = 12;

/// Objects with their places, some of which are still to be found.
pub struct Arrangement<'a> {
    setup: &'a ArmSetup,
    poses: Vec<ObjectPose>,
    /// Whether the object is in its place, so that others must not touch it.
    stands: Vec<bool>,
    /// When searches are given up.
    until: Option<Instant>,
}

impl<'a> Arrangement<'a> {
    /// Plans with all objects at their own places.
    pub fn new(setup: &'a ArmSetup, poses: Vec<ObjectPose>) -> Self {
        let stands = vec![true; poses.len()];
        Self { setup, poses, stands, until: None }
    }

    /// Searches find nothing from a moment on.
    pub fn until(self, moment: Instant) -> Self {
        Self { until: Some(moment), ..self }
    }

    /// Whether searches are given up.
    pub fn is_late(&self) -> bool {
        self.until.is_some_and(|until| Instant::now() >= until)
    }

    /// Returns the limb that can fetch an object among those in place.
    ///
    /// # Errors
    /// [`PlanError`] of the attempt that came furthest.
    pub fn limb(&self, i: usize) -> Result<Limb, PlanError> {
        self.limb_at(i, &self.poses[i], None)
    }

    /// Returns the object without which the arm could fetch `i`, if it is one that is in the way.
    pub fn in_the_way(&self, i: usize) -> Option<usize> {
        let mut near: Vec<(f64, usize)> = self
            .others(i)
            .map(|j| (distance_m(&self.poses[i].xyz_m, &self.poses[j].xyz_m), j))
            .filter(|(m, _)| *m < NEIGHBOUR_M)
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut near = near.into_iter().take(NEIGHBOURS_MAX).map(|(_, j)| j);
        near.find(|&j| !self.is_late() && self.limb_at(i, &self.poses[i], Some(j)).is_ok())
    }

    /// Returns the nearest place at the same height where the arm can fetch `i`, and all others
    /// that it can fetch now.
    pub fn nearest(&self, i: usize) -> Option<[f64; 3]> {
        let [x, y, z] = self.poses[i].xyz_m;
        let turned = |n: usize| {
            // Straight along the axes first, then between them.
            let (quarter, part) = (n % 4, n / 4);
            (quarter as f64 + part as f64 * 4.0 / DIRECTIONS as f64) * TAU / 4.0
        };
        RINGS_CM
            .iter()
            .flat_map(|cm| (0..DIRECTIONS).map(move |n| (cm / 100.0, turned(n))))
            .map(|(m, turn)| [rounded(x + m * turn.cos()), rounded(y + m * turn.sin()), z])
            .take_while(|_| !self.is_late())
            .find(|&place| self.fits(i, place, GAP_M))
    }

    /// The arm that fetches them.
    pub fn setup(&self) -> &'a ArmSetup {
        self.setup
    }

    /// Takes an object off its place: the others need not keep clear of it.
    pub fn lift(&mut self, i: usize) {
        self.stands[i] = false;
    }

    /// Puts an object at a place, metres, frame `base`.
    pub fn put(&mut self, i: usize, place: [f64; 3]) {
        (self.poses[i].xyz_m, self.stands[i]) = (place, true);
    }

    /// The poses of all objects, in or off their places.
    pub fn poses(&self) -> &[ObjectPose] {
        &self.poses
    }

    /// Returns whether the arm can fetch `i` at a place that is `gap_m` from others, and still
    /// fetch those that it can fetch now.
    pub fn fits(&self, i: usize, place: [f64; 3], gap_m: f64) -> bool {
        let pose = ObjectPose { xyz_m: place, ..self.poses[i] };
        if self.others(i).any(|j| are_near(&pose, &self.poses[j], gap_m)) {
            return false;
        }
        if self.limb_at(i, &pose, None).is_err() {
            return false;
        }
        let mut moved = Self { poses: self.poses.clone(), stands: self.stands.clone(), ..*self };
        (moved.poses[i], moved.stands[i]) = (pose, true);
        let is_near = |&j: &usize| distance_m(&place, &self.poses[j].xyz_m) < NEIGHBOUR_M;
        let mut others = self.others(i).filter(is_near);
        others.all(|j| moved.limb(j).is_ok() || self.limb(j).is_err())
    }

    fn limb_at(&self, i: usize, pose: &ObjectPose, but: Option<usize>) -> Result<Limb, PlanError> {
        let others: Vec<Cuboid> =
            (self.others(i).filter(|j| Some(*j) != but)).map(|j| self.poses[j].cuboid()).collect();
        let ArmSetup { robot, limb, plan } = self.setup;
        fetching_limb(robot, pose, *limb, &others, plan)
    }

    fn others(&self, i: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.poses.len()).filter(move |&j| j != i && self.stands[j])
    }
}

/// Returns whether the upright boxes round two objects are nearer than `gap_m` in every direction.
fn are_near(a: &ObjectPose, b: &ObjectPose, gap_m: f64) -> bool {
    let half = |pose: &ObjectPose| {
        let (sin, cos) = (pose.yaw_rad.sin().abs(), pose.yaw_rad.cos().abs());
        let [x, y, z] = pose.size_m;
        [0.5 * (cos * x + sin * y), 0.5 * (sin * x + cos * y), 0.5 * z]
    };
    let (of_a, of_b) = (half(a), half(b));
    (0..3).all(|axis| {
        let gap_m = if axis == 2 { 0.0 } else { gap_m };
        (a.xyz_m[axis] - b.xyz_m[axis]).abs() < of_a[axis] + of_b[axis] + gap_m
    })
}

fn distance_m(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Rounds to millimetres, as finely as places on a table are measured.
pub fn rounded(m: f64) -> f64 {
    // Zero has no sign in a file.
    (m * 1e3).round() / 1e3 + 0.0
}
