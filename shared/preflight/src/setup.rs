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
    /// Every fault of the description, the parts that an arm needs and it lacks, or a limb that it
    /// does not have.
    pub fn new(settings: &Settings) -> Result<Self, Diagnostics> {
        let robot = robot(settings.robot_files())?;
        let limb = limb(settings, &robot)?;
        Ok(Self { robot, limb, plan: plan_settings(&settings.arm.motion) })
    }
}

/// Returns the configured limb; `None` if any may fetch.
fn limb(settings: &Settings, robot: &Robot) -> Result<Option<Limb>, Diagnostics> {
    let Some(name) = &settings.arm.limb else { return Ok(None) };
    if let Some(limb) = robot.limb_named(name) {
        return Ok(Some(limb));
    }
    let known = robot.limbs().iter().map(|limb| robot.arm(*limb).name.as_str());
    let known: Vec<&str> = std::iter::once("auto").chain(known).collect();
    let what = format!("expected one of {}, found `{name}`", known.join(", "));
    let help = diagnostics::nearest(name, known.iter().copied()).map_or_else(
        || format!("use a limb of robot {}", robot.description().name()),
        |near| format!("did you mean `{near}`?"),
    );
    Err(settings.diagnostic(&["arm", "limb"], what, help).into())
}

fn plan_settings(motion: &config::Motion) -> PlanSettings {
    PlanSettings {
        speed_ratio: motion.speed_ratio,
        hover_m: motion.hover_m,
        hand_over_xyz_m: motion.hand_over_xyz_m,
        table_z_m: motion.table_z_m,
        table_near_m: motion.table_near_m,
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
