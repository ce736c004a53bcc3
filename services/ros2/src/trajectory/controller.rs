//! The arm's controller as the bridge sees it: windows become goals, and ends of goals are judged.

mod stop;

use std::collections::VecDeque;

use service::{Span, Time};
use trajectory_driver::{ArmOrder, Condition, Ending, JointMeasurement, Motion, Window};

use super::actions::{Answer, GoalId, Identity, Liveness, Request, status};
use super::types::{
    JointTrajectory, JointTrajectoryPoint, Tolerances, TrajectoryGoal, TrajectoryResult, seconds,
};
use crate::types::{Header, Time as RosTime};
use stop::Stop;

/// Age of the arm's latest order beyond which its process counts as dead.
const ARM_SILENT: Span = Span::from_ms(150);
/// Longest time to the answer to a goal: a window lasts little longer.
const ANSWER_WITHIN: Span = Span::from_ms(300);
/// Goals that are remembered: more than a controller can have under way.
const GOALS_MAX: usize = 32;
/// Time for which a result is waited for after the status has ended.
const RESULT_WITHIN: Span = Span::from_ms(500);

/// A goal that was sent.
#[derive(Clone, Debug)]
struct Sent {
    id: GoalId,
    /// Number of its window; 0 for one that holds the arm.
    window: u64,
    is_over: bool,
    /// A newer one was accepted: the controller does not execute it any more.
    is_replaced: bool,
    /// When its status was seen to have ended, and the status.
    over: Option<(Time, i8)>,
}

/// The controller, and everything that was asked of it.
#[derive(Debug)]
pub struct Controller {
    joints: Vec<String>,
    tolerances: Tolerances,
    still_rad_s: f64,
    identity: Identity,
    liveness: Liveness,
    sent: VecDeque<Sent>,
    /// Number of the newest window that was sent.
    newest: u64,
    accepted: u64,
    ended: Option<(u64, Ending)>,
    stop: Option<Stop>,
    stopped: u64,
    /// When a stop of the bridge's own began that no order of the arm has acknowledged.
    halted: Option<Time>,
    /// A goal of another client that is being executed.
    foreign: Option<GoalId>,
    /// Goals of this group that are not over, by their latest statuses.
    has_active: bool,
    /// One of them is of an earlier process.
    has_former: bool,
}

/// What the bridge knows when it decides.
#[derive(Clone, Copy, Debug)]
pub struct Facts<'a> {
    /// The arm's latest order.
    pub order: Option<&'a ArmOrder>,
    /// The newest joint state.
    pub joints: Option<&'a JointMeasurement>,
    /// This process is about to end.
    pub is_ending: bool,
    /// Now.
    pub now: Time,
}

impl Facts<'_> {
    /// Returns whether nothing stands behind the order any more: its arm is silent, or this process ends.
    pub fn is_dead(&self) -> bool {
        let age = self.order.map(|order| self.now.since(Time(order.at_ns)));
        self.is_ending || age.is_none_or(|age| age > ARM_SILENT)
    }
}

type Requests = Vec<Request<TrajectoryGoal>>;

impl Controller {
    /// Returns a controller of these joints before its first answer.
    pub fn new(
        joints: Vec<String>,
        tolerances: Tolerances,
        still_rad_s: f64,
        identity: Identity,
    ) -> Self {
        Self {
            joints,
            tolerances,
            still_rad_s,
            identity,
            liveness: Liveness::new(ANSWER_WITHIN),
            sent: VecDeque::new(),
            newest: 0,
            accepted: 0,
            ended: None,
            stop: None,
            stopped: 0,
            halted: None,
            foreign: None,
            has_active: false,
            has_former: false,
        }
    }

    /// Takes in an answer.
    pub fn on_answer(&mut self, answer: Answer<TrajectoryResult>, now: Time) {
        if !matches!(answer, Answer::Statuses(_)) {
            self.liveness.on_answer(now);
        }
        match answer {
            Answer::Accepted(id, is_accepted) => self.on_accepted(&id, is_accepted),
            Answer::Ended(id, status, result) => self.on_end(&id, status, Some(&result)),
            Answer::Cancelled(code) => {
                if let Some(stop) = &mut self.stop {
                    stop.on_answer(code, self.has_active || self.foreign.is_some(), now);
                }
            }
            Answer::Probed => {}
            Answer::Statuses(all) => self.on_statuses(&all, now),
        }
    }

