//! Grounding: turns an utterance's words into readings about the scene.
//!
//! The meaning of an utterance depends on the question that it answers, and only the policy can
//! judge which one that is. So every hypothesis is read as an answer to each question that it may
//! answer, and to none.
//!
//! A language model may read in place of the built-in reader (`dialogue.model`): its answers are
//! events, observations keep the order of the utterances, and each is published in time.
//!
//! Nothing is needed after a restart: an observation depends on the scene, the utterance and the
//! model alone, so this service can be killed or swapped at any moment and forgets nothing.

mod io;
mod model_queue;
mod model_worker;
mod rules;
pub mod shell;
mod slot;

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests;

pub use io::{In, ModelAnswer, ModelRequest, Out};
pub use model_queue::ModelUse;

use language::Reader;
use messages::{Utterance, WireError};
use model_queue::{ModelQueue, Read};
use rules::Rules;
use scene::Scene;
use service::{Effects, Event, Never, Node, NodeError, Time};
use std::process::ExitCode;
use whichone_sdk::grounding::{Grounder, Heard, message};

/// Runs the program: a service of a group, or an inspection of its records.
pub fn run() -> ExitCode {
    service::service_loop::run::<shell::GroundingProgram>()
}

/// Configuration: the scene, its readers and an optional model.
pub struct Config {
    /// The scene.
    pub scene: Scene,
    /// Reader of text with the scene's words.
    pub reader: Reader,
    /// How the model is used, if there is one.
    pub model: Option<ModelUse>,
}

/// Grounding as a reducer.
pub struct GroundingNode {
    config: Config,
    queue: Option<ModelQueue>,
}

impl Node for GroundingNode {
    type Config = Config;
    type In<'a> = In<'a>;
    type Out = Out;
    type Record = Never;

    fn recover(config: Config, _records: Vec<Never>) -> Result<Self, NodeError> {
        let queue = config.model.clone().map(ModelQueue::new);
        Ok(Self { config, queue })
    }

    fn on(&mut self, event: Event<In<'_>>, now: Time, fx: &mut Effects<Out, Never>) {
        let Self { config, queue } = self;
        match event {
            Event::Message(In::Utterance(utterance)) => match (config.read(&utterance, now), queue)
            {
                (Ok(read), Some(queue)) => queue.take(read, &config.scene, now, fx),
                (Ok(read), None) => fx.publish(Out::Observation(read.observation)),
                // Speech sends it again; a broken sender shows in its input age.
                (Err(error), _) => tracing::warn!(seq = utterance.seq, %error, "utterance refused"),
            },
            Event::Message(In::Answer(answer)) => {
                if let Some(queue) = queue {
                    queue.answer(answer, &config.scene, now, fx);
                }
            }
            Event::Tick => {
                if let Some(queue) = queue {
                    queue.expire(now, fx);
                }
            }
            Event::Shutdown => fx.exit(),
            Event::SetAside(_) | Event::Started => {}
        }
    }

    fn deadline(&self) -> Option<Time> {
        self.queue.as_ref()?.deadline()
    }

    fn pending_since(&self) -> Option<Time> {
        self.queue.as_ref()?.pending_since()
    }

    fn status(&self) -> Option<&str> {
        self.queue.as_ref()?.status()
    }

    fn checkpoint(&self) -> Option<Vec<u8>> {
        self.queue.as_ref().map_or(Some(Vec::new()), ModelQueue::checkpoint)
    }

    fn resume(config: Config, checkpoint: &[u8]) -> Result<Self, NodeError> {
        let resumed = |settings| {
            ModelQueue::resumed(settings, checkpoint).ok_or_else(NodeError::foreign_checkpoint)
        };
        let queue = config.model.clone().map(resumed).transpose()?;
        Ok(Self { config, queue })
    }
}

impl Config {
    /// Reads an utterance with the built-in reader.
    fn read(&self, utterance: &Utterance, now: Time) -> Result<Read, WireError> {
        let heard = Heard::new(utterance, &self.scene)?;
        let grounded = Rules(&self.reader).ground(&heard, &self.scene);
        let observation = Box::new(message(utterance, &heard, &self.scene, &grounded, now));
        Ok(Read { observation, heard, grounded })
    }
}
