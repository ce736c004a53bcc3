//! Sentence shapes of people talking to the robot, with slots that the scene fills.

/// Returns the sentence shapes by weight, in the order of `templates.txt`.
pub(super) fn shapes() -> Vec<(u32, Vec<&'static str>)> {
    let lines = include_str!("templates.txt").lines();
    let groups = lines.filter_map(|line| line.split_once(": ").filter(|_| !line.starts_with('#')));
    let weighted = groups
        .filter_map(|(weight, shapes)| Some((weight.parse().ok()?, shapes.split(" | ").collect())));
    weighted.collect()
}

/// Shapes that contain every word of every value at least once, whatever its part of speech.
pub(super) const COVERAGE: &[&str] = &[
    "{value}",
    "the {value}",
    "the {value} one",
    "the {value} {noun}",
    "get me the {value} {noun}",
    "yes the {value} one",
    "no the {value} one",
    "not the {value} one",
    "it is {value}",
    "from the {value}",
    "in the {value}",
    "on the {value}",
];

/// First words of a phrase of place ([`scene::Value::spoken`]: "in the dishwasher").
pub(super) const PREPOSITIONS: &[&str] =
    &["in", "on", "at", "from", "under", "inside", "behind", "near", "beside", "by", "next"];
