//! The policy's topics and configuration.

use crate::{Config, In, Out, PolicyNode, inspection, journal_record, policy_cache};
use config::Settings;
use dialogue::manager::Record;
use messages::Service;
use messages::{
    Activity, AppliedMark, ArmStatus, Forget, Observation, PolicyView, Presented, RobotAct,
    Sighting, TableView, WorldView, topics,
};
use service::Time;
use service::bus::{Bus, BusError, EncodedReader, EncodedWriter, PortError, Reader, Writer};
use service::exit::{Exit, Failure};
use service::flight::Decision;
use service::inspection::{Part, SharedFacts};
use service::journal_record::JournalRecord;
use service::lifecycle::Environment;
use service::service_loop::{Context, Program, Shell};
use setup::{DialogueSettings, ManagerError};

/// The policy as a program. `--planner NAME` overrides the setting, so that a group can be swapped
/// from one planner to another while it runs; `--planner-program PROGRAM…` has a program decide.
#[derive(Debug)]
pub struct PolicyProgram;

impl Program for PolicyProgram {
    const SERVICE: Service = Service::Policy;
    const RECORD: Option<&'static str> = Some("policy/12");
    const OLDER_RECORDS: &'static [&'static str] = &["policy/10"];
    const ABOUT: &'static str = "maintains the belief over the objects and decides what to ask or do \
                                 [--planner NAME | --planner-program PROGRAM [ARGUMENT...]]";
    type Node = PolicyNode;
    type Shell = PolicyShell;

    fn config(environment: &Environment, settings: &Settings) -> Result<Config, Failure> {
        let manager = match planner(&environment.arguments)? {
            Some(planner) => settings.manager_with(planner),
            None => settings.manager(),
        };
        let mut manager = manager.map_err(|error| {
            let exit = match error {
                ManagerError::Planner(_) => Exit::Config,
                ManagerError::Confusion(_) => Exit::Invariant,
            };
            Failure::new(exit, error.to_string())
        })?;
        policy_cache::precompute(&mut manager, &environment.paths.policies());
        let perception = &settings.group.perception;
        let tracker = perception.enabled.then(|| perception.tracker.clone());
        Ok(Config { tracker, ..Config::from(manager) })
    }

    fn prepare(arguments: &[String]) -> Result<(), Failure> {
        planner(arguments).map(|_| ())
    }

    fn recorded_at(record: &Record) -> Time {
        record.at
    }

    fn describe(settings: &[Settings], record: &Record) -> String {
        let scene = journal_record::scene(settings, record);
        inspection::line(scene.as_deref(), record)
    }

    fn explain(settings: &[Settings], record: &Record) -> Option<JournalRecord> {
        let scene = journal_record::scene(settings, record);
        let record = journal_record::explain(scene.as_deref(), record);
        Some(JournalRecord::Policy(Box::new(record)))
    }

    fn decision(settings: &Settings, record: &Record) -> Option<Decision> {
        let scene = journal_record::scene(std::slice::from_ref(settings), record);
        Some(inspection::decision(scene.as_deref(), record))
    }

    fn verify(settings: &[Settings], parts: &[Part<Record>]) -> Result<Vec<String>, Failure> {
        inspection::verify(settings, parts)
    }

    fn shared_facts(parts: &[Part<Record>]) -> SharedFacts {
        inspection::shared_facts(parts)
    }
}

/// Returns the planner that the arguments name, if any.
fn planner(arguments: &[String]) -> Result<Option<&str>, Failure> {
    match arguments {
        [] => Ok(None),
        [flag, name] if flag == "--planner" => match dialogue::registry::planner(name) {
            Ok(_) => Ok(Some(name)),
            Err(error) => Err(Failure::new(Exit::Usage, format!("--planner: {error}"))),
        },
        [flag, command @ ..] if flag == "--planner-program" => {
            planner_program::register(command)?;
            Ok(Some(planner_program::NAME))
        }
        other => {
            let expected = "expected --planner NAME or --planner-program PROGRAM [ARGUMENT...]";
            let what = format!("invalid arguments {other:?}: {expected}");
            Err(Failure::new(Exit::Usage, what))
        }
    }
}

