//! User studies, run from the console.
//!
//! [`Study`] lives on the main thread: it handles the commands that begin with `study.`
//! ([`Study::command`]) and the events of the dialogue ([`Study::on_event`]), and is called in every
//! pass ([`Study::pass`]). It shows the section `study` ([`Study::section`]) and serves [`routes`]
//! below `/study/`.
//!
//! The rules are in `study_controller.rs` and `trial_monitor.rs`, which are pure. Their events are
//! written into the participant's journal and synced before they are applied and answered, so that a
//! console that is killed resumes where it was.

mod command;
mod files;
mod http;
mod planner_switch;
mod robot_state;
mod section;
mod study_controller;
#[cfg(test)]
mod tests;
mod trial_monitor;

use std::path::PathBuf;

use config::Settings;
use evaluation::user_study::{Entry, Event, Source};
use messages::{Receipt, Source as Way};
use scene::Question;
use serde_json::Value as Json;
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::{Span, Time};

use crate::hub::command::{Words, typed};
use crate::hub::ms;
use crate::hub::outbound::Answer;
use crate::view_model::{DialogueEvent, Now, ViewModel, missing};
use files::Files;
use planner_switch::PlannerSwitch;
use robot_state::RobotState;
use section::StudySection;
use study_controller::StudyController;
use trial_monitor::{DialogueLine, RobotRequest};

pub use http::routes;

/// Interval at which an unfulfilled request is repeated.
const REQUEST_EVERY: Span = Span::from_ms(2_000);
/// Interval at which an unfulfilled request to the supervisor is repeated.
const ORDER_EVERY: Span = Span::from_ms(10_000);
/// Words that cancel an open interaction.
const CANCEL: &str = "never mind";

/// The study, where one is configured.
#[derive(Debug)]
pub struct Study(Option<Running>);

#[derive(Debug)]
struct Running {
    controller: StudyController,
    files: Files,
    switch: PlannerSwitch,
    fault_ms: f64,
    /// The latest request, and when it was made.
    requested: Option<(RobotRequest, Time)>,
    /// Obstacle that keeps the study from continuing, for the experimenter.
    trouble: Option<String>,
}

/// Returns the folder of the study's data.
pub fn folder(settings: &Settings, paths: &GroupPaths) -> PathBuf {
    settings.study.data_dir.clone().unwrap_or_else(|| paths.study())
}

impl Study {
    /// Reads the settings and recovers the participants.
    ///
    /// # Errors
    /// The data cannot be read.
    pub fn new(settings: &Settings, paths: &GroupPaths) -> Result<Self, Failure> {
        if !settings.study.enabled {
            return Ok(Self(None));
        }
        let mut files = Files::in_folder(folder(settings, paths));
        let people = files.recover().map_err(|why| Failure::new(Exit::Storage, why))?;
        let policy = std::env::current_exe().map(|own| own.with_file_name("whichone-policy"));
        let switch = policy.and_then(|policy| PlannerSwitch::start(paths.control_socket(), policy));
        let switch = switch
            .map_err(|error| Failure::new(Exit::NotReached, format!("study's thread: {error}")))?;
        let protocol = settings.study.protocol.clone();
        Ok(Self(Some(Running {
            controller: StudyController::new(protocol, paths.name().to_string(), people),
            files,
            switch,
            fault_ms: 1e3 * settings.study.fault.as_secs_f64(),
            requested: None,
            trouble: None,
        })))
    }

    /// Returns whether pages may begin a study.
    pub fn is_offered(&self) -> bool {
        self.0.is_some()
    }

    /// Carries out a command of a page.
    ///
    /// # Errors
    /// Why not, in a sentence.
    pub fn command(
        &mut self,
        verb: &str,
        arguments: &Json,
        model: &ViewModel,
        now: Now,
    ) -> Result<Answer, String> {
        let help = "set study.enabled, and reload the group";
        let study = self.0.as_mut().ok_or_else(|| format!("no study is running; help: {help}"))?;
        let robot = study.robot(model, now);
        study.command(verb, arguments, &robot)
    }

    /// Takes in an event of the dialogue.
    pub fn on_event(&mut self, event: &DialogueEvent, model: &ViewModel, now: Now) {
        let Some(study) = &mut self.0 else { return };
        let said = match event {
            DialogueEvent::Heard(receipt) => heard(receipt),
            DialogueEvent::Presented { prompt, presentation, question, text, .. }
                if *question != Question::None =>
            {
                let (prompt, presentation, words) = (*prompt, *presentation, text.clone());
                Some(DialogueLine::Asked { prompt, presentation, words })
            }
            _ => None,
        };
        let robot = study.robot(model, now);
        if let Some((id, event)) = said.and_then(|said| study.controller.said(&said, &robot)) {
            study.note(&id, vec![event], now.unix_ms);
        }
    }

