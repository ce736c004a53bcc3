//! The robot as a whole.

use crate::schema::wire_struct;
use crate::wire::{Code, wire_enum};
use iceoryx2::prelude::ZeroCopySend;

wire_enum! {
    /// The red button.
    EstopButton {
        /// Not pressed, and the robot is not stopped by it.
        Unpressed = 0,
        /// Pressed.
        Pressed = 1,
        /// The robot was stopped by something else.
        Unknown = 2,
        /// It was pressed and is not any more, but the robot is still stopped.
        Released = 3,
    }
}

wire_struct! {
    /// `baxter_core_msgs/AssemblyState` on `/robot/state`.
    AssemblyState = "AssemblyState" {
        /// 1 if it is enabled and takes commands: not homing, for example.
        ready: u8,
        /// 1 if its motors are on.
        enabled: u8,
        /// 1 while an emergency stop holds, until the robot is reset.
        stopped: u8,
        /// 1 if a part of it has a fault.
        error: u8,
        /// [`EstopButton`].
        estop_button: Code<EstopButton>,
        /// Cause of the stop: 0 none, 1 a person, 2 unknown, 3 a joint's fault, 4 its computer.
        estop_source: u8,
        /// Zero.
        reserved: [u8; 2],
    }
}
