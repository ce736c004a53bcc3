//! The robot's remarks about a stop follow from the arm's status.

use super::*;

/// The policy while the arm fetches, and the time of the latest event, milliseconds.
struct Fetching {
    node: PolicyNode,
    now_ms: u64,
}

impl Fetching {
    fn new() -> Self {
        let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
        tell(&mut node, observation(1, 0, &words(&["clear"])), at(1));
        assert_eq!(node.state().act.kind, ActKind::Pick);
        Self { node, now_ms: 1_000 }
    }

    fn tell(&mut self, after_ms: u64, message: In<'_>) -> String {
        self.now_ms += after_ms;
        let now = self.now();
        tell(&mut self.node, message, now);
        text(self.node.state())
    }

    /// The user says "stop".
    fn stop(&mut self) -> String {
        self.now_ms += 10;
        let seq = self.node.state().applied.0 + 1;
        let In::Observation(observed) =
            observation(seq, 0, &Reading { intent: Intent::Stop, ..Reading::default() })
        else {
            unreachable!()
        };
        let accepted_ns = self.now().ns();
        let observed = messages::Observation { accepted_ns, ..*observed };
        self.tell(5, In::Observation(MessageRef::from(observed)))
    }

    fn arm(&mut self, after_ms: u64, stopped: u8, moving: u8) -> String {
        let status = ArmStatus { stopped, moving, ..ArmStatus::default() };
        self.tell(after_ms, In::Arm(status))
    }

    fn tick(&mut self, after_ms: u64) -> String {
        self.now_ms += after_ms;
        let mut effects = Effects::default();
        let now = self.now();
        self.node.on(Event::Tick, now, &mut effects);
        text(self.node.state())
    }

    fn now(&self) -> Time {
        Time(self.now_ms * 1_000_000)
    }
}

const FETCHES: &str = "I will get the clear bowl.";
const STOPPED: &str = "I have stopped. Release the motion stop to go on.";
const UNCONFIRMED: &str = "The arm has not confirmed the stop. Use the robot's emergency stop.";

#[test]
fn stop_is_reported_once_the_arm_is_at_rest() {
    let mut fetching = Fetching::new();
    fetching.arm(10, 0, 1);
    assert_eq!(fetching.stop(), FETCHES);
    assert_eq!(fetching.arm(1, 1, 1), FETCHES, "latched, and still moving");
    assert_eq!(fetching.arm(90, 1, 0), STOPPED);
    fetching.stop();
    assert!(fetching.node.state().stop.order.is_some(), "only a younger status confirms it");
    fetching.arm(10, 1, 0);
    assert_eq!(fetching.node.state().stop.order, None);
}

#[test]
fn stop_that_the_arm_does_not_confirm_is_reported_as_such() {
    let mut fetching = Fetching::new();
    fetching.arm(10, 0, 1);
    fetching.stop();
    assert_eq!(fetching.tick(900), FETCHES);
    assert_eq!(fetching.tick(200), UNCONFIRMED);
    let act = fetching.node.state().act.id;
    fetching.tick(5_000);
    assert_eq!(fetching.node.state().act.id, act, "said once");
    // The arm's service is back: it moves, then the repeated order reaches it.
    assert_eq!(fetching.arm(10, 0, 1), UNCONFIRMED);
    assert_eq!(fetching.arm(60, 1, 0), STOPPED);
}

#[test]
fn stop_report_outlives_a_restart_of_the_policy() {
    let mut fetching = Fetching::new();
    fetching.stop();
    let state = fetching.node.state().clone();
    let record = Record { cause: Cause::Silence, at: fetching.now(), state };
    fetching.node = PolicyNode::recover(manager().into(), vec![record]).unwrap();
    assert_eq!(fetching.arm(300, 1, 0), STOPPED);
}

#[test]
fn stop_of_another_way_is_not_reported_in_words() {
    let mut fetching = Fetching::new();
    assert_eq!(fetching.arm(10, 1, 0), FETCHES);
    assert_eq!(fetching.tick(2_000), FETCHES);
}
