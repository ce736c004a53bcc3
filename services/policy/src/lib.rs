//! The policy service: maintains the belief over the objects, and decides the next act.
//!
//! [`PolicyNode`] is the reducer around the [dialogue manager](dialogue::manager). It takes
//! observations strictly in order, each exactly once, advances the state, and has it journaled
//! before anything that follows from it can be seen.

mod checkpoint;
mod inspection;
mod journal_record;
mod perceived;
pub mod planner;
mod policy_cache;
pub mod shell;
mod view;

#[cfg(test)]
mod tests;

use dialogue::manager::{Cause, Floor, HEARING_MAX, Manager, MotionStop, Record, State, Utterance};
use messages::inbox::{Inbox, Verdict};
use messages::{
    Activity, AppliedMark, ArmStatus, Forget, MessageRef, Observation, PolicyView,
    PresentationState, Presented, RobotAct, Sighting, Source, TableView, WorldView,
};
use perceived::Perceived;
use serde::{Deserialize, Serialize};
use service::{Effects, Event, Node, NodeError, SetAside, Span, Time};
use std::process::ExitCode;
use vocabulary::ids::{PromptId, UtteranceSeq};
use vocabulary::{PersonId, PickOutcome, PickPhase, Presentation};

/// Runs the program: a service of a group, or an inspection of its records.
pub fn run() -> ExitCode {
    service::service_loop::run::<shell::PolicyProgram>()
}

/// Interval at which the standing decision is sent again.
const RESEND_EVERY: Span = Span::from_ms(250);
/// Time without a message of speech, which sends several a second, that counts as an outage.
const OUTAGE: Span = Span::from_ms(1_000);

/// Longest time in which the arm confirms an ordered stop: it halts within 0.1 s and reports its
/// status four times a second.
const STOP_CONFIRMATION_MAX: Span = Span::from_ms(1_000);

/// Input of the policy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum In<'a> {
    /// An observation from grounding.
    Observation(MessageRef<'a, Observation>),
    /// From speech: the latest prompt said.
    Presented(Presented),
    /// From speech: whether the user is speaking.
    Activity(Activity),
    /// From the arm.
    Arm(ArmStatus),
    /// From the arm: positions of its grippers.
    World(Box<WorldView>),
    /// From a camera, another source or a client.
    Sighting(Box<Sighting>),
    /// An order of a client to forget a person.
    Forget(Forget),
}

/// Output of the policy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Out {
    /// To speech: the utterances applied.
    Mark(AppliedMark),
    /// To speech and arm: the standing decision.
    Act(Box<RobotAct>),
    /// To clients: belief and reasons.
    View(Box<PolicyView>),
    /// To arm and clients: the objects on the table.
    Objects(Box<TableView>),
}

/// Configuration of the policy.
#[allow(missing_debug_implementations, reason = "planners have none")]
pub struct Config {
    /// The dialogue manager.
    pub manager: Manager,
    /// Settings of tracking, if the objects come from perception.
    pub tracker: Option<perception::Settings>,
}

impl From<Manager> for Config {
    fn from(manager: Manager) -> Self {
        Self { manager, tracker: None }
    }
}

type Fx = Effects<Out, Record>;

/// The policy as a reducer.
pub struct PolicyNode {
    manager: Manager,
    state: State,
    /// Objects from perception, if they come from there.
    perceived: Option<Perceived>,
    floor: Floor,
    /// The latest standing prompt that was said to its end, and which presentation of it.
    said: (PromptId, u32),
    /// When speech was last heard of.
    heard_of_speech: Time,
    /// When the arm last reported that it was stopped and at rest, in its latest status.
    rested: Option<Time>,
    /// Messages rejected as invalid or contradictory.
    rejected: u64,
    /// Since when an earlier observation is missing.
    waiting_since: Option<Time>,
    next_send: Time,
    /// Key of the latest order to forget a person that was carried out.
    forgot: u64,
    /// A person was forgotten whose name the journal still holds.
    erases: bool,
}

