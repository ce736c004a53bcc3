//! Settings, calibration and robot together.

use std::path::Path;

use arm_driver::Port;
use config::Settings;
use diagnostics::{Diagnostic, Diagnostics};
use manipulation::{Limb, Robot};
use service::bus::Bus;
use service::exit::{Exit, Failure};

use crate::layout::Layout;
use crate::line::{self, PortProblem};
use crate::port::{ServoPort, Use};
use crate::registers::STEPS;
use crate::session::Limits;
use crate::settings::Feetech;

/// Refuses robots with two limbs, and those that are planned to move faster than their servos.
pub(crate) fn suits(settings: &Settings, own: &Feetech, robot: &Robot) -> Result<(), Diagnostics> {
    let limbs = robot.limbs().len();
    if limbs != 1 {
        let what = format!("expected a robot with one limb, found {limbs}");
        let help = "use driver = \"kinematic\", or a robot file with one limb: each bus of servos is an arm of its own";
        return Err(settings.diagnostic(&["arm", "driver"], what, help).into());
    }
    let arm = robot.arm(Limb::Only);
    let speeds = arm.joint_names.iter().zip(arm.limits.velocity);
    let Some((joint, fastest)) = speeds.max_by(|(_, a), (_, b)| a.total_cmp(b)) else {
        return Ok(());
    };
    let planned = fastest * settings.arm.motion.speed_ratio;
    if planned <= own.speed_max_rad_s {
        return Ok(());
    }
    let most = own.speed_max_rad_s;
    let what = format!(
        "joint {joint} is planned to move at {planned:.2} rad/s, its servo moves at {most:.2} at most"
    );
    let help = format!(
        "write `speed_ratio = {:.2}`, lower the velocity of its <limit>, or raise arm.feetech.speed_max_rad_s",
        (100.0 * most / fastest).floor() / 100.0
    );
    Err(settings.diagnostic(&["arm", "speed_ratio"], what, help).into())
}

/// The port and what is on it, by settings and calibration.
pub(crate) fn with(settings: &Settings, robot: &Robot) -> Result<Use, Vec<Diagnostic>> {
    let own: Feetech =
        settings.part().map_err(|problems| problems.iter().cloned().collect::<Vec<_>>())?;
    let calibration = own.calibrated().map_err(|problem| vec![problem])?;
    let layout = Layout::new(&own, robot, &calibration)?;
    let limits = Limits {
        speed: (own.speed_max_rad_s * STEPS / std::f64::consts::TAU).round() as u16,
        joints_permille: (10.0 * own.torque.joints_percent) as u16,
    };
    Ok(Use { port: own.port, baud: own.baud, layout, limits })
}

/// Starts the thread that uses the bus.
pub(crate) fn connect(
    _: &Bus,
    settings: &Settings,
    robot: &Robot,
) -> Result<Box<dyn Port>, Failure> {
    let with = with(settings, robot).map_err(|problems| {
        let lines: Vec<String> = problems.iter().map(Diagnostic::to_string).collect();
        Failure::new(Exit::Config, lines.join("\n"))
    })?;
    let port = ServoPort::start(with)
        .map_err(|error| Failure::new(Exit::NotReached, error.to_string()))?;
    Ok(Box::new(port))
}

/// Returns what this machine lacks for the arm: its port, its calibration, servos of joints.
pub(crate) fn examine(settings: &Settings, robot: &Robot) -> Vec<Diagnostic> {
    let mut problems = with(settings, robot).err().unwrap_or_default();
    if let Ok(own) = settings.part::<Feetech>()
        && let Some(problem) = line::problem_of(&own.port)
    {
        problems.push(port_diagnostic(settings, &own.port, &problem));
    }
    problems
}

/// A problem of the port, at its key.
pub(crate) fn port_diagnostic(
    settings: &Settings,
    port: &Path,
    problem: &PortProblem,
) -> Diagnostic {
    let text = format!("{}: {problem}", port.display());
    let (what, help) = text.split_once("; help: ").unwrap_or((&text, "choose another port"));
    settings.diagnostic(&["arm", crate::NAME, "port"], what, help)
}
