//! Grounding: turns an utterance's words into what they say about the scene.
//!
//! The meaning of an utterance depends on the question that it answers, and only the policy can
//! judge which one that is. So every hypothesis is read as an answer to each question that it may
//! answer, and to none.
//!
//! Stateless: an observation depends on the scene and the utterance alone, so this service can be
//! killed or swapped at any moment and forgets nothing.

mod rules;
pub mod shell;

use language::Reader;
use messages::{MessageRef, Observation, Utterance};
use rules::Rules;
use scene::Scene;
use service::{Effects, Event, Never, Node, NodeError, Time};
use whichone_sdk::grounding::observation;

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
            Event::Message(utterance) => {
                let Config { scene, reader } = &self.config;
                match observation(&mut Rules(reader), scene, &utterance, now) {
                    Ok(observation) => fx.publish(Box::new(observation)),
                    // Speech sends it again; a broken sender shows in its input age.
                    Err(error) => tracing::warn!(seq = utterance.seq, %error, "utterance refused"),
                }
            }
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
