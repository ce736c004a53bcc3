//! Rendering of amounts and conditions.

use messages::MotionInhibit;

/// A length of time, e.g. `340 ms`, `12.3 s`, `4 min`, `3 h 20 min`, `2 d 5 h`.
pub(super) fn time(seconds: f64) -> String {
    let whole = seconds.max(0.0).round() as u64;
    let (minutes, hours, days) = (whole / 60, whole / 3600, whole / 86_400);
    match whole {
        _ if seconds < 0.9995 => format!("{:.0} ms", seconds.max(0.0) * 1e3),
        _ if seconds < 59.95 => format!("{seconds:.1} s"),
        _ if hours < 1 => format!("{minutes} min {} s", whole % 60),
        _ if days < 1 => format!("{hours} h {} min", minutes % 60),
        _ => format!("{days} d {} h", hours % 24),
    }
}

/// Memory given in KiB, e.g. `3.4 MiB`.
pub(super) fn memory(kib: u64) -> String {
    let mib = kib as f64 / 1024.0;
    if mib < 1024.0 { format!("{mib:.1} MiB") } else { format!("{:.1} GiB", mib / 1024.0) }
}

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
    fn times_are_as_precise_as_they_need_to_be() {
        let rendered = [
            (-1.0, "0 ms"),
            (0.34, "340 ms"),
            (0.9996, "1.0 s"),
            (12.34, "12.3 s"),
            (59.97, "1 min 0 s"),
            (61.0, "1 min 1 s"),
            (3_660.0, "1 h 1 min"),
            (200_000.0, "2 d 7 h"),
        ];
        for (seconds, words) in rendered {
            assert_eq!(time(seconds), words);
        }
    }

    #[test]
    fn values_are_rendered_with_bounds() {
        assert_eq!(value(12.5, None), "value 12.50");
        assert_eq!(value(-1.0, Some((-1.0, 2.255))), "value -1.00, best -1.00 to 2.25");
    }

    #[test]
    fn amounts_have_units() {
        assert_eq!((memory(3482), memory(2 << 20)), ("3.4 MiB".into(), "2.0 GiB".into()));
    }
}
