//! Registers of the STS3215: addresses, units, signs. Below 40 they are stored, from there on volatile.
//!
//! Negative values are sign and magnitude, the sign in a bit of its own, and not two's complement.

use crate::packet::{Answer, Errors};

/// Steps of one turn.
pub(crate) const STEPS: f64 = 4096.0;
/// The number of the model STS3215.
pub(crate) const STS3215: u16 = 777;

/// Address and size of a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Register(pub(crate) u8, pub(crate) u8);

/// Least position, steps; greatest and least both 0: no limit.
pub(crate) const RANGE_MIN: Register = Register(9, 2);
/// Greatest position, steps.
pub(crate) const RANGE_MAX: Register = Register(11, 2);
/// Homing offset, steps, sign in bit 11: shown = actual − offset.
pub(crate) const OFFSET: Register = Register(31, 2);
/// 0 off, 1 on.
pub(crate) const TORQUE: Register = Register(40, 1);
/// Acceleration, 100 steps/s²; 0 is the servo's own.
pub(crate) const ACCELERATION: Register = Register(41, 1);
/// Goal, steps, sign in bit 15.
pub(crate) const GOAL: Register = Register(42, 2);
/// Greatest speed, steps/s.
pub(crate) const SPEED_LIMIT: Register = Register(46, 2);
/// From the goal to the limit of torque: goal, time (not used), speed and torque.
pub(crate) const TARGET: Register = Register(42, 8);
/// Greatest torque, 0.1 %; a copy of a stored value at power-on.
pub(crate) const TORQUE_LIMIT: Register = Register(48, 2);
/// 0: stored registers are saved; 1: they are used and lost at power-off.
pub(crate) const LOCK: Register = Register(55, 1);

/// The stored registers, of which the calibration is a part.
pub(crate) const STORED: Register = Register(0, 40);
/// Everything that changes while the arm moves, with what it was told: a servo that has restarted, or has not taken a
/// goal, shows in the same answer as its position.
pub(crate) const STATE: Register = Register(40, 31);

/// Two bytes, low one first.
fn word(data: &[u8], at: usize) -> u16 {
    u16::from_le_bytes([data[at], data[at + 1]])
}

/// The number whose sign is in `bit`.
pub(crate) fn signed(raw: u16, bit: u32) -> i32 {
    let magnitude = i32::from(raw & ((1 << bit) - 1));
    if raw >> bit & 1 == 1 { -magnitude } else { magnitude }
}

/// A number with its sign in `bit`; magnitudes beyond the bit become the greatest.
pub(crate) fn with_sign(value: i32, bit: u32) -> u16 {
    let magnitude = value.unsigned_abs().min((1 << bit) - 1) as u16;
    if value < 0 { magnitude | 1 << bit } else { magnitude }
}

/// The volatile registers of one servo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct State {
    pub(crate) id: u8,
    /// Error byte of the answer, and the status register.
    pub(crate) errors: Errors,
    pub(crate) torque: u8,
    pub(crate) acceleration: u8,
    pub(crate) goal: u16,
    pub(crate) speed_limit: u16,
    pub(crate) torque_limit: u16,
    /// Steps.
    pub(crate) position: i32,
    /// Steps/s.
    pub(crate) speed: i32,
    /// 0.1 % of the greatest torque.
    pub(crate) load: i32,
    /// 0.1 V.
    pub(crate) decivolts: u8,
    pub(crate) celsius: u8,
}

impl State {
    /// Reads an answer to a reading of [`STATE`].
    pub(crate) fn of(answer: &Answer<'_>) -> Self {
        let data = answer.data;
        let at = |register: u8| usize::from(register - STATE.0);
        Self {
            id: answer.id,
            errors: Errors(answer.errors.0 | data[at(65)]),
            torque: data[at(40)],
            acceleration: data[at(41)],
            goal: word(data, at(42)),
            speed_limit: word(data, at(46)),
            torque_limit: word(data, at(48)),
            position: signed(word(data, at(56)), 15),
            speed: signed(word(data, at(58)), 15),
            load: signed(word(data, at(60)), 10),
            decivolts: data[at(62)],
            celsius: data[at(63)],
        }
    }
}

/// The stored registers of one servo, as far as this program looks at them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Stored {
    pub(crate) id: u8,
    /// Version of its firmware.
    pub(crate) firmware: [u8; 2],
    pub(crate) model: u16,
    pub(crate) range: [u16; 2],
    /// °C at which it lets go.
    pub(crate) heat_limit: u8,
    pub(crate) offset: i32,
    /// 0: it holds positions.
    pub(crate) mode: u8,
}

impl Stored {
    /// Reads an answer to a reading of [`STORED`].
    pub(crate) fn of(answer: &Answer<'_>) -> Self {
        let data = answer.data;
        Self {
            id: answer.id,
            firmware: [data[0], data[1]],
            model: word(data, 3),
            range: [word(data, 9), word(data, 11)],
            heat_limit: data[13],
            offset: signed(word(data, 31), 11),
            mode: data[33],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_round_trip_in_each_bit() {
        for bit in [10, 11, 15] {
            let most = (1 << bit) - 1;
            for value in [0, 1, -1, 57, -964, most, -most] {
                assert_eq!(signed(with_sign(value, bit), bit), value, "{value} in bit {bit}");
            }
            assert_eq!(signed(with_sign(-100_000, bit), bit), -most);
        }
        assert_eq!(with_sign(-1, 15), 0x8001);
    }
}
