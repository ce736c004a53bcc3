//! The recovery protocol of docs/journals.md in small: a client, speech, policy and arm with their
//! journals, and a bus that loses, doubles and reorders. Numbers are given and judged by the real
//! `messages::{outbox, inbox, pick}`.
//!
//! A user wants one object after another. Each takes two utterances: a request, upon which the policy
//! asks, and the answer to the question once it was presented, which names the object.
//!
//! A pass of a service (decide, sync, publish) is one step, or one that a crash cuts short at any of
//! its points; since services only meet through the bus, which delays as long as it likes, no other
//! interleaving is lost by that.

use crate::search::System;
pub(crate) use state::State;

mod arm;
mod faults;
mod policy;
mod speech;
mod state;
mod stop_order;

/// The rule that a mutant breaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Broken {
    /// The policy's outputs may be visible before its record is durable.
    PublishBeforeSync,
    /// Speech acknowledges before its record is durable.
    AcknowledgeBeforeSync,
    /// The policy applies an utterance before the one that is missing.
    AcceptGap,
    /// The policy applies what it has applied.
    AcceptDuplicate,
    /// Speech accepts a repeated request as a new one.
    ResendWithoutKey,
    /// Speech sends each utterance once.
    NoResend,
    /// Speech takes a prompt for presented as soon as it begins.
    NoRepresentation,
    /// The policy keeps an order in memory only.
    OrderNotJournaled,
    /// The arm takes a repeated order for a new one.
    RepeatOrder,
    /// The arm grasps before its record of the order is durable.
    MoveBeforeRecord,
    /// The arm grasps again after a restart without asking its gripper.
    IgnoreGripper,
    /// The arm forgets the latched stop in a restart.
    ForgetLatch,
    /// The arm keeps in memory only that its pick was called off.
    CallOffInMemory,
    /// The arm hands over what it holds, though it was called off.
    HandOverCalledOff,
    /// The gripper opens before the record that it does is durable.
    OpenBeforeRecord,
    /// Speech sends a stop that was said once.
    StopOnce,
    /// Speech keeps a stop that was said in memory only.
    StopNotJournaled,
    /// An answer to an earlier order settles the pending one.
    SettleByAnyAnswer,
    /// The arm may confirm a stop before its latch is durable.
    ConfirmBeforeSync,
    /// The robot says that it has stopped once a stop is accepted.
    ReportIntention,
    /// A new policy journal begins with utterance 0, and speech sends the old ones.
    ReplayAfterLoss,
    /// A new policy journal numbers interactions from 1; picks are compared with their objects.
    ReuseInteractions,
    /// As before, and picks are compared without their objects.
    ReuseAndCompareIdOnly,
    /// A new speech journal numbers utterances from 1, before the policy's mark is known.
    ReuseUtterances,
    /// Speech numbers from above what is over, and the policy waits for what it has not applied.
    WaitForLost,
    /// A new policy journal numbers prompts from 1.
    ReusePrompts,
}

/// Bounds of the search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Protocol {
    /// Objects that the user wants.
    pub(crate) objects: u8,
    /// Crashes.
    pub(crate) crashes: u8,
    /// Journals that are set aside.
    pub(crate) lost: u8,
    /// Whether messages are lost and doubled.
    pub(crate) lossy: bool,
    /// Whether the user may stop the arm, once.
    pub(crate) stops: bool,
    /// Whether the user may say "stop", once.
    pub(crate) says_stop: bool,
    /// Whether the user may call off what is being fetched, once.
    pub(crate) calls_off: bool,
    /// Whether the user says the second thing before the robot has taken in the first.
    pub(crate) impatient: bool,
    /// The rule that does not hold.
    pub(crate) broken: Option<Broken>,
}

/// A service.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Service {
    Speech,
    Policy,
    Arm,
}

