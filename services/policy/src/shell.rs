//! The policy's topics and configuration.

use crate::mind::{Assumptions, Mind};
use crate::state::Record;
use crate::{In, Out, PolicyNode, inspection, kept};
use config::{Section, Settings};
use dialogue::Confusion;
use messages::{
    Activity, AppliedMark, ArmStatus, Observation, PolicyView, Presented, RobotAct, Service, topics,
};
use scene::{Fnv1a, Scene};
use service::bus::{EncodedWriter, PortError, Reader, Writer};
use service::exit::{Exit, Failure};
use service::inspection::Part;
use service::lifecycle::Environment;
use service::service_loop::{Context, Program, Shell};

/// The policy as a program. `--planner NAME` overrides the setting, so that a group can be swapped
/// from one planner to another while it runs.
#[derive(Debug)]
pub struct PolicyProgram;

impl Program for PolicyProgram {
    const SERVICE: Service = Service::Policy;
    const RECORD: Option<&'static str> = Some("policy/4");
    const ABOUT: &'static str = "keeps the belief over the objects and decides what to ask or do \
                                 [--planner NAME]";
    type Node = PolicyNode;
    type Shell = PolicyShell;

    fn config(environment: &Environment, settings: &Settings) -> Result<Mind, Failure> {
        let mut mind = match planner(&environment.arguments)? {
            Some(planner) => mind_with(settings, planner)?,
            None => mind(settings)?,
        };
        kept::work_ahead(&mut mind, &environment.paths.policies());
        Ok(mind)
    }

    fn describe(record: &Record) -> String {
        inspection::line(record)
    }

    fn verify(settings: Settings, parts: &[Part<Record>]) -> Result<Vec<String>, Failure> {
        inspection::verify(&settings, parts)
    }
}

/// The planner that the arguments name, if they do.
fn planner(arguments: &[String]) -> Result<Option<&str>, Failure> {
    match arguments {
        [] => Ok(None),
        [flag, name] if flag == "--planner" => match dialogue::registry::planner(name) {
            Ok(_) => Ok(Some(name)),
            Err(error) => Err(Failure::new(Exit::Usage, format!("--planner: {error}"))),
        },
        other => {
            let what = format!("{other:?}: only --planner NAME is known");
            Err(Failure::new(Exit::Usage, what))
        }
    }
}

/// The mind that the settings describe.
///
/// # Errors
/// A planner that does not exist.
pub fn mind(settings: &Settings) -> Result<Mind, Failure> {
    mind_with(settings, &settings.dialogue.planner)
}

/// The mind that made the decisions under the key of `settings_key`: that of the settings, or the
/// same with another planner, which may have been swapped in. That of the settings where the key is
/// of neither.
///
/// # Errors
/// A planner that does not exist.
pub fn mind_of_key(settings: &Settings, settings_key: u64) -> Result<Mind, Failure> {
    let mut known = dialogue::registry::names().into_iter();
    let planner = known.find(|planner| key(settings, planner) == settings_key);
    mind_with(settings, planner.unwrap_or(&settings.dialogue.planner))
}

/// The mind that the settings describe, with that planner in place of theirs.
fn mind_with(settings: &Settings, planner: &str) -> Result<Mind, Failure> {
    let dialogue = &settings.dialogue;
    let key = key(settings, planner);
    let planner = dialogue::registry::planner(planner)
        .map_err(|e| Failure::new(Exit::Config, format!("dialogue.planner: {e}")))?;
    let gesture = dialogue.gesture;
    let assumptions = Assumptions {
        params: dialogue.params,
        confusion: confusion(&settings.scene)?,
        costs: dialogue.costs,
        durations: settings.durations.clone(),
        actions: dialogue.actions,
        prior: dialogue.prior,
        gestures: gesture.enabled.then_some((gesture.model, gesture.person_xyz_m)),
    };
    let (scene, turns) = (settings.scene.clone(), dialogue.turns);
    Ok(Mind::new(scene, assumptions, planner, turns, key))
}

/// Which of the scene's words are misheard for one another.
fn confusion(scene: &Scene) -> Result<Confusion, Failure> {
    Confusion::from_rows(language::confusion(scene))
        .map_err(|e| Failure::new(Exit::Invariant, format!("words by sound: {e}")))
}

/// Identity of all that the mind decides by: the settings, with that planner.
pub(crate) fn key(settings: &Settings, planner: &str) -> u64 {
    let mut hash = Fnv1a::new();
    if planner != settings.dialogue.planner {
        hash.text(planner);
    }
    hash.text(&settings.section_text(Section::Dialogue));
    hash.text(&settings.scene_file().text);
    if settings.durations.is_some() {
        hash.text(&settings.durations_text());
    }
    hash.value()
}

/// The policy's topics.
#[derive(Debug)]
pub struct PolicyShell {
    observations: Reader<Observation>,
    presented: Reader<Presented>,
    activity: Reader<Activity>,
    arm: Reader<ArmStatus>,
    mark: Writer<AppliedMark>,
    act: Writer<RobotAct>,
    view: EncodedWriter<PolicyView>,
}

impl Shell<PolicyNode> for PolicyShell {
    fn open(context: &Context<'_, In>) -> Result<Self, Failure> {
        let bus = context.bus;
        Ok(Self {
            observations: bus.reader(&topics::OBSERVATION)?,
            presented: bus.reader(&topics::PRESENTED)?,
            activity: bus.reader(&topics::ACTIVITY)?,
            arm: bus.reader(&topics::STATUS)?,
            mark: bus.writer(&topics::MARK)?,
            act: bus.writer(&topics::ACT)?,
            view: bus.encoded_writer(&topics::VIEW)?,
        })
    }

    fn drain(&mut self, take: &mut dyn FnMut(In)) -> Result<(), PortError> {
        self.presented.drain(|message| take(In::Presented(*message)))?;
        self.activity.drain(|message| take(In::Activity(*message)))?;
        self.observations.drain(|message| take(In::Observation(Box::new(*message))))?;
        self.arm.drain(|message| take(In::Arm(*message)))
    }

    fn publish(&mut self, output: Out) -> Result<(), PortError> {
        match output {
            Out::Mark(mark) => self.mark.send(&mark),
            Out::Act(act) => self.act.send(&act),
            Out::View(view) => self.view.send(&view),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(words: &[&str]) -> Vec<String> {
        words.iter().map(|word| (*word).to_owned()).collect()
    }

    #[test]
    fn the_planner_may_be_named_on_the_command_line() {
        assert_eq!(planner(&[]).unwrap(), None);
        assert_eq!(planner(&words(&["--planner", "entropy"])).unwrap(), Some("entropy"));
        for wrong in [&["--planner"][..], &["--planner", "greedy"], &["--language", "paper"]] {
            let failure = planner(&words(wrong)).unwrap_err();
            assert_eq!(failure.exit, Exit::Usage, "{wrong:?}");
            assert!(failure.to_string().contains("planner"), "{failure}");
        }
    }
}
