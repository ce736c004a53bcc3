//! Utterances for which the model is asked: observations leave in the order of the utterances, each
//! at the latest when its time is up, then with the built-in reader's readings.

use std::collections::VecDeque;

use messages::{Hypothesis, Interpretation, Observation};
use model_reader::Calibration;
use model_reader::{ModelReading, calibrated, parse, utterance};
use scene::{Intent, Question, Reading, Reference, Response, Scene};
use serde::{Deserialize, Serialize};
use service::bounded::push_bounded;
use service::{Effects, Never, Span, Time};
use whichone_sdk::grounding::{Grounded, Heard, put_readings};

use crate::io::{ModelAnswer, ModelRequest, Out};
use crate::slot::{Slot, at_most, slots};

/// Utterances that may wait for the model; further ones are read by the built-in reader.
pub(crate) const PENDING_MAX: usize = 16;
/// Observations that are kept for utterances that are sent again.
const RECENT_MAX: usize = 8;
/// Least time between two warnings, so that a model that fails now and then does not fill the log.
const WARN_EVERY: Span = Span::from_ms(60_000);

/// How the model is used.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelUse {
    /// Name of the model, for the status.
    pub name: String,
    /// Time from an utterance to its observation.
    pub timeout: Span,
    /// Calibration of the model's weights.
    pub calibration: Calibration,
}

/// An utterance as the built-in reader has read it.
pub(crate) struct Read {
    pub(crate) observation: Box<Observation>,
    pub(crate) heard: Heard,
    pub(crate) grounded: Grounded,
}

/// The utterances in progress.
pub(crate) struct ModelQueue {
    settings: ModelUse,
    pending: VecDeque<Pending>,
    memory: Memory,
}

/// State that outlives the utterances in progress.
#[derive(Default, Serialize, Deserialize)]
struct Memory {
    /// Requests so far.
    tickets: u64,
    recent: VecDeque<Box<Observation>>,
    /// Whether the last request was answered; nothing before the first one.
    works: Option<bool>,
    /// Status for the operator.
    status: Option<String>,
    warned: Option<Time>,
}

struct Pending {
    since: Time,
    observation: Box<Observation>,
    /// Reason for waiting; `None` when the utterance can leave.
    waits: Option<Waits>,
}

struct Waits {
    ticket: u64,
    due: Time,
    slots: Vec<Slot>,
    /// Probability that a word of the best hypothesis was not said.
    noise: f64,
}

type Fx = Effects<Out, Never>;

impl ModelQueue {
    pub(crate) fn new(settings: ModelUse) -> Self {
        Self { settings, pending: VecDeque::new(), memory: Memory::default() }
    }

    /// Takes an utterance, and asks the model about it unless that is not needed.
    pub(crate) fn take(&mut self, read: Read, scene: &Scene, now: Time, fx: &mut Fx) {
        let seq = read.observation.seq;
        // Sent again while its observation is on the way.
        if self.pending.iter().any(|pending| pending.observation.seq == seq) {
            return;
        }
        let known = self.memory.recent.iter().find(|known| is_same(known, &read.observation));
        let (observation, waits) = match known {
            Some(known) => (known.clone(), None),
            None if self.pending.len() < PENDING_MAX && is_for_model(&read) => {
                let (request, waits) = self.request(&read, scene, now);
                fx.publish(Out::Ask(request));
                (read.observation, Some(waits))
            }
            None => (read.observation, None),
        };
        self.pending.push_back(Pending { since: now, observation, waits });
        self.release(now, fx);
    }

    fn request(
        &mut self,
        Read { heard, grounded, .. }: &Read,
        scene: &Scene,
        now: Time,
    ) -> (ModelRequest, Waits) {
        let (slots, heard) = (slots(heard, grounded), &heard.hypotheses);
        self.memory.tickets += 1;
        let (ticket, due) = (self.memory.tickets, now + self.settings.timeout);
        let texts: Vec<(f64, &str)> = heard.iter().map(|it| (it.weight, &*it.text)).collect();
        let utterance = utterance(scene, &texts, &asked(scene, &slots));
        let noise = heard.first().map_or(0.0, noise);
        (ModelRequest { ticket, due, utterance }, Waits { ticket, due, slots, noise })
    }

