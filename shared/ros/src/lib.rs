//! What the parts for ROS 1 and ROS 2 share: names, settings of detectors, and the messages that both have.

pub mod clock;
pub mod detector;
pub mod detectors;
pub mod geometry;
pub mod rotation;
pub mod wire;

/// Returns whether a text is a name of ROS without slashes. Two underscores side by side are reserved.
pub fn is_name(text: &str) -> bool {
    let begins = text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    let is_plain = text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    begins && is_plain && !text.contains("__") && text.len() <= 64
}
