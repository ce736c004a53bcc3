//! Steps of the policy.

use messages::UtteranceSeq;
use messages::inbox::{Inbox, Verdict};

use super::state::{Ordered, Phase, Policy, Said, State, bit};
use super::{Broken, Cut, Protocol, Service, Step, Visit, commit};

impl Protocol {
    pub(super) fn policy(&self, state: &State, visit: Visit<'_>) {
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
            let ends = matches!(phase, Phase::Delivered | Phase::Failed | Phase::Cancelled);
            if policy.open != 0 && policy.pick != 0 && is_it && ends {
                let object = if phase == Phase::Delivered { policy.pick } else { 0 };
                let ended = (policy.open, object);
                let after = Policy { open: 0, pick: 0, called_off: false, ended, ..policy };
                let is_delivered = state.world.delivered & bit(ordered) != 0;
                let really = object == 0 || is_delivered;
                let is_left = phase != Phase::Cancelled || !is_delivered;
                let ghost = move |next: &mut State| {
                    next.world.must(really, "false delivery: the arm did not deliver this object");
                    next.world.must(is_left, "false end: the user has what was called off");
                };
                self.advance(&next, after, ghost, &|cut| Step::PickEnds(policy.open, cut), visit);
            } else {
                visit(Step::PickEnds(0, Cut::Not), next);
            }
        }
        if self.calls_off && !state.world.calls_off && policy.pick != 0 {
            let mut next = state.clone();
            next.world.calls_off = true;
            let after = Policy { called_off: true, ..policy };
            self.advance(&next, after, |_| {}, &Step::CallOff, visit);
        }
        let mut next = state.clone();
        publish_act(&mut next, policy);
        publish_mark(&mut next, policy);
        visit(Step::PolicyTick, next);
    }

    pub(super) fn observe(
        &self,
        next: &State,
        policy: Policy,
        (seq, said): (u8, Said),
        visit: Visit<'_>,
    ) {
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
    pub(super) fn advance(
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
}

fn publish_act(next: &mut State, policy: Policy) {
    let asks = policy.open != 0 && policy.pick == 0;
    let prompt = if asks { policy.last_prompt } else { 0 };
    let order = Ordered { interaction: policy.open, object: policy.pick };
    next.bus.act = Some((prompt, order, policy.called_off));
}

fn publish_mark(next: &mut State, policy: Policy) {
    next.bus.mark = Some(policy.applied);
    next.bus.view = policy;
}
