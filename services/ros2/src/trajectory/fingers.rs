//! The gripper's controller as the bridge sees it.

use service::Time;
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

/// The gripper's controller.
#[derive(Debug)]
pub struct FingerController {
    identity: Identity,
    liveness: Liveness,
    /// The newest command and its goal; whether it is over.
    sent: Option<(FingerOrder, GoalId, bool)>,
    end: Option<FingerEnd>,
    cancelled: Option<u64>,
}

impl FingerController {
    /// Returns a gripper before its first answer.
    pub fn new(identity: Identity) -> Self {
        Self { identity, liveness: Liveness::default(), sent: None, end: None, cancelled: None }
    }

    /// Takes in an answer.
    pub fn on_answer(&mut self, answer: Answer<FingerResult>, now: Time) {
        self.liveness.on_answer(now);
        let (id, result) = match answer {
            Answer::Accepted(_, true) => return self.liveness.on_accepted(),
            Answer::Accepted(id, false) => {
                self.liveness.on_accepted();
                (id, FingerResult::default())
            }
            // A grasp stalls, and ends as aborted or succeeded after the controller's settings: the status of a goal that
            // was not cancelled says nothing.
            Answer::Ended(id, status::CANCELED, _) => (id, FingerResult::default()),
            Answer::Ended(id, status, result) => {
                let reached = result.reached || status == status::SUCCEEDED && !result.stalled;
                (id, FingerResult { reached, ..result })
            }
            Answer::Cancelled(_) | Answer::Probed | Answer::Statuses(_) => return,
        };
        if let Some((order, own, is_over)) = &mut self.sent
            && *own == id
        {
            *is_over = true;
            let FingerOrder { number, closes, .. } = *order;
            let FingerResult { stalled, reached } = result;
            self.end = Some(FingerEnd { number, closes, stalled, reached });
        }
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
        if let Some((own, _, false)) = self.sent
            && stops
            && self.cancelled != Some(own.number)
        {
            self.cancelled = Some(own.number);
            requests.push(Request::CancelAll);
        }
        let is_new =
            |order: &FingerOrder| self.sent.is_none_or(|(own, ..)| order.number > own.number);
        if let Some(order) = order.filter(is_new).filter(|_| !stops && self.is_ready(now)) {
            let id = self.identity.next();
            self.sent = Some((order, id, false));
            self.liveness.on_goal(now);
            requests.push(Request::Goal(id, order));
        }
        if self.liveness.probes(now) {
            requests.push(Request::Probe(self.identity.next()));
        }
        requests
    }
}
