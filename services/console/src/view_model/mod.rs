//! The view model: folds messages into the sections that pages show.
//!
//! Pure: no IO, no clock, no thread. Messages come in any order and more than once (a service that
//! is restarted repeats its latest); folding one twice changes nothing.

mod latency;
pub mod line;
mod listed;
mod prompts;
mod sections;
mod services;
mod transcript;
mod turn;

#[cfg(test)]
mod tests;

use std::collections::VecDeque;

use messages::{
    Activity, ArmStatus, Hearing, Observation, PolicyView, Presented, Receipt, RobotAct, Service,
    TrajectoryView, WorldView,
};
use page_part::{DialogueEvent, Now, Robot};
use scene::view::{Labels, SceneView, objects};
use scene::{ObjectId, Scene};
use serde::Serialize;
use service::bounded::push_bounded;
use service::status::{GroupStatus, ServiceStatus};
use service::view::{ArmView, DialogueView, HearingView, Latest, Readings};
use service::{Span, Time};

pub use latency::Latency;
pub use transcript::Transcript;
use turn::Turn;

use sections::{SpeakingSection, TrajectorySection, TurnSection, WorldSection};
use services::missing;

/// Utterances whose readings are remembered.
const READINGS_MAX: usize = 16;

/// Silence of the arm's service, which normally publishes at 3 to 4 Hz, to call its state unknown.
const ARM_SILENCE: Span = Span::from_ms(2_000);

/// Everything that pages show, at one moment.
#[derive(Debug)]
pub struct ViewModel {
    scene: Scene,
    labels: Labels,
    /// The objects that have a place.
    standing: Vec<ObjectId>,
    latest: Latest,
    /// When the arm's status arrived last, and whether its stop was latched.
    arm_seen: Time,
    was_stopped: bool,
    world: Option<WorldView>,
    trajectory: TrajectoryView,
    group: Option<GroupStatus>,
    /// `true` if the sound of the presented line can be fetched.
    has_sound: bool,
    prompts: prompts::Prompts,
    readings: VecDeque<Readings>,
    transcript: Transcript,
    latency: Latency,
    /// The turn, and when its state began.
    turn: Option<(Turn, Time)>,
    events: Vec<DialogueEvent>,
    /// `true` if a message has arrived since the sections were last made.
    is_changed: bool,
    is_scene_changed: bool,
}

impl ViewModel {
    /// Makes the view model of a dialogue about `scene`, continuing a transcript.
    pub fn new(scene: Scene, transcript: Transcript) -> Self {
        Self {
            labels: Labels::new(&scene),
            standing: scene.placed().collect(),
            scene,
            latest: Latest::default(),
            arm_seen: Time(0),
            was_stopped: false,
            world: None,
            trajectory: TrajectoryView::default(),
            group: None,
            has_sound: false,
            prompts: prompts::Prompts::default(),
            readings: VecDeque::new(),
            transcript,
            latency: Latency::default(),
            turn: None,
            events: Vec::new(),
            is_changed: true,
            is_scene_changed: true,
        }
    }

    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    pub fn latest(&self) -> &Latest {
        &self.latest
    }

