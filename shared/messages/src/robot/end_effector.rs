//! The grippers.

use crate::schema::wire_struct;
use crate::text::FixedText;
use crate::wire::{Code, WireError, wire_enum};
use iceoryx2::prelude::ZeroCopySend;

wire_enum! {
    /// The three values of a gripper's state fields.
    Tristate {
        /// `STATE_FALSE`.
        False = 0,
        /// `STATE_TRUE`.
        True = 1,
        /// `STATE_UNKNOWN`: unknown, or not known to this gripper.
        Unknown = 2,
    }
}

wire_enum! {
    /// Mounted end effector: [`EndEffectorProperties::ui_type`].
    UiType {
        /// Nothing.
        NoGripper = 0,
        /// A vacuum gripper.
        SuctionCup = 1,
        /// The electric parallel gripper.
        Electric = 2,
        /// Something without a motor, or a gripper of one's own.
        Passive = 3,
    }
}

/// [`EndEffectorState::command_sequence`] of a gripper that does not count commands.
pub const NO_SEQUENCE: u32 = 0;

/// Commands to a gripper: the words of [`EndEffectorCommand::command`].
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Command {
    /// `calibrate`: finds both ends of the fingers' travel; before it none but this is obeyed.
    Calibrate,
    /// `go` to a position in percent: 0 closed, 100 open. Fingers that meet something on the way
    /// stop and hold it.
    Go(f64),
    /// `grip`: closes until something is held.
    Grip,
    /// `release`: opens.
    Release,
    /// `stop`: hold the position.
    Stop,
    /// `configure`: force with which held objects are pressed, percent.
    Configure(f64),
}

wire_struct! {
    /// `baxter_core_msgs/EndEffectorCommand`.
    EndEffectorCommand = "EndEffectorCommand" {
        /// The gripper's own number, from its state.
        id: u32,
        /// Comes back in the state once the command is handled.
        sequence: u32,
        /// `calibrate`, `go`, `grip`, `release`, `stop` or `configure`.
        command: FixedText<28>,
        /// JSON; for `go` as `{"position": 50.0}`, for `configure` as `{"holding_force": 100.0}`.
        args: FixedText<60>,
        /// Comes back in the state once the command is handled.
        sender: FixedText<28>,
    }
}

wire_struct! {
    /// `baxter_core_msgs/EndEffectorState`. The bytes are [`Tristate`]s.
    EndEffectorState = "EndEffectorState" {
        /// When the state was so, monotonic clock.
        timestamp_ns: u64,
        /// The gripper's own number.
        id: u32,
        /// True if it is switched on.
        enabled: Code<Tristate>,
        /// True if it has been calibrated.
        calibrated: Code<Tristate>,
        /// True if it accepts commands.
        ready: Code<Tristate>,
        /// True if the fingers are moving.
        moving: Code<Tristate>,
        /// True if the fingers stopped at something: the force threshold was met on the way.
        gripping: Code<Tristate>,
        /// True if the fingers came to the end of a command without meeting anything.
        missed: Code<Tristate>,
        /// True if it has a fault; it has to be reset then.
        error: Code<Tristate>,
        /// True if it grips by opening.
        reverse: Code<Tristate>,
        /// Percent: 0 closed, 100 open.
        position: f32,
        /// Percent of the greatest force.
        force: f32,
        /// Sequence number of the last command that was handled, or [`NO_SEQUENCE`].
        command_sequence: u32,
        /// The last command.
        command: FixedText<28>,
        /// The sender.
        command_sender: FixedText<28>,
    }
}

wire_struct! {
    /// `baxter_core_msgs/EndEffectorProperties`: what is mounted. Text fields beyond product and
    /// serial number stay behind: nothing here depends on them.
    EndEffectorProperties = "EndEffectorProperties" {
        /// The gripper's own number.
        id: u32,
        /// [`UiType`].
        ui_type: Code<UiType>,
        /// 1 if it has to be calibrated.
        has_calibration: u8,
        /// 1 if it obeys `grip` and `release`.
        controls_grip: u8,
        /// 1 if it feels what it grips.
        senses_grip: u8,
        /// 1 if it can grip by opening.
        reverses_grip: u8,
        /// 1 if its force can be set.
        controls_force: u8,
        /// 1 if it measures its force.
        senses_force: u8,
        /// 1 if it obeys `go`.
        controls_position: u8,
        /// 1 if it measures its position.
        senses_position: u8,
        /// Zero.
        reserved: [u8; 3],
        /// The manufacturer.
        manufacturer: FixedText<60>,
        /// The product name.
        product: FixedText<60>,
        /// Its serial number.
        serial_number: FixedText<28>,
    }
}

