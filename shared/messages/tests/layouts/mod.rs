//! Every message type of the topics, by name: listed in the golden file and the generated bindings.

use messages::robot::*;
use messages::schema::{Field, Schema};
use messages::*;

/// Name, size, key and fields of a message type.
pub(crate) struct Layout {
    /// Name on the wire.
    pub(crate) name: &'static str,
    /// Name of the type in Rust, by which fields of other messages refer to it.
    #[allow(dead_code, reason = "only one of the tests that share this file uses it")]
    pub(crate) rust: &'static str,
    /// Bytes; 0 for an encoded payload.
    pub(crate) size: usize,
    /// Structural key.
    pub(crate) key: String,
    /// Fields in order; of a payload, the types in it.
    pub(crate) fields: Vec<Field>,
}

macro_rules! layouts {
    ($($message:ident),+ $(,)?) => {
        vec![$(Layout {
            name: <$message>::NAME,
            rust: stringify!($message),
            size: <$message>::layout().map_or(0, |layout| layout.size),
            key: <$message>::key().to_string(),
            fields: <$message>::fields(),
        }),+]
    };
}

/// Messages of fixed layout, those first that others contain.
pub(crate) fn structs() -> Vec<Layout> {
    layouts![
        Stamp,
        WireQuestion,
        WireGesture,
        AskedQuestion,
        WireHypothesis,
        WireReading,
        Utterance,
        Observation,
        AppliedMark,
        Forget,
        RobotAct,
        Presented,
        Activity,
        Hearing,
        Partial,
        AudioChunk,
        Receipt,
        ArmStatus,
        JointStates,
        JointCommand,
        JointState,
        JointTrajectoryPoint,
        SpeedRatio,
        EndpointState,
        EndEffectorCommand,
        EndEffectorState,
        EndEffectorProperties,
        AssemblyState,
        Drill,
    ]
}

/// Payloads in postcard.
pub(crate) fn payloads() -> Vec<Layout> {
    layouts![Injection, PolicyView, WorldView, TrajectoryView]
}

/// Payloads that the golden file does not list yet.
#[allow(dead_code, reason = "only one of the tests that share this file uses it")]
pub(crate) fn payloads_of_perception() -> Vec<Layout> {
    layouts![Sighting, TableView]
}
