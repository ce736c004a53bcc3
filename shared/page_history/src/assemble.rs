//! Interactions put together from the records of three journals. Pure.

use std::collections::BTreeMap;

use messages::{PickPhase, Task};
use service::journal_record::{
    AcceptedRecord, ArmCause, ArmRecord, EndedRecord, JournalLine, JournalRecord, Named,
    PickRecord, PolicyCause, PolicyRecord, SpeechRecord,
};
use service::view::Readings;

use crate::interaction::{End, Event, Heard, Interaction, Labelled, Moment, Thought};

/// Utterances and lines of the robot that are remembered.
const REMEMBERED_MAX: usize = 256;
/// Interactions in memory.
const RECENT_MAX: usize = 4096;
/// Moments of an interaction.
const MOMENTS_MAX: usize = 400;
/// Objects of a large scene that a moment adds.
const LIKELY_MAX: usize = 8;

/// Interactions that are not finished with.
#[derive(Debug, Default)]
pub(super) struct Assembler {
    /// Recent interactions by number.
    recent: BTreeMap<u64, Begun>,
    /// Accepted utterances by number.
    accepted: BTreeMap<u64, AcceptedRecord>,
    /// Lines of the robot by number.
    lines: BTreeMap<u64, String>,
    /// The last record of the policy: its interaction, and the end that it knows.
    before: Option<(u64, Option<EndedRecord>)>,
}

#[derive(Debug)]
struct Begun {
    /// When its first words were accepted, monotonic clock.
    opened_ns: u64,
    interaction: Interaction,
}

impl Assembler {
    /// Takes in records of one journal, oldest first. Those of speech come before those of the
    /// policy, and these before the arm's.
    pub(super) fn take_in(&mut self, lines: Vec<JournalLine>) {
        for JournalLine { seq, at_ns, unix_ms, record, .. } in lines {
            let at = At { seq, ns: at_ns, unix_ms };
            match record {
                JournalRecord::Speech(record) => self.on_speech(*record),
                JournalRecord::Policy(record) => self.on_policy(at, &record),
                JournalRecord::Arm(record) => self.on_arm(at, *record),
            }
        }
    }

    /// The interactions, oldest first.
    pub(super) fn recent(&self) -> impl DoubleEndedIterator<Item = &Interaction> {
        self.recent.values().map(|begun| &begun.interaction)
    }

    /// Returns the interaction with the given number.
    pub(super) fn get(&self, interaction: u64) -> Option<&Interaction> {
        self.recent.get(&interaction).map(|begun| &begun.interaction)
    }

    /// Forgets the interactions up to that one.
    pub(super) fn forget(&mut self, up_to: u64) {
        self.recent = self.recent.split_off(&(up_to + 1));
    }

    fn on_speech(&mut self, record: SpeechRecord) {
        if let SpeechRecord::Accepted(accepted) = record {
            remember(&mut self.accepted, accepted.utterance, accepted);
        }
    }

    fn on_policy(&mut self, at: At, record: &PolicyRecord) {
        let PolicyRecord { decision, interaction, ended, .. } = record;
        if decision.prompt != 0 && !decision.text.is_empty() {
            remember(&mut self.lines, decision.prompt, decision.text.clone());
        }
        let is_first = self.before.is_none() && at.seq != 1;
        let (open_before, ended_before) = self.before.take().unwrap_or_default();
        // A step that leaves no interaction open belongs to the one that it ends.
        let closed = ended.as_ref().filter(|_| *ended != ended_before).map(|it| it.interaction);
        let of = if *interaction != 0 { Some(*interaction) } else { closed };
        if let Some(of) = of {
            let opened = record.opened_ns.filter(|_| *interaction == of);
            let is_whole = !is_first && record.cause != PolicyCause::Snapshot;
            if opened.is_some() && !self.recent.contains_key(&of) {
                self.begin(of, at, opened.unwrap_or(at.ns), is_whole);
            }
            let is_repeated = record.cause == PolicyCause::Snapshot && open_before == of;
            if !is_repeated {
                self.add_thought(of, at, record);
            }
        }
        if let Some(ended) = ended {
            self.end(ended);
        }
        self.before = Some((*interaction, ended.clone()));
    }