impl Command {
    /// Name of the command in messages.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Calibrate => "calibrate",
            Self::Go(_) => "go",
            Self::Grip => "grip",
            Self::Release => "release",
            Self::Stop => "stop",
            Self::Configure(_) => "configure",
        }
    }
}

impl EndEffectorCommand {
    /// The message that says `command`.
    pub fn new(id: u32, command: Command, sender: &str, sequence: u32) -> Self {
        let args = match command {
            Command::Go(position) => format!("{{\"position\": {position:.3}}}"),
            Command::Configure(force) => format!("{{\"holding_force\": {force:.3}}}"),
            _ => String::new(),
        };
        Self {
            id,
            sequence,
            command: FixedText::truncated(command.word()),
            args: FixedText::truncated(&args),
            sender: FixedText::truncated(sender),
        }
    }

    /// Decodes the command.
    ///
    /// # Errors
    /// A word that no gripper knows, or a `go` or `configure` without its number.
    pub fn read(&self) -> Result<Command, WireError> {
        match self.command.as_str()? {
            "calibrate" => Ok(Command::Calibrate),
            "go" => Ok(Command::Go(self.percent("\"position\"")?)),
            "grip" => Ok(Command::Grip),
            "release" => Ok(Command::Release),
            "stop" => Ok(Command::Stop),
            "configure" => Ok(Command::Configure(self.percent("\"holding_force\"")?)),
            other => Err(WireError::new("gripper command of length", other.len() as u32)),
        }
    }

    /// The number under `key` in its arguments, percent.
    fn percent(&self, key: &str) -> Result<f64, WireError> {
        let args = self.args.as_str()?;
        let bad = || WireError::new("gripper arguments of length", args.len() as u32);
        let (_, after) = args.split_once(key).ok_or_else(bad)?;
        let number: String = after
            .trim_start_matches([':', ' '])
            .chars()
            .take_while(|c| c.is_ascii_digit() || "+-.eE".contains(*c))
            .collect();
        let percent: f64 = number.parse().map_err(|_| bad())?;
        if percent.is_finite() { Ok(percent.clamp(0.0, 100.0)) } else { Err(bad()) }
    }
}

impl EndEffectorState {
    /// Returns whether this state is of a gripper that has handled `command`.
    pub fn has_handled(&self, command: &EndEffectorCommand) -> bool {
        let numbered = [command.sequence, NO_SEQUENCE].contains(&self.command_sequence);
        numbered && self.command_sender == command.sender
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gripper_commands_round_trip() {
        use Command::{Calibrate, Configure, Go, Grip, Release, Stop};
        for command in [Calibrate, Go(12.5), Go(100.0), Grip, Release, Stop, Configure(100.0)] {
            let message = EndEffectorCommand::new(3, command, "whichone", 7);
            assert_eq!(message.read(), Ok(command));
        }
    }

    #[test]
    fn gripper_positions_of_other_programs_are_accepted() {
        let say = |args: &str| {
            let args = FixedText::truncated(args);
            let go = EndEffectorCommand::new(0, Command::Go(0.0), "", 0);
            EndEffectorCommand { args, ..go }.read()
        };
        assert_eq!(say("{\"position\":2.5e1}"), Ok(Command::Go(25.0)));
        assert_eq!(say("{\"velocity\": 3, \"position\" : 300}"), Ok(Command::Go(100.0)));
        assert!(say("{\"position\": fast}").is_err() && say("").is_err());
    }

    #[test]
    fn gripper_state_confirms_a_command_by_sender_and_number() {
        let command = EndEffectorCommand::new(3, Command::Grip, "whichone", 7);
        let state = EndEffectorState {
            command_sender: command.sender,
            command_sequence: 7,
            ..EndEffectorState::default()
        };
        assert!(state.has_handled(&command));
        assert!(EndEffectorState { command_sequence: 0, ..state }.has_handled(&command));
        assert!(!EndEffectorState { command_sequence: 6, ..state }.has_handled(&command));
        assert!(!EndEffectorState::default().has_handled(&command));
    }
}
