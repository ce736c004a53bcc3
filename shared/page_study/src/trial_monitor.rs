//! Progress of the running interaction and the study's requests to the robot, derived from what it
//! observes. Pure.

use messages::{ActKind, ArmStatus, Ended, PickPhase, PolicyView, Source as Way};
use page_part::DialogueEvent;
use scene::Scene;
use serde::Serialize;
use service::Time;
use service::view::ms;
use user_study::Verdict;
use user_study::{Asked, Ending, Event, Fault, Heard, Participant, Source, Stage, Trial};

use super::study_controller::StudyController;

/// Utterances and questions of an interaction that are written down.
const LINES_MAX: usize = 500;

/// The study's requests to the robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum RobotRequest {
    /// Cancel the current goal.
    Cancel,
    /// The policy is to decide by that planner.
    Switch(String),
    /// The policy is to be given its configured planner back, after that participant.
    Restore(String),
}

/// The robot at one moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct RobotState<'a> {
    /// Milliseconds since 1970.
    pub(super) at: u64,
    /// Milliseconds of the monotonic clock.
    pub(super) ms: f64,
    pub(super) scene: &'a Scene,
    pub(super) view: Option<&'a PolicyView>,
    /// A required service that is not ready.
    pub(super) missing: Option<&'a str>,
    pub(super) arm_is_busy: bool,
    /// `true` if the motion stop is latched: the experimenter releases it.
    pub(super) arm_is_stopped: bool,
    /// `true` if the planner is being switched or is still to be restored.
    pub(super) is_switching: bool,
}

/// Reason why an interaction cannot begin yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum NotReady {
    /// A service is not ready, or the policy has published nothing yet.
    Service,
    /// The policy uses another planner.
    Planner,
    /// An interaction is open, or the arm moves.
    Busy,
    /// The motion stop is latched.
    Stopped,
}

impl RobotState<'_> {
    /// Returns what keeps an interaction with this planner from beginning. A stop comes first: a person has to
    /// act.
    pub(super) fn not_ready(&self, planner: &str) -> Option<NotReady> {
        match self.arm_is_stopped {
            true => Some(NotReady::Stopped),
            false => self.not_prepared(planner),
        }
    }

    /// As [`RobotState::not_ready`], apart from a stop.
    fn not_prepared(&self, planner: &str) -> Option<NotReady> {
        match self.view {
            Some(view) if self.missing.is_none() => match () {
                () if view.planner != planner || self.is_switching => Some(NotReady::Planner),
                () if view.interaction != 0 || self.arm_is_busy => Some(NotReady::Busy),
                () => None,
            },
            _ => Some(NotReady::Service),
        }
    }

    /// Returns the number of the latest interaction, open or ended; 0 for none.
    pub(super) fn latest_interaction(&self) -> u64 {
        let ended = |view: &PolicyView| view.last.as_ref().map_or(0, |last| last.interaction.0);
        self.view.map_or(0, |view| view.interaction.max(ended(view)))
    }

    pub(super) fn scene_key(&self) -> String {
        format!("{:016x}", self.scene.key())
    }
}

/// Returns whether the arm has something to do, or may do something unseen.
pub(super) fn arm_is_busy(arm: Option<&ArmStatus>) -> bool {
    let still = [PickPhase::Idle, PickPhase::Done];
    arm.is_none_or(|arm| !still.contains(&arm.phase.get()))
}

impl StudyController {
    /// The running interaction.
    fn running(&self) -> Option<(&Participant, &Trial)> {
        let person = self.active().filter(|person| person.stage == Stage::Running)?;
        Some((person, person.trial()?))
    }

    /// Returns the consequences of an utterance or question.
    pub(super) fn said(
        &self,
        said: &DialogueEvent,
        robot: &RobotState<'_>,
    ) -> Option<(String, Event)> {
        let (person, trial) = self.running()?;
        if trial.said.len() + trial.asked.len() >= LINES_MAX {
            return None;
        }
        let kept = |words: &str| person.begun.protocol.keep_words.then(|| words.to_owned());
        let event = match said {
            DialogueEvent::Heard(receipt) => Event::Heard(Heard {
                seq: receipt.seq,
                source: if receipt.source == Way::Text { Source::Typed } else { Source::Voice },
                onset_ms: if receipt.onset_ns > 0 { ms(Time(receipt.onset_ns)) } else { robot.ms },
                accepted_ms: robot.ms,
                words: kept(receipt.note.as_str().unwrap_or_default()),
            }),
            DialogueEvent::Asked { prompt, presentation, words } => {
                let (prompt, presentation) = (*prompt, *presentation);
                Event::Asked(Asked { prompt, presentation, words: kept(words) })
            }
        };
        Some((person.id().to_owned(), event))
    }

