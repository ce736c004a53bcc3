//! The policy: keeps the belief over the objects, and decides what to do about it.
//!
//! [`PolicyNode`] is the reducer. It takes observations strictly in order, each exactly once;
//! turns each into the next [`State`] through [`Mind`]; and has the state journaled before anything
//! that follows from it can be seen.

pub mod evidence;
pub mod history;
mod inspection;
pub mod journal_check;
mod kept;
pub mod mind;
pub mod shell;
pub mod state;
mod view;

#[cfg(test)]
mod tests;

use messages::WireCode;
use messages::inbox::{Inbox, Verdict};
use messages::{
    ActKind, Activity, AppliedMark, ArmStatus, AskedQuestion, Observation, PickOutcome, PickPhase,
    PolicyView, PresentationState, Presented, PromptId, RobotAct, Source, UtteranceSeq,
};
use mind::Mind;
use service::{Effects, Event, Node, NodeError, Span, Time};
use state::{Asking, Cause, Heard, Record, State};

/// How often what stands is sent again.
const RESEND_EVERY: Span = Span::from_ms(250);
/// Longest time that a sound being heard holds back a decision or a repetition.
const HEARING_MAX: Span = Span::from_ms(10_000);

/// What arrives.
#[derive(Clone, Debug, PartialEq)]
pub enum In {
    /// From grounding.
    Observation(Box<Observation>),
    /// From speech: the latest prompt said.
    Presented(Presented),
    /// From speech: whether somebody speaks.
    Activity(Activity),
    /// From the arm.
    Arm(ArmStatus),
}

/// What is published.
#[derive(Clone, Debug, PartialEq)]
pub enum Out {
    /// To speech: how far the belief has come.
    Mark(AppliedMark),
    /// To speech and arm: what to do.
    Act(Box<RobotAct>),
    /// To clients: what is thought.
    View(Box<PolicyView>),
}

type Fx = Effects<Out, Record>;

/// The policy as a reducer.
pub struct PolicyNode {
    mind: Mind,
    state: State,
    presented: Presented,
    activity: Activity,
    refused: u64,
    waiting_since: Option<Time>,
    next_send: Time,
}

impl Node for PolicyNode {
    type Config = Mind;
    type In = In;
    type Out = Out;
    type Record = Record;

    fn recover(mind: Mind, mut records: Vec<Record>) -> Result<Self, NodeError> {
        let state = records.pop().map_or_else(|| mind.first(), |record| record.state);
        check(&state)?;
        Ok(Self {
            mind,
            state,
            presented: Presented::default(),
            activity: Activity::default(),
            refused: 0,
            waiting_since: None,
            next_send: Time(0),
        })
    }

