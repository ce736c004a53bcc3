//! The table of topics: who writes, who reads, and how much is kept.
//!
//! Every topic has safe overflow and never blocks its writer: it resends missed messages until
//! their effect is seen. A reader with a wake-up is notified after each send; clients poll.

use crate::definition::Definition;
use crate::layout::Layout;
use crate::schema::{Schema, SchemaKey};
use crate::*;

/// One topic: its name, its traffic and its bounds.
#[derive(Clone, Copy, Debug)]
pub struct Topic {
    /// Name of the iceoryx2 service.
    pub name: &'static str,
    /// Identity of the payload.
    pub schema: fn() -> SchemaKey,
    /// Name of the payload type.
    pub payload: &'static str,
    /// Layout of a message; none for encoded payloads.
    pub layout: fn() -> Option<Layout>,
    /// Description of the payload for programs that do not share this code.
    pub definition: fn() -> Definition,
    /// The writer; clients if none is named.
    pub writer: Option<Service>,
    /// Services that are woken after a send.
    pub readers: &'static [Service],
    /// Writers at a time; above 1 only where clients write.
    pub writers_max: usize,
    /// Readers at a time. The memory of a writer has room for what all of them may hold.
    pub readers_max: usize,
    /// Unread messages that a reader holds; the oldest gives way.
    pub buffer: usize,
    /// Unread messages that the recorder holds, if more: it looks four to ten times a second.
    pub recorded: usize,
    /// Messages that a late reader still gets.
    pub history: usize,
}

impl Topic {
    /// A topic with one writer, of which readers see the latest message: a state. A service of a
    /// new kind states its own topics with it, whose names begin with its own: `NAME/…`.
    pub const fn new<T: Schema>(name: &'static str, writer: Option<Service>) -> Self {
        Self {
            name,
            schema: T::key,
            payload: T::NAME,
            layout: T::layout,
            definition: T::definition,
            writer,
            readers: &[],
            writers_max: 1,
            readers_max: READERS_MAX,
            buffer: 1,
            recorded: 8,
            history: 1,
        }
    }

    /// Returns the topic of this name that the shipped services and clients share.
    pub fn named(name: &str) -> Option<Self> {
        ALL.iter().chain(&robot::ALL).find(|topic| topic.name == name).copied()
    }

    /// Most unread messages that any reader holds.
    pub fn buffer_max(&self) -> usize {
        self.buffer.max(self.recorded)
    }
}

/// Readers of one topic at a time: services, clients, consoles, recorders.
pub const READERS_MAX: usize = 24;
/// Readers of a topic with large messages between services: its reader, the console with its live
/// view, the recorder, each also while it is replaced, and two tools.
pub const SERVICES_MAX: usize = 10;
/// Clients that write at a time.
pub const CLIENTS_MAX: usize = 16;
/// Processes that have a topic open at a time.
pub const NODES_MAX: usize = 48;
/// Unread messages of a topic with 100 messages a second that the recorder, at 10 Hz, holds.
const RECORDED_FAST: usize = 32;
/// Utterances that are on their way at a time; the buffers of their topics hold them all.
pub const WINDOW: usize = 16;

const fn topic<T: Schema>(name: &'static str, writer: Option<Service>) -> Topic {
    Topic::new::<T>(name, writer)
}

/// Clients to speech. The recorder is woken, too: a client may end before it looks the next time.
pub const INJECTION: Topic = Topic {
    readers: &[Service::Speech, Service::Recorder],
    writers_max: CLIENTS_MAX,
    readers_max: SERVICES_MAX,
    buffer: WINDOW,
    history: 0,
    ..topic::<Injection>("speech/inject", None)
};
/// Clients to speech, ten or more a second while a client streams.
pub const AUDIO: Topic = Topic {
    readers: &[Service::Speech],
    writers_max: CLIENTS_MAX,
    readers_max: SERVICES_MAX,
    buffer: 4 * WINDOW,
    history: 0,
    ..topic::<AudioChunk>("speech/audio", None)
};
/// Speech to clients.
pub const RECEIPT: Topic = Topic {
    buffer: WINDOW,
    history: WINDOW,
    ..topic::<Receipt>("speech/receipt", Some(Service::Speech))
};
/// Speech to grounding.
pub const UTTERANCE: Topic = Topic {
    readers: &[Service::Grounding],
    readers_max: SERVICES_MAX,
    buffer: WINDOW,
    history: WINDOW,
    ..topic::<Utterance>("speech/utterance", Some(Service::Speech))
};
/// Speech to policy, and to the console, whose pages play it.
pub const PRESENTED: Topic = Topic {
    readers: &[Service::Policy, Service::Console],
    ..topic::<Presented>("speech/presented", Some(Service::Speech))
};
/// Speech to policy.
pub const ACTIVITY: Topic = Topic {
    readers: &[Service::Policy],
    ..topic::<Activity>("speech/activity", Some(Service::Speech))
};
/// Speech to clients.
pub const HEARING: Topic = topic::<Hearing>("speech/hearing", Some(Service::Speech));
/// Speech to clients, about three a second while a user speaks.
pub const PARTIAL: Topic =
    Topic { buffer: WINDOW, ..topic::<Partial>("speech/partial", Some(Service::Speech)) };
