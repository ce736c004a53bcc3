//! The robot as a whole, and influences on the simulated one: people around it, and faults.

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
        /// A person puts an object at `place`, wherever it was; not one that is in a gripper.
        Put = 9,
        /// A person takes an object off the table.
        Take = 10,
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
        /// Key of the scene file that `object` is from.
        scene_key: u64,
        /// Where the object is put: centre in frame `base`, metres, and yaw, radians.
        place: [f64; 4],
        /// Which object of the scene file is put or taken.
        object: u16,
        /// [`DrillKind`].
        kind: Code<DrillKind>,
        /// Zero.
        reserved: [u8; 5],
    }
}
