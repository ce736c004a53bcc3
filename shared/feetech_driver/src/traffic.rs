//! What the driver and its port tell each other, as `Report::Own` and `Order::Own`.

use messages::robot::{Order, Report};
use serde::{Deserialize, Serialize};
use service::Time;

use crate::packet::Errors;

/// What the port has found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum Heard {
    /// A whole reading of all servos.
    Reading(Reading),
    /// The bus cannot be used, for this reason.
    Unusable(String),
}

/// One reading of all servos: those of the joints from the shoulder on, then the jaw's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Reading {
    pub(crate) at: Time,
    /// The positions can be true.
    pub(crate) is_plausible: bool,
    /// The servos hold, with their whole torque.
    pub(crate) is_ready: bool,
    pub(crate) servos: Vec<Servo>,
}

/// State of one servo.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Servo {
    /// Radians, or percent of the jaw.
    pub(crate) value: f64,
    /// The same per second.
    pub(crate) speed: f64,
    /// Share of the greatest torque, −1 to 1.
    pub(crate) load: f64,
    pub(crate) volts: f64,
    pub(crate) celsius: u8,
    pub(crate) errors: Errors,
    /// It holds, with the settings that it was told.
    pub(crate) holds: bool,
    /// It was told to hold, and does not, or has lost its settings: it has restarted, or let go.
    pub(crate) has_let_go: bool,
    /// It is cool enough to hold again.
    pub(crate) is_cool: bool,
}

/// What the port shall do.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Told {
    /// Goals of all servos, as [`Servo::value`]; empty: as they are.
    pub(crate) goals: Vec<f64>,
    /// Limit of the jaw's torque, 0.1 %.
    pub(crate) grip_permille: u16,
    /// Servos that do not hold shall hold where they are.
    pub(crate) switch_on: bool,
}

impl Heard {
    pub(crate) fn into_report(self) -> Report<'static> {
        Report::Own(postcard::to_stdvec(&self).unwrap_or_default())
    }

    /// Reads a report; `None` if it is another driver's.
    pub(crate) fn of(report: &Report<'_>) -> Option<Self> {
        let Report::Own(bytes) = report else { return None };
        postcard::from_bytes(bytes).ok()
    }
}

impl Told {
    pub(crate) fn into_order(self) -> Order<'static> {
        Order::Own(postcard::to_stdvec(&self).unwrap_or_default())
    }

    /// Reads an order; `None` if it is another driver's.
    pub(crate) fn of(order: &Order<'_>) -> Option<Self> {
        let Order::Own(bytes) = order else { return None };
        postcard::from_bytes(bytes).ok()
    }
}
