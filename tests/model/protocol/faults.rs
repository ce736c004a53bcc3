//! Crashes, lost messages, starts, and journals that are set aside.

use super::state::{Arm, Bus, Phase, Policy, Speech, SpeechJournal, State};
use super::{Broken, Protocol, Service, Step, Visit, kill};

impl Protocol {
    pub(super) fn starts(&self, state: &State, visit: Visit<'_>) {
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

    pub(super) fn faults(&self, state: &State, visit: Visit<'_>) {
        type Clear = fn(&mut Bus) -> bool;
        let topics: [(&str, Clear); 8] = [
            ("injection", |bus| bus.injection.take().is_some()),
            ("receipt", |bus| bus.receipt.take().is_some()),
            ("utterance", |bus| bus.utterances.pop().is_some()),
            ("mark", |bus| bus.mark.take().is_some()),
            ("act", |bus| bus.act.take().is_some()),
            ("status", |bus| bus.status.take().is_some()),
            ("stop", |bus| std::mem::take(&mut bus.stop) != 0),
            ("stop's answer", |bus| std::mem::take(&mut bus.stop_done) != 0),
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
    pub(super) fn set_aside(&self, state: &State, service: Service) -> State {
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

    pub(super) fn speech_above(&self, state: &State, over: u8, is_own: bool) -> SpeechJournal {
        let presented = if is_own { 0 } else { state.speech_journal.presented };
        let stop = if is_own { 0 } else { state.speech_journal.stop };
        let above = SpeechJournal { base: over, accepted: Vec::new(), presented, stop };
        match self.broken {
            Some(Broken::ReuseUtterances) if is_own => SpeechJournal { base: 0, ..above },
            Some(Broken::ReplayAfterLoss) if !is_own => state.speech_journal.clone(),
            _ => above,
        }
    }

    pub(super) fn policy_above(&self, state: &State, over: u8, is_own: bool) -> Policy {
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
