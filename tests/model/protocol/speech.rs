//! Steps of the client and of speech.

use super::state::{Said, Speech, SpeechJournal, State};
use super::{Broken, Cut, Protocol, Service, Step, Visit, commit};

impl Protocol {
    pub(super) fn client(&self, state: &State, visit: Visit<'_>) {
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

    pub(super) fn speech(&self, state: &State, visit: Visit<'_>) {
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
        if let Some((prompt, ..)) = state.bus.act
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

    pub(super) fn hear(&self, state: &State, speech: Speech, said: Said, visit: Visit<'_>) {
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
}

pub(super) fn put(utterances: &mut Vec<(u8, Said)>, one: (u8, Said)) {
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