impl Node for PolicyNode {
    type Config = Config;
    type In<'a> = In<'a>;
    type Out = Out;
    type Record = Record;

    fn recover(config: Config, mut records: Vec<Record>) -> Result<Self, NodeError> {
        let Config { mut manager, tracker } = config;
        let erases = records.iter().any(|record| matches!(record.cause, Cause::Forget(_)));
        let state = records.pop().map_or_else(|| manager.first(), |record| record.state);
        if state.settings_key == manager.key() {
            manager.follow(&state);
        }
        Ok(Self {
            manager,
            perceived: tracker.map(Perceived::new),
            state,
            floor: Floor::default(),
            said: Default::default(),
            heard_of_speech: Time(0),
            rested: None,
            rejected: 0,
            waiting_since: None,
            next_send: Time(0),
            forgot: 0,
            erases,
        })
    }

    fn on(&mut self, event: Event<In<'_>>, now: Time, fx: &mut Fx) {
        match event {
            Event::SetAside(SetAside { over, .. }) if self.state.applied.0 < over => {
                tracing::warn!(over, "a journal was set aside: what was in progress has ended");
                self.apply(Cause::SetAside(over), now, fx);
            }
            Event::SetAside(_) => {}
            Event::Started => self.start(now, fx),
            Event::Message(In::Observation(observation)) => self.observe(&observation, now, fx),
            Event::Message(In::Presented(it)) => self.present(presentation(&it, now), now),
            Event::Message(In::Activity(activity)) => {
                self.listen(now);
                self.floor.speaking_since =
                    (activity.onset_ns > 0).then_some(Time(activity.onset_ns).min(now));
                self.floor.pending = activity.pending;
                self.decide_deferred(now, fx);
            }
            Event::Message(In::Arm(status)) => {
                self.note_handling(&status);
                self.watch_arm(&status, now, fx);
            }
            Event::Message(In::World(world)) => self.note_grippers(&world),
            Event::Message(In::Sighting(sighting)) => self.sight(&sighting, now, fx),
            Event::Message(In::Forget(order)) => self.forget(&order, now, fx),
            Event::Tick => self.tick(now, fx),
            Event::Shutdown => fx.exit(),
        }
    }

    fn deadline(&self) -> Option<Time> {
        Some(self.next_send)
    }

    fn pending_since(&self) -> Option<Time> {
        self.waiting_since
    }

    fn rejected(&self) -> u64 {
        self.rejected
    }

    fn take_erasure(&mut self) -> bool {
        std::mem::take(&mut self.erases)
    }

    fn checkpoint(&self) -> Option<Vec<u8>> {
        self.whole_state()
    }

    fn resume(config: Config, checkpoint: &[u8]) -> Result<Self, NodeError> {
        Self::with_whole_state(config, checkpoint)
    }

    fn snapshot(&self) -> Option<Vec<Record>> {
        let cause = Cause::Snapshot;
        // The state is whole in every record, also in the middle of an interaction.
        Some(vec![Record { cause, at: self.state.act.decided, state: self.state.clone() }])
    }
}

impl PolicyNode {
    /// Returns the state, for tests and simulation.
    pub fn state(&self) -> &State {
        &self.state
    }

    fn start(&mut self, now: Time, fx: &mut Fx) {
        if self.state.settings_key == self.manager.key() {
            self.send(now, fx);
        } else {
            self.apply(Cause::Reconfigured, now, fx);
        }
    }

