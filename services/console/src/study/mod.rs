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
mod section;
mod study_controller;
#[cfg(test)]
mod tests;
mod trial_monitor;

pub use command::read as read_command;

use std::path::PathBuf;

use config::Settings;
use evaluation::user_study::{Entry, Event};
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
use section::StudySection;
use study_controller::StudyController;
use trial_monitor::{RobotRequest, RobotState};

pub use http::routes;

/// Interval at which an unfulfilled request is repeated.
const REQUEST_EVERY: Span = Span::from_ms(2_000);
/// Interval at which an unfulfilled request to the supervisor is repeated.
const ORDER_EVERY: Span = Span::from_ms(10_000);
/// Words that cancel an open interaction.
const CANCEL: &str = "never mind";

/// A study that is offered to pages.
#[derive(Debug)]
pub struct Study {
    controller: StudyController,
    files: Files,
    switch: PlannerSwitch,
    fault_ms: f64,
    /// The latest request, and when it was made.
    requested: Option<(RobotRequest, Time)>,
    /// Obstacle that keeps the study from continuing, for the experimenter.
    trouble: Option<String>,
}

pub fn folder(settings: &Settings, paths: &GroupPaths) -> PathBuf {
    settings.study.data_dir.clone().unwrap_or_else(|| paths.study())
}

impl Study {
    /// Reads the settings and recovers the participants; none where no study is configured.
    pub fn new(settings: &Settings, paths: &GroupPaths) -> Result<Option<Self>, Failure> {
        if !settings.study.enabled {
            return Ok(None);
        }
        let folder = folder(settings, paths);
        let people = files::read(&folder).map_err(|why| Failure::new(Exit::Storage, why))?;
        let policy = std::env::current_exe().map(|own| own.with_file_name("whichone-policy"));
        let switch = policy.and_then(|policy| PlannerSwitch::start(paths.control_socket(), policy));
        let switch = switch
            .map_err(|error| Failure::new(Exit::NotReached, format!("study's thread: {error}")))?;
        let protocol = settings.study.protocol.clone();
        Ok(Some(Self {
            controller: StudyController::new(protocol, paths.name().to_string(), people),
            files: Files::in_folder(folder),
            switch,
            fault_ms: 1e3 * settings.study.fault.as_secs_f64(),
            requested: None,
            trouble: None,
        }))
    }

    pub fn on_event(&mut self, event: &DialogueEvent, model: &ViewModel, now: Now) {
        if let Some((id, event)) = self.controller.said(event, &self.robot(model, now)) {
            self.note(&id, vec![event], now.unix_ms);
        }
    }

    /// Takes in the robot's state; returns what is to be said to the robot.
    pub fn pass(&mut self, model: &ViewModel, now: Now) -> Option<Words> {
        let robot = self.robot(model, now);
        self.take_results(now.unix_ms);
        if let Some((id, event)) = self.controller.look(&robot, self.fault_ms) {
            self.note(&id, vec![event], now.unix_ms);
        }
        self.request(&robot, now)
    }

    pub fn section(&self, model: &ViewModel, now: Now) -> Option<String> {
        let robot = self.robot(model, now);
        let section = StudySection::new(&self.controller, &robot, self.trouble.as_deref());
        serde_json::to_string(&section).ok()
    }

    fn robot<'a>(&self, model: &'a ViewModel, now: Now) -> RobotState<'a> {
        RobotState {
            at: now.unix_ms,
            ms: ms(now.at),
            scene: model.scene(),
            view: model.latest().view.as_ref(),
            missing: model.group().and_then(missing).map(|service| service.name.as_str()),
            arm_is_busy: trial_monitor::arm_is_busy(model.latest().arm.as_ref()),
            arm_is_stopped: model.latest().arm.is_some_and(|arm| arm.stopped != 0),
            is_switching: self.switch.is_busy() || self.controller.owing().is_some(),
        }
    }

    pub fn command(
        &mut self,
        verb: &str,
        arguments: &Json,
        model: &ViewModel,
        now: Now,
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
        let robot = self.robot(model, now);
        let (id, events) = self.controller.handle(&page, &command, &robot, command::seed())?;
        self.write(&id, events, now.unix_ms).map_err(|error| {
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

    /// As [`Study::write`], where no page waits for an answer: the next pass repeats it.
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

    fn request(&mut self, robot: &RobotState<'_>, now: Now) -> Option<Words> {
        let Some(request) = self.controller.request(robot) else {
            self.requested = None;
            return None;
        };
        let every = if request == RobotRequest::Cancel { REQUEST_EVERY } else { ORDER_EVERY };
        let is_due = (self.requested.as_ref())
            .is_none_or(|(before, at)| *before != request || now.at >= *at + every);
        if !is_due || self.switch.is_busy() {
            return None;
        }
        self.requested = Some((request.clone(), now.at));
        match &request {
            RobotRequest::Cancel => return Some(typed(CANCEL)),
            RobotRequest::Switch(planner) => {
                // Before it is done, so that it is given back whatever happens in between.
                let event = Event::Switched { planner: planner.clone() };
                let active = self.controller.active().map(|person| person.id().to_owned());
                active.into_iter().for_each(|id| self.note(&id, vec![event.clone()], now.unix_ms));
            }
            RobotRequest::Restore(_) => {}
        }
        self.switch.order(request);
        None
    }
}
