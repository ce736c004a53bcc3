//! Numbers of Baxter that its description does not hold.
//!
//! Numbers from baxter_common 1.2.0 and baxter_interface 1.2.0, BSD-3-Clause, Copyright (c) 2013-2015
//! Rethink Robotics.

/// The SDK's default speed ratio.
pub const DEFAULT_SPEED_RATIO: f64 = 0.3;

/// Travel of one finger, metres; the gripper's stroke is twice that.
pub const FINGER_TRAVEL_M: f64 = 0.020833;

/// `<limb>_hand` to `<limb>_gripper` along z, by what is mounted, metres. All share one frame name;
/// the description that ships has the first.
pub mod tool {
    /// Electric gripper with the extended narrow fingers: the official default.
    pub const ELECTRIC_EXTENDED_M: f64 = 0.1577;
    /// Electric gripper with standard fingers.
    pub const ELECTRIC_STANDARD_M: f64 = 0.1200;
    /// The frame of the description without a gripper.
    pub const PLAIN_M: f64 = 0.025;
    /// The hand itself.
    pub const NONE_M: f64 = 0.0;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::fixture;

    #[test]
    fn baxter_numbers_match_the_data_sheet() {
        let facts: toml::Table = fixture("baxter_facts.toml").parse().unwrap();
        let of = |table: &str, key: &str| facts[table][key].as_float().unwrap();
        let tool = |key: &str| of("tool_frames", key);
        assert_eq!(tool::ELECTRIC_EXTENDED_M, tool("electric_extended_gripper"));
        assert_eq!(tool::ELECTRIC_STANDARD_M, tool("electric_standard_gripper"));
        assert_eq!(tool::PLAIN_M, tool("plain_urdf_gripper"));
        assert_eq!(FINGER_TRAVEL_M, of("electric_gripper", "travel_per_finger"));
        assert_eq!(DEFAULT_SPEED_RATIO, of("velocity_limits", "sdk_default_speed_ratio"));
    }
}
