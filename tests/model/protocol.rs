//! The recovery protocol of ARCHITECTURE.md in small: a client, speech, policy and arm with their
//! journals, and a bus that loses, doubles and reorders. Numbers are given and judged by the real
//! `messages::{outbox, inbox, pick}`.
//!
//! A user wants one object after another. Each takes two utterances: a request, upon which the policy
//! asks, and the answer to the question once it was presented, which names the object.
//!
//! A pass of a service (decide, sync, publish) is one step, or one that a crash cuts short at any of
//! its points; since services only meet through the bus, which delays as long as it likes, no other
//! interleaving is lost by that.

use messages::inbox::{Inbox, Verdict};
use messages::outbox::Outbox;
use messages::pick::{Order, Pick, judge};
use messages::{InteractionId, PickId, PickOutcome, PickPhase, Task, UtteranceSeq};
use scene::ObjectId;

use crate::search::System;

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
    Apply(u8, Cut),
    PickEnds(u8, Cut),
    PolicyTick,
    Order(u8, Cut),
    Grasp,
    Held(Cut),
    Release,
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

/// An utterance: the client's key, and the object that an answer names; 0 for a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Said {
    key: u8,
    object: u8,
}

/// An order of the policy, as it is published and journaled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
struct Ordered {
    interaction: u8,
    object: u8,
}

/// The state of the policy; each of its records holds it whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
struct Policy {
    applied: u8,
    last_interaction: u8,
    last_prompt: u8,
    /// The open interaction, 0 for none.
    open: u8,
    /// Its order; object 0 while it asks.
    pick: u8,
    /// The latest end: interaction, and the object delivered, 0 where it failed.
    ended: (u8, u8),
}

/// The state of the arm; each of its records holds it whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
struct Arm {
    pick: Ordered,
    phase: Phase,
    stopped: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
enum Phase {
    #[default]
    None,
    Accepted,
    Holding,
    Delivered,
    Failed,
}

/// Speech's journal.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
struct SpeechJournal {
    /// Number before the first of `accepted`.
    base: u8,
    accepted: Vec<Said>,
    presented: u8,
}

/// Speech's memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
struct Speech {
    mark: Option<u8>,
    playing: u8,
}

/// What travels. Latest-value topics hold one message.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
struct Bus {
    injection: Option<Said>,
    receipt: Option<(u8, u8)>,
    /// Utterances by number, in any order.
    utterances: Vec<(u8, Said)>,
    mark: Option<u8>,
    /// Prompt asked, and order.
    act: Option<(u8, Ordered)>,
    status: Option<(Ordered, Phase)>,
    /// What the client sees.
    view: Policy,
    presented: u8,
}

/// The client.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
struct Client {
    /// Objects that it has got.
    got: u8,
    keys: u8,
    sending: Option<Said>,
    /// Highest number accepted.
    accepted: u8,
    answered: u8,
    reported: u8,
}

/// What is true outside of all memories.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
struct World {
    holding: u8,
    /// The latest question that the user has heard to its end.
    heard: u8,
    /// Bits of interactions.
    grasped: u16,
    /// Bits of (interaction, object).
    ordered: u32,
    delivered: u32,
    /// Bits of keys.
    acknowledged: u32,
    applied: u32,
    stop_seen: bool,
    stops: u8,
    crashes: u8,
    lost: u8,
    broken: Option<&'static str>,
}

/// Everything at one moment.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct State {
    client: Client,
    speech_journal: SpeechJournal,
    speech: Option<Speech>,
    policy_journal: Policy,
    policy: Option<Policy>,
    arm_journal: Arm,
    arm: Option<Arm>,
    bus: Bus,
    world: World,
}

fn bit(order: Ordered) -> u32 {
    1 << (order.interaction * 3 + order.object)
}

impl World {
    fn must(&mut self, holds: bool, what: &'static str) {
        if !holds {
            self.broken.get_or_insert(what);
        }
    }
}

impl SpeechJournal {
    /// The real outbox as it is recovered from the journal, with the mark.
    fn outbox(&self, mark: Option<u8>) -> Outbox<Said> {
        let mut outbox = Outbox::new(UtteranceSeq(self.base.into()), 16, 256);
        for (seq, said) in (u64::from(self.base) + 1..).zip(&self.accepted) {
            outbox.push(UtteranceSeq(seq), *said);
        }
        if let Some(mark) = mark {
            // A mark that was never sent is not believed, as in the service.
            let _ = outbox.acknowledge(UtteranceSeq(mark.into()));
        }
        outbox
    }

