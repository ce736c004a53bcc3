//! `[baxter]` of `arm.toml`: tolerances of a Baxter.

use config::Section;
use diagnostics::Fields;

/// Tolerances of a Baxter. The defaults are those of the robot's own trajectory server, except for the
/// goal time, which is too short there for a real arm to settle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Baxter {
    /// Maximum tracking error of a joint during a motion, radians.
    pub path_tolerance_rad: f64,
    /// Maximum error of a joint at the end of a motion, radians.
    pub goal_tolerance_rad: f64,
    /// Time allowed for settling after the end of a motion, seconds.
    pub goal_time_s: f64,
    /// Speed below which a joint counts as stationary, rad/s.
    pub still_rad_s: f64,
    /// Age at which joint states are stale, seconds.
    pub stale_s: f64,
    /// Speed ratio sent to the robot; trajectories respect the limits regardless.
    pub speed_ratio: f64,
    /// Send velocity and acceleration beside the position.
    pub feed_forward: bool,
}

impl Section for Baxter {
    const KEY: &'static [&'static str] = &["arm", "baxter"];

    fn read(f: &mut Fields<'_>) -> Self {
        Self {
            path_tolerance_rad: f.number("path_tolerance_rad", 0.01..=1.0),
            goal_tolerance_rad: f.number("goal_tolerance_rad", 0.001..=0.1),
            goal_time_s: f.number("goal_time_s", 0.1..=60.0),
            still_rad_s: f.number("still_rad_s", 0.005..=0.5),
            stale_s: f.number("stale_s", 0.03..=1.0),
            speed_ratio: f.number("speed_ratio", 0.05..=1.0),
            feed_forward: f.flag("feed_forward"),
        }
    }
}
