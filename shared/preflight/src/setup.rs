//! The configured arm as the planner of motions takes it.

use config::{RobotFiles, Settings};
use diagnostics::{Diagnostic, Diagnostics};
use manipulation::{Limb, PlanSettings, Robot};
use robot_model::{BAXTER_SRDF, BAXTER_URDF};

/// Robot, limb and settings of motions.
#[derive(Clone, Debug, PartialEq)]
pub struct ArmSetup {
    /// The robot: links, joints, limits, shapes.
    pub robot: Robot,
    /// The limb that fetches; `None`: the one that reaches the object better.
    pub limb: Option<Limb>,
    /// Settings of motions.
    pub plan: PlanSettings,
}

impl ArmSetup {
    /// Reads the robot's description and converts the settings of the arm.
    ///
    /// # Errors
    /// Every fault of the description, or the parts that an arm needs and it lacks.
    pub fn new(settings: &Settings) -> Result<Self, Diagnostics> {
        let robot = robot(settings.robot_files())?;
        Ok(Self { robot, limb: limb(settings.arm.limb), plan: plan_settings(&settings.arm.motion) })
    }
}

/// Converts the setting of the limb; `None` if either may fetch.
fn limb(setting: config::Limb) -> Option<Limb> {
    match setting {
        config::Limb::Auto => None,
        config::Limb::Left => Some(Limb::Left),
        config::Limb::Right => Some(Limb::Right),
    }
}

fn plan_settings(motion: &config::Motion) -> PlanSettings {
    PlanSettings {
        speed_ratio: motion.speed_ratio,
        hover_m: motion.hover_m,
        hand_over_xyz_m: motion.hand_over_xyz_m,
        table_z_m: motion.table_z_m,
        open_percent: motion.grip_open_percent,
        standoff_m: motion.standoff_m,
        point_s: motion.point_s,
        margin_m: motion.margin_m,
    }
}

/// Reads the description; the built-in one is parsed once per process.
fn robot(files: &RobotFiles) -> Result<Robot, Diagnostics> {
    let srdf = files.srdf.as_ref().map(|file| file.text.as_str());
    if files.urdf.text == BAXTER_URDF && srdf == Some(BAXTER_SRDF) {
        return Ok(Robot::baxter().clone());
    }
    let description = robot_model::Robot::read(&files.urdf, files.srdf.as_ref())?;
    Robot::from_description(&description)
        .map_err(|error| Diagnostic::new(&*files.urdf.label, "", error.what, error.help).into())
}