/// Grounding to policy.
pub const OBSERVATION: Topic = Topic {
    readers: &[Service::Policy],
    readers_max: SERVICES_MAX,
    buffer: WINDOW,
    history: WINDOW,
    ..topic::<Observation>("grounding/observation", Some(Service::Grounding))
};
/// Policy to speech.
pub const MARK: Topic = Topic {
    readers: &[Service::Speech],
    ..topic::<AppliedMark>("policy/mark", Some(Service::Policy))
};
/// Policy to speech and arm, and to the console, whose pages show it.
pub const ACT: Topic = Topic {
    readers: &[Service::Speech, Service::Arm, Service::Console],
    ..topic::<RobotAct>("policy/act", Some(Service::Policy))
};
/// Cameras and other sources, and clients, to policy.
pub const SIGHTING: Topic = Topic {
    readers: &[Service::Policy, Service::Recorder],
    writers_max: CLIENTS_MAX,
    readers_max: SERVICES_MAX,
    buffer: WINDOW,
    history: 0,
    ..topic::<Sighting>("scene/sightings", None)
};
/// Policy to arm and clients.
pub const OBJECTS: Topic = Topic {
    readers: &[Service::Arm],
    ..topic::<TableView>("scene/objects", Some(Service::Policy))
};
/// Clients to policy.
pub const FORGET: Topic = Topic {
    readers: &[Service::Policy],
    writers_max: CLIENTS_MAX,
    readers_max: SERVICES_MAX,
    history: 0,
    ..topic::<Forget>("policy/forget", None)
};
/// Policy to clients.
pub const VIEW: Topic = topic::<PolicyView>("policy/view", Some(Service::Policy));
/// Arm to policy and speech, and to the console, whose pages show it.
pub const STATUS: Topic = Topic {
    readers: &[Service::Policy, Service::Speech, Service::Console],
    ..topic::<ArmStatus>("arm/status", Some(Service::Arm))
};
/// Arm to clients, 100 Hz while it is busy, and to the ROS 2 node, which passes them on.
pub const JOINTS: Topic = Topic {
    readers: &[Service::Other("ros2")],
    buffer: WINDOW,
    // A motion may begin just after a look at a group at rest.
    recorded: 2 * RECORDED_FAST,
    ..topic::<JointStates>("arm/joints", Some(Service::Arm))
};
/// Arm to clients.
pub const WORLD: Topic = topic::<WorldView>("arm/world", Some(Service::Arm));
/// Arm to clients, when a motion begins, enters its next phase, or ends.
pub const TRAJECTORY: Topic = topic::<TrajectoryView>("arm/trajectory", Some(Service::Arm));

/// The topics between the arm and a Baxter, or its simulation.
pub mod robot {
    use super::*;
    use crate::robot::*;

    const fn command<T: Schema>(name: &'static str) -> Topic {
        let topic = topic::<T>(name, Some(Service::Arm));
        Topic { buffer: 4, recorded: RECORDED_FAST, history: 0, ..topic }
    }

    const fn measured<T: Schema>(name: &'static str) -> Topic {
        Topic { recorded: RECORDED_FAST, ..topic::<T>(name, Some(Service::Robot)) }
    }

    /// The robot is woken: the arm sends other commands before these, and gripper commands again.
    const fn woken(topic: Topic) -> Topic {
        Topic { readers: &[Service::Robot], ..topic }
    }

