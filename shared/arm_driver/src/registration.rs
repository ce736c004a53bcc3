//! Registration of drivers by name.

use std::fmt;
use std::sync::Arc;

use config::Settings;
use diagnostics::{Diagnostic, Diagnostics};
use manipulation::{Limb, Robot};
use messages::robot::{Order, Report};
use runtime::bus::{Bus, PortError};
use runtime::exit::Failure;

use crate::{ArmDriver, Posture};

/// A driver as the arm knows it.
#[derive(Debug)]
pub struct Driver {
    /// Its name in `arm.driver`, its sections and the facts by which a configuration is checked.
    pub about: &'static config::Driver,
    /// Reads its settings for a robot.
    ///
    /// # Errors
    /// Every problem at once; there are none in a configuration that was checked by a program that knows the driver.
    pub configure: fn(&Settings, &Robot) -> Result<Configured, Diagnostics>,
    /// The way to the robot; `None` for a model, which has no robot.
    pub connect: Option<Connect>,
    /// Looks for the driver's needs on this machine, such as devices; `None` if it has none.
    pub examine: Option<Examine>,
}

/// Opens the way to the robot: topics of the group, or what the driver's settings name.
///
/// # Errors
/// Topics or devices that cannot be opened.
pub type Connect = fn(&Bus, &Settings, &Robot) -> Result<Box<dyn Port>, Failure>;

/// Returns everything that is missing, for `whichone check`.
pub type Examine = fn(&Settings, &Robot) -> Vec<Diagnostic>;

/// The drivers of a program that moves an arm.
pub trait Drivers: 'static {
    /// The list, in the order in which an error names them.
    const LIST: &'static [&'static Driver];
}

/// The way of messages between a driver and its robot: topics of the group, or a device. It decides nothing, since
/// what passes here is recorded in flights, and what a driver makes of it is replayed.
pub trait Port: fmt::Debug {
    /// Hands over the reports that have arrived. It is called in every pass of the arm and does not wait.
    ///
    /// # Errors
    /// As [`runtime::bus::Reader::take`].
    fn drain(&mut self, take: &mut dyn FnMut(Report<'_>)) -> Result<(), PortError>;

    /// Sends an order.
    ///
    /// # Errors
    /// As [`runtime::bus::Writer::send`].
    fn send(&mut self, order: &Order<'_>) -> Result<(), PortError>;
}

/// The arm as its journal left it, from which a driver starts.
#[derive(Clone, Copy, Debug)]
pub struct Start<'a> {
    /// The robot: links, joints, limits, grippers.
    pub robot: &'a Robot,
    /// The limb that fetches; `None` if any may.
    pub limb: Option<Limb>,
    /// Joint positions and widths of the fingers.
    pub posture: Posture,
    /// The limb whose gripper holds an object.
    pub holding: Option<Limb>,
}

type Open = dyn Fn(&Start<'_>) -> Box<dyn ArmDriver> + Send + Sync;

/// A driver with its settings.
#[derive(Clone)]
pub struct Configured(Arc<Open>);

impl Configured {
    /// Returns the driver that `open` starts.
    pub fn new(open: impl Fn(&Start<'_>) -> Box<dyn ArmDriver> + Send + Sync + 'static) -> Self {
        Self(Arc::new(open))
    }

    /// Starts the driver.
    pub fn open(&self, start: &Start<'_>) -> Box<dyn ArmDriver> {
        (self.0)(start)
    }
}

/// The same, configured once.
impl PartialEq for Configured {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for Configured {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Configured")
    }
}

/// Returns the configured one of these drivers.
///
/// # Errors
/// The program has no driver of this name, or it moves a robot and time is scaled.
pub fn named<'a>(
    drivers: impl Iterator<Item = &'a Driver> + Clone,
    settings: &Settings,
) -> Result<&'a Driver, Diagnostics> {
    let name = settings.arm.driver.as_str();
    let found = drivers.clone().find(|driver| driver.about.name == name);
    let Some(driver) = found else {
        let known: Vec<&str> = drivers.map(|driver| driver.about.name).collect();
        let what = format!("expected one of {}, found `{name}`", known.join(", "));
        let help =
            "these are the drivers of this program; group.services.arm.command starts another one";
        return Err(settings.diagnostic(&["arm", "driver"], what, help).into());
    };
    match driver.about.pace_problem(settings.arm.time_scale) {
        None => Ok(driver),
        Some((what, help)) => Err(settings.diagnostic(&["arm", "time_scale"], what, help).into()),
    }
}