    /// Takes in the robot's state; returns what is to be said to the robot.
    pub fn pass(&mut self, model: &ViewModel, now: Now) -> Vec<Words> {
        let Some(study) = &mut self.0 else { return Vec::new() };
        let robot = study.robot(model, now);
        study.take_results(now.unix_ms);
        if let Some((id, event)) = study.controller.look(&robot, study.fault_ms) {
            study.note(&id, vec![event], now.unix_ms);
        }
        study.request(&robot, now)
    }

    /// Returns the section `study` as JSON text.
    pub fn section(&self, model: &ViewModel, now: Now) -> Option<String> {
        let study = self.0.as_ref()?;
        let robot = study.robot(model, now);
        let section = StudySection::new(&study.controller, &robot, study.trouble.as_deref());
        serde_json::to_string(&section).ok()
    }
}

impl Running {
    fn robot<'a>(&self, model: &'a ViewModel, now: Now) -> RobotState<'a> {
        RobotState {
            at: now.unix_ms,
            ms: ms(now.at),
            scene: model.scene(),
            view: model.latest().view.as_ref(),
            missing: model.group().and_then(missing).map(|service| service.name.as_str()),
            arm_is_busy: robot_state::arm_is_busy(model.latest().arm.as_ref()),
            is_switching: self.switch.is_busy() || self.controller.owing().is_some(),
        }
    }

    fn command(
        &mut self,
        verb: &str,
        arguments: &Json,
        robot: &RobotState<'_>,
    ) -> Result<Answer, String> {
        let page = command::page(arguments)?;
        if verb == "find" {
            let found = self.controller.of_page(&page);
            return Ok(Answer::Found {
                participant: found.map(|person| person.id().to_owned()),
                stage: found.map(|person| person.stage.name()),
            });
        }
        let command = command::read(verb, arguments)?;
        let (id, events) = self.controller.handle(&page, &command, robot, command::seed())?;
        self.write(&id, events, robot.at).map_err(|error| {
            tracing::error!(participant = id, %error, "the study's data is not written");
            format!("The data cannot be written: {error}. Please tell the experimenter.")
        })?;
        Ok(Answer::Participant { participant: id })
    }

    /// Writes events to the journal and applies them once they are on the disk.
    fn write(&mut self, id: &str, events: Vec<Event>, at: u64) -> std::io::Result<()> {
        if events.is_empty() {
            return Ok(());
        }
        let entries: Vec<Entry> = events.into_iter().map(|event| Entry { at, event }).collect();
        match (&entries[..], self.controller.people().iter().find(|person| person.id() == id)) {
            ([deleted @ Entry { event: Event::Deleted, .. }], Some(person)) => {
                self.files.replace(id, &study_controller::kept(person, deleted))?;
            }
            _ => self.files.append(id, &entries)?,
        }
        self.trouble = None;
        entries.iter().for_each(|entry| self.controller.apply(id, entry));
        Ok(())
    }

    /// As [`Running::write`], where no page waits for an answer: the next pass repeats it.
    fn note(&mut self, id: &str, events: Vec<Event>, at: u64) {
        if let Err(error) = self.write(id, events, at) {
            tracing::error!(participant = id, %error, "the study's data is not written");
            self.trouble = Some(format!("the data cannot be written: {error}"));
        }
    }

    fn take_results(&mut self, at: u64) {
        match self.switch.result() {
            Some((RobotRequest::Restore(id), Ok(()))) => self.note(&id, vec![Event::Restored], at),
            Some((request, Err(why))) => {
                tracing::warn!(?request, why, "the policy is not switched");
                self.trouble = Some(format!("the policy cannot be switched: {why}"));
            }
            Some((_, Ok(()))) | None => {}
        }
    }

    fn request(&mut self, robot: &RobotState<'_>, now: Now) -> Vec<Words> {
        let Some(request) = self.controller.request(robot) else {
            self.requested = None;
            return Vec::new();
        };
        let every = if request == RobotRequest::Cancel { REQUEST_EVERY } else { ORDER_EVERY };
        let is_due = match &self.requested {
            Some((before, at)) => *before != request || now.at >= *at + every,
            None => true,
        };
        if !is_due || self.switch.is_busy() {
            return Vec::new();
        }
        self.requested = Some((request.clone(), now.at));
        match &request {
            RobotRequest::Cancel => return vec![typed(CANCEL)],
            RobotRequest::Switch(planner) => {
                // Before it is done, so that it is given back whatever happens in between.
                let event = Event::Switched { planner: planner.clone() };
                let active = self.controller.active().map(|person| person.id().to_owned());
                active.into_iter().for_each(|id| self.note(&id, vec![event.clone()], now.unix_ms));
            }
            RobotRequest::Restore(_) => {}
        }
        self.switch.order(request);
        Vec::new()
    }
}

fn heard(receipt: &Receipt) -> Option<DialogueLine> {
    let is_typed = receipt.source == Way::Text;
    (receipt.seq > 0).then(|| DialogueLine::Heard {
        seq: receipt.seq,
        source: if is_typed { Source::Typed } else { Source::Voice },
        onset_ms: ms(Time(receipt.onset_ns)),
        words: receipt.note.as_str().unwrap_or_default().to_owned(),
    })
}
