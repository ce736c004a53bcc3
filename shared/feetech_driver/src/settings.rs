//! `[feetech]` of `arm.toml`: an arm on a bus of servos.

use std::path::PathBuf;

use config::{Check, Section};
use diagnostics::{Diagnostic, Fields};

use crate::calibration::{Calibration, places};

/// Most entries of the lists below.
const ENTRIES_MAX: usize = 32;

/// An arm on a bus of servos.
#[derive(Clone, Debug, PartialEq)]
pub struct Feetech {
    /// The serial port.
    pub port: PathBuf,
    /// Rate of the bus, baud.
    pub baud: u32,
    /// The robot's id in lerobot, by which its calibration is found.
    pub robot_id: Option<String>,
    /// A calibration file elsewhere.
    pub calibration: Option<PathBuf>,
    /// The servo of the jaw in the calibration.
    pub gripper: String,
    /// Joints whose servo has another name, zero or direction.
    pub joints: Vec<JointEntry>,
    /// Width between the fingertips by the servo's position, ascending in both; empty: in proportion, or by the arc
    /// of a jaw that turns.
    pub openings: Vec<Opening>,
    /// Greatest speed of the joints, rad/s: the servos themselves keep it.
    pub speed_max_rad_s: f64,
    /// Limits of torque.
    pub torque: Torques,
    /// Tolerances of motions.
    pub tolerances: Tolerances,
}

/// A joint of the robot's description, and its servo.
#[derive(Clone, Debug, PartialEq)]
pub struct JointEntry {
    /// Name in the description.
    pub joint: String,
    /// Name in the calibration.
    pub servo: String,
    /// Angle of the joint in the middle of the servo's range, radians.
    pub zero_rad: f64,
    /// The joint turns against the servo.
    pub reversed: bool,
}

/// A point of the curve from the jaw's position to its width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opening {
    /// Position, percent of the recorded range.
    pub percent: f64,
    /// Width, metres.
    pub width_m: f64,
}

/// Limits of torque, percent of the servo's greatest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torques {
    /// Of the arm's joints.
    pub joints_percent: f64,
    /// Of the jaw while it closes.
    pub grip_percent: f64,
    /// Of the jaw while it holds: below the servo's threshold of overload.
    pub hold_percent: f64,
}

/// Tolerances of motions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Maximum tracking error of a joint during a motion, radians.
    pub path_rad: f64,
    /// Maximum error of a joint at the end of a motion, radians.
    pub goal_rad: f64,
    /// Time allowed for settling after the end of a motion, seconds.
    pub goal_time_s: f64,
    /// Speed below which a joint counts as stationary, rad/s.
    pub still_rad_s: f64,
    /// Age at which measurements are stale, seconds.
    pub stale_s: f64,
}

impl Section for Feetech {
    const KEY: &'static [&'static str] = &["arm", "feetech"];

    fn read(f: &mut Fields<'_>) -> Self {
        let read = Self {
            port: PathBuf::from(f.text("port")),
            baud: f.whole("baud", 9_600..=1_000_000),
            robot_id: f.optional_text("robot_id"),
            calibration: f.absolute("calibration"),
            gripper: f.text("gripper"),
            joints: f.list("joints", "zero_rad = 0.0\nreversed = false", joint),
            openings: f.list("openings", "", opening),
            speed_max_rad_s: f.number("speed_max_rad_s", 0.1..=6.0),
            torque: Torques {
                joints_percent: f.number("torque_percent", 10.0..=100.0),
                grip_percent: f.number("grip_torque_percent", 5.0..=100.0),
                hold_percent: f.number("hold_torque_percent", 5.0..=100.0),
            },
            tolerances: Tolerances {
                path_rad: f.number("path_tolerance_rad", 0.02..=1.0),
                goal_rad: f.number("goal_tolerance_rad", 0.005..=0.2),
                goal_time_s: f.number("goal_time_s", 0.1..=60.0),
                still_rad_s: f.number("still_rad_s", 0.005..=0.5),
                stale_s: f.number("stale_s", 0.03..=1.0),
            },
        };
        read.contradictions(f);
        read
    }

    fn check(&self, others: &mut Check<'_>) {
        if others.arm.driver == crate::NAME && self.robot_id.is_none() && self.calibration.is_none()
        {
            let what = "no calibration is named";
            let help = "write the id under which lerobot calibrated the arm, `robot_id = \"ID\"`, or the path of a \
                        file, `calibration = \"/…/ID.json\"`";
            others.problem(&["arm", crate::NAME, "robot_id"], what, help);
        }
    }
}

fn joint(f: &mut Fields<'_>) -> JointEntry {
    JointEntry {
        joint: f.text("joint"),
        servo: f.text("servo"),
        zero_rad: f.number("zero_rad", -6.3..=6.3),
        reversed: f.flag("reversed"),
    }
}

fn opening(f: &mut Fields<'_>) -> Opening {
    Opening { percent: f.number("percent", 0.0..=100.0), width_m: f.number("width_m", 0.0..=0.5) }
}

impl Feetech {
    fn contradictions(&self, f: &mut Fields<'_>) {
        let Torques { grip_percent, hold_percent, .. } = self.torque;
        if hold_percent > grip_percent {
            let what = format!("is {hold_percent}, above grip_torque_percent = {grip_percent}");
            f.problem("hold_torque_percent", what, "what is held needs less than what is gripped");
        }
        if let Some(id) = self.robot_id.as_ref().filter(|id| id.contains('/')) {
            f.problem("robot_id", format!("`{id}` is a path"), "write it as `calibration`");
        }
        for (key, entries) in [("joints", self.joints.len()), ("openings", self.openings.len())] {
            if entries > ENTRIES_MAX {
                let what = format!("expected at most {ENTRIES_MAX} entries, found {entries}");
                f.problem(key, what, "remove some");
            }
        }
        let rises =
            |two: &[Opening]| two[0].percent < two[1].percent && two[0].width_m < two[1].width_m;
        if self.openings.len() == 1 || !self.openings.windows(2).all(rises) {
            let what = "expected none or at least two points, percent and width of each above those of the one before";
            f.problem(
                "openings",
                what,
                "sort them, or remove them: the width then grows in proportion",
            );
        }
    }

    /// Reads the calibration.
    ///
    /// # Errors
    /// There is none where it should be, or it is wrong.
    pub(crate) fn calibrated(&self) -> Result<Calibration, Diagnostic> {
        if let Some(file) = &self.calibration {
            return Calibration::read(file);
        }
        let places = places(self.robot_id.as_deref().unwrap_or_default());
        if let Some(found) = places.iter().find(|file| file.is_file()) {
            return Calibration::read(found);
        }
        let searched: Vec<String> = places.iter().map(|file| file.display().to_string()).collect();
        let what = format!("no calibration file; looked for {}", searched.join(", "));
        let help = "calibrate the arm, `lerobot-calibrate --robot.type=so101_follower --robot.port=PORT \
                    --robot.id=ID`, or \
                    name the file: arm.feetech.calibration";
        Err(Diagnostic::new("arm.toml", "arm.feetech.robot_id", what, help))
    }
}
