//! The electric gripper: how wide it is, how long it takes, and what it holds.
//!
//! Numbers from baxter_common 1.2.0 and baxter_interface 1.2.0, BSD-3-Clause, Copyright (c) 2013-2015
//! Rethink Robotics.

mod success;

pub use success::{catches, is_felt, success_probability};

/// Travel of one finger, metres.
const FINGER_TRAVEL_M: f64 = 0.020833;

/// Distance between the fingers when they are fully open, metres: both fingers' travel.
pub const STROKE_M: f64 = 2.0 * FINGER_TRAVEL_M;

/// Seconds from fully open to closed at the SDK's default velocity.
pub const STROKE_S: f64 = 1.0;

/// Share of the stroke below which closed fingers hold nothing: the SDK's dead zone.
pub const DEAD_ZONE: f64 = 0.05;

/// Width between the fingers at a position in percent (0 closed, 100 open), metres.
pub fn width_m(percent: f64) -> f64 {
    STROKE_M * percent.clamp(0.0, 100.0) / 100.0
}

/// Position in percent at a width in metres.
pub fn percent(width_m: f64) -> f64 {
    100.0 * (width_m / STROKE_M).clamp(0.0, 1.0)
}

/// Seconds that the fingers take from one width to another, both in metres.
pub fn seconds_between(from_m: f64, to_m: f64) -> f64 {
    STROKE_S * (to_m - from_m).abs() / STROKE_M
}

/// Width at which the fingers stop when they close on an object that is `object_m` wide, metres.
pub fn closed_on(object_m: f64) -> f64 {
    object_m.clamp(0.0, STROKE_M)
}

/// Returns whether fingers that stopped closing at `width_m` have something between
/// them. Width alone cannot distinguish an object thinner than the dead zone from none.
pub fn holds(width_m: f64) -> bool {
    width_m > DEAD_ZONE * STROKE_M
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::fixture;

    #[test]
    fn gripper_percent_and_width_are_inverse() {
        for percent_open in [0.0, 12.5, 50.0, 100.0] {
            assert!((percent(width_m(percent_open)) - percent_open).abs() < 1e-12);
        }
        assert_eq!((width_m(250.0), width_m(-1.0)), (STROKE_M, 0.0));
        let facts: toml::Table = fixture("baxter_facts.toml").parse().unwrap();
        let travel_m = facts["electric_gripper"]["travel_per_finger"].as_float().unwrap();
        assert_eq!(STROKE_M, 2.0 * travel_m);
    }

    #[test]
    fn gripper_closing_time_is_proportional() {
        assert_eq!(seconds_between(STROKE_M, 0.0), 1.0);
        assert_eq!(seconds_between(0.0, 0.5 * STROKE_M), 0.5);
        assert_eq!(seconds_between(0.01, 0.01), 0.0);
    }

    #[test]
    fn gripper_position_distinguishes_a_held_object_from_none() {
        assert!(holds(closed_on(0.004)) && holds(closed_on(0.1)));
        assert!(!holds(closed_on(0.0)) && !holds(closed_on(0.001)));
    }
}
