//! The list of drivers of arms that ship: a line for each. The kinematic model is built into the arm.

use arm_driver::{Driver, Drivers};

/// The drivers that ship, for a program that moves an arm.
#[derive(Debug)]
pub struct Shipped;

impl Drivers for Shipped {
    const LIST: &'static [&'static Driver] =
        &[&baxter_driver::DRIVER, &feetech_driver::DRIVER, &trajectory_driver::DRIVER];
}

/// The same for a program that loads configurations.
pub fn known() -> impl Iterator<Item = &'static config::Driver> {
    Shipped::LIST.iter().map(|driver| driver.about)
}
