//! The action clients of the bridge, and its joint states. Nothing here waits, and nothing is decided.

use std::fmt::Debug;

use ros2_client::action::{ActionClient, ActionClientQosPolicies, GoalId as Uuid, SendGoalRequest};
use ros2_client::{ActionTypeName, Message, Name, Node, RmwRequestId};
use serde::Serialize;
use serde::de::DeserializeOwned;
use trajectory_driver::{FingerOrder, GripperController, GripperKind};

use super::actions::{Answer, GoalId, Request};
use super::fingers::FingerResult;
use super::types::{
    Feedback, GripperGoal, GripperResult, ParallelGoal, ParallelResult, TrajectoryGoal,
    TrajectoryResult,
};
use crate::dds::opening::{Opening, best_effort, latched, reliable};
use crate::dds::{Arrivals, Error, Inlet};
use crate::types::JointState;

impl Message for TrajectoryGoal {}
impl Message for TrajectoryResult {}
impl Message for GripperGoal {}
impl Message for GripperResult {}
impl Message for ParallelGoal {}
impl Message for ParallelResult {}
impl Message for Feedback {}

/// Requests of one kind that wait for their answers; older ones are given up.
const WAITING_MAX: usize = 64;
/// Answers of one kind that a pass takes.
const TAKEN_MAX: usize = 32;

/// An action of a controller.
pub(super) struct Action<G: Message + Clone, R: Message + Clone> {
    client: ActionClient<G, R, Feedback>,
    goals: Waiting,
    results: Waiting,
    cancels: Waiting,
}

/// Requests that wait, with the goal that each is about; none for all.
#[derive(Default)]
struct Waiting(Vec<(RmwRequestId, Option<GoalId>)>);

impl Waiting {
    fn push(&mut self, request: RmwRequestId, goal: Option<GoalId>) {
        if self.0.len() == WAITING_MAX {
            self.0.remove(0);
        }
        self.0.push((request, goal));
    }

    /// Takes the goal of an answered request; `None` if the answer is to another client.
    fn take(&mut self, answered: RmwRequestId) -> Option<Option<GoalId>> {
        let at = self.0.iter().position(|(request, _)| *request == answered)?;
        Some(self.0.remove(at).1)
    }
}

/// What went wrong on the way, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Losses {
    pub(super) unreadable: u64,
    pub(super) dropped: u64,
}

impl<G, R> Action<G, R>
where
    G: Message + Clone + Serialize + 'static,
    R: Message + Clone + DeserializeOwned + 'static,
{
    fn open(opening: &mut Opening<'_>, name: &str, kind: &str) -> Result<Self, Error> {
        let failed = |error: &dyn Debug| format!("action {name}: {error:?}");
        let full = Name::parse(name).map_err(|error| failed(&error))?;
        let policies = ActionClientQosPolicies {
            goal_service: reliable(10),
            result_service: reliable(10),
            cancel_service: reliable(10),
            feedback_subscription: best_effort(1),
            status_subscription: latched(),
        };
        let mapping = opening.service_mapping();
        let kind = ActionTypeName::new("control_msgs", kind);
        let client = opening.node.create_action_client(mapping, &full, &kind, policies);
        let client = client.map_err(|error| failed(&error))?;
        let [goals, results, cancels] = [(); 3].map(|()| Waiting::default());
        Ok(Self { client, goals, results, cancels })
    }

    /// Sends a request.
    pub(super) fn send(&mut self, request: Request<G>, losses: &mut Losses) {
        let sent = match request {
            Request::Goal(id, goal) => {
                let Some(goal_id) = uuid(&id) else { return };
                let sent =
                    self.client.goal_client().send_request(SendGoalRequest { goal_id, goal });
                sent.map(|request| self.goals.push(request, Some(id))).is_ok()
            }
            Request::Result(id) => {
                let Some(goal) = uuid(&id) else { return };
                let sent = self.client.request_result(goal);
                sent.map(|request| self.results.push(request, Some(id))).is_ok()
            }
            Request::CancelAll => {
                let sent = self.client.cancel_all_goals();
                sent.map(|request| self.cancels.push(request, None)).is_ok()
            }
            Request::Probe(id) => {
                let Some(goal) = uuid(&id) else { return };
                let sent = self.client.cancel_goal(goal);
                sent.map(|request| self.cancels.push(request, Some(id))).is_ok()
            }
        };
        losses.dropped += u64::from(!sent);
    }

    /// Returns the answers that have arrived; the end of each accepted goal is asked for.
    pub(super) fn answers(&mut self, losses: &mut Losses) -> Vec<Answer<R>> {
        let mut answers = Vec::new();
        taken(
            losses,
            || self.client.goal_client().receive_response(),
            |(request, response)| {
                if let Some(Some(id)) = self.goals.take(request) {
                    answers.push(Answer::Accepted(id, response.accepted));
                }
            },
        );
        taken(
            losses,
            || self.client.cancel_client().receive_response(),
            |(request, response)| {
                answers.extend(self.cancels.take(request).map(|goal| match goal {
                    Some(_) => Answer::Probed,
                    None => Answer::Cancelled(response.return_code as i8),
                }));
            },
        );
        taken(
            losses,
            || self.client.result_client().receive_response(),
            |(request, response)| {
                if let Some(Some(id)) = self.results.take(request) {
                    answers.push(Answer::Ended(id, response.status as i8, response.result));
                }
            },
        );
        let statuses = || self.client.receive_status();
        taken(losses, statuses, |array| {
            let each = array.status_list.iter();
            let pairs = each.map(|it| (it.goal_info.goal_id.uuid.into_bytes(), it.status as i8));
            answers.push(Answer::Statuses(pairs.collect()));
        });
        for answer in &answers {
            if let Answer::Accepted(id, true) = answer {
                self.send(Request::Result(*id), losses);
            }
        }
        answers
    }
}

