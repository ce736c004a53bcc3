//! The gripper's controller as the bridge sees it.

use service::{Span, Time};
use trajectory_driver::{CANCEL_FINGERS_MS, FingerEnd, FingerOrder};

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

/// Interval of requests to cancel a command: one may arrive before its goal, or be lost.
const CANCEL_EVERY: Span = Span::from_ms(50);
/// Longest time for which a command is cancelled; then it counts as over.
const CANCEL_WITHIN: Span = Span::from_ms(CANCEL_FINGERS_MS);

/// A command that was sent.
#[derive(Clone, Copy, Debug)]
struct Sent {
    order: FingerOrder,
    id: GoalId,
    at: Time,
    is_accepted: bool,
    is_over: bool,
    /// When it was cancelled first, and last.
    cancelled: Option<(Time, Time)>,
}

/// The gripper's controller.
#[derive(Debug)]
pub struct FingerController {
    identity: Identity,
    liveness: Liveness,
    /// The newest command.
    sent: Option<Sent>,
    end: Option<FingerEnd>,
}

impl FingerController {
    /// Returns a gripper before its first answer.
    pub fn new(identity: Identity) -> Self {
        let liveness = Liveness::new(ANSWER_WITHIN);
        Self { identity, liveness, sent: None, end: None }
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

    /// Returns whether a command is being cancelled and its end is not known.
    pub fn is_stopping(&self) -> bool {
        self.sent.is_some_and(|sent| !sent.is_over && sent.cancelled.is_some())
    }

    /// Decides on the requests to the controller; a stop of the arm, `stops`, cancels the command under way. It is
    /// cancelled until its end is told, after the stop too; until then no other one is sent.
    pub fn decide(
        &mut self,
        order: Option<FingerOrder>,
        stops: bool,
        now: Time,
    ) -> Vec<Request<FingerOrder>> {
        let mut requests = Vec::new();
        if self.cancels(stops, now) {
            requests.push(Request::CancelAll);
        }
        let is_barred = stops || self.is_stopping() || !self.is_ready(now);
        let is_due = |order: &FingerOrder| match &self.sent {
            None => true,
            Some(sent) if order.number > sent.order.number => true,
            Some(sent) => !sent.is_accepted && !sent.is_over && now.since(sent.at) > AGAIN_AFTER,
        };
        if let Some(order) = order.filter(is_due).filter(|_| !is_barred) {
            let id = self.identity.next_goal();
            let (is_accepted, is_over, cancelled) = (false, false, None);
            self.sent = Some(Sent { order, id, at: now, is_accepted, is_over, cancelled });
            self.liveness.on_goal(now);
            requests.push(Request::Goal(id, order));
        }
        if self.liveness.probes(now) {
            requests.push(Request::Probe(self.identity.next_goal()));
        }
        requests
    }

    /// Returns whether a request to cancel is due, and counts it as sent.
    fn cancels(&mut self, stops: bool, now: Time) -> bool {
        let Some(sent) = self.sent.as_mut().filter(|sent| !sent.is_over) else { return false };
        let first = match sent.cancelled {
            None if !stops => return false,
            None => now,
            Some((first, _)) if now.since(first) > CANCEL_WITHIN => {
                tracing::warn!(
                    "the gripper's controller does not tell the end of a cancelled command"
                );
                let id = sent.id;
                self.on_end(&id, FingerResult::default());
                return false;
            }
            Some((_, last)) if now.since(last) < CANCEL_EVERY => return false,
            Some((first, _)) => first,
        };
        sent.cancelled = Some((first, now));
        true
    }
}
