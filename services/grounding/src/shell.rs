//! Grounding's topics and configuration.

use crate::{Config, GroundingNode};
use config::Settings;
use language::{Language, Reader as TextReader};
use messages::Service;
use messages::{MessageRef, Observation, Utterance, topics};
use service::bus::{PortError, Reader, Writer};
use service::exit::{Exit, Failure};
use service::lifecycle::Environment;
use service::service_loop::{Context, Program, Shell};

/// Grounding as a program. `--language paper|careful` overrides the setting, so that a group can
/// be swapped from one reading to the other while it runs.
#[derive(Debug)]
pub struct GroundingProgram;

impl Program for GroundingProgram {
    const SERVICE: Service = Service::Grounding;
    const RECORD: Option<&'static str> = None;
    const ABOUT: &'static str = "reads what was said with the scene's words [--language \
                                 careful|paper]";
    type Node = GroundingNode;
    type Shell = GroundingShell;

    fn config(environment: &Environment, settings: &Settings) -> Result<Config, Failure> {
        let language = language(&environment.arguments, settings.dialogue.language)?;
        let reader = TextReader::new(&settings.scene, language);
        Ok(Config { scene: settings.scene.clone(), reader })
    }
}

fn language(arguments: &[String], configured: Language) -> Result<Language, Failure> {
    match arguments {
        [] => Ok(configured),
        [flag, name] if flag == "--language" && name == "paper" => Ok(Language::Paper),
        [flag, name] if flag == "--language" && name == "careful" => Ok(Language::Careful),
        other => {
            let what = format!("{other:?}: only --language careful or --language paper is known");
            Err(Failure::new(Exit::Usage, what))
        }
    }
}

/// Grounding's topics.
#[derive(Debug)]
pub struct GroundingShell {
    utterances: Reader<Utterance>,
    observations: Writer<Observation>,
}

impl Shell<GroundingNode> for GroundingShell {
    fn open(context: &Context<'_, MessageRef<'static, Utterance>>) -> Result<Self, Failure> {
        Ok(Self {
            utterances: context.bus.reader(&topics::UTTERANCE)?,
            observations: context.bus.writer(&topics::OBSERVATION)?,
        })
    }

    fn drain(&mut self, take: &mut dyn FnMut(MessageRef<'_, Utterance>)) -> Result<(), PortError> {
        self.utterances.drain(|utterance| take(utterance.into()))
    }

    fn publish(&mut self, observation: Box<Observation>) -> Result<(), PortError> {
        self.observations.send(&observation)
    }
}
