//! Wall-clock moments as text: nanoseconds since 1970, UTC.

/// Nanoseconds of a second.
const SECOND: u64 = 1_000_000_000;

/// Returns a moment as text, e.g. `2026-11-25T10:08:19.250Z`.
pub fn text(wall_ns: u64) -> String {
    let (s, ms) = (wall_ns / SECOND, wall_ns % SECOND / 1_000_000);
    let (year, month, day) = civil(s / 86_400);
    let (hour, minute, second) = (s / 3600 % 24, s / 60 % 60, s % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{ms:03}Z")
}

/// Nanoseconds since 1970 of a moment such as `2026-11-25T10:08:19.250Z`, with any number of
/// decimals and any mark between the numbers; `None` if the text is not a time.
pub fn parse(text: &str) -> Option<u64> {
    let number = |range: std::ops::Range<usize>| text.get(range)?.parse::<u64>().ok();
    let (year, month, day) = (number(0..4)?, number(5..7)?, number(8..10)?);
    let (hour, minute, second) = (number(11..13)?, number(14..16)?, number(17..19)?);
    let is_date = (1970..10_000).contains(&year) && (1..=12).contains(&month);
    let decimals = text.get(19..)?.strip_prefix('.')?.strip_suffix('Z')?;
    let fraction = format!("{decimals:0<9}").get(..9)?.parse::<u64>().ok()?;
    let s = days(year, month, day) * 86_400 + hour * 3600 + minute * 60 + second;
    (is_date && day > 0).then(|| s * SECOND + fraction)
}

/// Year, month and day of the Gregorian calendar, days after 1970-01-01. Years begin in March here,
/// so that the leap day is the last one.
fn civil(days: u64) -> (u64, u64, u64) {
    let days = days + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let (day, month) =
        (day - (153 * month + 2) / 5 + 1, if month < 10 { month + 3 } else { month - 9 });
    (era * 400 + year + u64::from(month <= 2), month, day)
}

/// Days of a date after 1970-01-01.
fn days(year: u64, month: u64, day: u64) -> u64 {
    let year = year - u64::from(month <= 2);
    let month = if month > 2 { month - 3 } else { month + 9 };
    let of_year = (153 * month + 2) / 5 + day.max(1) - 1;
    let (era, year) = (year / 400, year % 400);
    era * 146_097 + year * 365 + year / 4 - year / 100 + of_year - 719_468
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_read_back() {
        assert_eq!(text(0), "1970-01-01T00:00:00.000Z");
        assert_eq!(text(4_107_542_400 * SECOND), "2100-03-01T00:00:00.000Z");
        assert_eq!(text(1_764_065_299_250_000_000), "2025-11-25T10:08:19.250Z");
        assert_eq!(parse("2025-11-25T10:08:19.250Z"), Some(1_764_065_299_250_000_000));
        assert_eq!(parse("2000-02-29T23:59:59.999999Z"), Some(951_868_799_999_999_000));
        for day in 0..40_000 {
            let at = (day * 86_400 + 7) * SECOND;
            assert_eq!(parse(&text(at)), Some(at));
        }
        for wrong in ["", "2025-11-25", "2025-13-25T10:08:19.250Z", "2025-11-25T10:08:19", "ä"] {
            assert_eq!(parse(wrong), None, "{wrong}");
        }
    }
}
