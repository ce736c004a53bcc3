//! "Did you mean".

/// Returns help for a name that is not among `known`: the nearest one, else `otherwise`.
pub fn suggestion<'a>(
    wrong: &str,
    known: impl IntoIterator<Item = &'a str>,
    otherwise: impl FnOnce() -> String,
) -> String {
    nearest(wrong, known).map_or_else(otherwise, |near| format!("did you mean `{near}`?"))
}

/// Returns the known name within a few typing errors of `wrong`: a third of its letters, at most
/// four. Case, hyphens and underscores do not count.
pub fn nearest<'a>(wrong: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wrong = plain(wrong);
    let allowed = (wrong.chars().count() / 3).min(4);
    known
        .into_iter()
        .map(|name| (strsim::osa_distance(&wrong, &plain(name)), name))
        .min_by_key(|(distance, _)| *distance)
        .filter(|(distance, _)| *distance <= allowed)
        .map(|(_, name)| name)
}

fn plain(name: &str) -> String {
    name.to_lowercase().replace('-', "_")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn typing_errors_are_recognised_and_other_names_are_not() {
        let known = ["speed_ratio", "time_scale", "limb"];
        for (wrong, expected) in [
            ("speed-ratio", Some("speed_ratio")),
            ("sped_ratio", Some("speed_ratio")),
            ("Time_Scale", Some("time_scale")),
            ("ilmb", Some("limb")),
            ("voice", None),
            ("", None),
        ] {
            assert_eq!(nearest(wrong, known), expected, "{wrong}");
        }
        assert_eq!(suggestion("voice", known, || "use another".to_owned()), "use another");
        assert_eq!(suggestion("Limb", known, String::new), "did you mean `limb`?");
    }
}
