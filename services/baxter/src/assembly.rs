//! The robot as a whole: motors, faults and the red button.

use messages::robot::{AssemblyState, DrillKind, EstopButton};
use serde::{Deserialize, Serialize};

/// `ESTOP_SOURCE_USER`.
const BY_A_PERSON: u8 = 1;

/// State of the motors, and the cause that keeps them off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Assembly {
    enabled: bool,
    stopped: bool,
    error: bool,
    pressed: bool,
}

impl Assembly {
    /// Returns a robot that was just switched on, its motors `enabled` or not.
    pub fn new(enabled: bool) -> Self {
        Self { enabled, stopped: false, error: false, pressed: false }
    }

    /// Returns whether it takes commands.
    pub fn is_enabled(&self) -> bool {
        self.enabled
    }

    /// Injected faults and button presses.
    pub fn drill(&mut self, kind: DrillKind) {
        match kind {
            DrillKind::Enable if self.stopped || self.error => {
                tracing::warn!("stopped or with a fault, it has to be reset first");
            }
            DrillKind::Enable => self.enabled = true,
            DrillKind::Disable => self.enabled = false,
            DrillKind::Reset if self.pressed => tracing::warn!("the button is still pressed"),
            DrillKind::Reset => (self.stopped, self.error) = (false, false),
            DrillKind::PressEstop => {
                (self.pressed, self.stopped, self.enabled) = (true, true, false);
            }
            DrillKind::ReleaseEstop => self.pressed = false,
            DrillKind::Fail => (self.error, self.enabled) = (true, false),
            // These are of the robot's surroundings.
            DrillKind::Silence
            | DrillKind::Miss
            | DrillKind::Obstruct
            | DrillKind::Put
            | DrillKind::Take => {}
        }
    }

    /// Returns its reported state.
    pub fn state(&self) -> AssemblyState {
        let button = match (self.stopped, self.pressed) {
            (_, true) => EstopButton::Pressed,
            (true, false) => EstopButton::Released,
            (false, false) => EstopButton::Unpressed,
        };
        AssemblyState {
            ready: self.enabled.into(),
            enabled: self.enabled.into(),
            stopped: self.stopped.into(),
            error: self.error.into(),
            estop_button: button.code(),
            estop_source: if self.stopped { BY_A_PERSON } else { 0 },
            ..AssemblyState::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn after_an_emergency_stop_it_wants_release_reset_and_enable_in_this_order() {
        let mut robot = Assembly::new(true);
        robot.drill(DrillKind::PressEstop);
        for kind in [DrillKind::Enable, DrillKind::Reset, DrillKind::Enable] {
            robot.drill(kind);
            assert!(!robot.is_enabled() && robot.state().stopped == 1);
        }
        robot.drill(DrillKind::ReleaseEstop);
        assert_eq!(robot.state().estop_button, EstopButton::Released.code());
        robot.drill(DrillKind::Enable);
        assert!(!robot.is_enabled());
        robot.drill(DrillKind::Reset);
        robot.drill(DrillKind::Enable);
        assert!(robot.is_enabled());
        assert_eq!(robot.state(), Assembly::new(true).state());
    }
}
