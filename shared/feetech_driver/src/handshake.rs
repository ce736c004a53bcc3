//! What is on the bus, compared with what should be.

use std::collections::BTreeSet;

use service::Span;

use crate::bus::{Bus, Trouble};
use crate::layout::Layout;
use crate::line::Line;
use crate::packet::Answer;
use crate::registers::{Register, STORED, STS3215, Stored};
use crate::session::Ended;

/// Attempts to reach a servo, and to read all of them.
const ATTEMPTS: u32 = 6;
/// Pause between two attempts to read.
const PAUSE: Span = Span::from_ms(5);

/// Facts of the servos that stay.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Servos {
    /// Temperature at which each lets go, °C.
    pub(crate) heat_limits: Vec<u8>,
}

/// Looks for the servos and compares them with the calibration.
///
/// # Errors
/// Servos that are missing, of another model, in another mode, or calibrated otherwise.
pub(crate) fn shake<L: Line>(bus: &mut Bus<L>, layout: &Layout) -> Result<Servos, Ended> {
    let missing = missing(bus, layout)?;
    if missing.len() == layout.members.len() {
        let help = "help: switch the arm's supply on, and compare arm.feetech.baud with the servos";
        return Err(Ended(format!("no servo answers; {help}")));
    }
    if !missing.is_empty() {
        let help = "help: look at their plugs; a servo that blinks has let go: switch its supply off and on";
        return Err(Ended(format!("no answer of {}; {help}", missing.join(", "))));
    }
    let stored = read_surely(bus, STORED, &layout.ids(), Stored::of)?;
    for servo in &stored {
        let wrong = if servo.model != STS3215 {
            format!("servo {} is of model {}, expected {STS3215} (STS3215)", servo.id, servo.model)
        } else if servo.mode != 0 {
            format!("servo {} is in mode {}, expected 0: it holds positions", servo.id, servo.mode)
        } else {
            continue;
        };
        return Err(Ended(format!(
            "{wrong}; help: set the servo up again, `lerobot-setup-motors`"
        )));
    }
    let firmware: BTreeSet<[u8; 2]> = stored.iter().map(|servo| servo.firmware).collect();
    if firmware.len() > 1 {
        let versions: Vec<String> =
            firmware.iter().map(|[major, minor]| format!("{major}.{minor}")).collect();
        tracing::warn!(
            "the servos have different firmware: {}; help: update them with the maker's program",
            versions.join(", ")
        );
    }
    compare(&stored, layout).map_err(Ended)?;
    Ok(Servos { heat_limits: stored.iter().map(|servo| servo.heat_limit).collect() })
}

/// Returns the servos that do not answer.
///
/// # Errors
/// The device is gone.
pub(crate) fn missing<L: Line>(bus: &mut Bus<L>, layout: &Layout) -> Result<Vec<String>, Ended> {
    let mut missing = Vec::new();
    for member in &layout.members {
        let mut answers = false;
        for _ in 0..ATTEMPTS {
            answers = bus.ping(member.id()).map_err(|trouble| Ended(trouble.to_string()))?;
            if answers {
                break;
            }
        }
        if !answers {
            missing.push(member.name());
        }
    }
    Ok(missing)
}

/// Reads a register of these servos, again if it fails.
///
/// # Errors
/// It has failed too often.
pub(crate) fn read_surely<L: Line, T>(
    bus: &mut Bus<L>,
    register: Register,
    ids: &[u8],
    of: impl Fn(&Answer<'_>) -> T,
) -> Result<Vec<T>, Ended> {
    let mut last = None;
    for _ in 0..10 * ATTEMPTS {
        match bus.read(register, ids, &of) {
            Ok(read) => return Ok(read),
            Err(trouble) if trouble.is_of_device() => return Err(Ended(trouble.to_string())),
            Err(trouble) => last = Some(trouble),
        }
        let next = bus.line.now() + PAUSE;
        bus.line.wait_until(next);
    }
    let trouble = last.as_ref().map(Trouble::to_string).unwrap_or_default();
    Err(Ended(format!("the servos cannot be read: {trouble}; help: look at plugs and supply")))
}

/// Compares the servos with the calibration.
///
/// # Errors
/// All differences, with the command that ends them.
pub(crate) fn compare(stored: &[Stored], layout: &Layout) -> Result<(), String> {
    let differences: Vec<String> = differences(stored, layout).collect();
    if differences.is_empty() {
        return Ok(());
    }
    Err(format!(
        "the servos are not calibrated as the file says: {}; help: if the file is this arm's, `whichone robot servos \
         --write-calibration`",
        differences.join(", ")
    ))
}

/// The registers that differ from the calibration.
pub(crate) fn differences<'a>(
    stored: &'a [Stored],
    layout: &'a Layout,
) -> impl Iterator<Item = String> + 'a {
    stored.iter().zip(&layout.members).flat_map(|(servo, member)| {
        let file = member.calibrated;
        let pairs = [
            ("range_min", i32::from(servo.range[0]), i32::from(file.range_min)),
            ("range_max", i32::from(servo.range[1]), i32::from(file.range_max)),
            ("homing_offset", servo.offset, file.homing_offset),
        ];
        let differ = pairs.into_iter().filter(|(_, servo, file)| servo != file);
        differ.map(|(what, servo, file)| {
            format!("{} has {what} {servo}, the file {file}", member.name())
        })
    })
}
