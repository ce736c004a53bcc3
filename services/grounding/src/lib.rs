//! Grounding: turns an utterance's words into what they say about the scene.
//!
//! The meaning of an utterance depends on the question that it answers, and only the policy can
//! judge which one that is. So every hypothesis is read as an answer to each question that it may
//! answer, and to none.
//!
//! Stateless: an observation depends on the scene and the utterance alone, so this service can be
//! killed or swapped at any moment and forgets nothing.

mod interpret;
pub mod shell;

use interpret::interpretations;
use language::Reader;
use messages::{
    Fits, FixedText, Interpretation, MessageRef, Observation, Utterance, WireError, WireReading,
};
use scene::{Reading, Scene};
use service::{Effects, Event, Never, Node, NodeError, Time};

/// The scene and its reader.
pub struct Config {
    /// The scene.
    pub scene: Scene,
    /// Reads text with that scene's words.
    pub reader: Reader,
}

/// Grounding as a reducer.
pub struct GroundingNode {
    config: Config,
}

impl Node for GroundingNode {
    type Config = Config;
    type In<'a> = MessageRef<'a, Utterance>;
    type Out = Box<Observation>;
    type Record = Never;

    fn recover(config: Config, _records: Vec<Never>) -> Result<Self, NodeError> {
        Ok(Self { config })
    }

    fn on(
        &mut self,
        event: Event<MessageRef<'_, Utterance>>,
        now: Time,
        fx: &mut Effects<Box<Observation>, Never>,
    ) {
        match event {
            Event::Message(utterance) => match self.read(&utterance, now) {
                Ok(observation) => fx.publish(Box::new(observation)),
                // Speech sends it again; a broken sender shows in its input age.
                Err(error) => tracing::warn!(seq = utterance.seq, %error, "utterance refused"),
            },
            Event::Shutdown => fx.exit(),
            Event::SetAside(_) | Event::Started | Event::Tick => {}
        }
    }

    fn deadline(&self) -> Option<Time> {
        None
    }

    fn checkpoint(&self) -> Option<Vec<u8>> {
        Some(Vec::new())
    }

    fn resume(config: Config, _checkpoint: &[u8]) -> Result<Self, NodeError> {
        Self::recover(config, Vec::new())
    }
}

impl GroundingNode {
    fn read(&self, utterance: &Utterance, now: Time) -> Result<Observation, WireError> {
        let mut observation = Observation {
            seq: utterance.seq,
            asked: utterance.asked,
            asked_count: utterance.asked_count,
            source: utterance.source,
            scene_key: self.config.scene.key(),
            gesture: utterance.gesture.target_m()?.into(),
            onset_ns: utterance.onset_ns,
            end_ns: utterance.end_ns,
            accepted_ns: utterance.accepted_ns,
            grounded_ns: now.ns(),
            ..Observation::default()
        };
        let heard = utterance.hypotheses()?;
        let mut meant = if heard.is_empty() && utterance.gesture.target_m()?.is_some() {
            // A pointing gesture without words: one reading, without a word.
            vec![Interpretation { weight: 1.0, answers: None, reading: Reading::default() }]
        } else {
            interpretations(&self.config, &heard, utterance.asked()?)?
        };
        meant.truncate(observation.readings.len());
        observation.reading_count = meant.len() as u8;
        for (slot, interpretation) in observation.readings.iter_mut().zip(&meant) {
            let (wire, fits) = WireReading::new(interpretation);
            if fits == Fits::Cut {
                tracing::warn!(seq = utterance.seq, "more scene words than a message holds");
            }
            *slot = wire;
        }
        if let Some(word) = heard.first().and_then(|best| interpret::unknown(&self.config, best)) {
            observation.unknown = FixedText::truncated(&word.text);
            observation.unknown_role = word.role.into();
        }
        Ok(observation)
    }
}