    fn number(&self, key: u8) -> Option<u8> {
        let at = self.accepted.iter().position(|said| said.key == key)?;
        Some(self.base + at as u8 + 1)
    }

    fn last(&self) -> u8 {
        self.base + self.accepted.len() as u8
    }
}

impl Protocol {
    fn is(&self, broken: Broken) -> bool {
        self.broken == Some(broken)
    }

    /// Utterances that suffice whatever is lost: two for each object, three more for each
    /// interaction that ends with a journal, and what is said before the robot has listened.
    fn keys_max(&self) -> u8 {
        2 * self.objects + 3 * self.lost + u8::from(self.impatient)
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
        Service::Speech => state.speech = None,
        Service::Policy => state.policy = None,
        Service::Arm => state.arm = None,
    }
}

type Visit<'a> = &'a mut dyn FnMut(Step, State);

impl Protocol {
    fn client(&self, state: &State, visit: Visit<'_>) {
        let (client, view) = (state.client, state.bus.view);
        if let Some(said) = client.sending {
            if state.bus.injection.is_none() {
                let mut next = state.clone();
                next.bus.injection = Some(said);
                visit(Step::Resend(said.key), next);
            }
        } else if view.ended.0 > client.reported {
            let mut next = state.clone();
            next.client.reported = view.ended.0;
            next.client.got += u8::from(view.ended.1 == client.got + 1);
            visit(Step::Learn(view.ended.1), next);
        } else if client.got < self.objects && client.keys < self.keys_max() {
            let talks_on = self.impatient && client.keys == 1;
            let settled = view.applied >= client.accepted || talks_on;
            let asks = view.open == 0;
            let prompt = view.last_prompt;
            let answers = view.open != 0
                && view.pick == 0
                && state.bus.presented == prompt
                && state.world.heard == prompt
                && client.answered != prompt;
            if settled && (asks || answers) {
                let mut next = state.clone();
                let object = if asks { 0 } else { client.got + 1 };
                next.client.keys += 1;
                next.client.answered = if asks { client.answered } else { prompt };
                next.client.sending = Some(Said { key: next.client.keys, object });
                visit(Step::Submit(next.client.keys), next);
            }
        }
        if let Some((key, seq)) = state.bus.receipt {
            let mut next = state.clone();
            next.bus.receipt = None;
            next.client.accepted = client.accepted.max(seq);
            if client.sending.is_some_and(|said| said.key == key) {
                next.client.sending = None;
                next.world.acknowledged |= 1 << key;
            }
            visit(Step::Receive(key), next);
        }
    }

    fn speech(&self, state: &State, visit: Visit<'_>) {
        let Some(speech) = state.speech else { return };
        let journal = &state.speech_journal;
        let is_marked = speech.mark.is_some() || self.is(Broken::ReuseUtterances);
        if let Some(said) = state.bus.injection.filter(|_| is_marked) {
            self.hear(state, speech, said, visit);
        }
        if let Some(mark) = state.bus.mark {
            let mut next = state.clone();
            next.bus.mark = None;
            next.speech = Some(Speech { mark: Some(mark), ..speech });
            visit(Step::Marked(mark), next);
        }
        if let Some((prompt, _)) = state.bus.act
            && prompt > journal.presented
            && prompt != speech.playing
        {
            let mut next = state.clone();
            next.speech = Some(Speech { playing: prompt, ..speech });
            let early = self.is(Broken::NoRepresentation);
            for cut in if early { self.cuts(state, false) } else { vec![Cut::Not] } {
                let record = |next: &mut State| {
                    if early {
                        next.speech_journal.presented = prompt;
                    }
                };
                visit(Step::Play(prompt, cut), commit(&next, cut, Service::Speech, record, &[]));
            }
        }
        if speech.playing != 0 {
            let mut next = state.clone();
            let prompt = speech.playing;
            next.speech = Some(Speech { playing: 0, ..speech });
            next.world.heard = prompt;
            let record = |next: &mut State| next.speech_journal.presented = prompt;
            let publish = |next: &mut State| next.bus.presented = prompt;
            for cut in self.cuts(state, false) {
                let next = commit(&next, cut, Service::Speech, record, &[&publish]);
                visit(Step::Present(prompt, cut), next);
            }
        }
        if !self.is(Broken::NoResend) {
            let mut next = state.clone();
            send(&mut next, speech, journal);
            visit(Step::SpeechTick, next);
        }
    }