    /// Returns the robot as optional parts of the page see it.
    pub fn robot(&self, now: Now) -> Robot<'_> {
        Robot {
            now,
            scene: &self.scene,
            view: self.latest.view.as_ref(),
            arm: self.latest.arm.as_ref(),
            missing: self.group.as_ref().and_then(missing).map(|service| service.name.as_str()),
        }
    }

    /// Returns the highest utterance that is known to be accepted.
    pub fn accepted(&self) -> u64 {
        let applied = self.latest.view.as_ref().map_or(0, |view| view.applied);
        self.latest.accepted.max(applied)
    }

    pub fn group(&self) -> Option<&GroupStatus> {
        self.group.as_ref()
    }

    /// Returns why the first of these services does nothing for anyone for now; `None` if they work
    /// or soon will.
    pub fn unavailable(&self, services: &[Service]) -> Option<String> {
        let named = |name: &str| services.iter().any(|service| service.name() == name);
        let needed = self.group.iter().flat_map(|group| &group.services);
        needed.filter(|service| named(&service.name)).find_map(ServiceStatus::unavailable)
    }

    pub fn transcript(&mut self) -> &mut Transcript {
        &mut self.transcript
    }

    pub fn latency(&mut self) -> &mut Latency {
        &mut self.latency
    }

    /// Returns whether the policy is about another scene than is shown: the settings have changed.
    pub fn is_of_another_scene(&self) -> bool {
        self.latest.view.as_ref().is_some_and(|view| view.scene_key != self.scene.key())
    }

    pub fn set_scene(&mut self, scene: Scene) {
        self.labels = Labels::new(&scene);
        self.standing = scene.placed().collect();
        self.scene = scene;
        (self.is_changed, self.is_scene_changed) = (true, true);
    }

    pub fn on_view(&mut self, view: PolicyView, now: Now) {
        self.is_changed = true;
        if let Some(ended) = &view.last {
            self.transcript.on_end(&self.scene, &self.labels, ended, now);
        }
        self.latest.view = Some(view);
        self.attribute();
    }

    pub fn on_act(&mut self, act: &RobotAct) {
        self.is_changed = true;
        self.latency.on_act(act);
        self.prompts.remember(act);
    }

    /// Takes in the presentation of the robot's latest line, and whether its sound is stored.
    pub fn on_presented(&mut self, presented: Presented, has_sound: bool, now: Now) {
        self.is_changed = true;
        self.latency.on_presented(&presented);
        self.latest.presented = presented;
        self.has_sound = has_sound;
        if let Some(prompt) = self.prompts.of(&presented)
            && self.transcript.on_presented(&presented, prompt, now)
            && prompt.asks
        {
            let Presented { prompt: id, presentation, .. } = presented;
            let words = prompt.text.clone();
            self.events.push(DialogueEvent::Asked { prompt: id, presentation, words });
        }
    }

    pub fn on_receipt(&mut self, receipt: &Receipt, now: Now) {
        self.is_changed = true;
        self.latency.on_receipt(receipt);
        self.latest.on_receipt(receipt);
        if self.transcript.on_receipt(receipt, now) && receipt.seq > 0 {
            self.events.push(DialogueEvent::Heard(Box::new(*receipt)));
        }
    }

    pub fn on_observation(&mut self, observation: &Observation) {
        self.is_changed = true;
        self.latency.on_observation(observation);
        let Some(readings) = Readings::of_observation(&self.scene, observation) else { return };
        if self.readings.iter().all(|known| known.seq != readings.seq) {
            push_bounded(&mut self.readings, READINGS_MAX, readings);
        }
        self.attribute();
    }

    /// Shows the latest utterance with the shares that the policy has given to each question.
    fn attribute(&mut self) {
        let Some(view) = &self.latest.view else { return };
        let attributed = &view.attributed;
        let readings = self.readings.iter().find(|known| known.seq == attributed.utterance);
        if let Some(readings) = readings {
            let understood = readings.attribute(attributed, |prompt, presentation| {
                self.prompts.find(prompt, presentation).map(|prompt| prompt.text.clone())
            });
            self.transcript.on_understood(attributed.utterance.0, understood);
        }
    }

    pub fn on_activity(&mut self, activity: Activity) {
        self.is_changed = true;
        self.latest.activity = Some(activity);
    }

    pub fn on_hearing(&mut self, hearing: Hearing) {
        self.is_changed = true;
        self.latest.hearing = Some(hearing);
    }

    pub fn on_arm(&mut self, arm: ArmStatus, now: Now) {
        self.is_changed = true;
        let is_stopped = arm.stopped != 0;
        if is_stopped != std::mem::replace(&mut self.was_stopped, is_stopped) {
            self.transcript.on_motion_stop(is_stopped, now);
        }
        self.arm_seen = now.at;
        self.latest.arm = Some(arm);
    }

    /// Forgets the arm's state if its service is silent: it may have changed.
    pub fn tick(&mut self, now: Now) {
        let is_silent = now.at.since(self.arm_seen) >= ARM_SILENCE;
        if is_silent && self.latest.arm.take().is_some() {
            self.is_changed = true;
        }
    }

    pub fn on_world(&mut self, world: WorldView) {
        self.is_changed = true;
        self.world = Some(world);
    }

    pub fn on_trajectory(&mut self, trajectory: TrajectoryView) {
        self.is_changed = true;
        self.trajectory = trajectory;
    }

    pub fn on_group(&mut self, group: GroupStatus, now: Now) {
        self.is_changed = true;
        for (service, is_back) in services::transitions(self.group.as_ref(), &group) {
            self.transcript.on_service(service, is_back, now);
        }
        self.group = Some(group);
    }

    /// Takes the events since the last call.
    pub fn take_events(&mut self) -> Vec<DialogueEvent> {
        std::mem::take(&mut self.events)
    }

    /// Returns the sections as JSON text, once after each change of anything; the board finds out
    /// which of them differ from before.
    pub fn sections(&mut self, now: Now) -> Vec<(&'static str, String)> {
        if !std::mem::take(&mut self.is_changed) {
            return Vec::new();
        }
        let mut sections = Sections(Vec::new());
        if std::mem::take(&mut self.is_scene_changed) {
            sections.put("scene", Some(SceneView::new(&self.scene, &self.labels, &self.standing)));
        }
        let Latest { view, presented, hearing, arm, .. } = &self.latest;
        let view = view.as_ref().filter(|view| view.scene_key == self.scene.key());
        let further = listed::further(&self.scene, &self.standing, view, arm.as_ref());
        let listed = || self.standing.iter().copied().chain(further.iter().copied());
        let dialogue = |view| {
            let dialogue = DialogueView::new(&self.scene, view, presented);
            let belief = listed().filter_map(|i| dialogue.belief.get(i.index()).copied()).collect();
            DialogueView { belief, ..dialogue }
        };
        // Before the belief, which names them.
        let objects = objects(&self.scene, &self.labels, further.iter().copied());
        sections.put("further", Some(objects));
        sections.put("dialogue", view.map(dialogue));
        let speaking = self.prompts.of(presented);
        let speaking = speaking.map(|p| SpeakingSection::new(p, presented, self.has_sound));
        sections.put("speaking", Some(speaking));
        sections.put("hearing", hearing.as_ref().map(HearingView::new));
        sections.put("arm", Some(arm.as_ref().map(|arm| ArmView::new(&self.scene, arm))));
        sections.put(
            "world",
            self.world.as_ref().map(|world| WorldSection::new(world, &self.standing)),
        );
        sections.put("trajectory", Some(TrajectorySection::new(&self.trajectory)));
        sections.put("group", self.group.as_ref());
        sections.put("latency", Some(self.latency.section()));
        let turn = turn::turn(&self.latest, self.group.as_ref());
        let since = self.turn.filter(|(before, _)| before.state == turn.state);
        let since = since.map_or(now.at, |(_, since)| since);
        self.turn = Some((turn, since));
        sections.put("turn", Some(TurnSection::new(turn, since)));
        sections.0
    }
}

struct Sections(Vec<(&'static str, String)>);

impl Sections {
    fn put<T: Serialize>(&mut self, name: &'static str, section: Option<T>) {
        // Every section can be written.
        let text = section.and_then(|section| serde_json::to_string(&section).ok());
        self.0.extend(text.map(|text| (name, text)));
    }
}