    fn observe(&mut self, observation: &Observation, now: Time, fx: &mut Fx) {
        let seq = UtteranceSeq(observation.seq);
        match Inbox::new(self.state.applied).judge(seq) {
            Verdict::Apply => {}
            Verdict::Duplicate => return,
            Verdict::Early => {
                self.waiting_since.get_or_insert(now);
                return;
            }
        }
        let Some(utterance) = self.utterance(observation, now) else {
            // Not applied, so speech sends the utterance again: grounding may be repaired or
            // swapped meanwhile, and nothing is lost.
            self.rejected += 1;
            self.waiting_since.get_or_insert(now);
            let same_scene = observation.scene_key == self.manager.scene_file().key();
            tracing::warn!(%seq, same_scene, "invalid observation; the utterance stays pending");
            return;
        };
        self.waiting_since = None;
        let more = self.manager.more_is_coming(&self.floor, now);
        self.apply(Cause::Utterance(Utterance { more, ..utterance }), now, fx);
        self.report_stop(now, fx);
    }

    /// Returns the utterance of an observation; `None` if it is invalid or of another scene. A time
    /// in the future is invalid: it is of a clock before a restart of the machine, or a defect.
    fn utterance(&self, observation: &Observation, now: Time) -> Option<Utterance> {
        let scene = self.manager.scene_file();
        let begun =
            if observation.onset_ns > 0 { observation.onset_ns } else { observation.accepted_ns };
        let presentations = observation.asked().ok()?.iter().map(Presentation::try_from);
        (observation.scene_key == scene.key()).then_some(Utterance {
            seq: UtteranceSeq(observation.seq),
            presentations: presentations.collect::<Result<_, _>>().ok()?,
            typed: !is_live(observation.source.get()),
            onset: Time(begun).min(now),
            end: Time(observation.end_ns.max(begun)).min(now),
            accepted: Time(observation.accepted_ns).min(now),
            interpretations: observation.interpretations(scene.words().len()).ok()?,
            unknown: observation.unknown(),
            gesture: observation.gesture.target_m().ok()?,
            more: false,
            from: observation.person().ok()?,
        })
    }

    /// Forgets a person, unless this order is repeated.
    fn forget(&mut self, order: &Forget, now: Time, fx: &mut Fx) {
        let person = order.person.as_str().ok().and_then(|name| PersonId::new(name).ok());
        let Some(person) = person.filter(|person| !person.is_nobody()) else {
            self.rejected += 1;
            return;
        };
        if order.key == self.forgot {
            return;
        }
        (self.forgot, self.erases) = (order.key, true);
        self.apply(Cause::Forget(person), now, fx);
    }

    /// Reports the effect of a user's stop, which only a status younger than the order shows.
    fn report_stop(&mut self, now: Time, fx: &mut Fx) {
        let Some(order) = self.state.stop.order else { return };
        // A time in the future is of a clock before a restart of the machine.
        let accepted = order.accepted.min(now);
        if self.rested.is_some_and(|rested| rested >= accepted) {
            self.apply(Cause::StopReport { confirmed: true }, now, fx);
        } else if !order.is_late && now >= accepted + STOP_CONFIRMATION_MAX {
            self.apply(Cause::StopReport { confirmed: false }, now, fx);
        }
    }

    /// Continues when the arm has ended its order; notes the motion stop.
    fn watch_arm(&mut self, status: &ArmStatus, now: Time, fx: &mut Fx) {
        let stop = motion_stop(status);
        self.rested = (stop == MotionStop::Stopped).then_some(now);
        if stop != self.state.stop.motion {
            self.apply(Cause::MotionStop(stop), now, fx);
        }
        self.report_stop(now, fx);
        let Some((pick, object)) = self.state.ordered() else { return };
        if status.phase.get() != PickPhase::Done || status.pick() != pick {
            return;
        }
        let mut outcome = status.outcome.get();
        if outcome == PickOutcome::Pending {
            // Done without an outcome is not an end.
            return;
        }
        let done = match self.state.to_put_back() {
            Some(_) => PickOutcome::PutBack,
            None => PickOutcome::Delivered,
        };
        let is_done = matches!(outcome, PickOutcome::Delivered | PickOutcome::PutBack);
        let object = self.manager.scene().number(object);
        if is_done && (status.object != u32::from(object.0) || outcome != done) {
            // The order has a key, an object and a task. Whatever the arm did, it was something
            // else.
            self.rejected += 1;
            tracing::error!(?pick, ordered = object.0, found = status.object, "another order");
            outcome = PickOutcome::Interrupted;
        }
        self.apply(Cause::PickEnded { pick, outcome }, now, fx);
    }