    /// Takes an answer; one that comes too late finds nothing that waits for it.
    pub(crate) fn answer(&mut self, answer: ModelAnswer, scene: &Scene, now: Time, fx: &mut Fx) {
        let waits_for_it = |pending: &&mut Pending| {
            pending.waits.as_ref().is_some_and(|waits| waits.ticket == answer.ticket)
        };
        let Some(pending) = self.pending.iter_mut().find(waits_for_it) else { return };
        let Some(waits) = pending.waits.take() else { return };
        let numbers: Vec<usize> = asked(scene, &waits.slots).iter().map(|it| it.0).collect();
        let readings = answer.content.and_then(|content| {
            parse(scene, &numbers, &content).map_err(|error| format!("answer refused: {error}"))
        });
        match readings {
            Ok(readings) => {
                let meant = combined(self.settings.calibration, &readings, &waits);
                put_readings(&mut pending.observation, &meant);
                if readings.iter().any(|it| has_content(&it.reading)) {
                    // The word that the built-in reader does not know was understood.
                    let Observation { unknown, unknown_role, .. } = Observation::default();
                    pending.observation.unknown = unknown;
                    pending.observation.unknown_role = unknown_role;
                }
                self.works();
            }
            Err(reason) => self.fails(reason, now),
        }
        self.release(now, fx);
    }

    /// Gives up the requests whose time is up.
    pub(crate) fn expire(&mut self, now: Time, fx: &mut Fx) {
        let is_due = |waits: &mut Waits| waits.due <= now;
        let expired = self.pending.iter_mut().filter_map(|it| it.waits.take_if(is_due)).count();
        if expired > 0 {
            self.fails(format!("no answer within {} ms", self.settings.timeout.0 / 1_000_000), now);
        }
        self.release(now, fx);
    }

    /// Publishes the utterances that wait for nothing, up to the first that does.
    fn release(&mut self, now: Time, fx: &mut Fx) {
        while self.pending.front().is_some_and(|first| first.waits.is_none())
            && let Some(mut done) = self.pending.pop_front()
        {
            done.observation.grounded_ns = now.ns();
            let recent = &mut self.memory.recent;
            recent.retain(|known| known.seq != done.observation.seq);
            push_bounded(recent, RECENT_MAX, done.observation.clone());
            fx.publish(Out::Observation(done.observation));
        }
    }

    fn works(&mut self) {
        let Self { settings: ModelUse { name, .. }, memory, .. } = self;
        if memory.works != Some(true) {
            tracing::info!(model = name, "the model answers");
            memory.status = Some(format!("model {name} answers"));
        }
        memory.works = Some(true);
    }

    fn fails(&mut self, reason: String, now: Time) {
        let Memory { works, status, warned, .. } = &mut self.memory;
        let is_news = works.replace(false) != Some(false);
        if is_news && warned.is_none_or(|warned| now >= warned + WARN_EVERY) {
            *warned = Some(now);
            tracing::warn!(reason, "the model is not used; the built-in reader takes its place");
        } else {
            tracing::debug!(reason, "the model is not used for this utterance");
        }
        *status = Some(format!("built-in reader in place of the model: {reason}"));
    }

    pub(crate) fn deadline(&self) -> Option<Time> {
        self.pending.iter().filter_map(|it| Some(it.waits.as_ref()?.due)).min()
    }

    pub(crate) fn pending_since(&self) -> Option<Time> {
        self.pending.front().map(|first| first.since)
    }

    pub(crate) fn status(&self) -> Option<&str> {
        self.memory.status.as_deref()
    }

    /// The state between utterances; `None` while one waits.
    pub(crate) fn checkpoint(&self) -> Option<Vec<u8>> {
        self.pending.is_empty().then(|| postcard::to_stdvec(&self.memory).ok()).flatten()
    }

    /// Restores [`ModelQueue::checkpoint`]; none from one of another build.
    pub(crate) fn resumed(settings: ModelUse, checkpoint: &[u8]) -> Option<Self> {
        // One of a node without a model.
        let memory = match checkpoint {
            [] => Memory::default(),
            bytes => postcard::from_bytes(bytes).ok()?,
        };
        Some(Self { settings, pending: VecDeque::new(), memory })
    }
}

