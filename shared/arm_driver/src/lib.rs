//! The contract between the arm and its drivers: set points and measurements ([`ArmDriver`]), the way of messages
//! to the robot ([`Port`]), and the registration of a driver under a name ([`Driver`]).
//!
//! A driver is a crate of its own, which neither the arm nor the configuration names. A program that moves an arm
//! lists the drivers that it has ([`Drivers`]).

mod driver;
mod fault;
mod motion;
mod registration;

pub use driver::ArmDriver;
pub use fault::Fault;
pub use motion::{Command, Fingers, Grip, Measured, Posture, Source, furthest};
pub use registration::{Configured, Connect, Driver, Drivers, Examine, Port, Start, named};
