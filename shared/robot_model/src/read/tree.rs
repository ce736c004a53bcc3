//! The tree of links and joints.

use std::collections::HashMap;

use diagnostics::suggestion;

use crate::model::{Joint, JointKind, Link, Mimic, Robot};

use super::element::{Element, Log};
use super::joint::Written;

type Links<'a> = Vec<(Link, Element<'a>)>;

/// Returns the robot, links parents first; reports a description that is not one tree.
pub(super) fn build(
    log: &Log<'_>,
    name: String,
    links: Links<'_>,
    joints: Vec<Written<'_>>,
) -> Option<Robot> {
    let before = log.count();
    let places = indices(links.iter().map(|(link, element)| (link.name.as_str(), element)));
    let names = indices(joints.iter().map(|joint| (joint.name, &joint.element)));
    let carriers = carriers(&places, links.len(), &joints);
    let rules = rules(&names, &joints);
    let named =
        |joint: &Written<'_>| places.contains_key(joint.parent) && places.contains_key(joint.child);
    // Unknown and missing names would be reported again as loose ends.
    if log.count() > before || links.is_empty() || !joints.iter().all(named) {
        return None;
    }
    let order = order(log, &links, &joints, &carriers, &places)?;
    Some(assembled(name, links, joints, &order, &rules, &places))
}

/// Returns the index of every name; reports duplicates.
fn indices<'n, 'a: 'n>(
    all: impl Iterator<Item = (&'n str, &'n Element<'a>)>,
) -> HashMap<String, usize> {
    let mut places = HashMap::new();
    for (index, (name, element)) in all.enumerate() {
        if !name.is_empty() && places.insert(name.to_owned(), index).is_some() {
            element.problem("its name is used twice", "rename one of them");
        }
    }
    places
}

