//! Choices of the owner.

/// The gripper that is wanted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Gripper {
    /// The one that is found.
    #[default]
    Found,
    /// The one whose fingers this link carries.
    Link(String),
    /// None: two fingers are assumed on the flange.
    None,
}

/// Choices of the owner.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Name of the robot, of its files and of its profile.
    pub name: String,
    /// Link that the arm hangs on.
    pub base: Option<String>,
    /// Link at the end of the arm.
    pub tip: Option<String>,
    /// Gripper.
    pub gripper: Gripper,
    /// Distance between the open fingers, metres.
    pub open_m: Option<f64>,
    /// SRDF to compare with; the one beside the file by default.
    pub srdf: Option<std::path::PathBuf>,
}
