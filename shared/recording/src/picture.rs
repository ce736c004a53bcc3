//! The group as viewers draw it: robot, objects with belief as colour, path, dialogue, logs.

use std::path::PathBuf;

use config::Settings;
use measured_joints::MeasuredJoints;
use messages::layout::FixedMessage;
use messages::topics::{self, Topic};
use messages::{
    AudioChunk, JOINT_STATE_NAMES, PolicyView, Receipt, ReceiptStatus, RobotAct, TableView,
    TrajectoryView, WorldView,
};
use robot_model::Robot;
use scene::{ObjectId, Scene};
use serde::{Serialize, de::DeserializeOwned};
use service::bus::AnyMessage;
use service::{Span, Time as Monotonic};

use crate::channels::{CDR_HEADER, Picture};
use crate::clock::WallClock;
use crate::foxglove::{
    Color, CubePrimitive, FrameTransform, FrameTransforms, JointState, JointStates, LinePrimitive,
    Log, Pose, RawAudio, SceneEntity, SceneEntityDeletion, SceneUpdate, TextPrimitive, Time, level,
};
use crate::log_lines::LogLines;

/// Frame of the objects: the robot's base.
const BASE: &str = "base";
/// Shortest interval between two pictures of the joints, while they move and at rest.
const JOINTS_EVERY: (Span, Span) = (Span::from_ms(50), Span::from_ms(1_000));
/// Joints that change by less are at rest, radians or percent.
const STILL: f64 = 1e-4;
/// Extents of an object whose size is not known, metres.
const UNKNOWN_SIZE: [f64; 3] = [0.05; 3];
/// Height of letters, metres.
const LETTERS_M: f64 = 0.03;
/// Thickness of the planned path, pixels.
const PATH_PX: f64 = 3.0;
const WHITE: Color = Color { r: 1.0, g: 1.0, b: 1.0, a: 1.0 };
const PATH_COLOR: Color = Color { r: 1.0, g: 0.8, b: 0.0, a: 0.9 };
/// Samples of streamed sound in a second.
const SAMPLE_RATE: u32 = 16_000;

/// A message of the picture: its channel, its moment in nanoseconds since 1970, and its bytes.
pub type Shown = (Picture, u64, Vec<u8>);

/// Draws the picture from the messages of the group.
#[derive(Debug)]
pub struct Painter {
    /// The scene file, which has the words.
    file: Scene,
    /// The scene with the present objects.
    scene: Scene,
    description: String,
    joints: MeasuredJoints,
    logs: LogLines,
    log_folder: PathBuf,
    /// The joints that were shown last, and when.
    shown_joints: Option<(messages::JointStates, Monotonic)>,
    world: Option<WorldView>,
    belief: Option<PolicyView>,
    path: Option<TrajectoryView>,
    /// Whether the objects, their belief or the path have changed since they were shown.
    has_changed: bool,
    /// The robot's line that was shown last: its prompt and which presentation of it.
    said: (u64, u32),
}

impl Painter {
    /// Draws for a group with these settings, whose logs are in `log_folder`.
    pub fn new(settings: &Settings, robot: &Robot, log_folder: PathBuf) -> Self {
        let file = settings.scene.clone();
        Self {
            scene: match settings.group.perception.enabled {
                true => file.with_objects(&[]),
                false => file.clone(),
            },
            file,
            description: settings.robot_files().urdf.text.clone(),
            joints: MeasuredJoints::new(robot, &JOINT_STATE_NAMES),
            logs: LogLines::default(),
            log_folder,
            shown_joints: None,
            world: None,
            belief: None,
            path: None,
            has_changed: false,
            said: (0, 0),
        }
    }

    /// The beginning of a file at `now`: it shows everything that is known.
    pub fn begin(&mut self, now: Monotonic, clock: WallClock, show: &mut dyn FnMut(Shown)) {
        self.shown_joints = None;
        self.has_changed = true;
        let wall_ns = clock.wall_ns(now);
        show((Picture::RobotDescription, wall_ns, cdr_string(&self.description)));
        if let Some(world) = &self.world {
            let frames = self.frames(world, Time::at(wall_ns));
            show((Picture::Frames, wall_ns, json(&frames)));
        }
    }

