//! "Did you mean …?"

/// The cure for a name that is not among `known`: the nearest one, else the list.
pub(crate) fn cure(wrong: &str, known: &[&str]) -> String {
    match nearest(wrong, known) {
        Some(near) => format!("did you mean `{near}`?"),
        None if known.is_empty() => "there is none".to_owned(),
        None => format!("use one of {}", known.join(", ")),
    }
}

/// The known name that `wrong` is a slip of the fingers away from.
pub(crate) fn nearest<'a>(wrong: &str, known: &[&'a str]) -> Option<&'a str> {
    let wrong = plain(wrong);
    let distance = |name: &str| strsim::osa_distance(&wrong, &plain(name));
    let (near, distance) =
        known.iter().map(|name| (*name, distance(name))).min_by_key(|(_, distance)| *distance)?;
    let allowed = (wrong.chars().count() / 3).clamp(1, 4);
    (distance <= allowed).then_some(near)
}

/// Hyphens, underscores and upper case are the commonest slips and cost nothing here.
fn plain(name: &str) -> String {
    name.to_lowercase().replace('-', "_")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_recognised_and_strangers_are_not() {
        let known = ["speed_ratio", "time_scale", "limb"];
        assert_eq!(nearest("speed-ratio", &known), Some("speed_ratio"));
        assert_eq!(nearest("sped_ratio", &known), Some("speed_ratio"));
        assert_eq!(nearest("Time_Scale", &known), Some("time_scale"));
        assert_eq!(nearest("ilmb", &known), Some("limb"));
        assert_eq!(nearest("voice", &known), None);
        assert_eq!(cure("voice", &known), "use one of speed_ratio, time_scale, limb");
        assert_eq!(cure("x", &[]), "there is none");
    }
}
