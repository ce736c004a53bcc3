//! The electric gripper: how wide it is, how long it takes, and what it holds.
//!
//! The model of a grasp is one-dimensional, across the fingers. An object of width `w` fits between fingers
//! `o` apart while it stands no further than `(o − w) / 2` from their middle; beyond that a finger
//! comes down on it or beside it, and the fingers close on nothing. With a placement error that is
//! normal with standard deviation `σ` and no bias the grasp succeeds with probability
//! `P(|e| ≤ (o − w) / 2) = erf((o − w) / (2 √2 σ))`.
//!
//! Numbers from baxter_common 1.2.0 and baxter_interface 1.2.0, BSD-3-Clause, Copyright (c) 2013-2015
//! Rethink Robotics.

use robot_model::Jaw;

/// Travel of one finger, metres.
const FINGER_TRAVEL_M: f64 = 0.020833;

/// Travel of both fingers, metres: what the distance between them changes by.
const STROKE_M: f64 = 2.0 * FINGER_TRAVEL_M;

/// Seconds for the whole travel at the SDK's default velocity.
const STROKE_S: f64 = 1.0;

/// Room between a fixed finger and an object before the jaw closes, metres.
const JAW_ROOM_M: f64 = 0.004;

/// Change of the distance between the fingers per second, m/s.
pub const SPEED_M_S: f64 = STROKE_M / STROKE_S;

/// Share of the range below which closed fingers hold nothing: the SDK's dead zone.
pub const DEAD_ZONE: f64 = 0.05;

/// Distances between the fingertips of one gripper, and how hard they press: from the shapes of its
/// fingers, see [`Robot::from_description`](crate::Robot::from_description).
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Gripper {
    /// Distance at the closed end of the travel, metres. Negative: the tips meet before it, as after
    /// a calibration they do at position 0.
    pub stop_m: f64,
    /// Distance of fully open fingers, metres: position 100.
    pub open_m: f64,
    /// Reach of the fingertips beyond the frame `<limb>_gripper`, metres.
    pub beyond_m: f64,
    /// Force of each finger, newtons.
    pub force_n: f64,
    /// The jaw of a gripper whose other finger does not move; none for two that move alike.
    // What is recorded is a Baxter's, which has none.
    #[serde(skip)]
    pub jaw: Option<Jaw>,
}

impl Default for Gripper {
    /// Fingers that close entirely and open by their whole travel: for descriptions without fingers.
    fn default() -> Self {
        Self { stop_m: 0.0, open_m: STROKE_M, beyond_m: 0.0, force_n: 20.0, jaw: None }
    }
}

impl Gripper {
    /// Distance of fully closed fingers, metres: position 0.
    pub fn closed_m(&self) -> f64 {
        self.stop_m.max(0.0)
    }

    fn range_m(&self) -> f64 {
        self.open_m - self.closed_m()
    }

    /// Width between the fingers at a position in percent (0 closed, 100 open), metres.
    pub fn width_m(&self, percent: f64) -> f64 {
        self.closed_m() + self.range_m() * percent.clamp(0.0, 100.0) / 100.0
    }

    /// Position in percent at a width in metres.
    pub fn percent(&self, width_m: f64) -> f64 {
        100.0 * ((width_m - self.closed_m()) / self.range_m()).clamp(0.0, 1.0)
    }

    /// Position of a finger's joint at a width, metres: 0 at the closed end of its travel.
    pub fn travel_m(&self, width_m: f64) -> f64 {
        0.5 * (width_m - self.stop_m)
    }

    /// Width at which the fingers stop when they close on an object that is `object_m` wide, metres.
    pub fn closed_on(&self, object_m: f64) -> f64 {
        object_m.clamp(self.closed_m(), self.open_m)
    }

    /// Returns how far from the middle of an object the frame `<limb>_gripper` stands before the fingers close, along
    /// its y axis, metres. A fixed finger comes down beside the object with some room, and the jaw pushes it there.
    pub(crate) fn aside_m(&self, object_m: f64) -> f64 {
        let room_m = (0.5 * (self.open_m - object_m)).clamp(0.0, JAW_ROOM_M);
        self.jaw.map_or(0.0, |_| 0.5 * object_m + room_m)
    }