    /// Takes in a message that was sent at `sent`.
    pub fn on_message(
        &mut self,
        topic: &Topic,
        (sent, clock): (Monotonic, WallClock),
        message: AnyMessage<'_>,
        show: &mut dyn FnMut(Shown),
    ) {
        let wall_ns = clock.wall_ns(sent);
        match message {
            AnyMessage::Fixed(message) => self.on_fixed(message, (sent, clock), show),
            AnyMessage::Encoded(bytes) if is(topic, &topics::VIEW) => {
                let view: Option<PolicyView> = decoded(bytes);
                if let Some(view) = view {
                    self.has_changed |=
                        self.belief.as_ref().map(|it| &it.belief) != Some(&view.belief);
                    self.belief = Some(view);
                }
            }
            AnyMessage::Encoded(bytes) if is(topic, &topics::WORLD) => {
                let Some(world) = decoded::<WorldView>(bytes) else { return };
                let frames = self.frames(&world, Time::at(clock.wall_ns(Monotonic(world.at_ns))));
                show((Picture::Frames, wall_ns, json(&frames)));
                self.has_changed |=
                    self.world.as_ref().map(|it| &it.objects) != Some(&world.objects);
                self.world = Some(world);
            }
            AnyMessage::Encoded(bytes) if is(topic, &topics::TRAJECTORY) => {
                let Some(path) = decoded::<TrajectoryView>(bytes) else { return };
                self.has_changed |= self.path.as_ref().map(|it| &it.phases) != Some(&path.phases);
                self.path = Some(path);
            }
            AnyMessage::Encoded(bytes) if is(topic, &topics::OBJECTS) => {
                let Some(table) = decoded::<TableView>(bytes) else { return };
                let objects: Vec<_> =
                    table.objects.into_iter().map(|object| object.known).collect();
                // Without perception the table is empty and the objects are the scene's.
                if !objects.is_empty() || self.scene.objects().is_empty() {
                    self.scene = self.file.with_objects(&objects);
                    self.has_changed = true;
                }
            }
            AnyMessage::Encoded(_) => {}
        }
    }

    fn on_fixed(
        &mut self,
        message: FixedMessage<'_>,
        (sent, clock): (Monotonic, WallClock),
        show: &mut dyn FnMut(Shown),
    ) {
        let wall_ns = clock.wall_ns(sent);
        if let Some(states) = message.get::<messages::JointStates>() {
            if self.is_due(states, sent) {
                let measured = Time::at(clock.wall_ns(Monotonic(states.at_ns)));
                show((Picture::Joints, wall_ns, json(&self.joint_states(states, measured))));
                self.shown_joints = Some((*states, sent));
            }
        } else if let Some(receipt) = message.get::<Receipt>() {
            let is_heard = receipt.status == ReceiptStatus::Accepted;
            if let Some(text) = receipt.note.as_str().ok().filter(|_| is_heard) {
                show((Picture::Dialogue, wall_ns, json(&line("user", text, wall_ns))));
            }
        } else if let Some(act) = message.get::<RobotAct>() {
            let prompt = (act.prompt, act.presentation);
            let text = act.text.as_str().ok().filter(|text| !text.is_empty());
            if let Some(text) = text.filter(|_| act.prompt != 0 && prompt != self.said) {
                self.said = prompt;
                show((Picture::Dialogue, wall_ns, json(&line("robot", text, wall_ns))));
            }
        } else if let Some(chunk) = message.get::<AudioChunk>() {
            let bytes: Vec<u8> = chunk.sound().iter().flat_map(|it| it.to_le_bytes()).collect();
            let sound = RawAudio {
                timestamp: Time::at(clock.wall_ns(Monotonic(chunk.taken_ns))),
                data: bytes.as_slice().into(),
                format: "pcm-s16".to_owned(),
                sample_rate: SAMPLE_RATE,
                number_of_channels: 1,
            };
            show((Picture::Sound, wall_ns, json(&sound)));
        }
    }

    /// Shows objects and path, if they have changed, as they are at `now`.
    pub fn show_scene(&mut self, now: Monotonic, clock: WallClock, show: &mut dyn FnMut(Shown)) {
        if self.has_changed && self.world.is_some() {
            self.has_changed = false;
            let wall_ns = clock.wall_ns(now);
            show((Picture::Scene, wall_ns, json(&self.scene_update(Time::at(wall_ns)))));
        }
    }

    /// Shows the lines that were added to the services' logs.
    pub fn show_logs(&mut self, now: Monotonic, clock: WallClock, show: &mut dyn FnMut(Shown)) {
        for (wall_ns, log) in self.logs.take(&self.log_folder, clock.wall_ns(now)) {
            show((Picture::Log, wall_ns, json(&log)));
        }
    }

    fn is_due(&self, states: &messages::JointStates, now: Monotonic) -> bool {
        let Some((last, shown)) = &self.shown_joints else { return true };
        let moves = (states.position.iter().zip(&last.position))
            .chain(states.gripper_percent.iter().zip(&last.gripper_percent))
            .any(|(new, old)| (new - old).abs() > STILL);
        now >= *shown + if moves { JOINTS_EVERY.0 } else { JOINTS_EVERY.1 }
    }

    fn joint_states(&self, states: &messages::JointStates, timestamp: Time) -> JointStates {
        let own = self.joints.names().iter().enumerate();
        let own = own.filter_map(|(entry, name)| {
            Some(JointState {
                name: name.clone()?,
                position: states.position[entry],
                velocity: states.velocity[entry],
                effort: states.effort[entry],
            })
        });
        let fingers = self.joints.fingers().iter().map(|finger| JointState {
            name: finger.name.clone(),
            position: finger.position(states.gripper_percent[finger.limb]),
            ..JointState::default()
        });
        JointStates { timestamp, joints: own.chain(fingers).collect() }
    }

