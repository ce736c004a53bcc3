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

use std::f64::consts::{PI, SQRT_2};

/// Travel of one finger, metres.
const FINGER_TRAVEL_M: f64 = 0.020833;

/// Travel of both fingers, metres: what the distance between them changes by.
const STROKE_M: f64 = 2.0 * FINGER_TRAVEL_M;

/// Seconds for the whole travel at the SDK's default velocity.
const STROKE_S: f64 = 1.0;

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
}

impl Default for Gripper {
    /// Fingers that close entirely and open by their whole travel: for descriptions without fingers.
    fn default() -> Self {
        Self { stop_m: 0.0, open_m: STROKE_M, beyond_m: 0.0, force_n: 20.0 }
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

/// Returns the largest offset from the middle of fingers `opening_m` apart for an object of width `object_m`,
/// metres; none for one that is too wide.
fn tolerance_m(opening_m: f64, object_m: f64) -> Option<f64> {
    (object_m <= opening_m).then_some(0.5 * (opening_m - object_m))
}

/// Returns whether fingers that are `opening_m` apart take hold of an object that is `object_m`
/// wide and stands `offset_m` beside their middle.
pub fn catches(opening_m: f64, object_m: f64, offset_m: f64) -> bool {
    tolerance_m(opening_m, object_m).is_some_and(|tolerance_m| offset_m.abs() <= tolerance_m)
}

/// Probability that a grasp takes hold of an object: fingers `opening_m` apart, an object of width
/// `object_m`, placement errors across the fingers with standard deviation `error_m`. 0 for an
/// object that is too wide.
pub fn success_probability(opening_m: f64, object_m: f64, error_m: f64) -> f64 {
    match tolerance_m(opening_m, object_m) {
        None => 0.0,
        Some(_) if error_m <= 0.0 => 1.0,
        Some(tolerance_m) => erf(tolerance_m / (SQRT_2 * error_m)),
    }
}

/// Returns the error function, for arguments that are not negative: its Taylor series about zero
/// (Abramowitz and Stegun 7.1.6, all terms positive), which is exact to 1e-15 below 6; above, it is
/// 1.
fn erf(x: f64) -> f64 {
    if x >= 6.0 {
        return 1.0;
    }
    let (mut term, mut sum, mut n) = (x, x, 0.0);
    while term > 1e-17 * sum {
        n += 1.0;
        term *= 2.0 * x * x / (2.0 * n + 1.0);
        sum += term;
    }
    (2.0 / PI.sqrt() * (-x * x).exp() * sum).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::fixture;

    /// Fingers that stay 16 mm apart when closed, and such that meet 4 mm before the end.
    const APART: Gripper = Gripper { stop_m: 0.016, open_m: 0.0577, beyond_m: 0.0, force_n: 20.0 };
    const MEETING: Gripper =
        Gripper { stop_m: -0.004, open_m: 0.0377, beyond_m: 0.0035, force_n: 20.0 };

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
    fn the_error_function_has_its_tabulated_values() {
        // Abramowitz and Stegun, table 7.1.
        let table = [
            (0.0, 0.0),
            (0.1, 0.112_462_916_0),
            (0.5, 0.520_499_877_8),
            (1.0, 0.842_700_792_9),
            (2.0, 0.995_322_265_0),
            (7.0, 1.0),
        ];
        for (x, expected) in table {
            assert!((erf(x) - expected).abs() < 1e-10, "erf({x}) = {}", erf(x));
        }
    }

    #[test]
    fn grasp_fits_until_a_finger_hits_the_object() {
        assert!(catches(0.04, 0.02, 0.0) && catches(0.04, 0.02, -0.01));
        assert!(!catches(0.04, 0.02, 0.0101) && !catches(0.04, 0.041, 0.0));
        assert!(catches(0.04, 0.04, 0.0), "it just fits");
    }

    #[test]
    fn grasp_probability_is_exact_at_0_and_1() {
        assert_eq!(success_probability(0.04, 0.004, 0.0), 1.0);
        assert_eq!(success_probability(0.04, 0.041, 0.0), 0.0);
        assert_eq!(success_probability(0.04, 0.041, 0.01), 0.0);
        // One and two standard deviations on either side.
        assert!((success_probability(0.03, 0.01, 0.01) - 0.682_689_492).abs() < 1e-9);
        assert!((success_probability(0.03, 0.01, 0.005) - 0.954_499_736).abs() < 1e-9);
    }

    #[test]
    fn grasp_probability_agrees_with_sampling() {
        let (opening_m, object_m, error_m, side) = (0.04, 0.012, 0.012, 400);
        let grid = |i: i32| (f64::from(i) + 0.5) / f64::from(side);
        let mut caught = 0;
        for u in 0..side {
            for v in 0..side {
                // A placement error from two uniform numbers (Box and Muller 1958).
                let radius_m = error_m * (-2.0 * (1.0 - grid(u)).ln()).sqrt();
                let offset_m = radius_m * (2.0 * PI * grid(v)).cos();
                caught += i32::from(catches(opening_m, object_m, offset_m));
            }
        }
        let share = f64::from(caught) / f64::from(side * side);
        let expected = success_probability(opening_m, object_m, error_m);
        assert!((share - expected).abs() < 0.003, "{share} of draws, {expected} expected");
    }
}