    fn hear(&self, state: &State, speech: Speech, said: Said, visit: Visit<'_>) {
        let journal = &state.speech_journal;
        let known = journal.number(said.key).filter(|_| !self.is(Broken::ResendWithoutKey));
        if let Some(seq) = known {
            let mut next = state.clone();
            next.bus.injection = None;
            next.bus.receipt = Some((said.key, seq));
            return visit(Step::Hear(said.key, Cut::Not), next);
        }
        let Ok(number) = journal.outbox(speech.mark).next() else { return };
        let seq = number.0 as u8;
        let is_early = self.is(Broken::AcknowledgeBeforeSync);
        // With and without a second copy of the request on its way.
        for copies in 0..=usize::from(self.lossy) {
            let mut next = state.clone();
            next.bus.injection = (copies == 1).then_some(said);
            let record = |next: &mut State| {
                let twice = next.speech_journal.number(said.key).is_some();
                next.world.must(!twice, "one utterance is accepted twice");
                if next.speech_journal.last() < seq - 1 {
                    next.speech_journal =
                        SpeechJournal { base: seq - 1, accepted: Vec::new(), ..journal.clone() };
                }
                next.speech_journal.accepted.push(said);
            };
            let receipt = |next: &mut State| next.bus.receipt = Some((said.key, seq));
            let utterance = |next: &mut State| put(&mut next.bus.utterances, (seq, said));
            for cut in self.cuts(state, is_early) {
                let next = commit(&next, cut, Service::Speech, record, &[&receipt, &utterance]);
                visit(Step::Hear(said.key, cut), next);
            }
        }
    }

    fn policy(&self, state: &State, visit: Visit<'_>) {
        let Some(policy) = state.policy else { return };
        for (seq, said) in &state.bus.utterances {
            // Delivered for the last time, or once more.
            for copies in 0..=usize::from(self.lossy) {
                let mut next = state.clone();
                if copies == 0 {
                    next.bus.utterances.retain(|(other, _)| other != seq);
                }
                self.observe(&next, policy, (*seq, *said), visit);
            }
        }
        if let Some((order, phase)) = state.bus.status {
            let mut next = state.clone();
            next.bus.status = None;
            let ordered = Ordered { interaction: policy.open, object: policy.pick };
            let is_it = match self.is(Broken::ReuseAndCompareIdOnly) {
                true => order.interaction == ordered.interaction,
                false => order == ordered,
            };
            let ends = matches!(phase, Phase::Delivered | Phase::Failed);
            if policy.open != 0 && policy.pick != 0 && is_it && ends {
                let object = if phase == Phase::Delivered { policy.pick } else { 0 };
                let after = Policy { open: 0, pick: 0, ended: (policy.open, object), ..policy };
                let really = object == 0 || state.world.delivered & bit(ordered) != 0;
                let ghost = move |next: &mut State| {
                    next.world.must(really, "false delivery: the arm did not deliver this object");
                };
                self.advance(&next, after, ghost, &|cut| Step::PickEnds(policy.open, cut), visit);
            } else {
                visit(Step::PickEnds(0, Cut::Not), next);
            }
        }
        let mut next = state.clone();
        publish_act(&mut next, policy);
        publish_mark(&mut next, policy);
        visit(Step::PolicyTick, next);
    }

    fn observe(&self, next: &State, policy: Policy, (seq, said): (u8, Said), visit: Visit<'_>) {
        let inbox = Inbox::new(UtteranceSeq(policy.applied.into()));
        let applies = match inbox.judge(UtteranceSeq(seq.into())) {
            Verdict::Apply => true,
            Verdict::Duplicate => self.is(Broken::AcceptDuplicate),
            Verdict::Early => self.is(Broken::AcceptGap),
        };
        if !applies {
            return visit(Step::Apply(seq, Cut::Not), next.clone());
        }
        let mut after = Policy { applied: seq, ..policy };
        if policy.open == 0 && said.object == 0 {
            after.last_interaction += 1;
            after.last_prompt += 1;
            after.open = after.last_interaction;
        } else if policy.open != 0 && policy.pick == 0 {
            after.pick = said.object;
        }
        let ghost = move |next: &mut State| {
            let again = next.world.applied & 1 << said.key != 0;
            next.world.must(!again, "I1: an utterance is applied twice");
            next.world.must(seq == policy.applied + 1, "I1: an utterance is applied out of order");
            next.world.applied |= 1 << said.key;
        };
        self.advance(next, after, ghost, &|cut| Step::Apply(seq, cut), visit);
    }

