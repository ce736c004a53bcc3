//! The driver of arms whose controllers follow trajectories by themselves, as those of ros2_control do.
//!
//! Nothing watches a client of such a controller: a trajectory goes on when its client has died. So the driver sends
//! the next part of a motion alone, ten times a second, with a ramp to rest behind it ([`window`](mod@window)).
//! A bridge in a process of its own speaks to the controllers; [`messages`] travel between the two.

mod driver;
mod fingers;
mod messages;
mod port;
mod settings;
#[cfg(test)]
mod tests;
pub mod window;

pub use crate::messages::*;
pub use driver::TrajectoryDriver;
pub use settings::{Controllers, GripperController, GripperKind};

use arm_driver::{Configured, Driver};
use config::{Registered, Settings};
use diagnostics::Diagnostics;
use preflight::ArmSetup;

/// Name of the driver.
pub(crate) const NAME: &str = "trajectory";

/// Longest time between two orders, milliseconds.
pub const ORDER_EVERY_MS: u64 = 40;

/// Longest time for which the end of a cancelled command to the fingers is awaited, milliseconds.
pub const CANCEL_FINGERS_MS: u64 = 2_000;

/// The driver `trajectory`.
pub static DRIVER: Driver = Driver {
    about: &config::Driver {
        name: NAME,
        in_real_time: true,
        needs: if cfg!(feature = "dds") { None } else { Some("dds") },
        sections: &[Registered::of::<Controllers>()],
    },
    configure: |settings: &Settings, _| {
        let own: Controllers = settings.part()?;
        joint_names(settings, &own)?;
        Ok(Configured::new(move |start| Box::new(TrajectoryDriver::new(own.clone(), start))))
    },
    connect: Some(port::connect),
    examine: None,
};

/// Returns the controller's names of the joints of the limb that fetches, shoulder first.
///
/// # Errors
/// The robot's description cannot be used, or the setting names another number of joints than it has.
pub fn joint_names(settings: &Settings, own: &Controllers) -> Result<Vec<String>, Diagnostics> {
    let ArmSetup { robot, limb, .. } = ArmSetup::new(settings)?;
    let limb = limb.unwrap_or(robot.limbs()[0]);
    let described = &robot.arm(limb).joint_names;
    if own.joints.is_empty() {
        return Ok(described.clone());
    }
    if own.joints.len() != described.len() {
        let (expected, found) = (described.len(), own.joints.len());
        let what = format!("expected the names of {expected} joints, found {found}");
        let help =
            "name the controller's joints in the order of the robot's description, shoulder first";
        return Err(settings.diagnostic(&["arm", "trajectory", "joints"], what, help).into());
    }
    Ok(own.joints.clone())
}