    fn on(&mut self, event: Event<In>, now: Time, fx: &mut Fx) {
        match event {
            Event::Started => self.start(now, fx),
            Event::Message(In::Observation(observation)) => self.observe(&observation, now, fx),
            Event::Message(In::Presented(presented)) => self.presented = presented,
            Event::Message(In::Activity(activity)) => {
                self.activity = activity;
                self.go_on(now, fx);
            }
            Event::Message(In::Arm(status)) => self.watch_arm(&status, now, fx),
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

    fn snapshot(&self) -> Option<Vec<Record>> {
        let cause = Cause::Snapshot;
        let record = Record { cause, at: self.state.act.decided, state: self.state.clone() };
        self.state.open.is_none().then(|| vec![record])
    }
}

impl PolicyNode {
    /// The state, for tests and simulation.
    pub fn state(&self) -> &State {
        &self.state
    }

    fn start(&mut self, now: Time, fx: &mut Fx) {
        if self.state.settings_key == self.mind.key() {
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
        let meant = observation.interpretations(self.mind.scene().words().len());
        let gesture = observation.gesture.target_m();
        let same_scene = observation.scene_key == self.mind.scene().key();
        let (Ok(meant), Ok(asked), Ok(gesture), true) =
            (meant, observation.asked(), gesture, same_scene)
        else {
            // Not applied, so speech sends the utterance again: a grounding that is mended or
            // swapped meanwhile gets another chance at it, and nothing is lost.
            self.refused += 1;
            self.waiting_since.get_or_insert(now);
            tracing::warn!(%seq, same_scene, "observation refused; the utterance stays pending");
            return;
        };
        self.waiting_since = None;
        let begun =
            if observation.onset_ns > 0 { observation.onset_ns } else { observation.accepted_ns };
        let heard = Heard {
            seq,
            asked: asked.iter().map(asking).collect(),
            typed: !is_live(observation.source.get()),
            onset: Time(begun),
            end: Time(observation.end_ns.max(begun)),
            accepted: Time(observation.accepted_ns),
            meant,
            unknown: observation.unknown.as_str().unwrap_or_default().to_owned(),
            gesture,
            more: self.more_is_coming(now),
        };
        self.apply(Cause::Utterance(heard), now, fx);
    }

    /// Whether more than the utterance at hand was said: somebody speaks, or is being recognised.
    fn more_is_coming(&self, now: Time) -> bool {
        self.somebody_is_heard(now) || self.activity.pending > 1
    }

    /// Ends the interaction when the arm has ended its pick.
    fn watch_arm(&mut self, status: &ArmStatus, now: Time, fx: &mut Fx) {
        let ordered = self.state.open.as_ref().and_then(|open| open.pick);
        let Some((pick, _)) = ordered else { return };
        let done = status.phase == PickPhase::Done.code() && status.pick() == pick;
        if let (true, Ok(outcome)) = (done, PickOutcome::from_code(status.outcome)) {
            self.apply(Cause::PickEnded { pick, outcome }, now, fx);
        }
    }

    fn tick(&mut self, now: Time, fx: &mut Fx) {
        self.go_on(now, fx);
        if self.silence_has_lasted(now) {
            self.apply(Cause::Silence, now, fx);
        } else if now >= self.next_send {
            self.send(now, fx);
        }
    }

    /// Decides what was held, once nobody speaks any more.
    fn go_on(&mut self, now: Time, fx: &mut Fx) {
        let held = self.state.open.as_ref().and_then(|open| open.held.as_ref());
        if held.is_some_and(|held| !self.somebody_speaks(now) || now >= held.since + HEARING_MAX) {
            self.apply(Cause::Quiet, now, fx);
        }
    }

    /// Whether the standing question was said to its end and the response window has passed since.
    fn silence_has_lasted(&self, now: Time) -> bool {
        let act = &self.state.act;
        let said = self.presented.prompt == act.prompt.0
            && self.presented.presentation == act.presentation
            && self.presented.state == PresentationState::Ended.code();
        let window = Span::from_s(self.mind.response_window_s(&self.state));
        act.kind == ActKind::Ask
            && said
            && !self.somebody_speaks(now)
            && now >= Time(self.presented.ended_ns) + window
            && now >= act.decided + window
    }

    fn somebody_speaks(&self, now: Time) -> bool {
        self.somebody_is_heard(now) || self.activity.pending > 0 || self.waiting_since.is_some()
    }

    fn somebody_is_heard(&self, now: Time) -> bool {
        self.activity.onset_ns > 0 && now < Time(self.activity.onset_ns) + HEARING_MAX
    }

    fn apply(&mut self, cause: Cause, now: Time, fx: &mut Fx) {
        self.state = self.mind.step(&self.state, &cause, now);
        fx.append(Record { cause, at: now, state: self.state.clone() });
        self.send(now, fx);
    }

    fn send(&mut self, now: Time, fx: &mut Fx) {
        // The act first: the mark lets speech go on, which must not be with what stood before.
        fx.publish(Out::Act(Box::new(view::act(&self.state))));
        fx.publish(Out::Mark(AppliedMark { seq: self.state.applied.0 }));
        let view = view::view(&self.mind, &self.state, self.refused);
        fx.publish(Out::View(Box::new(view)));
        self.next_send = now + RESEND_EVERY;
    }
}

/// Whether the times are those at which a person spoke. Whatever a client gives whole, a recording
/// too, comes at a moment of its own choosing.
fn is_live(source: Source) -> bool {
    matches!(source, Source::Microphone | Source::Browser)
}

fn asking(asked: &AskedQuestion) -> Asking {
    Asking {
        prompt: PromptId(asked.prompt),
        began: Time(asked.began_ns),
        ended: (asked.ended_ns > 0).then_some(Time(asked.ended_ns)),
        whole: asked.whole != 0,
    }
}

/// Whether the journal's last state can be gone on from.
fn check(state: &State) -> Result<(), NodeError> {
    let Some(open) = &state.open else { return Ok(()) };
    dialogue::Belief::from_log(open.belief.clone()).map(|_| ()).map_err(|error| NodeError {
        what: format!("the journal's belief cannot be gone on from: {error}"),
        cure: "start the group afresh: whichone up --fresh".to_owned(),
    })
}
