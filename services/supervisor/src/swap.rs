//! Replacement of a service's program while the group runs, and rollback when the new
//! one does not become ready.
//!
//! Pure: it inspects the service's machine after each event and returns the next step.

use crate::machine::{Actual, Machine};

/// A replacement under way. It begins by giving the machine the new command and
/// [`Event::Restart`](crate::machine::Event::Restart).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Swap {
    step: Step,
    /// The last incarnation before the current step's restart.
    earlier: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    /// The new command stops the old one, starts, and should become ready.
    Trying,
    /// The old command is started again.
    Restoring,
}

/// Next step of a swap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Move {
    /// Nothing yet.
    Wait,
    /// The new command was not ready in time: restore the old one and restart, then keep polling.
    Restore,
    /// Finished: the new command is ready.
    Kept,
    /// Finished: the old command is ready again.
    Restored,
    /// Finished: even the old command did not become ready again; the usual rules apply to it.
    Lost,
}

impl Swap {
    /// Created before the machine receives the restart.
    pub fn new(machine: &Machine) -> Self {
        Self { step: Step::Trying, earlier: machine.incarnation() }
    }

    /// Returns the next step for the current state of the machine.
    pub fn next(&mut self, machine: &Machine) -> Move {
        let has_begun = machine.incarnation() > self.earlier;
        match (machine.actual(), self.step) {
            (Actual::Ready, Step::Trying) if has_begun => Move::Kept,
            (Actual::Ready, Step::Restoring) if has_begun => Move::Restored,
            (Actual::Starting | Actual::Ready | Actual::Stopping, _) => Move::Wait,
            (Actual::Down | Actual::Backoff | Actual::Held, Step::Trying) => {
                self.step = Step::Restoring;
                self.earlier = machine.incarnation();
                Move::Restore
            }
            (Actual::Down | Actual::Backoff | Actual::Held, Step::Restoring) => Move::Lost,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::Time;
    use crate::group::tests::{LIMITS, service};
    use crate::machine::{Event, Limits};
    use service::exit::ProcessExit;

    const NOW: Time = Duration::from_secs(1);

    fn running() -> Machine {
        let mut machine = Machine::new(Limits::of(&service("grounding", &[]), LIMITS));
        for event in [Event::Start, Event::Admit, Event::Ready] {
            machine.on(event, NOW);
        }
        machine
    }

    /// Gives the events and says what the replacement wants after each.
    fn moves(swap: &mut Swap, machine: &mut Machine, events: &[Event]) -> Vec<Move> {
        let mut after = |event: &Event| {
            machine.on(*event, NOW);
            swap.next(machine)
        };
        events.iter().map(&mut after).collect()
    }

    const STOPPED: Event = Event::Exited(ProcessExit::Code(0));
    const REFUSED: Event = Event::Exited(ProcessExit::Code(78));

    #[test]
    fn swap_reports_a_failed_rollback() {
        let mut machine = running();
        let mut swap = Swap::new(&machine);
        let found = moves(
            &mut swap,
            &mut machine,
            &[Event::Restart, STOPPED, REFUSED, Event::Restart, REFUSED],
        );
        assert_eq!(found.last(), Some(&Move::Lost));
    }

    #[test]
    fn swap_replaces_a_stopped_service() {
        let mut machine = running();
        moves(&mut Swap::new(&machine), &mut machine, &[Event::Stop, STOPPED]);
        let mut swap = Swap::new(&machine);
        let found = moves(&mut swap, &mut machine, &[Event::Restart, Event::Ready]);
        assert_eq!(found, [Move::Wait, Move::Kept]);
    }
}
