//! What a viewer is shown: everything that was heard, folded into sections.
//!
//! Pure: no IO, no clock, no thread. Messages come in any order and more than once (a service that is
//! started anew repeats its latest); folding one twice changes nothing.

mod arm;
mod dialogue;
mod event;
mod latency;
mod line;
mod scene;
mod services;
mod speech;
mod transcript;
mod turn;
mod understood;

#[cfg(test)]
mod tests;

use ::scene::Scene;
use messages::{
    Activity, ArmStatus, Hearing, JointStates, Observation, Partial, PolicyView, Presented,
    Receipt, RobotAct, TrajectoryView, WorldView,
};
use serde_json::{Value as Json, json};
use service::Time;
use service::status::GroupStatus;

pub use event::PictureEvent;
pub use latency::{Latency, Stages};
pub use line::{Line, Who};
pub use transcript::Transcript;
pub use turn::{Turn, TurnState};

use crate::hub::ms;

/// What time it is: both clocks at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Now {
    /// The monotonic clock.
    pub at: Time,
    /// Milliseconds since 1970.
    pub unix_ms: u64,
}

/// Everything that is shown, at one moment.
#[derive(Debug)]
pub struct Picture {
    scene: Scene,
    view: Option<PolicyView>,
    presented: Presented,
    activity: Option<Activity>,
    hearing: Option<Hearing>,
    arm: Option<ArmStatus>,
    world: Option<WorldView>,
    trajectory: TrajectoryView,
    group: Option<GroupStatus>,
    /// Whether the sound of what is being said can be fetched.
    has_sound: bool,
    prompts: speech::Prompts,
    transcript: Transcript,
    latency: Latency,
    turn: Option<Turn>,
    turn_since: Time,
    events: Vec<PictureEvent>,
    changed: Changed,
}

/// Sections that are to be written anew.
#[derive(Clone, Copy, Debug, Default)]
struct Changed {
    scene: bool,
    dialogue: bool,
    speech: bool,
    arm: bool,
    world: bool,
    trajectory: bool,
    services: bool,
    latency: bool,
}

impl Picture {
    /// Nothing seen yet of a dialogue about `scene`; goes on with a transcript.
    pub fn new(scene: Scene, transcript: Transcript) -> Self {
        Self {
            scene,
            view: None,
            presented: Presented::default(),
            activity: None,
            hearing: None,
            arm: None,
            world: None,
            trajectory: TrajectoryView::default(),
            group: None,
            has_sound: false,
            prompts: speech::Prompts::default(),
            transcript,
            latency: Latency::default(),
            turn: None,
            turn_since: Time(0),
            events: Vec::new(),
            changed: Changed { scene: true, trajectory: true, ..Changed::default() },
        }
    }

    /// The scene that is shown.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What the policy thinks, once it was heard.
    pub fn view(&self) -> Option<&PolicyView> {
        self.view.as_ref()
    }

    /// What the arm does, once it was heard.
    pub fn arm(&self) -> Option<&ArmStatus> {
        self.arm.as_ref()
    }

    /// What the supervisor said of the group, once it did.
    pub fn group(&self) -> Option<&GroupStatus> {
        self.group.as_ref()
    }

    /// The latest turn.
    pub fn turn(&self) -> Option<&Turn> {
        self.turn.as_ref()
    }

    /// What was said.
    pub fn transcript(&mut self) -> &mut Transcript {
        &mut self.transcript
    }

    /// How long answers take.
    pub fn latency(&mut self) -> &mut Latency {
        &mut self.latency
    }

    /// Whether the policy speaks of another scene than is shown: the settings are to be read again.
    pub fn is_of_another_scene(&self) -> bool {
        self.view.as_ref().is_some_and(|view| view.scene_key != self.scene.key())
    }

    /// The scene was changed.
    pub fn set_scene(&mut self, scene: Scene) {
        if scene != self.scene {
            self.scene = scene;
            self.events.push(PictureEvent::SceneChanged);
        }
        let Changed { scene, dialogue, arm, .. } = &mut self.changed;
        (*scene, *dialogue, *arm) = (true, true, true);
    }

    /// What the policy thinks now.
    pub fn see_view(&mut self, view: PolicyView, now: Now) {
        let before = self.view.as_ref();
        let open = before.map_or(0, |before| before.interaction);
        if before.is_some() && view.interaction != open && view.interaction != 0 {
            self.events.push(PictureEvent::Opened { interaction: view.interaction, at: now.at });
        }
        if let Some(ended) = &view.last
            && self.transcript.ended(&self.scene, ended, now)
            && before.is_some()
        {
            self.events.push(PictureEvent::Ended { ended: ended.clone(), at: now.at });
        }
        self.view = Some(view);
        self.changed.dialogue = true;
    }

    /// What the policy has decided.
    pub fn see_act(&mut self, act: &RobotAct) {
        self.latency.decided(act);
        self.prompts.remember(act);
        // What is being said may be known by its words only now.
        self.changed.speech = true;
        self.changed.latency = true;
    }

    /// What is being said or was said last; whether its sound is kept.
    pub fn see_presented(&mut self, presented: Presented, has_sound: bool, now: Now) {
        self.latency.presented(&presented);
        self.changed.latency = true;
        self.presented = presented;
        self.has_sound = has_sound;
        self.changed.speech = true;
        if let Some(prompt) = self.prompts.of(&presented)
            && self.transcript.robot(&self.scene, &presented, prompt, now)
        {
            self.events.push(PictureEvent::Said {
                prompt: presented.prompt,
                presentation: presented.presentation,
                question: prompt.question,
                text: prompt.text.clone(),
                began: Time(presented.started_ns),
            });
        }
    }