    /// Robot to arm, 100 Hz; each finger's joint in a message of its own.
    pub const JOINT_STATES: Topic = Topic {
        readers: &[Service::Arm],
        buffer: WINDOW,
        // Body and two fingers.
        recorded: 3 * RECORDED_FAST,
        readers_max: SERVICES_MAX,
        ..measured::<JointState>("robot/joint_states")
    };
    /// Robot to arm.
    pub const STATE: Topic = measured::<AssemblyState>("robot/state");
    /// Arm to robot, 100 Hz, left and right.
    pub const JOINT_COMMAND: [Topic; 2] = [
        woken(command::<JointCommand>("robot/limb/left/joint_command")),
        woken(command::<JointCommand>("robot/limb/right/joint_command")),
    ];
    /// Arm to robot while a limb moves, left and right.
    pub const INVERSE_DYNAMICS_COMMAND: [Topic; 2] = [
        command::<JointTrajectoryPoint>("robot/limb/left/inverse_dynamics_command"),
        command::<JointTrajectoryPoint>("robot/limb/right/inverse_dynamics_command"),
    ];
    /// Arm to robot, left and right.
    pub const SET_SPEED_RATIO: [Topic; 2] = [
        command::<SpeedRatio>("robot/limb/left/set_speed_ratio"),
        command::<SpeedRatio>("robot/limb/right/set_speed_ratio"),
    ];
    /// Robot to clients, 100 Hz, left and right.
    pub const ENDPOINT_STATE: [Topic; 2] = [
        measured::<EndpointState>("robot/limb/left/endpoint_state"),
        measured::<EndpointState>("robot/limb/right/endpoint_state"),
    ];
    /// Arm to robot, left and right.
    pub const GRIPPER_COMMAND: [Topic; 2] = [
        command::<EndEffectorCommand>("robot/end_effector/left_gripper/command"),
        command::<EndEffectorCommand>("robot/end_effector/right_gripper/command"),
    ];
    /// Robot to arm, left and right.
    pub const GRIPPER_STATE: [Topic; 2] = [
        measured::<EndEffectorState>("robot/end_effector/left_gripper/state"),
        measured::<EndEffectorState>("robot/end_effector/right_gripper/state"),
    ];
    /// Robot to arm, left and right.
    pub const GRIPPER_PROPERTIES: [Topic; 2] = [
        measured::<EndEffectorProperties>("robot/end_effector/left_gripper/properties"),
        measured::<EndEffectorProperties>("robot/end_effector/right_gripper/properties"),
    ];
    /// Clients to the simulated robot: actions of people on it, and faults.
    pub const DRILL: Topic = Topic {
        readers: &[Service::Robot],
        writers_max: CLIENTS_MAX,
        buffer: WINDOW,
        history: 0,
        ..topic::<Drill>("robot/drill", None)
    };

    /// All topics.
    pub const ALL: [Topic; 17] = [
        JOINT_STATES,
        STATE,
        JOINT_COMMAND[0],
        JOINT_COMMAND[1],
        INVERSE_DYNAMICS_COMMAND[0],
        INVERSE_DYNAMICS_COMMAND[1],
        SET_SPEED_RATIO[0],
        SET_SPEED_RATIO[1],
        ENDPOINT_STATE[0],
        ENDPOINT_STATE[1],
        GRIPPER_COMMAND[0],
        GRIPPER_COMMAND[1],
        GRIPPER_STATE[0],
        GRIPPER_STATE[1],
        GRIPPER_PROPERTIES[0],
        GRIPPER_PROPERTIES[1],
        DRILL,
    ];
}

/// Every topic that the group's services and clients share, but for those of [`robot`], which are
/// only used with a robot behind them.
pub const ALL: [Topic; 19] = [
    INJECTION,
    AUDIO,
    RECEIPT,
    UTTERANCE,
    PRESENTED,
    ACTIVITY,
    HEARING,
    PARTIAL,
    OBSERVATION,
    MARK,
    ACT,
    SIGHTING,
    OBJECTS,
    FORGET,
    VIEW,
    STATUS,
    JOINTS,
    WORLD,
    TRAJECTORY,
];

/// Returns the services that are woken by some topic.
pub fn woken() -> Vec<Service> {
    let mut services: Vec<Service> = Vec::new();
    for service in ALL.iter().chain(&robot::ALL).flat_map(|topic| topic.readers) {
        if !services.contains(service) {
            services.push(*service);
        }
    }
    services
}
