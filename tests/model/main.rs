//! Every interleaving of messages, losses, duplicates, crashes at every point of a pass, restarts and
//! journals set aside, in a small model of the recovery protocol: the invariants of ARCHITECTURE.md
//! hold in all of its states, and each rule is needed, because without it one of them breaks.
//!
//! The simulation (`tests/sim`) checks the same invariants on the real services, with seeds in place
//! of all interleavings.

mod protocol;
mod search;

use protocol::{Broken, Protocol, State};
use search::{Found, search};

/// Two objects, crashes of any service at any point.
const CRASHES: Protocol = Protocol {
    objects: 2,
    crashes: 1,
    lost: 0,
    lossy: true,
    stops: false,
    says_stop: false,
    calls_off: false,
    impatient: false,
    broken: None,
};
/// One object: for rules whose lack only the whole search shows.
const ONE: Protocol = Protocol { objects: 1, ..CRASHES };
/// One object, and a stop on the way.
const STOPS: Protocol = Protocol { objects: 1, crashes: 2, stops: true, ..CRASHES };
/// A user who says "stop" to a robot that does nothing else.
const STOP_ALONE: Protocol = Protocol { objects: 0, crashes: 3, says_stop: true, ..CRASHES };
/// One object, and a user who says "stop" on the way.
const SAYS_STOP: Protocol = Protocol { objects: 1, lossy: false, says_stop: true, ..CRASHES };
/// One object, and a user who calls it off at any moment.
const CALLS_OFF: Protocol = Protocol { objects: 1, calls_off: true, lossy: false, ..CRASHES };
/// One object, and a user who talks on before the robot has taken in what was said.
const TALKS: Protocol = Protocol { objects: 1, crashes: 1, impatient: true, ..CRASHES };
/// Two objects, and one journal set aside at any moment; the bus delays and reorders.
const LOST: Protocol = Protocol { crashes: 0, lost: 1, lossy: false, ..CRASHES };
/// As before with one object.
const ONE_LOST: Protocol = Protocol { objects: 1, ..LOST };

fn run(protocol: Protocol) -> Found {
    search(&protocol, State::default())
}

fn holds(protocol: Protocol) {
    let found = run(protocol);
    print(&format!("{protocol:?}: {} states, depth {}", found.states, found.depth));
    if let Some((broken, way)) = found.violation {
        panic!("{broken}, after:\n  {}", way.join("\n  "));
    }
}

/// Checks that without the rule an invariant breaks, and prints the shortest way to it.
fn breaks(protocol: Protocol, broken: Broken, expected: &str) {
    let found = run(Protocol { broken: Some(broken), ..protocol });
    let Some((what, way)) = found.violation else { panic!("{broken:?} is not noticed") };
    print(&format!("{broken:?}: {what}, after {} steps:\n  {}", way.len(), way.join("\n  ")));
    assert!(what.contains(expected), "{broken:?}: expected {expected}, found {what}");
}

fn print(line: &str) {
    use std::io::Write;
    // A closed pipe is the reader's choice.
    let _ = writeln!(std::io::stdout(), "{line}");
}

#[test]
fn protocol_holds_under_crashes_losses_and_duplicates() {
    holds(CRASHES);
}

#[test]
fn protocol_holds_with_an_impatient_user() {
    holds(TALKS);
}

#[test]
fn protocol_holds_with_a_stop() {
    holds(STOPS);
}

#[test]
fn protocol_holds_with_a_stop_that_is_said() {
    holds(STOP_ALONE);
    holds(SAYS_STOP);
}

#[test]
fn protocol_holds_with_an_order_that_is_called_off() {
    holds(CALLS_OFF);
}

#[test]
fn protocol_holds_when_a_journal_is_set_aside() {
    holds(LOST);
}

#[test]
fn protocol_needs_its_rules_of_durability() {
    breaks(CRASHES, Broken::PublishBeforeSync, "no durable record orders");
    breaks(CRASHES, Broken::OrderNotJournaled, "no durable record orders");
    breaks(CRASHES, Broken::AcknowledgeBeforeSync, "acknowledged utterance is lost");
    breaks(CRASHES, Broken::MoveBeforeRecord, "not in its journal");
    breaks(CRASHES, Broken::IgnoreGripper, "grasps twice");
    breaks(STOPS, Broken::ForgetLatch, "moves after its stop");
    breaks(ONE, Broken::NoRepresentation, "progress");
}

#[test]
fn protocol_needs_its_rules_for_a_stop_that_is_said() {
    breaks(STOP_ALONE, Broken::StopOnce, "progress");
    breaks(STOP_ALONE, Broken::StopNotJournaled, "progress");
    breaks(STOP_ALONE, Broken::SettleByAnyAnswer, "progress");
    breaks(SAYS_STOP, Broken::ConfirmBeforeSync, "moves after its stop");
    breaks(SAYS_STOP, Broken::ReportIntention, "moves after its stop");
}

#[test]
fn protocol_needs_its_rules_for_an_order_that_is_called_off() {
    breaks(CALLS_OFF, Broken::CallOffInMemory, "called off is handed over");
    breaks(CALLS_OFF, Broken::HandOverCalledOff, "called off is handed over");
    breaks(CALLS_OFF, Broken::OpenBeforeRecord, "the user has what was called off");
}

#[test]
fn protocol_needs_its_rules_of_delivery() {
    breaks(TALKS, Broken::AcceptGap, "out of order");
    breaks(CRASHES, Broken::AcceptDuplicate, "applied twice");
    breaks(CRASHES, Broken::ResendWithoutKey, "accepted twice");
    breaks(ONE, Broken::NoResend, "progress");
    breaks(CRASHES, Broken::RepeatOrder, "grasps twice");
}

#[test]
fn protocol_needs_its_rules_for_a_journal_set_aside() {
    breaks(LOST, Broken::ReplayAfterLoss, "applied twice");
    breaks(ONE_LOST, Broken::ReuseInteractions, "progress");
    breaks(LOST, Broken::ReuseAndCompareIdOnly, "false delivery");
    breaks(ONE_LOST, Broken::ReuseUtterances, "progress");
    breaks(ONE_LOST, Broken::WaitForLost, "progress");
    breaks(LOST, Broken::ReusePrompts, "progress");
}