    /// What became of somebody's words.
    pub fn see_receipt(&mut self, receipt: &Receipt, now: Now) {
        self.latency.heard(receipt);
        if self.transcript.receipt(receipt, now) && receipt.seq > 0 {
            self.events.push(PictureEvent::Heard(Box::new(*receipt)));
        }
    }

    /// What was understood.
    pub fn see_observation(&mut self, observation: &Observation) {
        self.latency.understood(observation);
        let open = self.view.as_ref().map_or(0, |view| view.interaction);
        let understood = understood::read(&self.scene, observation, &self.prompts, open);
        if let Some(understood) = understood {
            self.transcript.understood(observation.seq, understood);
        }
    }

    /// Whether somebody speaks.
    pub fn see_activity(&mut self, activity: Activity) {
        self.activity = Some(activity);
    }

    /// How well the robot hears.
    pub fn see_hearing(&mut self, hearing: Hearing) {
        self.hearing = Some(hearing);
        self.changed.speech = true;
    }

    /// What the arm does.
    pub fn see_arm(&mut self, arm: ArmStatus, now: Now) {
        let was = self.arm.is_some_and(|arm| arm.stopped != 0);
        let is = arm.stopped != 0;
        if is != was {
            if self.arm.is_some() || is {
                self.transcript.motion(is, now);
            }
            self.events.push(PictureEvent::Stopped { stopped: is, at: now.at });
        }
        self.arm = Some(arm);
        self.changed.arm = true;
    }

    /// Where the objects are.
    pub fn see_world(&mut self, world: WorldView) {
        self.world = Some(world);
        self.changed.world = true;
    }

    /// The way that a gripper is going.
    pub fn see_trajectory(&mut self, trajectory: TrajectoryView) {
        self.trajectory = trajectory;
        self.changed.trajectory = true;
    }

    /// What the supervisor says.
    pub fn see_group(&mut self, group: GroupStatus, now: Now) {
        for (service, is_back) in services::turns(self.group.as_ref(), &group) {
            self.transcript.service(service, is_back, now);
            let event = PictureEvent::Service { name: service.name.clone(), is_back, at: now.at };
            self.events.push(event);
        }
        self.group = Some(group);
        self.changed.services = true;
    }

    /// What has happened since it was asked last.
    pub fn take_events(&mut self) -> Vec<PictureEvent> {
        std::mem::take(&mut self.events)
    }

    /// The sections that may have changed since they were asked for last.
    pub fn sections(&mut self, now: Now) -> Vec<(&'static str, Json)> {
        let Changed { scene, dialogue, speech, arm, world, trajectory, services, latency } =
            std::mem::take(&mut self.changed);
        let mut sections = Vec::new();
        let mut put = |is_due: bool, name, value: Option<Json>| {
            sections.extend(value.filter(|_| is_due).map(|value| (name, value)));
        };
        put(scene, "scene", scene.then(|| scene::section(&self.scene)));
        let view = self.view.as_ref().filter(|view| view.scene_key == self.scene.key());
        put(dialogue, "dialogue", view.map(|view| dialogue::section(&self.scene, view)));
        put(speech, "speech", speech.then(|| self.speech()));
        put(arm, "arm", self.arm.as_ref().map(|arm| arm::section(&self.scene, arm)));
        put(world, "world", self.world.as_ref().map(arm::world));
        put(trajectory, "trajectory", Some(arm::trajectory(&self.trajectory)));
        put(services, "services", self.group.as_ref().map(services::section));
        put(latency, "latency", latency.then(|| self.latency.section()));
        sections.extend(self.turn_section(now).map(|turn| ("turn", turn)));
        sections
    }

    fn speech(&self) -> Json {
        let speaking = self.prompts.of(&self.presented);
        json!({
            "speaking": speaking.map(|prompt| speech::speaking(prompt, &self.presented, self.has_sound)),
            "hearing": self.hearing.as_ref().map(speech::hearing),
        })
    }

    fn turn_section(&mut self, now: Now) -> Option<Json> {
        let turn = turn::turn(&turn::Facts {
            view: self.view.as_ref(),
            presented: &self.presented,
            activity: self.activity.as_ref(),
            hearing: self.hearing.as_ref(),
            arm: self.arm.as_ref(),
            group: self.group.as_ref(),
        });
        if self.turn == Some(turn) {
            return None;
        }
        if self.turn.is_none_or(|before| before.state != turn.state) {
            self.turn_since = now.at;
        }
        self.turn = Some(turn);
        Some(turn.to_json(self.turn_since))
    }
}

/// The frame of the joints: numbers with as many digits as are seen.
pub fn joints(joints: &JointStates) -> String {
    let digits = |number: f64| (number * 1e5).round() / 1e5;
    let q: Vec<f64> = joints.position.iter().copied().map(digits).collect();
    let grip: Vec<f64> = joints.gripper_percent.iter().map(|g| (g * 10.0).round() / 10.0).collect();
    json!({ "t": "joints", "at_ms": ms(Time(joints.at_ns)), "q": q, "grip": grip }).to_string()
}

/// The stream of a partial utterance, as text, and its frame.
pub fn partial(partial: &Partial, stream: Option<u32>) -> (String, String) {
    let key: String = partial.stream.iter().map(|byte| format!("{byte:02x}")).collect();
    let text = partial.text.as_str().unwrap_or_default();
    let text = if partial.over == 0 { text } else { "" };
    let frame = json!({
        "t": "partial",
        "stream": stream,
        "text": text,
        "over": partial.over != 0,
        "onset_ms": ms(Time(partial.onset_ns)),
    });
    (key, frame.to_string())
}
