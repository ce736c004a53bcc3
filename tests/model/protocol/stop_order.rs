//! A stop that the user says: accepted by speech, repeated until the arm has confirmed it.

use super::state::{Arm, State};
use super::{Broken, Cut, Protocol, Service, Step, Visit, commit};

impl Protocol {
    pub(super) fn stop_order(&self, state: &State, visit: Visit<'_>) {
        if state.speech.is_some() {
            self.speech_stops(state, visit);
        }
        if let Some(arm) = state.arm.filter(|_| state.bus.stop != 0) {
            self.arm_obeys(state, arm, visit);
        }
    }

    fn speech_stops(&self, state: &State, visit: Visit<'_>) {
        // The client repeats what was not accepted.
        if self.says_stop && !state.world.stop_said {
            let order = state.world.stop_orders + 1;
            let record = |next: &mut State| {
                let is_kept = !self.is(Broken::StopNotJournaled);
                next.speech_journal.stop = if is_kept { order } else { 0 };
                (next.world.stop_said, next.world.stop_due) = (true, order);
                next.world.stop_seen |= self.is(Broken::ReportIntention);
            };
            for cut in self.cuts(state, false) {
                // The order itself waits for no disk.
                let mut next = state.clone();
                next.world.stop_orders = order;
                send(&mut next, order);
                visit(Step::SayStop(cut), commit(&next, cut, Service::Speech, record, &[]));
            }
        }
        let pending = state.speech_journal.stop;
        if pending != 0 && pending != state.bus.stop && !self.is(Broken::StopOnce) {
            let mut next = state.clone();
            send(&mut next, pending);
            visit(Step::SpeechTick, next);
        }
        if state.bus.stop_done != 0 {
            let mut next = state.clone();
            let answered = std::mem::take(&mut next.bus.stop_done);
            // An answer to an earlier order says nothing of this one.
            if answered != pending && !self.is(Broken::SettleByAnyAnswer) {
                return visit(Step::StopSettled(Cut::Not), next);
            }
            let record = |next: &mut State| next.speech_journal.stop = 0;
            for cut in self.cuts(state, false) {
                let next = commit(&next, cut, Service::Speech, record, &[]);
                visit(Step::StopSettled(cut), next);
            }
        }
    }

    fn arm_obeys(&self, state: &State, arm: Arm, visit: Visit<'_>) {
        let mut next = state.clone();
        let order = std::mem::take(&mut next.bus.stop);
        // A repeated order is known: it does not latch again what was released meanwhile.
        let is_new = order > arm.obeyed;
        let after = Arm { stopped: arm.stopped || is_new, obeyed: arm.obeyed.max(order), ..arm };
        next.arm = Some(after);
        let record = |next: &mut State| {
            next.arm_journal = after;
            if next.world.stop_due <= order {
                next.world.stop_due = 0;
            }
        };
        let answer = |next: &mut State| {
            next.bus.stop_done = order;
            next.world.stop_seen |= after.stopped;
        };
        for cut in self.cuts(state, self.is(Broken::ConfirmBeforeSync)) {
            let next = commit(&next, cut, Service::Arm, record, &[&answer]);
            visit(Step::StopOrder(cut), next);
        }
    }
}

/// A datagram to the arm's socket: none arrives while its process is away.
fn send(next: &mut State, order: u8) {
    next.bus.stop = if next.arm.is_some() { order } else { 0 };
}