    fn on_accepted(&mut self, id: &GoalId, is_accepted: bool) {
        self.liveness.on_accepted();
        let Some(n) = self.sent.iter().position(|goal| goal.id == *id) else { return };
        let window = self.sent[n].window;
        if is_accepted {
            self.accepted = self.accepted.max(window);
            self.sent.iter_mut().take(n).for_each(|goal| goal.is_replaced = true);
            return;
        }
        self.sent[n].is_over = true;
        if window == self.newest && window > 0 {
            tracing::error!("the controller refused a goal; help: is it active? Its log says more");
            self.ended = Some((window, Ending::Refused));
        }
    }

    /// Judges the end of a goal, by its status first. The ends of goals that newer ones have replaced say nothing, be they
    /// aborted or cancelled, unless a tolerance was violated.
    fn on_end(&mut self, id: &GoalId, status: i8, result: Option<&TrajectoryResult>) {
        let newest = self.newest;
        let own = self.sent.iter_mut().find(|goal| goal.id == *id && !goal.is_over);
        let Some(goal) = own else { return };
        goal.is_over = true;
        let (window, code) = (goal.window, result.map_or(0, |result| result.error_code));
        let Some(ending) = judged(status, code) else { return };
        let is_violation = matches!(ending, Ending::Aborted(-5 | -4));
        if window == 0 || window < newest && !is_violation {
            return;
        }
        if ending != Ending::Succeeded && self.stop.is_none() {
            let text = result.map_or("", |result| result.error_string.as_str());
            tracing::warn!(status, code, text, "the controller ended a goal");
        }
        self.ended = Some((window, ending));
    }

    fn on_statuses(&mut self, all: &[(GoalId, i8)], now: Time) {
        let active =
            || all.iter().filter(|(_, status)| status::is_active(*status)).map(|(id, _)| id);
        let foreign = active().find(|id| !self.identity.is_of_group(id)).copied();
        if foreign != self.foreign
            && let Some(id) = &foreign
        {
            tracing::warn!(goal = hex(id), "the controller executes a goal of another client");
        }
        self.foreign = foreign;
        self.has_active = active().any(|id| self.identity.is_of_group(id));
        let identity = &self.identity;
        self.has_former = active().any(|id| identity.is_of_group(id) && !identity.is_own(id));
        for (id, status) in all.iter().filter(|(_, status)| !status::is_active(*status)) {
            if let Some(goal) = self.sent.iter_mut().find(|goal| goal.id == *id && !goal.is_over) {
                goal.over.get_or_insert((now, *status));
            }
        }
    }

    /// Returns whether the controller can be used. After a stop of the bridge's own it cannot, until the arm knows of
    /// it: the arm would go on with its plan, and the controller would catch up in a leap.
    pub fn condition(&self, now: Time) -> Condition {
        if self.foreign.is_some() {
            Condition::Foreign
        } else if !self.liveness.is_heard() {
            Condition::Unheard
        } else if self.liveness.is_silent(now) || self.halted.is_some() {
            Condition::Silent
        } else {
            Condition::Ready
        }
    }

    /// The newest window that was accepted, the latest end that counts, and the newest stop that is confirmed.
    pub fn facts(&self) -> (u64, Option<(u64, Ending)>, u64) {
        (self.accepted, self.ended, self.stopped)
    }

    /// Returns whether the arm is being stopped.
    pub fn is_stopping(&self) -> bool {
        self.stop.is_some()
    }

    /// Returns whether the fingers are to stop, and to begin nothing.
    pub fn stops_fingers(&self, facts: &Facts<'_>) -> bool {
        self.is_stopping() || self.halted.is_some() || facts.is_dead()
    }

    /// Returns whether a goal of this process may be under way.
    fn has_goal(&self) -> bool {
        self.sent.iter().any(|goal| !goal.is_over && !goal.is_replaced)
    }

    /// Decides on the requests to the controller. `stamp` returns the controller's time for one of this machine.
    pub fn decide(
        &mut self,
        facts: &Facts<'_>,
        stamp: impl Fn(Time) -> Option<RosTime>,
    ) -> Requests {
        let now = facts.now;
        self.judge_late_results(now);
        self.watch(facts);
        if self.stop.is_some() {
            return self.advance_stop(facts);
        }
        let mut requests = Requests::new();
        if let Some(Motion::Follow(window)) = facts.order.map(|order| &order.motion)
            && window.number > self.newest
            && !facts.is_dead()
            && self.condition(now) == Condition::Ready
        {
            self.newest = window.number;
            let goal = self.goal_of(window, stamp(Time(window.begin_ns)));
            requests.push(self.send(window.number, goal, now));
        }
        if self.liveness.probes(now) {
            requests.push(Request::Probe(self.identity.next_goal()));
        }
        requests
    }

