//! User studies on the console's page: an optional [`Part`] of it, with commands that begin with `study.`, the section
//! `study`, and files below `/study/`.
//!
//! The rules are in `study_controller.rs` and `trial_monitor.rs`, which are pure. Their events are
//! written into the participant's journal and synced before they are applied and answered, so that a
//! console that is killed resumes where it was.

#![allow(
    unreachable_pub,
    missing_docs,
    reason = "its interface in Rust is that of `page_part`; the console's fuzz target reads commands"
)]

mod command;
mod files;
mod http;
mod lines;
mod planner_switch;
mod section;
mod study_controller;
#[cfg(test)]
mod tests;
mod trial_monitor;

pub use command::read as read_command;

use std::path::PathBuf;

use config::Settings;
use page_part::{DialogueEvent, Fields, Now, Part, Robot};
use serde_json::{Value as Json, json};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::view::ms;
use service::{Span, Time};
use user_study::{Entry, Event};

use files::Files;
use planner_switch::PlannerSwitch;
use section::StudySection;
use study_controller::StudyController;
use trial_monitor::{RobotRequest, RobotState};

/// Interval at which an unfulfilled request is repeated.
const REQUEST_EVERY: Span = Span::from_ms(2_000);
/// Interval at which an unfulfilled request to the supervisor is repeated.
const ORDER_EVERY: Span = Span::from_ms(10_000);
/// Words that cancel an open interaction.
const CANCEL: &str = "never mind";

/// A study that is offered to pages.
#[derive(Debug)]
struct Study {
    controller: StudyController,
    files: Files,
    switch: PlannerSwitch,
    fault_ms: f64,
    /// The latest request, and when it was made.
    requested: Option<(RobotRequest, Time)>,
    /// Obstacle that keeps the study from continuing, for the experimenter.
    trouble: Option<String>,
}

/// Opens the study of the settings and recovers its participants; none where no study is configured.
///
/// # Errors
/// The data of a participant cannot be read, or there is no thread for the study.
pub fn open(settings: &Settings, paths: &GroupPaths) -> Result<Option<Box<dyn Part>>, Failure> {
    let study = settings.part::<user_study::Study>()?;
    if !study.enabled {
        return Ok(None);
    }
    let folder = folder(&study, paths);
    let people = files::read(&folder).map_err(|why| Failure::new(Exit::Storage, why))?;
    let policy = std::env::current_exe().map(|own| own.with_file_name("whichone-policy"));
    let switch = policy.and_then(|policy| PlannerSwitch::start(paths.control_socket(), policy));
    let switch = switch
        .map_err(|error| Failure::new(Exit::NotReached, format!("study's thread: {error}")))?;
    let protocol = study.protocol_with(&settings.dialogue.planner);
    Ok(Some(Box::new(Study {
        controller: StudyController::new(protocol, paths.name().to_string(), people),
        files: Files::in_folder(folder),
        switch,
        fault_ms: 1e3 * study.fault.as_secs_f64(),
        requested: None,
        trouble: None,
    })))
}

/// Returns the files of all studies that were conducted with these settings.
///
/// # Errors
/// The section of studies is invalid.
pub fn files(
    settings: &Settings,
    paths: &GroupPaths,
) -> Result<Box<dyn page_part::Files>, Failure> {
    let study = settings.part::<user_study::Study>()?;
    Ok(Box::new(http::Results(folder(&study, paths))))
}

fn folder(study: &user_study::Study, paths: &GroupPaths) -> PathBuf {
    study.data_dir.clone().unwrap_or_else(|| paths.study())
}

impl Part for Study {
    fn command(
        &mut self,
        verb: &str,
        arguments: &Json,
        robot: &Robot<'_>,
    ) -> Result<Fields, String> {
        let page = command::page(arguments)?;
        if verb == "find" {
            let found = self.controller.of_page(&page);
            let id = found.map(|person| person.id());
            let stage = found.map(|person| person.stage.name());
            return Ok(Fields::from_iter([
                ("participant".into(), json!(id)),
                ("stage".into(), json!(stage)),
            ]));
        }
        let command = command::read(verb, arguments)?;
        let (state, at) = (self.state(robot), robot.now.unix_ms);
        let (id, events) = self.controller.handle(&page, &command, &state, command::seed())?;
        self.write(&id, events, at).map_err(|error| {
            tracing::error!(participant = id, %error, "the study's data is not written");
            format!("The data cannot be written: {error}. Please tell the experimenter.")
        })?;
        Ok(Fields::from_iter([("participant".into(), json!(id))]))
    }

    fn on_event(&mut self, event: &DialogueEvent, robot: &Robot<'_>) {
        if let Some((id, event)) = self.controller.said(event, &self.state(robot)) {
            self.note(&id, vec![event], robot.now.unix_ms);
        }
    }

    fn pass(&mut self, robot: &Robot<'_>) -> Option<String> {
        let (state, at) = (self.state(robot), robot.now.unix_ms);
        self.take_results(at);
        if let Some((id, event)) = self.controller.look(&state, self.fault_ms) {
            self.note(&id, vec![event], at);
        }
        self.request(&state, robot.now)
    }

    fn section(&self, robot: &Robot<'_>) -> Option<String> {
        let state = self.state(robot);
        let section = StudySection::new(&self.controller, &state, self.trouble.as_deref());
        serde_json::to_string(&section).ok()
    }
}

impl Study {
    fn state<'a>(&self, robot: &Robot<'a>) -> RobotState<'a> {
        RobotState {
            at: robot.now.unix_ms,
            ms: ms(robot.now.at),
            scene: robot.scene,
            view: robot.view,
            missing: robot.missing,
            arm_is_busy: trial_monitor::arm_is_busy(robot.arm),
            arm_is_stopped: robot.arm.is_some_and(|arm| arm.stopped != 0),
            is_switching: self.switch.is_busy() || self.controller.owing().is_some(),
        }
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

    fn request(&mut self, robot: &RobotState<'_>, now: Now) -> Option<String> {
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
            RobotRequest::Cancel => return Some(CANCEL.to_owned()),
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
