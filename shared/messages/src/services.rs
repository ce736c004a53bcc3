//! The services of a group.

/// Name of the process that starts the services, reserved for it.
pub const SUPERVISOR: &str = "supervisor";

/// A service whose program `whichone-NAME` ships with the others. Groups may have more services, which
/// need a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Service {
    /// Recognises and synthesises speech.
    Speech,
    /// Interprets utterances.
    Grounding,
    /// Tracks the belief and decides.
    Policy,
    /// Moves the arm.
    Arm,
    /// Serves the web page.
    Console,
    /// Records every topic; an observer, which the others do without.
    Recorder,
    /// Simulates a Baxter behind the robot's topics; optional.
    Robot,
    /// Presents the group as a ROS 2 node; optional.
    Ros2,
    /// Links the group to operators elsewhere; optional.
    Link,
}

impl Service {
    /// Services of every group, in the order in which they are listed.
    pub const BUILT_IN: [Self; 6] =
        [Self::Speech, Self::Grounding, Self::Policy, Self::Arm, Self::Console, Self::Recorder];

    /// Services that a dialogue needs.
    pub const DIALOGUE: [Self; 4] = [Self::Speech, Self::Grounding, Self::Policy, Self::Arm];

    /// Services that keep a journal.
    pub const JOURNALED: [Self; 3] = [Self::Speech, Self::Policy, Self::Arm];

    /// Its name in configuration, journals and status.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Speech => "speech",
            Self::Grounding => "grounding",
            Self::Policy => "policy",
            Self::Arm => "arm",
            Self::Console => "console",
            Self::Recorder => "recorder",
            Self::Robot => "baxter",
            Self::Ros2 => "ros2",
            Self::Link => "link",
        }
    }

    /// Returns the service with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::BUILT_IN
            .into_iter()
            .chain([Self::Robot, Self::Ros2, Self::Link])
            .find(|service| service.name() == name)
    }
}
