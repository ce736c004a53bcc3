//! External influences on the simulated robot: people around it, and faults.

use crate::schema::wire_struct;
use crate::wire::{Code, wire_enum};
use iceoryx2::prelude::ZeroCopySend;

wire_enum! {
    /// An external influence on the simulated robot.
    DrillKind {
        /// `set_super_enable` true: motors on.
        Enable = 0,
        /// `set_super_enable` false: motors off.
        Disable = 1,
        /// `set_super_reset`: faults and emergency stop are cleared; the motors stay off.
        Reset = 2,
        /// A person presses the red button.
        PressEstop = 3,
        /// A person releases it; the robot stays stopped until it is reset.
        ReleaseEstop = 4,
        /// A part of it fails.
        Fail = 5,
        /// No joint states for some seconds.
        Silence = 6,
        /// The next grasps close beside the object; `amount` says how many.
        Miss = 7,
        /// Something holds a limb for some seconds, so that it cannot follow.
        Obstruct = 8,
    }
}

wire_struct! {
    /// Something that happens to the simulated robot. Clients to the simulated robot; a real one
    /// has no such topic.
    Drill = "Drill" {
        /// Made by the client; a drill that comes twice happens once.
        key: u64,
        /// Seconds or a number, after the kind.
        amount: f64,
        /// [`DrillKind`].
        kind: Code<DrillKind>,
        /// Zero.
        reserved: [u8; 7],
    }
}