    /// Returns how far an object that is `object_m` wide at the fingers, its middle at `y_m` along the travel of the
    /// fingers, is pushed when they close: a jaw pushes it to the fixed finger; metres.
    pub(crate) fn push_m(&self, object_m: f64, y_m: f64) -> f64 {
        let room_m = y_m - 0.5 * object_m;
        let is_beside = self.jaw.is_some() && (0.0..=1.5 * JAW_ROOM_M).contains(&room_m);
        if is_beside { -room_m } else { 0.0 }
    }

    /// Returns whether fingers that stopped closing at `width_m` have something between
    /// them. Width alone cannot distinguish an object thinner than the dead zone from none.
    pub fn holds(&self, width_m: f64) -> bool {
        width_m > self.least_m()
    }

    /// Least width of an object that the gripper detects, metres: what is thinner it does not hold,
    /// or takes for closed fingers.
    pub fn least_m(&self) -> f64 {
        self.closed_m() + DEAD_ZONE * self.range_m()
    }
}

/// Seconds that the fingers take from one width to another, both in metres.
pub fn seconds_between(from_m: f64, to_m: f64) -> f64 {
    (to_m - from_m).abs() / SPEED_M_S
}

/// Returns whether fingers that are `opening_m` apart take hold of an object that is `object_m`
/// wide and stands `offset_m` beside their middle.
pub fn catches(opening_m: f64, object_m: f64, offset_m: f64) -> bool {
    offset_m.abs() <= 0.5 * (opening_m - object_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::fixture;

    /// Fingers that stay 16 mm apart when closed, and such that meet 4 mm before the end.
    const APART: Gripper =
        Gripper { stop_m: 0.016, open_m: 0.0577, beyond_m: 0.0, force_n: 20.0, jaw: None };
    const MEETING: Gripper =
        Gripper { stop_m: -0.004, open_m: 0.0377, beyond_m: 0.0035, force_n: 20.0, jaw: None };

    #[test]
    fn gripper_percent_and_width_are_inverse() {
        for gripper in [APART, MEETING, Gripper::default()] {
            for percent in [0.0, 12.5, 50.0, 100.0] {
                assert!((gripper.percent(gripper.width_m(percent)) - percent).abs() < 1e-12);
            }
            assert_eq!(gripper.width_m(250.0), gripper.open_m);
            assert_eq!(gripper.width_m(-1.0), gripper.closed_m());
        }
        let facts: toml::Table = fixture("baxter_facts.toml").parse().unwrap();
        let travel_m = facts["electric_gripper"]["travel_per_finger"].as_float().unwrap();
        assert_eq!(FINGER_TRAVEL_M, travel_m);
        assert_eq!((APART.closed_m(), MEETING.closed_m()), (0.016, 0.0));
        assert!((MEETING.travel_m(MEETING.open_m) - travel_m).abs() < 1e-4);
    }

    #[test]
    fn gripper_closing_time_is_proportional() {
        assert_eq!(seconds_between(STROKE_M, 0.0), 1.0);
        assert_eq!(seconds_between(0.0, 0.5 * STROKE_M), 0.5);
        assert_eq!(seconds_between(0.01, 0.01), 0.0);
    }

    #[test]
    fn gripper_position_distinguishes_a_held_object_from_none() {
        let detects = |gripper: Gripper, object_m| gripper.holds(gripper.closed_on(object_m));
        assert!(detects(MEETING, 0.004) && detects(MEETING, 0.1));
        assert!(!detects(MEETING, 0.0) && !detects(MEETING, 0.001));
        assert!(detects(APART, 0.0181) && !detects(APART, 0.018) && !detects(APART, 0.006));
    }

    #[test]
    fn grasp_fits_until_a_finger_hits_the_object() {
        assert!(catches(0.04, 0.02, 0.0) && catches(0.04, 0.02, -0.01));
        assert!(!catches(0.04, 0.02, 0.0101) && !catches(0.04, 0.041, 0.0));
        assert!(catches(0.04, 0.04, 0.0), "it just fits");
    }
}
