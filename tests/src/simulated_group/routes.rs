//! Routing of messages between simulated services, with injected loss and duplication.

use std::iter::repeat_n;

use dialogue::Model;
use evaluation::simulation::users::TimedUtterance;
use messages::{ActKind, PresentationState, Presented, Source};
use service::{Span, Time};
use speech::{Hypothesis, Recognised, RecognisedSegment};
use speech_engines::stream::{Began, LIVE_FROM, SpeechSegment, StreamEvent};

use super::user::{Channel, key, seconds, time};
use super::{Decoding, SimulatedGroup};

/// Time from the first sound of an utterance to its detection.
const DETECTION: Span = Span::from_ms(100);

impl SimulatedGroup {
    /// Sends onsets and ends of the user's utterances by the user's channel.
    pub(super) fn user_speaks(&mut self) {
        if self.client.is_some() {
            return;
        }
        let now = self.now;
        let story = self.user.begins(now, &self.settings.scene);
        story.into_iter().for_each(|line| self.log(line));
        for n in 0..self.user.begun.len() {
            let live = self.user.channel == Channel::Live;
            let begun = &mut self.user.begun[n];
            let (onset, end) = (time(begun.utterance.onset_s), time(begun.utterance.end_s));
            let detected = !begun.onset_sent && now >= onset + DETECTION;
            let ended = !begun.end_sent && now >= end;
            (begun.onset_sent, begun.end_sent) =
                (begun.onset_sent || detected, begun.end_sent || ended);
            if live && detected {
                self.inboxes
                    .speech
                    .push(speech::In::Stream(StreamEvent::Began(live_onset(n, onset))));
            }
            if live && ended {
                let segment = SpeechSegment { onset, end, samples: Vec::new(), speech: 0..0 };
                let sound = LIVE_FROM + n as u64;
                self.inboxes.speech.push(speech::In::Stream(StreamEvent::Ended { sound, segment }));
            } else if ended {
                let done = time(begun.utterance.result_s);
                self.decoding.push(Decoding { done, sound: None, utterance: n });
            }
        }
        for injection in self.user.sends(now) {
            let copies = self.faults.copies(now);
            let message = speech::In::Injection(injection);
            self.inboxes.speech.extend(repeat_n(message, copies));
        }
    }

    /// Delivers the results of the recognisers.
    pub(super) fn finish_decoding(&mut self) {
        let now = self.now;
        let done: Vec<Decoding> = self.decoding.extract_if(.., |one| one.done <= now).collect();
        for Decoding { sound, utterance, .. } in done {
            let Some(sound) = sound else {
                self.user.send_transcript(utterance, now);
                continue;
            };
            let begun = &self.user.begun[utterance];
            let TimedUtterance { onset_s, end_s, .. } = begun.utterance;
            let hypotheses = vec![Hypothesis::certain(begun.text.clone())];
            let segment = RecognisedSegment::accepted((0.0, end_s - onset_s), 40.0, hypotheses);
            let recognised = Recognised { sound, segments: Ok(vec![segment]) };
            self.inboxes.speech.push(speech::In::Recognised(recognised));
        }
    }

    pub(super) fn route_speech(&mut self, outputs: Vec<speech::Out>) {
        for output in outputs {
            let copies = self.faults.copies(self.now);
            match output {
                speech::Out::Utterance(utterance) => {
                    let input = grounding::In::Utterance(utterance.into());
                    self.inboxes.grounding.extend(repeat_n(input, copies));
                }
                speech::Out::Receipt(receipt) => match &mut self.client {
                    Some(client) => client.publish(copies, |it| it.receipts.push(*receipt)),
                    None if copies > 0 => self.user.acknowledge(&receipt),
                    None => {}
                },
                speech::Out::Presented(presented) => {
                    self.user_hears(&presented);
                    if let Some(client) = &mut self.client {
                        client.publish(copies, |it| it.presented = Some(presented));
                    }
                    let message = policy::In::Presented(presented);
                    self.inboxes.policy.extend(repeat_n(message, copies));
                }
                speech::Out::Activity(activity) => {
                    if let Some(client) = &mut self.client {
                        client.publish(copies, |it| it.activity = Some(activity));
                    }
                    self.inboxes.policy.extend(repeat_n(policy::In::Activity(activity), copies));
                }
                speech::Out::Stop(given) => self.stop.give(given),
                speech::Out::Speak(line) => self.speak(&line),
                speech::Out::StopSpeaking => self.stop_speaking(),
                speech::Out::Recognise(sound, _) => {
                    let utterance = (sound - LIVE_FROM) as usize;
                    let timed = &self.user.begun[utterance].utterance;
                    let done = self.now + Span::from_s(timed.result_s - timed.end_s);
                    self.decoding.push(Decoding { done, sound: Some(sound), utterance });
                }
                speech::Out::Hearing(_)
                | speech::Out::Partial(_)
                | speech::Out::InterimSamples(..)
                | speech::Out::DecodeEarly(..)
                | speech::Out::Close(..) => {}
                speech::Out::OpenMicrophone(..) => unreachable!("no client opens the microphone"),
            }
        }
    }

