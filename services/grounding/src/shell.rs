//! Grounding's topics and configuration.

use crate::io::{In, Out};
use crate::model_worker::ModelWorker;
use crate::{Config, GroundingNode, ModelUse};
use config::Settings;
use language::Reader as TextReader;
use messages::Service;
use messages::{Observation, Utterance, topics};
use model_reader::{Client, Configured, LanguageModel};
use service::Span;
use service::bus::{PortError, Reader, Writer};
use service::exit::{Exit, Failure};
use service::lifecycle::Environment;
use service::service_loop::{Context, Program, Shell};
use service::worker_channel::DeviceSender;
use vocabulary::Language;

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
        let model = model(language, settings)?.map(|model| ModelUse {
            name: model.name,
            timeout: Span::from_s(model.timeout.as_secs_f64()),
            calibration: model.calibration,
        });
        Ok(Config { scene: settings.scene.clone(), reader, model })
    }
}

/// The model to use: `None` for the paper's reading, which is that of its word lists.
fn model(language: Language, settings: &Settings) -> Result<Option<LanguageModel>, Failure> {
    let Configured(model) = settings.part()?;
    Ok(model.filter(|_| language == Language::Careful))
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

/// Topics of grounding, and the connection to the model.
#[derive(Debug)]
pub struct GroundingShell {
    utterances: Reader<Utterance>,
    observations: Writer<Observation>,
    model: Option<ModelWorker>,
    inbox: DeviceSender<In<'static>>,
    /// Answers in place of the model that did not fit into the inbox.
    replies: Vec<In<'static>>,
}

impl Shell<GroundingNode> for GroundingShell {
    fn open(context: &Context<'_, In<'static>>) -> Result<Self, Failure> {
        let (settings, inbox) = (context.settings, context.devices.clone());
        let language = language(&context.environment.arguments, settings.dialogue.language)?;
        let model = model(language, settings)?.map(|model| {
            let client = Client::new(&model, &settings.scene)
                .map_err(|error| Failure::new(Exit::Config, error.to_string()))?;
            ModelWorker::start(client, inbox.clone())
                .map_err(|error| Failure::new(Exit::NotReached, format!("thread: {error}")))
        });
        Ok(Self {
            utterances: context.bus.reader(&topics::UTTERANCE)?,
            observations: context.bus.writer(&topics::OBSERVATION)?,
            model: model.transpose()?,
            inbox,
            replies: Vec::new(),
        })
    }

    fn drain(&mut self, take: &mut dyn FnMut(In<'_>)) -> Result<(), PortError> {
        self.replies.drain(..).for_each(&mut *take);
        self.utterances.drain(|utterance| take(In::Utterance(utterance.into())))
    }

    fn publish(&mut self, output: Out) -> Result<(), PortError> {
        match output {
            Out::Observation(observation) => return self.observations.send(&observation),
            Out::Ask(request) => {
                let submitted = self.model.as_ref().map(|model| model.submit(request));
                if let Some(Err(answer)) = submitted {
                    // Without waiting: the main loop must not wait for itself.
                    self.replies.extend(self.inbox.offer(In::Answer(answer)).err());
                }
            }
        }
        Ok(())
    }
}