    /// A new state of the policy: recorded, then published.
    fn advance(
        &self,
        state: &State,
        after: Policy,
        ghost: impl Fn(&mut State),
        step: &dyn Fn(Cut) -> Step,
        visit: Visit<'_>,
    ) {
        let mut next = state.clone();
        next.policy = Some(after);
        let is_order = after.pick != 0;
        let record = |next: &mut State| {
            ghost(next);
            if is_order && self.is(Broken::OrderNotJournaled) {
                next.policy_journal = Policy { pick: 0, ..after };
                return;
            }
            next.policy_journal = after;
            if is_order {
                let order = Ordered { interaction: after.open, object: after.pick };
                next.world.ordered |= bit(order);
            }
        };
        let act = |next: &mut State| publish_act(next, after);
        let mark = |next: &mut State| publish_mark(next, after);
        for cut in self.cuts(state, self.is(Broken::PublishBeforeSync)) {
            visit(step(cut), commit(&next, cut, Service::Policy, record, &[&act, &mark]));
        }
    }

    fn arm(&self, state: &State, visit: Visit<'_>) {
        let Some(arm) = state.arm else { return };
        if let Some((_, order)) = state.bus.act.filter(|(_, order)| order.object != 0) {
            self.on_order(state, arm, order, visit);
        }
        let move_now = |next: &mut State| {
            let stop_seen = next.world.stop_seen;
            next.world.must(!stop_seen, "the arm moves after its stop was confirmed");
        };
        match (arm.phase, state.world.holding) {
            _ if arm.stopped => {}
            (Phase::Accepted, 0) => visit(Step::Grasp, grasp(state, arm, move_now)),
            (Phase::Accepted, _) => {
                let after = Arm { phase: Phase::Holding, ..arm };
                self.record_arm(state, after, &Step::Held, visit);
            }
            (Phase::Holding, 0) => {
                let after = Arm { phase: Phase::Delivered, ..arm };
                self.record_arm(state, after, &Step::Done, visit);
            }
            (Phase::Holding, _) => {
                let mut next = state.clone();
                move_now(&mut next);
                let twice = next.world.delivered & bit(arm.pick) != 0;
                next.world.must(!twice, "I4: an object is delivered twice");
                next.world.delivered |= bit(arm.pick);
                next.world.holding = 0;
                visit(Step::Release, next);
            }
            _ => {}
        }
        if self.stops && state.world.stops == 0 {
            let mut next = state.clone();
            next.world.stops = 1;
            let after = Arm { stopped: true, ..arm };
            self.record_arm(&next, after, &Step::Stop, visit);
        }
        if arm.stopped && state.world.stop_seen {
            let mut next = state.clone();
            next.world.stop_seen = false;
            self.record_arm(&next, Arm { stopped: false, ..arm }, &Step::Resume, visit);
        }
        let mut next = state.clone();
        publish_status(&mut next, arm);
        visit(Step::ArmTick, next);
    }

    fn on_order(&self, state: &State, arm: Arm, order: Ordered, visit: Visit<'_>) {
        let latest = latest(arm);
        let id = id(order);
        let judged = judge(latest.as_ref(), id, ObjectId(order.object.into()), Some(Task::Fetch));
        let again = judged == Order::Known && self.is(Broken::RepeatOrder);
        let is_over = !matches!(arm.phase, Phase::Accepted | Phase::Holding);
        let by_id = judged == Order::Conflict && self.is(Broken::ReuseAndCompareIdOnly);
        if (judged == Order::Accept || again && is_over) && !by_id {
            if self.is(Broken::MoveBeforeRecord) && state.world.holding == 0 {
                let ready = Arm { pick: order, ..arm };
                let next = grasp(state, ready, |_| {});
                return visit(Step::Grasp, next);
            }
            let after = Arm { pick: order, phase: Phase::Accepted, ..arm };
            self.record_arm(state, after, &|cut| Step::Order(order.interaction, cut), visit);
        }
    }

