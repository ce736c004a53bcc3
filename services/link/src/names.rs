//! The keys under which a robot is found, by its name.

use roster::Name;

/// First part of every key.
const ROOT: &str = "whichone";

/// The keys of one robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Keys(String);

/// A request to a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Call {
    /// Content of a list of robots.
    Presence,
    /// First message to a mirror.
    Hello,
    /// Sound of one of the robot's lines.
    Line,
    /// Words of a person.
    Say,
    /// An order to the motion stop.
    Motion,
}

impl Call {
    /// Every one.
    pub const ALL: [Self; 5] = [Self::Presence, Self::Hello, Self::Line, Self::Say, Self::Motion];

    /// Returns the last part of the key.
    pub fn name(self) -> &'static str {
        match self {
            Self::Presence => "presence",
            Self::Hello => "hello",
            Self::Line => "line",
            Self::Say => "say",
            Self::Motion => "motion",
        }
    }

    /// Returns whether it only reads, so that a viewer may make it.
    pub fn only_reads(self) -> bool {
        matches!(self, Self::Presence | Self::Hello | Self::Line)
    }
}

impl Keys {
    /// The keys of `robot`.
    pub fn of(robot: &Name) -> Self {
        Self(format!("{ROOT}/{robot}"))
    }

    /// The keys of every robot.
    pub fn of_all() -> Self {
        Self(format!("{ROOT}/*"))
    }

    /// Returns the pattern of all keys of the robot.
    pub fn all(&self) -> String {
        format!("{}/**", self.0)
    }

    /// A state: a topic by its name, `group` or `motion`.
    pub fn state(&self, name: &str) -> String {
        format!("{}/state/{name}", self.0)
    }

    /// Joint states.
    pub fn joints(&self) -> String {
        format!("{}/joints", self.0)
    }

    /// Returns the key of the robot's presence.
    pub fn presence(&self) -> String {
        format!("{}/presence", self.0)
    }

    /// Token while the link runs; `start` is its number ([`crate::frame::Frame::start`]).
    pub fn alive(&self, start: &str) -> String {
        format!("{}/alive/{start}", self.0)
    }

    /// A request.
    pub fn call(&self, call: Call) -> String {
        format!("{}/call/{}", self.0, call.name())
    }

    /// Every request.
    pub fn calls(&self) -> String {
        format!("{}/call/*", self.0)
    }

    /// Returns the key of the sound of new lines.
    pub fn line(&self) -> String {
        format!("{}/line", self.0)
    }

    /// Sound that a person streams to the robot.
    pub fn audio(&self) -> String {
        format!("{}/audio", self.0)
    }

    /// Returns the state's name in a key of this robot.
    pub fn state_of<'a>(&self, key: &'a str) -> Option<&'a str> {
        key.strip_prefix(&self.0)?.strip_prefix("/state/")
    }
}

/// Returns the request in a key, which may be one of every robot.
pub fn call_of(key: &str) -> Option<Call> {
    let (_, name) = key.split_once("/call/")?;
    Call::ALL.into_iter().find(|call| call.name() == name)
}

/// Returns the robot in a key.
pub fn robot_of(key: &str) -> Option<Name> {
    let mut parts = key.split('/');
    (parts.next() == Some(ROOT)).then(|| Name::new(parts.next()?).ok())?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_name_their_robot_and_state() {
        let keys = Keys::of(&Name::new("r1").unwrap());
        assert_eq!(keys.state_of(&keys.state("policy/view")), Some("policy/view"));
        assert_eq!(keys.state_of(&keys.joints()), None);
        assert_eq!(keys.state_of("whichone/r10/state/group"), None);
        assert_eq!(robot_of(&keys.alive("7")).unwrap().as_str(), "r1");
        assert_eq!(robot_of("other/r1/presence"), None);
    }
}
