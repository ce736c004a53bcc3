//! Rendering of values and conditions.

pub(super) use command_line::amounts::{memory, time};
use messages::MotionInhibit;

/// Returns the condition that inhibits motion, if any.
pub(super) fn hindrance(hindrance: MotionInhibit) -> Option<&'static str> {
    match hindrance {
        MotionInhibit::None => None,
        MotionInhibit::Stopped => Some("the robot's emergency stop holds"),
        MotionInhibit::Error => Some("the robot has a fault"),
        MotionInhibit::Disabled => Some("the robot is disabled"),
        MotionInhibit::Unheard => Some("the robot is not heard"),
        MotionInhibit::Stale => Some("the robot's joint states are too old"),
        MotionInhibit::Gripper => Some("a gripper has a fault"),
        MotionInhibit::Calibrating => Some("a gripper is being calibrated"),
    }
}

/// Renders the value of a decision and the bounds of the best one, e.g. `value 33.97, best
/// 33.97 to 33.98`.
pub(super) fn value(value: f64, bounds: Option<(f64, f64)>) -> String {
    let bounds = bounds.map(|(low, high)| format!(", best {low:.2} to {high:.2}"));
    format!("value {value:.2}{}", bounds.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_rendered_with_bounds() {
        assert_eq!(value(12.5, None), "value 12.50");
        assert_eq!(value(-1.0, Some((-1.0, 2.255))), "value -1.00, best -1.00 to 2.25");
    }
}