    fn record_arm(&self, state: &State, after: Arm, step: &dyn Fn(Cut) -> Step, visit: Visit<'_>) {
        let mut next = state.clone();
        next.arm = Some(after);
        let record = |next: &mut State| next.arm_journal = after;
        let publish = |next: &mut State| publish_status(next, after);
        for cut in self.cuts(state, false) {
            visit(step(cut), commit(&next, cut, Service::Arm, record, &[&publish]));
        }
    }

    fn starts(&self, state: &State, visit: Visit<'_>) {
        if state.speech.is_none() {
            let mut next = state.clone();
            next.speech = Some(Speech::default());
            next.bus.presented = state.speech_journal.presented;
            visit(Step::Start(Service::Speech), next);
        }
        if state.policy.is_none() {
            let mut next = state.clone();
            next.policy = Some(state.policy_journal);
            visit(Step::Start(Service::Policy), next);
        }
        if state.arm.is_none() {
            let mut next = state.clone();
            let mut arm = state.arm_journal;
            arm.stopped &= !self.is(Broken::ForgetLatch);
            if self.is(Broken::IgnoreGripper) && arm.phase == Phase::Accepted {
                next.world.holding = 0;
            }
            next.arm = Some(arm);
            visit(Step::Start(Service::Arm), next);
        }
    }

    fn faults(&self, state: &State, visit: Visit<'_>) {
        type Clear = fn(&mut Bus) -> bool;
        let topics: [(&str, Clear); 6] = [
            ("injection", |bus| bus.injection.take().is_some()),
            ("receipt", |bus| bus.receipt.take().is_some()),
            ("utterance", |bus| bus.utterances.pop().is_some()),
            ("mark", |bus| bus.mark.take().is_some()),
            ("act", |bus| bus.act.take().is_some()),
            ("status", |bus| bus.status.take().is_some()),
        ];
        for (name, clear) in topics.into_iter().filter(|_| self.lossy) {
            let mut next = state.clone();
            if clear(&mut next.bus) {
                visit(Step::Lose(name), next);
            }
        }
        let services = [Service::Speech, Service::Policy, Service::Arm];
        if state.world.crashes < self.crashes {
            let is_up = [state.speech.is_some(), state.policy.is_some(), state.arm.is_some()];
            for (service, _) in services.into_iter().zip(is_up).filter(|(_, is_up)| *is_up) {
                let mut next = state.clone();
                kill(&mut next, service);
                next.world.crashes += 1;
                visit(Step::Crash(service), next);
            }
        }
        if state.world.lost < self.lost {
            for service in services {
                visit(Step::SetAside(service), self.set_aside(state, service));
            }
        }
    }

    /// `whichone journal set-aside` of one service's journal, with the group down: every number that
    /// anything knows is over, and nothing that has one goes on; what the arm holds it hands over.
    fn set_aside(&self, state: &State, service: Service) -> State {
        let mut next = state.clone();
        (next.speech, next.policy, next.arm) = (None, None, None);
        next.bus = Bus { view: Policy::default(), ..Bus::default() };
        next.world.lost += 1;
        // A client finds that its group has ended, and with it its request: no key outlives a journal.
        next.client.sending = None;
        next.client.answered = 0;
        // What nobody had taken in is over as well: the user asks again.
        next.world.acknowledged &= next.world.applied;
        let over = state.highest_number();
        let is_own = |own| service == own;
        next.speech_journal = self.speech_above(state, over, is_own(Service::Speech));
        next.policy_journal = self.policy_above(state, over, is_own(Service::Policy));
        if is_own(Service::Arm) {
            // It may have been stopped, and may hold something: a person looks before it moves.
            next.arm_journal = Arm { stopped: true, ..Arm::default() };
            next.world.holding = 0;
            next.world.stop_seen = true;
        } else if state.arm_journal.phase == Phase::Accepted && state.world.holding == 0 {
            next.arm_journal.phase = Phase::Failed;
        }
        next
    }

    fn speech_above(&self, state: &State, over: u8, is_own: bool) -> SpeechJournal {
        let presented = if is_own { 0 } else { state.speech_journal.presented };
        let above = SpeechJournal { base: over, accepted: Vec::new(), presented };
        match self.broken {
            Some(Broken::ReuseUtterances) if is_own => SpeechJournal { base: 0, ..above },
            Some(Broken::ReplayAfterLoss) if !is_own => state.speech_journal.clone(),
            _ => above,
        }
    }