    /// The user hears the robot's questions, whatever the bus loses.
    fn user_hears(&mut self, presented: &Presented) {
        let ended = match presented.state.get() {
            PresentationState::Speaking => false,
            PresentationState::Ended => true,
            _ => return,
        };
        let ends = match (ended, &self.saying) {
            (false, Some(saying)) => saying.ends,
            (false, None) => self.now,
            (true, _) => Time(presented.ended_ns),
        };
        let presentation = (presented.prompt, presented.presentation);
        let times = (Time(presented.started_ns), ends);
        let question = self.user.asked(presented.prompt);
        let wanted = self.user.wanted();
        let table = self.table.as_ref();
        match question.and_then(|it| table.and_then(|table| table.by_place(it, wanted))) {
            // Where they stand is what perception says; what they are like, the user knows better.
            Some((scene, seen)) => {
                let model = Model::new(&scene, self.settings.dialogue.params);
                self.user.want(seen);
                self.user.hear((&scene, &model), presentation, times, ended);
                self.user.want(wanted);
            }
            None => {
                let domain = (&self.settings.scene, &self.model);
                self.user.hear(domain, presentation, times, ended);
            }
        }
    }

    pub(super) fn route_grounding(&mut self, outputs: Vec<grounding::Out>) {
        for output in outputs {
            // These groups have no model.
            let grounding::Out::Observation(observation) = output else { continue };
            for _ in 0..self.faults.copies(self.now) {
                // The bus may hand over a doubled message out of turn.
                self.inboxes.policy.insert(0, policy::In::Observation(observation.clone().into()));
            }
        }
    }

    pub(super) fn route_policy(&mut self, outputs: Vec<policy::Out>) {
        for output in outputs {
            let copies = self.faults.copies(self.now);
            match output {
                policy::Out::Mark(mark) => {
                    self.inboxes.speech.extend(repeat_n(speech::In::Mark(mark), copies));
                }
                policy::Out::Act(act) => {
                    self.check_durable(&act);
                    if act.kind == ActKind::Ask
                        && let Ok(question) = act.question.try_into()
                    {
                        let table = self.table.as_ref();
                        let question = table.map_or(question, |table| table.question(question));
                        self.user.announce(act.prompt, act.scene_key, question);
                        self.die_at_question(act.prompt);
                    }
                    self.picked = self.picked.or(act.pick().map(|(_, object)| object));
                    let to_speech = speech::In::Act(act.clone().into());
                    let to_arm = arm::In::Act(act.into());
                    self.inboxes.speech.extend(repeat_n(to_speech, copies));
                    self.inboxes.arm.extend(repeat_n(to_arm, copies));
                }
                policy::Out::Objects(view) => {
                    if let Some(table) = &mut self.table {
                        table.on_table(&view);
                    }
                    self.inboxes.arm.extend(repeat_n(arm::In::Table(view), copies));
                }
                policy::Out::View(view) => {
                    if let Some(client) = &mut self.client {
                        client.publish(copies, |it| it.view = Some((*view).clone()));
                    }
                    self.view = *view;
                }
            }
        }
    }

    pub(super) fn route_arm(&mut self, outputs: Vec<arm::Out>) {
        for output in outputs {
            match output {
                arm::Out::World(world) => {
                    if let Some(table) = &mut self.table {
                        table.on_world(&world);
                        self.inboxes.policy.push(policy::In::World(world));
                    }
                }
                arm::Out::Status(status) => {
                    if let Some(table) = &mut self.table {
                        table.on_arm(&status);
                    }
                    let copies = self.faults.copies(self.now);
                    self.inboxes.policy.extend(repeat_n(policy::In::Arm(status), copies));
                    self.inboxes.speech.extend(repeat_n(speech::In::Arm(status), copies));
                }
                arm::Out::StopState(_, state) => {
                    self.inboxes.speech.extend(self.stop.on_answer(state, self.now));
                }
                // A result that comes while the arm is down is lost, as with its thread.
                arm::Out::Plan(request) => {
                    self.inboxes.arm.push(arm::In::Planned(Box::new(request.solve())));
                }
                _ => {}
            }
        }
    }

    /// Records acts that become visible before they are durable.
    fn check_durable(&mut self, act: &messages::RobotAct) {
        let durable = self.policy.journal().last().map_or(0, |record| record.state.act.id.0);
        if act.act > durable && act.kind != ActKind::Wait {
            self.premature.push(format!("act {} before record {durable}", act.act));
        }
    }

    /// Seconds since the dialogue began.
    pub(super) fn seconds(&self) -> f64 {
        seconds(self.now)
    }
}

fn live_onset(n: usize, at: Time) -> Began {
    Began {
        sound: LIVE_FROM + n as u64,
        at,
        stream: key(n),
        segment: None,
        source: Source::Microphone,
        interrupts: true,
    }
}
