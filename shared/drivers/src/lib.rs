//! The list of drivers of arms that ship: a line for each. The kinematic model is built into the arm.

use arm_driver::{Driver, Drivers};

static ALL: &[&Driver] = &[&baxter_driver::DRIVER];

/// The drivers that ship, for a program that moves an arm.
#[derive(Debug)]
pub struct Shipped;

impl Drivers for Shipped {
    fn list() -> &'static [&'static Driver] {
        ALL
    }
}

/// The same for a program that loads configurations.
pub fn known() -> impl Iterator<Item = &'static config::Driver> {
    ALL.iter().map(|driver| driver.about)
}