    fn policy_above(&self, state: &State, over: u8, is_own: bool) -> Policy {
        let before = if is_own { Policy::default() } else { state.policy_journal };
        let ended = if before.open == 0 { before.ended } else { (before.open, 0) };
        let above = Policy {
            applied: over,
            last_interaction: over,
            last_prompt: over,
            ended,
            ..Policy::default()
        };
        match self.broken {
            Some(Broken::WaitForLost) => Policy { applied: before.applied, ..above },
            Some(Broken::ReplayAfterLoss) if is_own => Policy { applied: 0, ..above },
            Some(Broken::ReuseInteractions | Broken::ReuseAndCompareIdOnly) if is_own => {
                Policy { last_interaction: 0, ..above }
            }
            Some(Broken::ReusePrompts) if is_own => Policy { last_prompt: 0, ..above },
            _ => above,
        }
    }
}

impl State {
    /// The highest number that any journal has given to anything.
    fn highest_number(&self) -> u8 {
        let (speech, policy) = (&self.speech_journal, &self.policy_journal);
        let numbers = [
            speech.last(),
            speech.presented,
            policy.applied,
            policy.last_interaction,
            policy.last_prompt,
            self.arm_journal.pick.interaction,
            self.client.reported,
        ];
        numbers.into_iter().max().unwrap_or(0)
    }
}

fn put(utterances: &mut Vec<(u8, Said)>, one: (u8, Said)) {
    if !utterances.contains(&one) {
        utterances.push(one);
        utterances.sort_unstable();
    }
}

/// Sends what is above the mark, and the latest presentation, again.
fn send(next: &mut State, speech: Speech, journal: &SpeechJournal) {
    next.bus.presented = journal.presented;
    if speech.mark.is_some() {
        let outbox = journal.outbox(speech.mark);
        for (seq, said) in outbox.window() {
            put(&mut next.bus.utterances, (seq.0 as u8, *said));
        }
    }
}

fn publish_act(next: &mut State, policy: Policy) {
    let asks = policy.open != 0 && policy.pick == 0;
    let prompt = if asks { policy.last_prompt } else { 0 };
    let order = Ordered { interaction: policy.open, object: policy.pick };
    next.bus.act = Some((prompt, order));
}

fn publish_mark(next: &mut State, policy: Policy) {
    next.bus.mark = Some(policy.applied);
    next.bus.view = policy;
}

fn publish_status(next: &mut State, arm: Arm) {
    next.bus.status = Some((arm.pick, arm.phase));
    next.world.stop_seen |= arm.stopped;
}

fn id(order: Ordered) -> PickId {
    PickId { interaction: InteractionId(order.interaction.into()), attempt: 1 }
}

/// The latest pick as the real judge takes it.
fn latest(arm: Arm) -> Option<Pick> {
    let (phase, outcome) = match arm.phase {
        Phase::None => return None,
        Phase::Accepted => (PickPhase::Accepted, PickOutcome::Pending),
        Phase::Holding => (PickPhase::Holding, PickOutcome::Pending),
        Phase::Delivered => (PickPhase::Done, PickOutcome::Delivered),
        Phase::Failed => (PickPhase::Done, PickOutcome::Interrupted),
    };
    let object = ObjectId(arm.pick.object.into());
    Some(Pick { id: id(arm.pick), object, task: Task::Fetch, phase, outcome })
}

/// The arm closes its gripper on the object of its pick.
fn grasp(state: &State, arm: Arm, moves: impl Fn(&mut State)) -> State {
    let mut next = state.clone();
    moves(&mut next);
    let (order, journal) = (arm.pick, state.arm_journal);
    let recorded = journal.pick == order && journal.phase == Phase::Accepted;
    next.world.must(recorded, "I6: the arm moves for a pick that is not in its journal");
    let ordered = next.world.ordered & bit(order) != 0;
    next.world.must(ordered, "I3, I5: the arm grasps what no durable record orders");
    let again = next.world.grasped & 1 << order.interaction != 0;
    next.world.must(!again, "I4: the arm grasps twice");
    next.world.grasped |= 1 << order.interaction;
    next.world.holding = order.object;
    next
}

impl System for Protocol {
    type State = State;
    type Step = Step;

    fn successors(&self, state: &State, visit: &mut dyn FnMut(Step, State)) {
        self.client(state, visit);
        self.speech(state, visit);
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
        state.client.got == self.objects
    }
}
