//! The gripper's controller as the bridge sees it.

use service::{Span, Time};
use trajectory_driver::{FingerEnd, FingerOrder};

use super::actions::{Answer, GoalId, Identity, Liveness, Request, status};

/// A result of either type of action.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FingerResult {
    /// The fingers stopped at something.
    pub stalled: bool,
    /// The fingers are at the position.
    pub reached: bool,
}

/// Longest time to the answer to a command. Nothing hurries: the arm waits for its fingers.
const ANSWER_WITHIN: Span = Span::from_ms(1_500);
/// Time after which a command that was not accepted is sent again: the server may not have known this client yet.
const AGAIN_AFTER: Span = Span::from_ms(1_700);

/// A command that was sent.
#[derive(Clone, Copy, Debug)]
struct Sent {
    order: FingerOrder,
    id: GoalId,
    at: Time,
    is_accepted: bool,
    is_over: bool,
}

/// The gripper's controller.
#[derive(Debug)]
pub struct FingerController {
    identity: Identity,
    liveness: Liveness,
    /// The newest command.
    sent: Option<Sent>,
    end: Option<FingerEnd>,
    cancelled: Option<u64>,
}

impl FingerController {
    /// Returns a gripper before its first answer.
    pub fn new(identity: Identity) -> Self {
        let liveness = Liveness::new(ANSWER_WITHIN);
        Self { identity, liveness, sent: None, end: None, cancelled: None }
    }

    /// Takes in an answer.
    pub fn on_answer(&mut self, answer: Answer<FingerResult>, now: Time) {
        if matches!(answer, Answer::Statuses(_)) {
            return;
        }
        self.liveness.on_answer(now);
        match answer {
            Answer::Accepted(id, is_accepted) => {
                self.liveness.on_accepted();
                if let Some(sent) = self.sent.as_mut().filter(|sent| sent.id == id) {
                    sent.is_accepted = true;
                }
                if !is_accepted {
                    self.on_end(&id, FingerResult::default());
                }
            }
            Answer::Ended(id, status::CANCELED, _) => self.on_end(&id, FingerResult::default()),
            // A grasp stalls, and ends as aborted or succeeded after the controller's settings: the status of a goal that
            // was not cancelled says nothing.
            Answer::Ended(id, status, result) => {
                let reached = result.reached || status == status::SUCCEEDED && !result.stalled;
                self.on_end(&id, FingerResult { reached, ..result });
            }
            Answer::Cancelled(_) | Answer::Probed | Answer::Statuses(_) => {}
        }
    }

    fn on_end(&mut self, id: &GoalId, FingerResult { stalled, reached }: FingerResult) {
        let Some(sent) = self.sent.as_mut().filter(|sent| sent.id == *id) else { return };
        sent.is_over = true;
        let FingerOrder { number, closes, .. } = sent.order;
        self.end = Some(FingerEnd { number, closes, stalled, reached });
    }

    /// Returns the latest end of a command.
    pub fn end(&self) -> Option<FingerEnd> {
        self.end
    }

    /// Returns whether the controller answers.
    pub fn is_ready(&self, now: Time) -> bool {
        self.liveness.is_heard() && !self.liveness.is_silent(now)
    }

    /// Decides what is asked of the controller; a stop of the arm, `stops`, cancels the command under way.
    pub fn decide(
        &mut self,
        order: Option<FingerOrder>,
        stops: bool,
        now: Time,
    ) -> Vec<Request<FingerOrder>> {
        let mut requests = Vec::new();
        let under_way = self.sent.filter(|sent| !sent.is_over).map(|sent| sent.order.number);
        if stops && under_way.is_some() && self.cancelled != under_way {
            self.cancelled = under_way;
            requests.push(Request::CancelAll);
        }
        let is_due = |order: &FingerOrder| match &self.sent {
            None => true,
            Some(sent) if order.number > sent.order.number => true,
            Some(sent) => !sent.is_accepted && !sent.is_over && now.since(sent.at) > AGAIN_AFTER,
        };
        if let Some(order) = order.filter(is_due).filter(|_| !stops && self.is_ready(now)) {
            let id = self.identity.next_goal();
            self.sent = Some(Sent { order, id, at: now, is_accepted: false, is_over: false });
            self.liveness.on_goal(now);
            requests.push(Request::Goal(id, order));
        }
        if self.liveness.probes(now) {
            requests.push(Request::Probe(self.identity.next_goal()));
        }
        requests
    }
}