    fn present(&mut self, put: Presentation, now: Time) {
        self.listen(now);
        let (act, which) = (&self.state.act, (put.prompt, put.number));
        if let Some(ended) = put.ended
            && put.complete
            && which == (act.prompt, act.presentation)
            && which != self.said
        {
            (self.said, self.floor.listened) = (which, now.since(ended).min(OUTAGE));
        }
        self.floor.presented = put;
    }

    fn listen(&mut self, now: Time) {
        self.floor.listened = self.listened(now);
        self.heard_of_speech = now;
    }

    /// Returns for how long the standing prompt could be answered since its end.
    fn listened(&self, now: Time) -> Span {
        let Span(before) = self.floor.listened;
        Span(before + now.since(self.heard_of_speech).min(OUTAGE).0)
    }

    fn tick(&mut self, now: Time, fx: &mut Fx) {
        self.decide_deferred(now, fx);
        self.report_stop(now, fx);
        self.step_table(None, now, fx);
        if self.manager.silence_is_due(&self.state, &self.floor(now), now) {
            self.apply(Cause::Silence, now, fx);
        } else if now >= self.next_send {
            self.send(now, fx);
        }
    }

    fn decide_deferred(&mut self, now: Time, fx: &mut Fx) {
        if self.manager.quiet_is_due(&self.state, &self.floor(now), now) {
            self.apply(Cause::Quiet, now, fx);
        }
    }

    /// Returns the floor: an observation that arrived early shows that one more is on its way. It
    /// is not waited for without end: the early one may never have been an utterance's.
    fn floor(&self, now: Time) -> Floor {
        let is_on_its_way = self.waiting_since.is_some_and(|since| now < since + HEARING_MAX);
        let pending = self.floor.pending.max(is_on_its_way.into());
        Floor { pending, listened: self.listened(now), ..self.floor }
    }

    fn apply(&mut self, cause: Cause, now: Time, fx: &mut Fx) {
        self.manager.step(&mut self.state, &cause, now);
        if let Cause::Utterance(utterance) = &cause {
            tracing::debug!(seq = %utterance.seq, rule = self.manager.rule(), "utterance applied");
        }
        fx.append(Record { cause, at: now, state: self.state.clone() });
        self.sync_table(now);
        self.send(now, fx);
    }

    fn send(&mut self, now: Time, fx: &mut Fx) {
        // The act first: the mark lets speech continue, which it must not do with the former act.
        self.send_table(now, fx);
        fx.publish(Out::Act(Box::new(view::act(&self.manager, &self.state))));
        fx.publish(Out::Mark(AppliedMark { seq: self.state.applied.0 }));
        let view = view::view(&self.manager, &self.state, self.rejected);
        let view = PolicyView { forgot: self.forgot, ..view };
        fx.publish(Out::View(Box::new(view)));
        self.next_send = now + RESEND_EVERY;
    }
}

fn motion_stop(status: &ArmStatus) -> MotionStop {
    match (status.stopped, status.moving) {
        (0, _) => MotionStop::Released,
        (_, 0) => MotionStop::Stopped,
        _ => MotionStop::Stopping,
    }
}

/// Returns whether the times are those at which a user spoke. An utterance that a client gives as a
/// whole, even a recording, comes at a moment of the client's choice.
fn is_live(source: Source) -> bool {
    matches!(source, Source::Microphone | Source::Browser)
}

fn presentation(presented: &Presented, now: Time) -> Presentation {
    Presentation {
        prompt: PromptId(presented.prompt),
        number: presented.presentation,
        began: Time(presented.started_ns).min(now),
        ended: (presented.ended_ns > 0).then_some(Time(presented.ended_ns).min(now)),
        complete: presented.state.get() == PresentationState::Ended,
        ..Presentation::default()
    }
}
