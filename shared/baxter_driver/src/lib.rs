//! The driver of a Baxter behind its own topics: a real one's bridge, or the simulated one.

mod driver;
mod gripper;
mod robot_side;
mod settings;
#[cfg(test)]
mod tests;
mod topics;

pub use driver::BaxterDriver;
pub use robot_side::RobotSide;
pub use settings::Baxter;

use arm_driver::{Configured, Driver};
use config::{Registered, Settings};
use manipulation::Robot;

/// The driver `baxter`.
pub static DRIVER: Driver = Driver {
    about: &config::Driver {
        name: "baxter",
        in_real_time: true,
        needs: None,
        sections: &[Registered::of::<Baxter>()],
    },
    configure: |settings: &Settings, _: &Robot| {
        let own: Baxter = settings.part()?;
        Ok(Configured::new(move |start| Box::new(BaxterDriver::new(own, start))))
    },
    connect: Some(topics::connect),
    examine: None,
};
