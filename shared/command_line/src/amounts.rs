//! Rendering of amounts.

/// A length of time, e.g. `340 ms`, `12.3 s`, `4 min`, `3 h 20 min`, `2 d 5 h`.
pub fn time(seconds: f64) -> String {
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
pub fn memory(kib: u64) -> String {
    let mib = kib as f64 / 1024.0;
    if mib < 1024.0 { format!("{mib:.1} MiB") } else { format!("{:.1} GiB", mib / 1024.0) }
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
    fn amounts_have_units() {
        assert_eq!((memory(3482), memory(2 << 20)), ("3.4 MiB".into(), "2.0 GiB".into()));
    }
}
