//! The driver of an arm on a bus of Feetech servos, as SO-100 and SO-101 have it.
//!
//! | contents | file |
//! |---|---|
//! | packets, registers | `packet.rs`, `registers.rs` |
//! | serial line, who else has opened it, requests with their answers | `line.rs`, `holder.rs`, `bus.rs` |
//! | lerobot's calibration, servos of joints | `calibration.rs`, `layout.rs` |
//! | servos on the bus, one exchange, plausibility | `handshake.rs`, `session.rs`, `plausible.rs` |
//! | the thread that uses the bus | `port.rs`, `traffic.rs` |
//! | set points to goals, readings to measurements and faults | `driver.rs`, `jaw.rs` |
//! | a person's orders to the servos | `service_desk.rs` |

mod bus;
mod calibration;
mod driver;
mod handshake;
mod holder;
mod jaw;
mod layout;
mod line;
mod packet;
mod plausible;
mod port;
mod registers;
mod service_desk;
mod session;
mod settings;
mod setup;
mod traffic;

#[cfg(test)]
mod tests;

pub use driver::FeetechDriver;
pub use service_desk::{Condition, Done, Found, ServiceDesk};
pub use settings::Feetech;

use arm_driver::{Configured, Driver};
use config::{Registered, Settings};
use manipulation::Robot;

/// The driver's name.
pub(crate) const NAME: &str = "feetech";

/// The driver `feetech`.
pub static DRIVER: Driver = Driver {
    about: &config::Driver {
        name: NAME,
        in_real_time: true,
        needs: None,
        sections: &[Registered::of::<Feetech>()],
    },
    configure: |settings: &Settings, robot: &Robot| {
        let own: Feetech = settings.part()?;
        setup::suits(settings, &own, robot)?;
        Ok(Configured::new(move |start| Box::new(FeetechDriver::new(own.clone(), start))))
    },
    connect: Some(setup::connect),
    examine: Some(setup::examine),
};