    fn begin(&mut self, number: u64, at: At, opened_ns: u64, whole: bool) {
        let since_ms = at.ns.saturating_sub(opened_ns) / 1_000_000;
        let interaction = Interaction {
            interaction: number,
            unix_ms: at.unix_ms.map(|now| now.saturating_sub(since_ms)),
            whole,
            objects: Vec::new(),
            moments: Vec::new(),
            left_out: 0,
            end: None,
        };
        self.recent.insert(number, Begun { opened_ns, interaction });
        // Without a disk that takes the settled ones.
        if self.recent.len() > RECENT_MAX {
            self.recent.pop_first();
        }
    }

    fn add_thought(&mut self, of: u64, at: At, record: &PolicyRecord) {
        let event = match &record.cause {
            PolicyCause::Utterance { utterance, interpretations, .. } => {
                let readings = Readings::of_records(*utterance, interpretations);
                let line = |prompt: u64, _: u32| self.lines.get(&prompt).cloned();
                let understood = readings.attribute(&record.attributed, line);
                let said = self.accepted.get(utterance);
                Event::Heard(Heard {
                    utterance: *utterance,
                    text: said.map(|said| said.text.clone()).unwrap_or_default(),
                    source: said.map(|said| said.source),
                    confidence: said.map(|said| said.confidence),
                    snr_db: said.and_then(|said| said.snr_db),
                    readings: understood.meanings,
                    answers: understood.answers,
                })
            }
            PolicyCause::Silence => Event::Silence,
            PolicyCause::Quiet => Event::Quiet,
            PolicyCause::PickEnded { outcome, .. } => Event::PickEnded { outcome: *outcome },
            PolicyCause::Reconfigured => Event::Reconfigured,
            PolicyCause::Objects { .. } => Event::Objects,
            PolicyCause::Stopped => Event::Stopped,
            // The arm comes to rest within a moment.
            PolicyCause::Stopping | PolicyCause::Forget { .. } => return,
            PolicyCause::StopReport { confirmed: true } => Event::StopConfirmed,
            PolicyCause::StopReport { confirmed: false } => Event::StopUnconfirmed,
            PolicyCause::Released => Event::Released,
            PolicyCause::SetAside { .. } | PolicyCause::Snapshot => Event::Recovered,
        };
        let Some(begun) = self.recent.get_mut(&of) else { return };
        let thought = begun.interaction.thought(record);
        begun.add(at, event, Some(thought));
    }

    fn on_arm(&mut self, at: At, record: ArmRecord) {
        let ArmRecord { cause, pick, offered, .. } = record;
        let Some(mut pick) = pick.filter(|pick| is_shown(cause, pick)) else { return };
        // The gripper opens for the user: the end of the pick shows it.
        let opens = pick.phase == PickPhase::Holding && offered.is_some();
        if cause == ArmCause::Phase && opens {
            return;
        }
        let Some(begun) = self.recent.get_mut(&pick.interaction) else { return };
        // The arm knows perceived objects by number; the policy has named the order's object.
        if let Some(name) = begun.interaction.ordered(pick.attempt) {
            pick.object = name;
        }
        let is_rest = |moment: &Moment| matches!(&moment.event, Event::Arm { cause: ArmCause::Rested, pick: known } if known.attempt == pick.attempt);
        // At rest once more: nothing has happened.
        if cause == ArmCause::Rested && begun.interaction.moments.iter().any(is_rest) {
            return;
        }
        begun.add(at, Event::Arm { cause, pick }, None);
    }

    fn end(&mut self, ended: &EndedRecord) {
        let Some(begun) = self.recent.get_mut(&ended.interaction) else { return };
        let interaction = &mut begun.interaction;
        let labelled = |name: &String| {
            let known = interaction.objects.iter().find(|object| object.name == *name);
            known.cloned().unwrap_or_else(|| Labelled { name: name.clone(), label: name.clone() })
        };
        interaction.end = Some(End {
            outcome: ended.outcome,
            object: ended.object.as_ref().map(labelled),
            questions: ended.questions,
            duration_s: ended.duration_s,
        });
    }
}

