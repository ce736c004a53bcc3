//! One electric gripper.

use manipulation::gripper::{DEAD_ZONE, Gripper, SPEED_M_S};
use messages::robot::{Command, EndEffectorCommand, EndEffectorState, Tristate};
use serde::{Deserialize, Serialize};

/// Force of fingers that hold something, percent: the SDK's holding force.
const HOLDING_FORCE: f32 = 30.0;

/// One gripper: fingers that move at their speed and stop at what they meet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fingers {
    /// Width between the fingers, metres.
    pub width_m: f64,
    /// Target widths, the next one first; none at rest.
    goals: Vec<f64>,
    calibrated: bool,
    calibrating: bool,
    /// Width of what is between the fingers, where there is something.
    object_m: Option<f64>,
    gripping: bool,
    missed: bool,
    /// The last command that was handled: word, sender, number.
    handled: (String, String, u32),
}

/// Event of the fingers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// They start to close; the object between them is to be determined.
    Closes,
    /// They have stopped at what is between them.
    Holds,
    /// They have let go of it.
    LetsGo,
}

impl Fingers {
    /// Handles a command. A repeated one, or one that needs calibration that is missing,
    /// changes nothing.
    pub fn command(&mut self, message: &EndEffectorCommand, gripper: &Gripper) -> Option<Event> {
        let command = match message.read() {
            Ok(command) => command,
            Err(error) => {
                tracing::warn!(%error, "a gripper command that makes no sense is ignored");
                return None;
            }
        };
        let text = |text: &str| text.to_owned();
        let sender = text(message.sender.as_str().unwrap_or_default());
        let handled = (text(command.word()), sender, message.sequence);
        if handled == self.handled {
            return None;
        }
        if !self.calibrated && command != Command::Calibrate {
            tracing::warn!(command = command.word(), "not calibrated; the command is ignored");
            return None;
        }
        self.handled = handled;
        match command {
            Command::Calibrate => {
                self.calibrated = false;
                self.calibrating = true;
                self.go(vec![gripper.open_m, gripper.closed_m(), gripper.open_m], gripper)
            }
            Command::Go(percent) => self.go(vec![gripper.width_m(percent)], gripper),
            Command::Grip => self.go(vec![gripper.closed_m()], gripper),
            Command::Release => self.go(vec![gripper.open_m], gripper),
            Command::Stop => {
                self.goals.clear();
                None
            }
            // Simulated fingers do not slip.
            Command::Configure(_) => None,
        }
    }

    /// Width of the object between the fingers when they begin to close, if any.
    pub fn meet(&mut self, object_m: Option<f64>) {
        self.object_m = object_m;
    }

    /// Advances the time.
    pub fn advance(&mut self, seconds: f64, gripper: &Gripper) -> Option<Event> {
        let goal_m = *self.goals.first()?;
        let travel_m = SPEED_M_S * seconds;
        let stop_m = self.object_m.filter(|object_m| goal_m < *object_m);
        let end_m = stop_m.unwrap_or(goal_m);
        self.width_m += (end_m - self.width_m).clamp(-travel_m, travel_m);
        if (self.width_m - end_m).abs() > 1e-9 {
            return None;
        }
        self.goals.remove(0);
        if !self.goals.is_empty() {
            return None;
        }
        if std::mem::take(&mut self.calibrating) {
            self.calibrated = true;
            return None;
        }
        self.gripping = stop_m.is_some() && gripper.holds(self.width_m);
        self.missed = !self.gripping;
        self.gripping.then_some(Event::Holds)
    }

    /// Returns the gripper's reported state.
    pub fn state(&self, timestamp_ns: u64, enabled: bool, gripper: &Gripper) -> EndEffectorState {
        let is = |fact: bool| if fact { Tristate::True } else { Tristate::False }.code();
        let waits = !self.goals.is_empty();
        let (command, sender, sequence) = &self.handled;
        EndEffectorState {
            timestamp_ns,
            id: 65_664,
            enabled: is(enabled),
            calibrated: is(self.calibrated),
            ready: is(self.calibrated && !waits),
            moving: is(enabled && waits),
            gripping: is(self.gripping),
            missed: is(self.missed),
            error: is(false),
            reverse: is(false),
            position: gripper.percent(self.width_m) as f32,
            force: if self.gripping { HOLDING_FORCE } else { 0.0 },
            command_sequence: *sequence,
            command: messages::FixedText::truncated(command),
            command_sender: messages::FixedText::truncated(sender),
        }
    }