    /// Begins a stop if the arm orders one, or its process is dead with a goal under way, or a goal of an earlier process
    /// of this group is executed still.
    fn watch(&mut self, facts: &Facts<'_>) {
        self.take_acknowledgement(facts.order);
        let ordered = match facts.order.map(|order| &order.motion) {
            Some(Motion::Stop(number)) if *number > self.stopped => Some(*number),
            _ => None,
        };
        let goes_on = (facts.is_dead() && self.has_goal()) || self.has_former;
        match (&mut self.stop, ordered) {
            (Some(stop), Some(number)) => stop.number = number,
            (None, Some(number)) => self.stop = Some(Stop::new(number)),
            (None, None) if goes_on => {
                tracing::warn!(
                    "a goal is under way and the arm's process does not go on; stopping"
                );
                self.stop = Some(Stop::new(0));
                self.halted = Some(facts.now);
            }
            _ => {}
        }
    }

    /// A later order that follows nothing shows that the arm has given up the motion that the bridge stopped.
    fn take_acknowledgement(&mut self, order: Option<&ArmOrder>) {
        let is_acknowledged = |halted: &Time| {
            order.is_some_and(|order| {
                order.at_ns > halted.ns() && !matches!(order.motion, Motion::Follow(_))
            })
        };
        if self.halted.as_ref().is_some_and(is_acknowledged) {
            self.halted = None;
        }
    }

    fn advance_stop(&mut self, facts: &Facts<'_>) -> Requests {
        let mut requests = Requests::new();
        let (still_rad_s, now) = (self.still_rad_s, facts.now);
        let Some(stop) = &mut self.stop else { return requests };
        let wants = stop.advance(facts.joints, still_rad_s, now);
        if wants.cancels {
            requests.push(Request::CancelAll);
        }
        if let Some(q) = wants.holds_at {
            let goal = self.hold(&q);
            requests.push(self.send(0, goal, now));
        }
        if wants.is_done {
            let number = self.stop.take().map_or(0, |stop| stop.number);
            self.stopped = self.stopped.max(number);
            // Their ends may never be told.
            self.sent.iter_mut().for_each(|goal| goal.is_over = true);
            self.has_former = false;
        }
        requests
    }

    /// A server that tells a status and no result is believed by its status.
    fn judge_late_results(&mut self, now: Time) {
        let is_late = |goal: &Sent| {
            let (at, status) = goal.over.filter(|_| !goal.is_over)?;
            (now.since(at) > RESULT_WITHIN).then_some((goal.id, status))
        };
        let late: Vec<_> = self.sent.iter().filter_map(is_late).collect();
        late.into_iter().for_each(|(id, status)| self.on_end(&id, status, None));
    }

    fn send(&mut self, window: u64, goal: TrajectoryGoal, now: Time) -> Request<TrajectoryGoal> {
        let id = self.identity.next_goal();
        if self.sent.len() == GOALS_MAX {
            self.sent.pop_front();
        }
        self.sent.push_back(Sent { id, window, is_over: false, is_replaced: false, over: None });
        self.liveness.on_goal(now);
        Request::Goal(id, goal)
    }

    fn goal_of(&self, window: &Window, stamp: Option<RosTime>) -> TrajectoryGoal {
        let points = window.points.iter().map(|point| JointTrajectoryPoint {
            positions: point.q.clone(),
            velocities: point.qd.clone(),
            time_from_start: seconds(point.t_s),
            ..JointTrajectoryPoint::default()
        });
        self.goal(stamp.unwrap_or_default(), points.collect())
    }

    /// Holds the arm in its measured posture, in case requests to cancel are lost.
    fn hold(&self, q: &[f64]) -> TrajectoryGoal {
        let point = JointTrajectoryPoint {
            positions: q.to_vec(),
            velocities: vec![0.0; q.len()],
            time_from_start: seconds(stop::HOLD_S),
            ..JointTrajectoryPoint::default()
        };
        self.goal(RosTime::default(), vec![point])
    }

    fn goal(&self, stamp: RosTime, points: Vec<JointTrajectoryPoint>) -> TrajectoryGoal {
        let trajectory = JointTrajectory {
            header: Header { stamp, frame_id: String::new() },
            joint_names: self.joints.clone(),
            points,
        };
        TrajectoryGoal::new(&self.joints, trajectory, self.tolerances)
    }
}

/// Judges the end of a goal. A goal that was cancelled has the `error_code` of success, so the status counts first.
pub fn judged(status: i8, error_code: i32) -> Option<Ending> {
    match status {
        status::SUCCEEDED => Some(Ending::Succeeded),
        status::CANCELED => Some(Ending::Cancelled),
        status::ABORTED => Some(Ending::Aborted(error_code)),
        _ => None,
    }
}

fn hex(id: &GoalId) -> String {
    id.iter().map(|byte| format!("{byte:02x}")).collect()
}