/// Returns whether a step of the arm is part of the interaction of its pick. That the fetch has
/// ended is known from the policy; the limbs also come to rest before they set out.
fn is_shown(cause: ArmCause, pick: &PickRecord) -> bool {
    let is_done = pick.phase == PickPhase::Done;
    match cause {
        ArmCause::Ordered | ArmCause::Phase | ArmCause::Missed | ArmCause::Blocked => true,
        ArmCause::Motion { .. } => !is_done,
        ArmCause::Ended => pick.task == Task::PutBack,
        ArmCause::Rested => is_done,
        ArmCause::Snapshot | ArmCause::SceneChanged | ArmCause::Moved | ArmCause::Shutdown => false,
    }
}

/// When a record was written, and its number.
#[derive(Clone, Copy, Debug)]
struct At {
    seq: u64,
    ns: u64,
    unix_ms: Option<u64>,
}

impl Begun {
    fn add(&mut self, at: At, event: Event, thought: Option<Thought>) {
        let after_ms = self.after_ms(at);
        let moments = &mut self.interaction.moments;
        if moments.len() >= MOMENTS_MAX {
            self.interaction.left_out += 1;
            return;
        }
        let place = moments.partition_point(|moment| moment.after_ms <= after_ms);
        moments.insert(place, Moment { after_ms, event, thought });
    }

    /// Time since the first words. The monotonic clock restarts with the machine; this does not.
    fn after_ms(&self, at: At) -> u64 {
        let by_wall = at.unix_ms.zip(self.interaction.unix_ms);
        let by_wall = by_wall.map(|(now, began)| now.saturating_sub(began));
        by_wall.unwrap_or(at.ns.saturating_sub(self.opened_ns) / 1_000_000)
    }
}

impl Interaction {
    /// Returns belief and decision of a record; its objects are added to the interaction's.
    fn thought(&mut self, record: &PolicyRecord) -> Thought {
        self.list(&record.belief, &record.objects);
        let digits = |share: f64| (share * 1e4).round() / 1e4;
        let last = self.moments.iter().rev().find_map(|moment| moment.thought.as_ref());
        let belief = match (record.belief.is_empty(), last) {
            // The belief at the end of an interaction is the last one.
            (true, Some(last)) => last.belief.clone(),
            _ => {
                let share = |object: &Labelled| record.belief.get(&object.name).copied();
                let shares = self.objects.iter().map(|it| digits(share(it).unwrap_or(0.0)));
                shares.collect()
            }
        };
        let absent = match (record.belief.is_empty(), last) {
            (true, Some(last)) => last.absent,
            _ => digits(record.absent),
        };
        Thought { belief, absent, decision: record.decision.clone() }
    }

    fn list(&mut self, belief: &Named<f64>, described: &Named<String>) {
        let mut new: Vec<&(String, f64)> = belief.0.iter().collect();
        if described.is_empty() {
            new.sort_by(|a, b| b.1.total_cmp(&a.1));
            new.truncate(LIKELY_MAX);
        }
        for (name, _) in new {
            if self.objects.iter().any(|object| object.name == *name) {
                continue;
            }
            let words = described.get(name).unwrap_or(name);
            let numbered = |n: usize| if n == 1 { words.clone() } else { format!("{words} {n}") };
            let is_free = |label: &String| self.objects.iter().all(|it| it.label != *label);
            let label = (1..).map(numbered).find(is_free).unwrap_or_default();
            self.objects.push(Labelled { name: name.clone(), label });
        }
    }

    /// Returns the name of the object that was ordered with that attempt.
    fn ordered(&self, attempt: u32) -> Option<String> {
        let thoughts = self.moments.iter().filter_map(|moment| moment.thought.as_ref());
        let picks = thoughts.filter_map(|thought| thought.decision.pick.as_ref());
        let of_this = picks.filter(|pick| pick.interaction == self.interaction);
        of_this.filter(|pick| pick.attempt == attempt).map(|pick| pick.object.clone()).next()
    }
}

fn remember<T>(known: &mut BTreeMap<u64, T>, number: u64, item: T) {
    known.insert(number, item);
    if known.len() > REMEMBERED_MAX {
        known.pop_first();
    }
}