    /// The present objects: place in the scene, number, and pose.
    fn placed<'a>(
        &'a self,
        world: &'a WorldView,
    ) -> impl Iterator<Item = (ObjectId, ObjectId, Pose)> + 'a {
        world.objects.iter().enumerate().filter_map(|(at, pose)| {
            let number = world.numbers.get(at).copied().unwrap_or_else(|| at.into());
            let place = self.scene.numbered(number)?;
            Some((place, number, Pose::from((*pose)?)))
        })
    }

    fn frames(&self, world: &WorldView, timestamp: Time) -> FrameTransforms {
        let frame = |(place, _, pose): (ObjectId, ObjectId, Pose)| FrameTransform {
            timestamp,
            parent_frame_id: BASE.to_owned(),
            child_frame_id: format!("object/{}", self.scene.objects()[place.index()].name),
            translation: pose.position,
            rotation: pose.orientation,
        };
        FrameTransforms { transforms: self.placed(world).map(frame).collect() }
    }

    fn probability(&self, number: ObjectId) -> f64 {
        let Some(view) = &self.belief else { return 0.0 };
        let place = match view.objects.is_empty() {
            true => Some(number.index()),
            false => view.objects.iter().position(|known| *known == number),
        };
        let p = place.and_then(|place| view.belief.get(place)).copied();
        p.filter(|p| p.is_finite()).unwrap_or(0.0)
    }

    fn scene_update(&self, timestamp: Time) -> SceneUpdate {
        let entity = |id: &str| SceneEntity {
            timestamp,
            frame_id: BASE.to_owned(),
            id: id.to_owned(),
            frame_locked: true,
            ..SceneEntity::default()
        };
        let mut objects = entity("objects");
        for (place, number, pose) in self.world.iter().flat_map(|world| self.placed(world)) {
            let object = &self.scene.objects()[place.index()];
            let size = object.placement.map_or(UNKNOWN_SIZE, |placement| placement.size);
            let p = self.probability(number);
            let mut above = pose;
            above.position.z += size[2] / 2.0 + LETTERS_M;
            objects.cubes.push(CubePrimitive { pose, size: size.into(), color: color(p) });
            objects.texts.push(TextPrimitive {
                pose: above,
                billboard: true,
                font_size: LETTERS_M,
                scale_invariant: false,
                color: WHITE,
                text: format!("{} {:.0} %", object.name, 100.0 * p),
            });
        }
        let points = self.path.iter().flat_map(|path| &path.phases).flat_map(|it| &it.points_m);
        let points: Vec<_> = points.map(|point| (*point).into()).collect();
        let mut update = SceneUpdate { deletions: Vec::new(), entities: vec![objects] };
        match points.is_empty() {
            true => {
                update.deletions.push(SceneEntityDeletion {
                    timestamp,
                    kind: 0,
                    id: "path".into(),
                });
            }
            false => {
                let line = LinePrimitive {
                    points,
                    thickness: PATH_PX,
                    scale_invariant: true,
                    color: PATH_COLOR,
                    ..LinePrimitive::default()
                };
                update.entities.push(SceneEntity { lines: vec![line], ..entity("path") });
            }
        }
        update
    }
}

/// Colour of a probability: from blue at 0 over green to red at 1, and more opaque.
fn color(p: f64) -> Color {
    let p = p.clamp(0.0, 1.0);
    let (r, b) = ((2.0 * p - 1.0).max(0.0), (1.0 - 2.0 * p).max(0.0));
    Color { r, g: 1.0 - r - b, b, a: 0.4 + 0.6 * p }
}

fn line(name: &str, text: &str, wall_ns: u64) -> Log {
    Log {
        timestamp: Time::at(wall_ns),
        level: level::INFO,
        message: text.to_owned(),
        name: name.to_owned(),
        ..Log::default()
    }
}

fn is(topic: &Topic, other: &Topic) -> bool {
    topic.name == other.name
}

/// The payload, unless it is none: readers of the topic reject such a message, too.
fn decoded<T: DeserializeOwned>(bytes: &[u8]) -> Option<T> {
    postcard::from_bytes(bytes).ok()
}

fn json(message: &impl Serialize) -> Vec<u8> {
    // Every message of the picture can be written.
    serde_json::to_vec(message).unwrap_or_default()
}

/// `std_msgs/msg/String` in CDR.
fn cdr_string(text: &str) -> Vec<u8> {
    let mut bytes = CDR_HEADER.to_vec();
    bytes.extend((text.len() as u32 + 1).to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes.push(0);
    bytes
}

#[cfg(test)]
mod tests;