    /// Returns the consequences of the robot's state; call it again once they are written down.
    pub(super) fn look(
        &mut self,
        robot: &RobotState<'_>,
        fault_ms: f64,
    ) -> Option<(String, Event)> {
        match robot.missing {
            None => self.missing_since = None,
            Some(_) => _ = self.missing_since.get_or_insert(robot.ms),
        }
        let away_ms = self.missing_since.map_or(0.0, |since| robot.ms - since);
        let (person, trial) = self.running()?;
        let event = spoilt(trial, robot, away_ms > fault_ms)
            .or_else(|| ended(trial, robot))
            .or_else(|| too_long(trial, robot, person.begun.protocol.seconds_max))
            .or_else(|| decided(trial, robot));
        Some((person.id().to_owned(), event?))
    }

    /// Returns the study's current request to the robot.
    pub(super) fn request(&self, robot: &RobotState<'_>) -> Option<RobotRequest> {
        let view = robot.view?;
        if let Some(person) = self.owing() {
            return Some(RobotRequest::Restore(person.id().to_owned()));
        }
        let Some(person) = self.active() else { return self.left_standing(view) };
        let trial = person.trial()?;
        match person.stage {
            Stage::Drawn => match robot.not_prepared(&trial.step.policy) {
                Some(NotReady::Busy) if view.interaction != 0 => Some(RobotRequest::Cancel),
                Some(NotReady::Planner) if view.interaction != 0 => Some(RobotRequest::Cancel),
                Some(NotReady::Planner) if view.planner == trial.step.policy => None,
                Some(NotReady::Planner) => Some(RobotRequest::Switch(trial.step.policy.clone())),
                _ => None,
            },
            Stage::Over if view.interaction != 0 => Some(RobotRequest::Cancel),
            _ => None,
        }
    }

    /// Returns a participant who has ended and whose planner is still to be restored.
    pub(super) fn owing(&self) -> Option<&Participant> {
        let owes = |person: &&Participant| person.stage.is_final() && person.switched.is_some();
        self.people().iter().find(owes)
    }

    /// Cancels the open interaction of a participant who has left.
    fn left_standing(&self, view: &PolicyView) -> Option<RobotRequest> {
        let trial = self.people().last()?.trial()?;
        let left = trial.end.is_none() && trial.started_at.is_some();
        (left && view.interaction == trial.after + 1).then_some(RobotRequest::Cancel)
    }
}

fn spoilt(trial: &Trial, robot: &RobotState<'_>, is_away: bool) -> Option<Event> {
    let fault = |fault, why: String| Some(Event::Faulted { fault, why });
    if is_away {
        let name = robot.missing.unwrap_or_default();
        return fault(Fault::Service, format!("the service {name} was away for too long"));
    }
    if robot.scene_key() != trial.drawn.scene_key {
        return fault(Fault::Scene, "the scene was changed".to_owned());
    }
    let view = robot.view?;
    if view.planner != trial.step.policy {
        return fault(Fault::Planner, format!("the policy decides by {}", view.planner));
    }
    let latest = robot.latest_interaction();
    let ended = view.last.as_ref().map_or(0, |last| last.interaction.0);
    if latest < trial.after {
        return fault(Fault::Missed, "the robot was started afresh".to_owned());
    }
    if ended > trial.after + 1 {
        return fault(Fault::Missed, "the console was away as it ended".to_owned());
    }
    None
}

/// The robot has ended it.
fn ended(trial: &Trial, robot: &RobotState<'_>) -> Option<Event> {
    let last = robot.view?.last.as_ref().filter(|last| last.interaction.0 == trial.after + 1)?;
    let right = last.name.as_ref() == Some(&trial.drawn.object);
    let Some(verdict) = Verdict::of(last.outcome, right) else {
        let why = "the scene was changed".to_owned();
        return Some(Event::Faulted { fault: Fault::Scene, why });
    };
    Some(Event::Ended(Ending {
        verdict,
        interaction: last.interaction.0,
        object: last.name.clone(),
        questions: last.questions,
        utterances: utterances(last),
        seconds: Some(last.seconds),
        ended_ms: robot.ms,
    }))
}

fn utterances(last: &Ended) -> u32 {
    let (first, latest) = last.utterances;
    u32::try_from(latest.0.saturating_sub(first.0) + 1).unwrap_or(u32::MAX)
}

/// It lasts longer than it may: from the first utterance, or from the start where nothing was said.
fn too_long(trial: &Trial, robot: &RobotState<'_>, seconds_max: f64) -> Option<Event> {
    let waited_ms = match trial.said.first() {
        Some(said) => robot.ms - said.onset_ms,
        None => robot.at.saturating_sub(trial.started_at?) as f64,
    };
    let view = robot.view.filter(|view| view.interaction == trial.after + 1);
    (waited_ms > 1e3 * seconds_max).then(|| {
        Event::Ended(Ending {
            verdict: Verdict::TooLong,
            interaction: view.map_or(0, |view| view.interaction),
            object: None,
            questions: view.map_or(0, |view| view.questions),
            utterances: 0,
            seconds: None,
            ended_ms: robot.ms,
        })
    })
}

fn decided(trial: &Trial, robot: &RobotState<'_>) -> Option<Event> {
    let view = robot.view.filter(|view| view.interaction == trial.after + 1)?;
    let is_new = trial.decided_ms.is_none() && view.decision == ActKind::Pick;
    is_new.then_some(Event::Decided { decided_ms: robot.ms })
}
