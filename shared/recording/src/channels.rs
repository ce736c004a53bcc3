//! The channels of a recording: every topic of the group, and the picture.

use messages::definition::Definition;
use messages::topics::{self, Topic};
use serde_reflection::{Registry, Tracer, TracerConfig};

use crate::foxglove::{FrameTransforms, JointStates, Log, RawAudio, SceneUpdate};
use crate::json_schema::json_schema;

/// A channel in the form in which MCAP describes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Name of the channel in the file.
    pub topic: String,
    /// Name of the schema.
    pub schema: String,
    /// Language of the schema: `ros2msg` or `jsonschema`.
    pub schema_encoding: &'static str,
    /// The schema.
    pub definition: String,
    /// Whether late joiners need the latest message, which is valid until the next one.
    pub is_state: bool,
}

/// Encoding of the messages of a channel.
pub fn message_encoding(schema_encoding: &str) -> &'static str {
    if schema_encoding == ROS2MSG { "cdr" } else { "json" }
}

/// ROS 2 message definitions; the messages are CDR.
pub const ROS2MSG: &str = "ros2msg";
/// JSON Schema; the messages are JSON.
pub const JSONSCHEMA: &str = "jsonschema";
/// Before the body of a CDR message: plain CDR, little-endian.
pub const CDR_HEADER: [u8; 4] = [0, 1, 0, 0];

/// A channel of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Picture {
    /// The robot's description, `std_msgs/msg/String`.
    RobotDescription,
    /// Joints under the description's names.
    Joints,
    /// Objects with the belief as colour, and the planned path.
    Scene,
    /// Frames of the objects.
    Frames,
    /// Lines of the dialogue.
    Dialogue,
    /// The services' logs.
    Log,
    /// Sound that clients stream.
    Sound,
}

impl Picture {
    /// All channels.
    pub const ALL: [Self; 7] = [
        Self::RobotDescription,
        Self::Joints,
        Self::Scene,
        Self::Frames,
        Self::Dialogue,
        Self::Log,
        Self::Sound,
    ];

    /// Returns the channel's name in the file.
    pub fn topic(self) -> &'static str {
        match self {
            Self::RobotDescription => "/robot_description",
            Self::Joints => "/joint_states",
            Self::Scene => "/scene",
            Self::Frames => "/tf",
            Self::Dialogue => "/dialogue",
            Self::Log => "/log",
            Self::Sound => "/sound",
        }
    }

    fn channel(self) -> Channel {
        let (schema, definition) = match self {
            Self::RobotDescription => {
                return Channel {
                    topic: self.topic().to_owned(),
                    schema: "std_msgs/msg/String".to_owned(),
                    schema_encoding: ROS2MSG,
                    definition: "string data\n".to_owned(),
                    is_state: true,
                };
            }
            Self::Joints => ("JointStates", traced::<JointStates>()),
            Self::Scene => ("SceneUpdate", traced::<SceneUpdate>()),
            Self::Frames => ("FrameTransforms", traced::<FrameTransforms>()),
            Self::Dialogue | Self::Log => ("Log", traced::<Log>()),
            Self::Sound => ("RawAudio", traced::<RawAudio>()),
        };
        Channel {
            topic: self.topic().to_owned(),
            schema: format!("foxglove.{schema}"),
            schema_encoding: JSONSCHEMA,
            definition: json_schema(schema, &definition).to_string(),
            is_state: matches!(self, Self::Joints | Self::Scene | Self::Frames),
        }
    }
}

/// Every type in a message of the picture; their test makes sure that each can be traced.
fn traced<'de, T: serde::Deserialize<'de>>() -> Registry {
    let mut tracer = Tracer::new(TracerConfig::default());
    let traced = tracer.trace_simple_type::<T>();
    traced.and_then(|_| tracer.registry()).unwrap_or_default()
}

/// Number of a channel in [`all`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ChannelId(pub usize);

impl ChannelId {
    /// The channel of a topic, by its place in [`topics`](group_topics).
    pub fn of_topic(place: usize) -> Self {
        Self(place)
    }

    /// Returns whether it carries sound, which is shown only if `recorder.sound` allows it.
    pub fn is_sound(self) -> bool {
        let topic = group_topics().nth(self.0);
        topic.map_or(self == Picture::Sound.into(), |topic| topic.name == topics::AUDIO.name)
    }
}

impl From<Picture> for ChannelId {
    fn from(picture: Picture) -> Self {
        Self(group_topics().count() + picture as usize)
    }
}

/// Every topic of a group, those of a robot included.
pub fn group_topics() -> impl Iterator<Item = &'static Topic> {
    topics::ALL.iter().chain(&topics::robot::ALL)
}

/// Every channel: those of the topics, then those of the picture.
pub fn all() -> Vec<Channel> {
    let pictures = Picture::ALL.into_iter().map(Picture::channel);
    group_topics().map(of_topic).chain(pictures).collect()
}

fn of_topic(topic: &Topic) -> Channel {
    let (schema_encoding, schema, definition) = match (topic.definition)() {
        Definition::Ros2Msg(text) => (ROS2MSG, format!("whichone/msg/{}", topic.payload), text),
        Definition::Payload(types) => {
            let schema = json_schema(topic.payload, &types).to_string();
            (JSONSCHEMA, format!("whichone.{}", topic.payload), schema)
        }
    };
    let is_state = topic.history == 1;
    Channel { topic: format!("/{}", topic.name), schema, schema_encoding, definition, is_state }
}

/// The channels of a recording or live view, with or without sound.
pub fn shown(sound: bool) -> impl Iterator<Item = (ChannelId, Channel)> {
    let numbered = all().into_iter().enumerate().map(|(n, channel)| (ChannelId(n), channel));
    numbered.filter(move |(id, _)| sound || !id.is_sound())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_have_unique_names_and_the_picture_follows_the_topics() {
        let all = all();
        for (i, channel) in all.iter().enumerate() {
            assert!(all[i + 1..].iter().all(|other| other.topic != channel.topic), "{channel:?}");
            assert!(!channel.definition.is_empty());
        }
        for picture in Picture::ALL {
            assert_eq!(all[ChannelId::from(picture).0].topic, picture.topic());
        }
        assert_eq!(all[0].topic, "/speech/inject");
    }

    /// The viewers' reader of schemas refuses others.
    #[test]
    fn schemas_of_the_picture_are_whole_and_plain() {
        for picture in Picture::ALL.into_iter().filter(|it| *it != Picture::RobotDescription) {
            let schema: serde_json::Value =
                serde_json::from_str(&picture.channel().definition).unwrap();
            let defs = schema["$defs"].as_object().unwrap();
            let own = &defs[schema["title"].as_str().unwrap()]["properties"];
            let (own, plain) =
                (own.as_object().unwrap(), schema["properties"].as_object().unwrap());
            assert!(own.keys().eq(plain.keys()), "{picture:?}: {own:?} {plain:?}");
        }
    }
}