/// The policy's topics.
#[derive(Debug)]
pub struct PolicyShell {
    observations: Reader<Observation>,
    presented: Reader<Presented>,
    activity: Reader<Activity>,
    arm: Reader<ArmStatus>,
    forget: Reader<Forget>,
    mark: Writer<AppliedMark>,
    act: Writer<RobotAct>,
    view: EncodedWriter<PolicyView>,
    /// Topics of the table, if the objects come from perception.
    table: Option<TableTopics>,
}

#[derive(Debug)]
struct TableTopics {
    sightings: EncodedReader<Sighting>,
    world: EncodedReader<WorldView>,
    objects: EncodedWriter<TableView>,
}

impl TableTopics {
    fn open(bus: &Bus) -> Result<Self, BusError> {
        Ok(Self {
            sightings: bus.encoded_reader(&topics::SIGHTING)?,
            world: bus.encoded_reader(&topics::WORLD)?,
            objects: bus.encoded_writer(&topics::OBJECTS)?,
        })
    }
}

impl Shell<PolicyNode> for PolicyShell {
    fn open(context: &Context<'_, In<'static>>) -> Result<Self, Failure> {
        let bus = context.bus;
        let table = context.settings.group.perception.enabled.then(|| TableTopics::open(bus));
        Ok(Self {
            observations: bus.reader(&topics::OBSERVATION)?,
            presented: bus.reader(&topics::PRESENTED)?,
            activity: bus.reader(&topics::ACTIVITY)?,
            arm: bus.reader(&topics::STATUS)?,
            forget: bus.reader(&topics::FORGET)?,
            mark: bus.writer(&topics::MARK)?,
            act: bus.writer(&topics::ACT)?,
            view: bus.encoded_writer(&topics::VIEW)?,
            table: table.transpose()?,
        })
    }

    fn drain(&mut self, take: &mut dyn FnMut(In<'_>)) -> Result<(), PortError> {
        self.presented.drain(|message| take(In::Presented(*message)))?;
        self.activity.drain(|message| take(In::Activity(*message)))?;
        self.observations.drain(|message| take(In::Observation(message.into())))?;
        self.arm.drain(|message| take(In::Arm(*message)))?;
        self.forget.drain(|order| take(In::Forget(*order)))?;
        let Some(table) = &mut self.table else { return Ok(()) };
        if let Some(world) = table.world.latest()? {
            take(In::World(Box::new(world)));
        }
        table.sightings.drain_in_turn(|sighting| take(In::Sighting(Box::new(sighting))))
    }

    fn publish(&mut self, output: Out) -> Result<(), PortError> {
        match output {
            Out::Mark(mark) => self.mark.send(&mark),
            Out::Act(act) => self.act.send(&act),
            Out::View(view) => self.view.send(&view),
            Out::Objects(view) => self.table.as_ref().map_or(Ok(()), |it| it.objects.send(&view)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arguments(words: &[&str]) -> Vec<String> {
        words.iter().map(|word| (*word).to_owned()).collect()
    }

    #[test]
    fn policy_arguments_name_the_planner() {
        assert_eq!(planner(&[]).unwrap(), None);
        assert_eq!(planner(&arguments(&["--planner", "entropy"])).unwrap(), Some("entropy"));
        for wrong in [
            &["--planner"][..],
            &["--planner", "greedy"],
            &["--language", "paper"],
            &["--planner-program"],
        ] {
            let failure = planner(&arguments(wrong)).unwrap_err();
            assert_eq!(failure.exit, Exit::Usage, "{wrong:?}");
            assert!(failure.to_string().contains("planner"), "{failure}");
        }
    }
}