/// Takes what waits, up to a bound.
fn taken<T, E: Debug>(
    losses: &mut Losses,
    next: impl Fn() -> Result<Option<T>, E>,
    mut take: impl FnMut(T),
) {
    for _ in 0..TAKEN_MAX {
        match next() {
            Ok(Some(message)) => take(message),
            Ok(None) => return,
            Err(error) => {
                losses.unreadable += 1;
                tracing::debug!(?error, "an answer is not readable");
            }
        }
    }
}

/// The library makes identities from text or at random alone.
fn uuid(id: &GoalId) -> Option<Uuid> {
    let text: String = id.iter().map(|byte| format!("{byte:02x}")).collect();
    Some(Uuid { uuid: text.parse().ok()? })
}

/// The gripper's action, of either type.
pub(super) enum Gripper {
    Command(Action<GripperGoal, GripperResult>, GripperController),
    Parallel(Action<ParallelGoal, ParallelResult>, GripperController),
}

impl Gripper {
    pub(super) fn send(&mut self, request: Request<FingerOrder>, losses: &mut Losses) {
        match self {
            Self::Command(action, own) => {
                let max_effort = own.effort;
                let goal =
                    |order: FingerOrder| GripperGoal { position: order.position, max_effort };
                action.send(mapped(request, goal), losses);
            }
            Self::Parallel(action, own) => {
                let goal = |order: FingerOrder| {
                    let command = JointState {
                        name: vec![own.joint.clone()],
                        position: vec![order.position],
                        effort: vec![own.effort],
                        ..JointState::default()
                    };
                    ParallelGoal { command }
                };
                action.send(mapped(request, goal), losses);
            }
        }
    }

    pub(super) fn answers(&mut self, losses: &mut Losses) -> Vec<Answer<FingerResult>> {
        let of = |stalled, reached| FingerResult { stalled, reached };
        match self {
            Self::Command(action, _) => {
                let all = action.answers(losses).into_iter();
                all.map(|it| ended(it, |r: GripperResult| of(r.stalled, r.reached_goal))).collect()
            }
            Self::Parallel(action, _) => {
                let all = action.answers(losses).into_iter();
                all.map(|it| ended(it, |r: ParallelResult| of(r.stalled, r.reached_goal))).collect()
            }
        }
    }
}

fn mapped<A, B>(request: Request<A>, goal: impl Fn(A) -> B) -> Request<B> {
    match request {
        Request::Goal(id, order) => Request::Goal(id, goal(order)),
        Request::Result(id) => Request::Result(id),
        Request::CancelAll => Request::CancelAll,
        Request::Probe(id) => Request::Probe(id),
    }
}

fn ended<A, B>(answer: Answer<A>, result: impl Fn(A) -> B) -> Answer<B> {
    match answer {
        Answer::Ended(id, status, own) => Answer::Ended(id, status, result(own)),
        Answer::Accepted(id, is_accepted) => Answer::Accepted(id, is_accepted),
        Answer::Cancelled(code) => Answer::Cancelled(code),
        Answer::Probed => Answer::Probed,
        Answer::Statuses(all) => Answer::Statuses(all),
    }
}

/// Everything that the bridge says and hears in the domain.
pub(super) struct Domain {
    pub(super) arm: Action<TrajectoryGoal, TrajectoryResult>,
    pub(super) gripper: Gripper,
    pub(super) joint_states: Inlet<JointState>,
    pub(super) arrivals: Arrivals,
    _node: Node,
}

impl Domain {
    /// Opens the actions and the topic of a node that has joined the domain.
    pub(super) fn open(
        mut opening: Opening<'_>,
        own: &trajectory_driver::Controllers,
    ) -> Result<Self, Error> {
        let joints = ("sensor_msgs", "JointState");
        let o = &mut opening;
        let gripper = own.gripper.clone();
        let action = &own.gripper.action;
        Ok(Self {
            arm: Action::open(o, &own.action, "FollowJointTrajectory")?,
            gripper: match own.gripper.kind {
                GripperKind::Command => {
                    Gripper::Command(Action::open(o, action, "GripperCommand")?, gripper)
                }
                GripperKind::Parallel => {
                    Gripper::Parallel(Action::open(o, action, "ParallelGripperCommand")?, gripper)
                }
            },
            joint_states: o.inlet(&own.joint_states, joints, best_effort(8))?,
            arrivals: Arrivals::new(opening.poll),
            _node: opening.node,
        })
    }
}