    fn go(&mut self, goals: Vec<f64>, gripper: &Gripper) -> Option<Event> {
        let goal_m = goals[0];
        self.goals = goals;
        let held = self.gripping;
        if held && goal_m < self.width_m {
            return None;
        }
        (self.gripping, self.missed) = (false, false);
        if goal_m < self.width_m - DEAD_ZONE * (gripper.open_m - gripper.closed_m()) {
            return Some(Event::Closes);
        }
        self.object_m = None;
        held.then_some(Event::LetsGo)
    }
}

impl Fingers {
    /// Returns open fingers without calibration.
    pub fn open(gripper: &Gripper) -> Self {
        Self {
            width_m: gripper.open_m,
            goals: Vec::new(),
            calibrated: false,
            calibrating: false,
            object_m: None,
            gripping: false,
            missed: false,
            handled: Default::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRIPPER: Gripper =
        Gripper { stop_m: -0.003, open_m: 0.038, beyond_m: 0.0035, force_n: 20.0, jaw: None };

    fn say(fingers: &mut Fingers, command: Command, sequence: u32) -> Option<Event> {
        fingers.command(&EndEffectorCommand::new(0, command, "test", sequence), &GRIPPER)
    }

    fn calibrated() -> Fingers {
        let mut fingers = Fingers::open(&GRIPPER);
        assert_eq!(say(&mut fingers, Command::Go(50.0), 1), None);
        assert_eq!(
            fingers.state(0, true, &GRIPPER).moving,
            Tristate::False,
            "nothing before it is calibrated"
        );
        say(&mut fingers, Command::Calibrate, 2);
        (0..300).for_each(|_| assert_eq!(fingers.advance(0.01, &GRIPPER), None));
        let state = fingers.state(0, true, &GRIPPER);
        assert_eq!([state.calibrated, state.ready], [Tristate::True; 2]);
        assert_eq!(state.command_sequence, 2);
        fingers
    }

    #[test]
    fn fingers_grip_an_object_and_release_it() {
        let mut fingers = calibrated();
        assert_eq!(say(&mut fingers, Command::Grip, 3), Some(Event::Closes));
        fingers.meet(Some(0.01));
        let events: Vec<Event> = (0..100).filter_map(|_| fingers.advance(0.01, &GRIPPER)).collect();
        let state = fingers.state(0, true, &GRIPPER);
        assert_eq!(events, [Event::Holds]);
        assert_eq!([state.gripping, state.missed], [Tristate::True, Tristate::False]);
        assert!((state.position - 100.0 / 3.8).abs() < 0.1);
        assert_eq!(say(&mut fingers, Command::Grip, 4), None, "it grips already");
        assert_eq!(say(&mut fingers, Command::Go(100.0), 5), Some(Event::LetsGo));
        assert_eq!(say(&mut fingers, Command::Go(100.0), 5), None, "it came twice");
    }

    #[test]
    fn absent_and_thin_objects_are_missed() {
        for object_m in [None, Some(0.001)] {
            let mut fingers = calibrated();
            say(&mut fingers, Command::Go(0.0), 3);
            fingers.meet(object_m);
            (0..110).for_each(|_| assert_eq!(fingers.advance(0.01, &GRIPPER), None));
            let state = fingers.state(0, true, &GRIPPER);
            assert_eq!(state.missed, Tristate::True);
            assert_eq!([state.gripping, state.moving], [Tristate::False; 2]);
        }
    }

    #[test]
    fn stopped_fingers_stay_where_they_are() {
        let mut fingers = calibrated();
        say(&mut fingers, Command::Grip, 3);
        fingers.advance(0.3, &GRIPPER);
        say(&mut fingers, Command::Stop, 4);
        let width_m = fingers.width_m;
        fingers.advance(0.3, &GRIPPER);
        assert_eq!(fingers.width_m, width_m);
        assert!((width_m - (GRIPPER.open_m - 0.3 * SPEED_M_S)).abs() < 1e-9);
    }
}