/// One step.
#[derive(Clone, Debug)]
#[allow(dead_code, reason = "the fields are for the counterexample")]
pub(crate) enum Step {
    Submit(u8),
    Resend(u8),
    Learn(u8),
    Receive(u8),
    Hear(u8, Cut),
    Marked(u8),
    Play(u8, Cut),
    Present(u8, Cut),
    SpeechTick,
    SayStop(Cut),
    StopSettled(Cut),
    StopOrder(Cut),
    Apply(u8, Cut),
    PickEnds(u8, Cut),
    CallOff(Cut),
    PolicyTick,
    Order(u8, Cut),
    Grasp,
    Held(Cut),
    LetGo(Cut),
    Release,
    TurnBack(Cut),
    PutDown,
    Done(Cut),
    ArmTick,
    Stop(Cut),
    Resume(Cut),
    Start(Service),
    /// A message is lost.
    Lose(&'static str),
    Crash(Service),
    SetAside(Service),
}

/// Where a crash cuts a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cut {
    Not,
    BeforeSync,
    AfterSync,
    AfterFirstOutput,
    /// Only with a rule broken: the outputs are seen, the record is lost.
    OutputsWithoutRecord,
}

impl Protocol {
    fn is(&self, broken: Broken) -> bool {
        self.broken == Some(broken)
    }

    /// Utterances that suffice whatever is lost: two for each object, three more for each
    /// interaction that ends with a journal, two more after a call-off, and what is said before the robot
    /// has listened.
    fn keys_max(&self) -> u8 {
        2 * (self.objects + u8::from(self.calls_off)) + 3 * self.lost + u8::from(self.impatient)
    }

    /// The points at which this pass may be cut.
    fn cuts(&self, state: &State, without_record: bool) -> Vec<Cut> {
        let mut cuts = vec![Cut::Not];
        if state.world.crashes < self.crashes {
            cuts.extend([Cut::BeforeSync, Cut::AfterSync, Cut::AfterFirstOutput]);
            cuts.extend(without_record.then_some(Cut::OutputsWithoutRecord));
        }
        cuts
    }
}

/// Ends a pass as the cut says: `record` makes it durable, each of `outputs` publishes.
fn commit(
    state: &State,
    cut: Cut,
    service: Service,
    record: impl Fn(&mut State),
    outputs: &[&dyn Fn(&mut State)],
) -> State {
    let mut next = state.clone();
    if !matches!(cut, Cut::BeforeSync | Cut::OutputsWithoutRecord) {
        record(&mut next);
    }
    let count = match cut {
        Cut::Not | Cut::OutputsWithoutRecord => outputs.len(),
        Cut::AfterFirstOutput => 1,
        Cut::BeforeSync | Cut::AfterSync => 0,
    };
    outputs.iter().take(count).for_each(|publish| publish(&mut next));
    if cut != Cut::Not {
        kill(&mut next, service);
        next.world.crashes += 1;
    }
    next
}

fn kill(state: &mut State, service: Service) {
    match service {
        Service::Speech => (state.speech, state.bus.stop_done) = (None, 0),
        Service::Policy => state.policy = None,
        // Nothing listens to orders to a process that is away.
        Service::Arm => (state.arm, state.bus.stop) = (None, 0),
    }
}

type Visit<'a> = &'a mut dyn FnMut(Step, State);

impl System for Protocol {
    type State = State;
    type Step = Step;

    fn successors(&self, state: &State, visit: &mut dyn FnMut(Step, State)) {
        self.client(state, visit);
        self.speech(state, visit);
        self.stop_order(state, visit);
        self.policy(state, visit);
        self.arm(state, visit);
        self.starts(state, visit);
        self.faults(state, visit);
    }

    fn is_fault(step: &Step) -> bool {
        matches!(step, Step::Lose(_) | Step::Crash(_) | Step::SetAside(_))
    }

    fn broken(state: &State) -> Option<&'static str> {
        let journal = &state.speech_journal;
        let keeps =
            |key: u32| state.world.applied & 1 << key != 0 || journal.number(key as u8).is_some();
        let lost = (0..32).any(|key| state.world.acknowledged & 1 << key != 0 && !keeps(key));
        state.world.broken.or(lost.then_some("I2: an acknowledged utterance is lost"))
    }

    fn is_done(&self, state: &State) -> bool {
        state.client.got == self.objects && state.world.stop_due == 0
    }
}