/// The joint that carries each link.
fn carriers(
    places: &HashMap<String, usize>,
    links: usize,
    joints: &[Written<'_>],
) -> Vec<Option<usize>> {
    let mut carriers: Vec<Option<usize>> = vec![None; links];
    for (index, joint) in joints.iter().enumerate() {
        for (which, name) in [("parent", joint.parent), ("child", joint.child)] {
            if !name.is_empty() && !places.contains_key(name) {
                let what = format!("its {which} {name:?} is not a link");
                let otherwise = format!("describe <link name={name:?}/>, or correct the name");
                let help =
                    suggestion(name, places.keys().map(String::as_str), || otherwise.to_owned());
                joint.element.problem(what, help);
            }
        }
        let Some(&child) = places.get(joint.child) else { continue };
        if let Some(other) = carriers[child].replace(index) {
            let what = format!(
                "its child {:?} is already carried by {}",
                joint.child, joints[other].element.label
            );
            joint.element.problem(what, "a link has one parent: remove one joint");
        }
    }
    carriers
}

/// Returns for each joint the rule by which it follows another, chained rules combined.
fn rules(names: &HashMap<String, usize>, joints: &[Written<'_>]) -> Vec<Option<Mimic>> {
    let mut rules = Vec::with_capacity(joints.len());
    for (start, joint) in joints.iter().enumerate() {
        let mut rule = Mimic { joint: start, multiplier: 1.0, offset: 0.0 };
        let mut what = None;
        let mut help = "name a joint that mimics no other".to_owned();
        for _ in 0..=joints.len() {
            let Some(next) = joints[rule.joint].mimic else { break };
            let Some(&followed) = names.get(next.joint) else {
                // An end that another joint names wrongly is reported at that joint.
                if rule.joint == start && !next.joint.is_empty() {
                    what = Some(format!("it mimics {:?}, which is not a joint", next.joint));
                    let others =
                        names.keys().map(String::as_str).filter(|name| *name != joint.name);
                    help = suggestion(next.joint, others, || help.to_owned());
                }
                break;
            };
            rule = Mimic {
                joint: followed,
                multiplier: rule.multiplier * next.multiplier,
                offset: rule.multiplier * next.offset + rule.offset,
            };
            if followed == start {
                what = Some("it mimics itself through other joints".to_owned());
                break;
            }
        }
        if rule.joint != start && joints[rule.joint].kind == JointKind::Fixed {
            let followed = joints[rule.joint].name;
            what = Some(format!("it mimics {followed:?}, which does not move"));
        }
        if let Some(what) = what {
            joint.element.problem(what, help);
        }
        rules.push(joint.mimic.map(|_| rule));
    }
    rules
}

/// Returns the links from the root outwards, children in the order of the file; reports links that are
/// not part of one tree.
fn order(
    log: &Log<'_>,
    links: &Links<'_>,
    joints: &[Written<'_>],
    carriers: &[Option<usize>],
    places: &HashMap<String, usize>,
) -> Option<Vec<usize>> {
    let before = log.count();
    let roots: Vec<usize> = (0..links.len()).filter(|&link| carriers[link].is_none()).collect();
    if let [first, _, ..] = roots[..] {
        for &loose in &roots[1..] {
            let element = &links[loose].1;
            let what = format!("no joint carries it, nor link {:?}", links[first].0.name);
            let help = "a robot has one root: join this link to another with a <joint>";
            element.problem(what, help);
        }
    }
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); links.len()];
    for joint in joints {
        children[places[joint.parent]].push(places[joint.child]);
    }
    let mut order = Vec::with_capacity(links.len());
    let mut reached = vec![false; links.len()];
    let mut waiting: Vec<usize> = roots.into_iter().rev().collect();
    while let Some(link) = waiting.pop() {
        reached[link] = true;
        order.push(link);
        waiting.extend(children[link].iter().rev());
    }
    for start in 0..links.len() {
        if !reached[start] {
            loop_from(start, joints, carriers, places, &mut reached);
        }
    }
    (log.count() == before).then_some(order)
}

/// Reports the loop above a link without a root, once per loop.
fn loop_from(
    start: usize,
    joints: &[Written<'_>],
    carriers: &[Option<usize>],
    places: &HashMap<String, usize>,
    seen: &mut [bool],
) {
    let mut way = Vec::new();
    let mut at = start;
    while !seen[at] {
        seen[at] = true;
        let Some(joint) = carriers[at] else { return };
        way.push(joint);
        at = places[joints[joint].parent];
    }
    // A way that ends in a link that it did not pass leads into a reported loop.
    let Some(first) = way.iter().position(|&joint| places[joints[joint].child] == at) else {
        return;
    };
    let members = &way[first..];
    let joint = &joints[members[0]];
    let what = match members {
        [_] => format!("it joins {:?} to itself", joint.child),
        _ => {
            let names: Vec<&str> = members.iter().rev().map(|&m| joints[m].name).collect();
            format!("the joints {} form a loop", names.join(", "))
        }
    };
    joint.element.problem(what, "links must form a tree: give it another parent");
}

fn assembled(
    name: String,
    links: Links<'_>,
    joints: Vec<Written<'_>>,
    order: &[usize],
    rules: &[Option<Mimic>],
    places: &HashMap<String, usize>,
) -> Robot {
    let mut place = vec![0; links.len()];
    for (new, &old) in order.iter().enumerate() {
        place[old] = new;
    }
    let new_link = |name: &str| place[places[name]];
    // A joint's new place is that of its child, less the root.
    let new_joint = |old: usize| new_link(joints[old].child) - 1;
    let mut ordered: Vec<Joint> = joints
        .iter()
        .zip(rules)
        .map(|(joint, rule)| Joint {
            name: joint.name.to_owned(),
            kind: joint.kind,
            parent: new_link(joint.parent),
            child: new_link(joint.child),
            origin: joint.origin,
            axis: joint.axis,
            limits: joint.limits,
            mimic: rule.map(|rule| Mimic { joint: new_joint(rule.joint), ..rule }),
        })
        .collect();
    ordered.sort_by_key(|joint| joint.child);
    let mut links: Vec<(usize, Link)> =
        links.into_iter().enumerate().map(|(old, (link, _))| (place[old], link)).collect();
    links.sort_by_key(|(new, _)| *new);
    let links = links.into_iter().map(|(_, link)| link).collect();
    Robot { name, links, joints: ordered, postures: Vec::new(), may_touch: Vec::new() }
}
