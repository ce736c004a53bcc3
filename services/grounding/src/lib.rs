//! Grounding: turns an utterance's words into what they say about the scene.
//!
//! Stateless: an observation depends on the scene and the utterance alone, so this service can be
//! killed or swapped at any moment and forgets nothing.

pub mod shell;

use language::Reader;
use node::{Effects, Event, Never, Node, NodeError, Time};
use protocol::{Fits, FixedText, Observation, Utterance, WireReading};
use scene::{Question, Reading, Scene};

/// How it reads: the scene and its reader.
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
    type In = Box<Utterance>;
    type Out = Box<Observation>;
    type Record = Never;

    fn recover(config: Config, _records: Vec<Never>) -> Result<Self, NodeError> {
        Ok(Self { config })
    }

    fn on(
        &mut self,
        event: Event<Box<Utterance>>,
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
            Event::Started | Event::Tick => {}
        }
    }

    fn deadline(&self) -> Option<Time> {
        None
    }
}

impl GroundingNode {
    fn read(&self, utterance: &Utterance, now: Time) -> Result<Observation, protocol::WireError> {
        let question = Question::try_from(utterance.heard_question)?;
        // In another scene its numbers mean something else.
        let scene = &self.config.scene;
        let is_known = utterance.heard_scene == scene.key() && scene.contains(question);
        let question = if is_known { question } else { Question::None };
        let mut observation = Observation {
            seq: utterance.seq,
            heard_prompt: utterance.heard_prompt,
            heard_question: utterance.heard_question,
            scene_key: self.config.scene.key(),
            gesture: utterance.gesture.target_m()?.into(),
            onset_ns: utterance.onset_ns,
            accepted_ns: utterance.accepted_ns,
            grounded_ns: now.ns(),
            ..Observation::default()
        };
        let hypotheses = utterance.hypotheses()?;
        if hypotheses.is_empty() && utterance.gesture.target_m()?.is_some() {
            // Somebody points and says nothing: one reading, without a word.
            observation.reading_count = 1;
            observation.readings[0] = WireReading::new(&Reading::default(), 1.0).0;
            return Ok(observation);
        }
        observation.reading_count = hypotheses.len() as u8;
        for (i, (text, weight)) in hypotheses.into_iter().enumerate() {
            let understood = self.config.reader.read(text, question);
            let (wire, fits) = WireReading::new(&understood.reading, weight);
            if fits == Fits::Cut {
                tracing::warn!(seq = utterance.seq, "more scene words than a message holds");
            }
            observation.readings[i] = wire;
            if let (0, Some(word)) = (i, understood.unknown.first()) {
                observation.unknown = FixedText::truncated(word);
            }
        }
        Ok(observation)
    }
}
