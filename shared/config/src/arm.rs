//! `arm.toml`: driver, limb and motion of the arm.

use diagnostics::{Fields, Report, Table};
use perception::CameraSettings;
use vocabulary::time::Span;

/// The arm.
#[derive(Clone, Debug, PartialEq)]
pub struct Arm {
    /// The driver of its joints.
    pub driver: Driver,
    /// The limb that fetches, by its name in the robot's description; `None`: the one that reaches the
    /// object better.
    pub limb: Option<String>,
    /// Settings of its motions.
    pub motion: Motion,
    /// Simulated seconds per second.
    pub time_scale: f64,
    /// Objects return to their places in the simulated world after a hand-over.
    pub restock: bool,
    /// Rate of published joint states, Hz.
    pub joint_rate_hz: f64,
    /// Attempts at grasps.
    pub grasp: Grasps,
    /// Tolerances of a Baxter.
    pub baxter: Baxter,
    /// The simulated Baxter.
    pub simulated: Simulated,
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
    /// Standard deviation of the objects' positions across the fingers, metres; simulated worlds only.
    pub error_m: f64,
}

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

/// The simulated Baxter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simulated {
    /// Time constant with which a joint follows its command, seconds.
    pub lag_s: f64,
    /// Standard deviation of measured joint positions, radians.
    pub noise_rad: f64,
    /// Share of joint states that are lost.
    pub loss: f64,
    /// Seed of its random numbers.
    pub seed: u64,
    /// The motors are enabled at start.
    pub enabled: bool,
    /// A camera that reports the objects on its table, where they come from perception.
    pub camera: Option<CameraSettings>,
}

/// The driver of the joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// The kinematic model of Baxter in a simulated world.
    Kinematic,
    /// A Baxter behind its own topics: a real one's bridge, or the simulated one.
    Baxter,
}

/// Reads the section.
pub(crate) fn read(f: &mut Fields<'_>) -> Arm {
    f.text("robot");
    let arm = Arm {
        driver: f.choice("driver", &[("kinematic", Driver::Kinematic), ("baxter", Driver::Baxter)]),
        limb: Some(f.text("limb")).filter(|limb| limb != "auto"),
        motion: motion(f),
        time_scale: f.number("time_scale", 0.01..=1000.0),
        restock: f.flag("restock"),
        joint_rate_hz: f.number("joint_rate_hz", 1.0..=1000.0),
        grasp: Grasps {
            attempts: f.whole("grasp_attempts", 1..=5),
            error_m: f.number("grasp_error_m", 0.0..=0.1),
        },
        baxter: f.table("baxter", baxter),
        simulated: f.table("simulated", simulated),
    };
    if arm.driver == Driver::Baxter && arm.time_scale != 1.0 && !f.is_wrong("time_scale") {
        let what = format!("is {}, but a robot moves in real time", arm.time_scale);
        f.problem("time_scale", &what, "write `time_scale = 1.0`, or use driver = \"kinematic\"");
    }
    arm
}

fn baxter(f: &mut Fields<'_>) -> Baxter {
    Baxter {
        path_tolerance_rad: f.number("path_tolerance_rad", 0.01..=1.0),
        goal_tolerance_rad: f.number("goal_tolerance_rad", 0.001..=0.1),
        goal_time_s: f.number("goal_time_s", 0.1..=60.0),
        still_rad_s: f.number("still_rad_s", 0.005..=0.5),
        stale_s: f.number("stale_s", 0.03..=1.0),
        speed_ratio: f.number("speed_ratio", 0.05..=1.0),
        feed_forward: f.flag("feed_forward"),
    }
}

fn simulated(f: &mut Fields<'_>) -> Simulated {
    let seed = f.whole("seed", 0..=u64::from(u32::MAX));
    Simulated {
        lag_s: f.number("lag_s", 0.002..=1.0),
        noise_rad: f.number("noise_rad", 0.0..=0.01),
        loss: f.number("loss", 0.0..=0.9),
        seed,
        enabled: f.flag("enabled"),
        camera: f.table("camera", |f| camera(f, seed)),
    }
}

fn camera(f: &mut Fields<'_>, seed: u64) -> Option<CameraSettings> {
    let is_enabled = f.flag("enabled");
    let camera = CameraSettings {
        rate_hz: f.number("rate_hz", 0.5..=30.0),
        noise_m: f.number("noise_m", 0.0..=0.05),
        misses: f.number("misses", 0.0..=0.9),
        delay: Span::from_s(f.number("delay_s", 0.0..=1.0)),
        sure: (f.number("sure_min", 0.0..=1.0), f.number("sure_max", 0.0..=1.0)),
        hidden_m: f.number("hidden_m", 0.0..=1.0),
        seed,
    };
    let (least, most) = camera.sure;
    if least > most && !f.is_wrong("sure_min") && !f.is_wrong("sure_max") {
        let what = format!("is {least}, more than sure_max");
        f.problem("sure_min", &what, "raise sure_max or lower sure_min");
    }
    is_enabled.then_some(camera)
}

/// Reports a camera whose reports would have no effect.
pub(crate) fn check_camera(arm: &Arm, perceives: bool, tree: &Table, report: &mut Report) {
    let (what, help) = match arm.driver {
        _ if arm.simulated.camera.is_none() => return,
        Driver::Kinematic => (
            "is true, but the driver is kinematic",
            "start with `--profile camera`, or write driver = \"baxter\"",
        ),
        Driver::Baxter if !perceives => (
            "is true, but the objects are those of the scene file",
            "start with `--profile camera`, or write group.perception.enabled = true",
        ),
        Driver::Baxter => return,
    };
    let path = ["arm", "simulated", "camera", "enabled"];
    report.add(tree.source_of(&path).diagnostic(&path.map(str::to_owned), what, help));
}

fn motion(f: &mut Fields<'_>) -> Motion {
    Motion {
        speed_ratio: f.number("speed_ratio", 0.05..=1.0),
        hover_m: f.number("hover_m", 0.02..=0.5),
        hand_over_xyz_m: f.triple("hand_over_xyz"),
        table_z_m: f.number("table_z_m", -1.0..=1.0),
        grip_open_percent: f.number("grip_open_percent", 1.0..=100.0),
        standoff_m: f.number("standoff_m", 0.05..=1.0),
        point_s: f.number("point_s", 0.0..=60.0),
        margin_m: f.number("margin_m", 0.0..=0.2),
    }
}
