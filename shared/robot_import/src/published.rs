//! A published SRDF: what of it is of use is compared, what is wrong in it is reported and does no harm.

use std::collections::BTreeSet;

use roxmltree::Document;

use crate::pairs::Pair;
use crate::report::Findings;
use crate::source::Source;

/// Returns the pairs that may touch by an SRDF.
pub(crate) fn pairs(text: &str, source: &Source, findings: &mut Findings) -> BTreeSet<Pair> {
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let document = match Document::parse(text) {
        Ok(document) => document,
        Err(error) => {
            findings.ignored(format!("the SRDF, which is not XML: {error}"));
            return BTreeSet::new();
        }
    };
    let root = document.root_element();
    if root.attribute("name").is_some_and(|name| name != source.name) {
        let name = root.attribute("name").unwrap_or_default();
        findings.ignored(format!("the SRDF's name {name:?}: the URDF describes {:?}", source.name));
    }
    for state in root.children().filter(|it| it.has_tag_name("group_state")) {
        let name = state.attribute("name").unwrap_or_default();
        if let Some(why) = fault(source, state) {
            findings.ignored(format!("posture {name:?} of the SRDF: {why}"));
        }
    }
    let mut unknown = 0;
    let mut pairs = BTreeSet::new();
    for pair in root.children().filter(|it| it.has_tag_name("disable_collisions")) {
        let end = |key| pair.attribute(key).and_then(|name| source.link(name));
        match (end("link1"), end("link2")) {
            (Some(a), Some(b)) => drop(pairs.insert((a.min(b), a.max(b)))),
            _ => unknown += 1,
        }
    }
    if unknown > 0 {
        findings.ignored(format!("{unknown} pairs of the SRDF that name links the URDF lacks"));
    }
    pairs
}

fn fault(source: &Source, state: roxmltree::Node<'_, '_>) -> Option<String> {
    if state.attribute("group").is_none() {
        return Some("it names no group".to_owned());
    }
    state.children().filter(|it| it.has_tag_name("joint")).find_map(|entry| {
        let name = entry.attribute("name").unwrap_or_default();
        let Some(joint) = source.joints.iter().find(|joint| joint.name == name) else {
            return Some(format!("the robot has no joint {name:?}"));
        };
        let at: f64 = entry.attribute("value")?.split_whitespace().next()?.parse().ok()?;
        let (low, high) = joint.range.filter(|(low, high)| low < high)?;
        let outside = at < low - 1e-9 || at > high + 1e-9;
        outside.then(|| format!("joint {name} is at {at}, outside its limits {low} to {high}"))
    })
}
