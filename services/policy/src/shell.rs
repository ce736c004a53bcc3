//! The policy's topics and configuration.

use crate::mind::{Assumptions, Mind};
use crate::{In, Out, PolicyNode, kept, turns};
use dialogue::Confusion;
use protocol::{
    Activity, AppliedMark, ArmStatus, Observation, PolicyView, Presented, RobotAct, Service, topics,
};
use runtime::bus::{EncodedWriter, PortError, Reader, Writer};
use runtime::driver::{Context, Program, Shell};
use runtime::exit::{Exit, Failure};
use runtime::lifecycle::Environment;
use scene::{Fnv1a, Scene};
use settings::{Section, Settings};

/// The policy as a program.
#[derive(Debug)]
pub struct PolicyProgram;

impl Program for PolicyProgram {
    const SERVICE: Service = Service::Policy;
    const RECORD: Option<&'static str> = Some("policy/3");
    const ABOUT: &'static str = "keeps the belief over the objects and decides what to ask or do";
    type Node = PolicyNode;
    type Shell = PolicyShell;

    fn config(environment: &Environment, settings: &Settings) -> Result<Mind, Failure> {
        let mut mind = mind(settings)?;
        kept::work_ahead(&mut mind, &environment.paths.policies());
        Ok(mind)
    }
}

/// The mind that the settings describe.
///
/// # Errors
/// A planner that does not exist.
pub fn mind(settings: &Settings) -> Result<Mind, Failure> {
    let dialogue = &settings.dialogue;
    let planner = dialogue::registry::planner(&dialogue.planner)
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
    let (scene, turns) = (settings.scene.clone(), turns(settings));
    Ok(Mind::new(scene, assumptions, planner, turns, key(settings)))
}

/// Which of the scene's words are misheard for one another.
fn confusion(scene: &Scene) -> Result<Confusion, Failure> {
    Confusion::from_rows(language::confusion(scene))
        .map_err(|e| Failure::new(Exit::Invariant, format!("words by sound: {e}")))
}

/// Identity of all that the mind decides by.
fn key(settings: &Settings) -> u64 {
    let mut hash = Fnv1a::new();
    hash.text(&settings.section_text(Section::Dialogue));
    hash.text(settings.scene_text());
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
