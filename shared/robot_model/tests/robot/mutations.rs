//! Arbitrary text: reading returns a robot or diagnostics.

use robot_model::{BAXTER_SRDF, BAXTER_URDF, JointKind, Robot};

use crate::samples::{Random, fixture};

/// Insertions: meaningful text in the wrong place.
const PIECES: [&str; 24] = [
    "<",
    ">",
    "/>",
    "\"",
    "&",
    "&amp;",
    "<!--",
    "-->",
    "]]>",
    "nan",
    "inf",
    "-1",
    "1e999",
    "0",
    "name=\"base\"",
    "<link/>",
    "<joint/>",
    "</robot>",
    "<mimic joint=\"left_s0\"/>",
    "\u{0}",
    "\u{fe0f}",
    "<origin/>",
    "type=\"fixed\"",
    "<limit lower=\"1\"/>",
];

/// The text with one to three changes: most swap what stands between two pairs of quotes or whole
/// lines, which leaves XML that says something else; the others break into it anywhere.
fn mutated(text: &str, random: &mut Random) -> String {
    let mut text = text.to_owned();
    for _ in 0..=random.below(3) {
        text = match random.below(8) {
            0..3 => swapped(&text, "\"", random),
            3..6 => swapped(&text, "\n", random),
            6 => replaced(&text, random),
            _ => broken(&text, random),
        };
    }
    text
}

/// Two of the parts between separators change places.
fn swapped(text: &str, separator: &str, random: &mut Random) -> String {
    let mut parts: Vec<&str> = text.split(separator).collect();
    // Every other part lies between quotes.
    let [a, b] = [(); 2].map(|()| random.below(parts.len()) | 1).map(|i| i.min(parts.len() - 1));
    parts.swap(a, b);
    parts.join(separator)
}

/// Another value stands between a pair of quotes.
fn replaced(text: &str, random: &mut Random) -> String {
    let mut parts: Vec<&str> = text.split('"').collect();
    let at = (random.below(parts.len()) | 1).min(parts.len() - 1);
    parts[at] = PIECES[random.below(PIECES.len())];
    parts.join("\"")
}

/// A few characters are removed, doubled or replaced, or the rest is cut off.
fn broken(text: &str, random: &mut Random) -> String {
    let mut text: Vec<char> = text.chars().collect();
    let from = random.below(text.len());
    let to = (from + random.below(40)).min(text.len());
    match random.below(4) {
        0 => drop(text.drain(from..to)),
        1 => {
            let part = text[from..to].to_vec();
            let at = random.below(text.len());
            text.splice(at..at, part);
        }
        2 => drop(text.splice(from..to, PIECES[random.below(PIECES.len())].chars())),
        _ => text.truncate(from),
    }
    text.into_iter().collect()
}

/// Checks the invariants of a robot.
fn check(robot: &Robot) {
    assert_eq!(robot.links().len(), robot.joints().len() + 1);
    for (i, joint) in robot.joints().iter().enumerate() {
        assert_eq!(joint.child, i + 1);
        assert!(joint.parent <= i);
        assert!((joint.axis.norm() - 1.0).abs() < 1e-12);
        let bounded = matches!(joint.kind, JointKind::Revolute | JointKind::Prismatic);
        assert!(joint.limits.is_some() || !bounded);
        assert!(joint.limits.is_none_or(|l| l.lower <= l.upper && l.velocity >= 0.0));
        assert!(joint.mimic.is_none_or(|rule| {
            let followed = &robot.joints()[rule.joint];
            followed.kind != JointKind::Fixed && followed.mimic.is_none()
        }));
    }
    assert_eq!(robot.poses(|_| 0.3).len(), robot.links().len());
    let last = &robot.links()[robot.links().len() - 1].name;
    let chain = robot.chain(last).unwrap();
    let q = vec![0.3; chain.movable().len()];
    chain.forward(&q);
}

/// Counts the mutated texts that still describe a robot.
fn survivors(urdf: &str, srdf: Option<&str>, seeds: std::ops::Range<u64>) -> usize {
    let mut good = 0;
    for seed in seeds {
        let mut random = Random::seeded(seed);
        let (urdf, srdf) = match srdf {
            Some(srdf) if random.below(2) == 0 => {
                (urdf.to_owned(), Some(mutated(srdf, &mut random)))
            }
            _ => (mutated(urdf, &mut random), srdf.map(str::to_owned)),
        };
        let result = std::panic::catch_unwind(|| match Robot::parse(&urdf, srdf.as_deref()) {
            Ok(robot) => {
                check(&robot);
                true
            }
            Err(faults) => {
                assert!(faults.iter().count() > 0);
                for fault in faults.iter() {
                    assert!(
                        fault.line > Some(0) && !fault.help.is_empty() && !fault.what.is_empty()
                    );
                }
                false
            }
        });
        good += usize::from(result.unwrap_or_else(|_| panic!("seed {seed}")));
    }
    good
}

#[test]
fn mutated_files_never_panic() {
    let seven = fixture("robots/seven_joints.urdf");
    let good = survivors(&seven, None, 0..4000);
    assert!((100..3900).contains(&good), "{good} of 4000 survive: the mutations test little");
    let good = survivors(BAXTER_URDF, Some(BAXTER_SRDF), 10_000..10_300);
    assert!((10..290).contains(&good), "{good} of 300 survive: the mutations test little");
}

#[test]
fn long_chains_are_read_and_deep_files_rejected() {
    let n = 3000;
    let mut text = String::from("<robot name=\"snake\"><link name=\"l0\"/>");
    for i in 0..n {
        text += &format!(
            "<link name=\"l{}\"/><joint name=\"j{i}\" type=\"continuous\"><parent link=\"l{i}\"/>\
             <child link=\"l{}\"/></joint>",
            i + 1,
            i + 1
        );
    }
    let robot = Robot::parse(&(text + "</robot>"), None).unwrap();
    assert_eq!(robot.chain(&format!("l{n}")).unwrap().movable().len(), n);
    let deep = format!("<robot name=\"x\">{}", "<a>".repeat(100_000));
    assert!(Robot::parse(&deep, None).is_err());
    let deep = format!("<robot name=\"x\">{}{}</robot>", "<a>".repeat(5_000), "</a>".repeat(5_000));
    assert!(Robot::parse(&deep, None).is_err());
}

#[test]
fn entity_expansion_is_rejected() {
    let text = "<!DOCTYPE r [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;\">]>\
                <robot name=\"&b;\"/>";
    let faults = Robot::parse(text, None).unwrap_err();
    assert!(faults.to_string().contains("DTD"), "{faults}");
}
