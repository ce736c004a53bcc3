//! `arm.toml`: driver, limb and motion of the arm.

use diagnostics::Fields;

use crate::driver;

/// The arm.
#[derive(Clone, Debug, PartialEq)]
pub struct Arm {
    /// Name of the driver of its joints.
    pub driver: String,
    /// The limb that fetches, by its name in the robot's description; `None`: the one that reaches
    /// the object better.
    pub limb: Option<String>,
    /// Settings of the arm's motions.
    pub motion: Motion,
    /// Simulated seconds per second.
    pub time_scale: f64,
    /// Objects return to their places in the simulated world after a hand-over.
    pub restock: bool,
    /// Rate of published joint states, Hz.
    pub joint_rate_hz: f64,
    /// Attempts at grasps.
    pub grasp: Grasps,
}

/// Settings of motions. Positions in frame `base`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Share of the joints' velocity, acceleration and jerk limits, 0 to 1.
    pub speed_ratio: f64,
    /// Height above an object at which a grasp is approached, metres.
    pub hover_m: f64,
    /// Position at which objects are handed over, metres.
    pub hand_over_xyz_m: [f64; 3],
    /// Height of the table, metres.
    pub table_z_m: f64,
    /// Near edge of the table, x in metres.
    pub table_near_m: f64,
    /// Opening of the gripper before a grasp, per cent of its range.
    pub grip_open_percent: f64,
    /// Distance from the gripper to an object that it points at, metres.
    pub standoff_m: f64,
    /// Time for which a pointing gesture is held, seconds.
    pub point_s: f64,
    /// Distance kept from obstacles, metres.
    pub margin_m: f64,
}

/// Attempts at grasps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grasps {
    /// Attempts in all if the fingers close without an object.
    pub attempts: u32,
    /// Standard deviation of objects' positions across the fingers, metres; simulated worlds only.
    pub error_m: f64,
}

/// Reads the section of an arm that has a program of its own, or not.
pub(crate) fn read(f: &mut Fields<'_>, is_own: bool) -> Arm {
    f.text("robot");
    let (driver, known) = driver::read(f, is_own);
    let arm = Arm {
        driver,
        limb: Some(f.text("limb")).filter(|limb| limb != "auto"),
        motion: motion(f),
        time_scale: f.number("time_scale", 0.01..=1000.0),
        restock: f.flag("restock"),
        joint_rate_hz: f.number("joint_rate_hz", 1.0..=1000.0),
        grasp: Grasps {
            attempts: f.whole("grasp_attempts", 1..=5),
            error_m: f.number("grasp_error_m", 0.0..=0.1),
        },
    };
    if let Some((what, help)) = known.and_then(|driver| driver.pace_problem(arm.time_scale))
        && !f.is_wrong("time_scale")
    {
        f.problem("time_scale", what, help);
    }
    arm
}

fn motion(f: &mut Fields<'_>) -> Motion {
    Motion {
        speed_ratio: f.number("speed_ratio", 0.05..=1.0),
        hover_m: f.number("hover_m", 0.02..=0.5),
        hand_over_xyz_m: f.triple("hand_over_xyz"),
        table_z_m: f.number("table_z_m", -1.0..=1.0),
        table_near_m: f.number("table_near_m", -2.0..=2.0),
        grip_open_percent: f.number("grip_open_percent", 1.0..=100.0),
        standoff_m: f.number("standoff_m", 0.05..=1.0),
        point_s: f.number("point_s", 0.0..=60.0),
        margin_m: f.number("margin_m", 0.0..=0.2),
    }
}