/// The same utterance with the same presentations of questions.
fn is_same(known: &Observation, new: &Observation) -> bool {
    let key = |it: &Observation| (it.seq, it.accepted_ns, it.asked_count, it.asked, it.scene_key);
    key(known) == key(new)
}

/// Requests to end something are understood at once; without words there is nothing to ask.
fn is_for_model(Read { heard, grounded, .. }: &Read) -> bool {
    let has_words = heard.hypotheses.first().is_some_and(|best| !best.text.trim().is_empty());
    let best = grounded.interpretations.iter().find(|one| one.answers.is_none());
    let ends = |best: &Interpretation| {
        let Reading { intent, excluded, .. } = &best.reading;
        matches!(intent, Intent::Stop | Intent::StopAndCancel)
            || *intent == Intent::Cancel && excluded.is_empty()
    };
    has_words && !best.is_some_and(ends)
}

/// Whether a reading says something about objects.
fn has_content(reading: &Reading) -> bool {
    let Reading { base, excluded, further, refers, .. } = reading;
    !(base.is_empty() && excluded.is_empty() && further.is_empty()) || *refers != Reference::None
}

/// The questions of this scene, by their numbers.
fn asked(scene: &Scene, slots: &[Slot]) -> Vec<(usize, Question)> {
    let known = |slot: &&Slot| slot.question != Question::None && scene.contains(slot.question);
    slots.iter().filter(known).filter_map(|slot| Some((slot.place?, slot.question))).collect()
}

/// Mean probability that a word was not said.
fn noise(best: &Hypothesis) -> f64 {
    let doubt: f64 = best.word_confidence.iter().map(|sure| 1.0 - f64::from(*sure)).sum();
    doubt / best.word_confidence.len().max(1) as f64
}

/// Calibrated readings of the model, by question. For a question without any, the built-in reader's
/// count; if these say nothing, its other readings count: the utterance may follow that question.
fn combined(
    calibration: Calibration,
    readings: &[ModelReading],
    waits: &Waits,
) -> Vec<Interpretation> {
    let most = at_most(waits.slots.len());
    let of_slot = |slot: &Slot| {
        let of = |place| readings.iter().filter(move |it| it.question == place);
        let mut own: Vec<&ModelReading> = of(slot.place).collect();
        if own.is_empty() && slot.readings.iter().all(|(_, reading)| says_nothing(reading)) {
            own = of(None).collect();
        }
        let own: Vec<(f64, Reading)> =
            own.into_iter().map(|it| (it.weight, it.reading.clone())).collect();
        let mut all = calibrated(calibration, &own, &slot.readings, most);
        if !own.is_empty() {
            all.iter_mut().for_each(|(_, reading)| doubt(reading, slot, waits.noise));
        }
        all
    };
    waits.slots.iter().flat_map(|slot| slot.interpretations(of_slot(slot))).collect()
}

fn says_nothing(reading: &Reading) -> bool {
    reading.base.is_empty() && reading.excluded.is_empty() && reading.response == Response::None
}

/// Doubts a reading of the model, which sees no confidences: as the built-in reader doubts the same
/// words and answers, and readings that it has not found as much as the words in the mean.
fn doubt(reading: &mut Reading, slot: &Slot, noise: f64) {
    let all = || slot.readings.iter().map(|(_, known)| known);
    let word = |word: &scene::WordId| {
        let found = |known: &Reading| {
            let at = known.base.iter().position(|it| it == word)?;
            Some(known.doubt.of_word(at))
        };
        all().find_map(found).unwrap_or(noise)
    };
    let group = |group: &Vec<scene::WordId>| {
        let found = |known: &Reading| {
            let at = known.excluded.iter().position(|it| it == group)?;
            Some(known.doubt.of_group(at))
        };
        all().find_map(found).unwrap_or(noise)
    };
    reading.doubt.base = reading.base.iter().map(word).collect();
    reading.doubt.excluded = reading.excluded.iter().map(group).collect();
    let same = all().find(|known| known.response == reading.response);
    let of_answer = same.map_or((2.0 * noise).min(1.0), |known| known.doubt.response);
    reading.doubt.response = if reading.response == Response::None { 0.0 } else { of_answer };
}
