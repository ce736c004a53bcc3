//! Lenient reader of URDF: what is missing or wrong but not needed is reported and replaced.

use std::collections::HashMap;

use diagnostics::{Diagnostic, Diagnostics, Report, suggestion};
use nalgebra::{Isometry3, Translation3, Unit, UnitQuaternion, Vector3};
use robot_model::JointKind;
use roxmltree::{Document, Node, ParsingOptions};

use crate::report::Findings;
use crate::source::{Follows, Form, Joint, Link, Piece, Source};

/// Reads a description; `label` names the file in messages.
///
/// # Errors
/// The text is not XML, or its links and joints are not one tree: everything wrong at once.
pub(crate) fn read(
    label: &str,
    text: &str,
    findings: &mut Findings,
) -> Result<Source, Diagnostics> {
    // Files from Windows begin with a byte order mark, which is not XML.
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    let fault = |what: String, help: &str| Diagnostic::new(label, "", what, help);
    let document = Document::parse_with_options(text, options).map_err(|error| {
        let line = error.pos().row;
        fault(format!("not XML: {error}"), "correct the file, or export it again").at(Some(line))
    })?;
    let root = document.root_element();
    if root.tag_name().name() != "robot" {
        let what = format!("expected <robot>, found <{}>", root.tag_name().name());
        return Err(fault(what, "import a URDF, or a xacro that makes one").into());
    }
    let mut report = Report::default();
    let links: Vec<Node<'_, '_>> = elements(root, "link").collect();
    let places: HashMap<&str, usize> =
        links.iter().enumerate().map(|(i, link)| (attribute(*link, "name"), i)).collect();
    let joints: Vec<Node<'_, '_>> = elements(root, "joint").collect();
    let names: HashMap<&str, usize> =
        joints.iter().enumerate().map(|(i, joint)| (attribute(*joint, "name"), i)).collect();
    let mut read: Vec<Joint> = Vec::new();
    for node in &joints {
        let ends = ["parent", "child"].map(|key| end(*node, key, &places, label, &mut report));
        if let [Some(parent), Some(child)] = ends {
            read.push(joint(*node, parent, child, &names, findings));
        }
    }
    if report.count() > 0 {
        return report.verdict(None);
    }
    let links: Vec<Link> = links.iter().map(|node| link(*node, findings)).collect();
    let name = root.attribute("name").unwrap_or("robot").to_owned();
    ordered(name, links, resolved(read)).map_err(|what| {
        fault(what, "join its links by joints so that each but one has one parent").into()
    })
}

fn elements<'a, 'i: 'a>(
    node: Node<'a, 'i>,
    name: &'a str,
) -> impl Iterator<Item = Node<'a, 'i>> + 'a {
    node.children().filter(move |child| child.is_element() && child.tag_name().name() == name)
}

fn attribute<'a>(node: Node<'a, '_>, key: &str) -> &'a str {
    node.attribute(key).unwrap_or_default()
}

/// Returns the link that a joint names.
fn end(
    node: Node<'_, '_>,
    key: &str,
    places: &HashMap<&str, usize>,
    label: &str,
    report: &mut Report,
) -> Option<usize> {
    let name = elements(node, key).next().map_or("", |end| attribute(end, "link"));
    let found = places.get(name).copied();
    if found.is_none() {
        let what = format!("its {key} {name:?} is not a link");
        let help = suggestion(name, places.keys().copied(), || "correct the name".to_owned());
        let line = node.document().text_pos_at(node.range().start).row;
        let key = format!("joint {:?}", attribute(node, "name"));
        report.add(Diagnostic::new(label, key, what, help).at(Some(line)));
    }
    found
}

fn joint(
    node: Node<'_, '_>,
    parent: usize,
    child: usize,
    names: &HashMap<&str, usize>,
    findings: &mut Findings,
) -> Joint {
    let name = attribute(node, "name").to_owned();
    let kind = kind(&name, attribute(node, "type"), findings);
    let axis = elements(node, "axis").next().and_then(|axis| vector(axis, "xyz"));
    let axis = Unit::try_new(axis.unwrap_or_else(Vector3::x), 1e-9);
    if axis.is_none() && kind != JointKind::Fixed {
        findings.assumed(format!("joint {name} has an axis of no length: x is taken"));
    }
    let limit = elements(node, "limit").next();
    let number = |key: &str| limit.and_then(|limit| number(limit, key));
    let range = number("lower").zip(number("upper"));
    let follows = elements(node, "mimic").next().and_then(|rule| {
        let joint = *names.get(attribute(rule, "joint"))?;
        let or = |key: &str, otherwise| self::number(rule, key).unwrap_or(otherwise);
        Some(Follows { joint, factor: or("multiplier", 1.0), offset: or("offset", 0.0) })
    });
    Joint {
        name,
        kind,
        parent,
        child,
        origin: origin(node),
        axis: axis.unwrap_or_else(Vector3::x_axis),
        range: range.map(|(low, high)| (low.min(high), low.max(high))),
        velocity: number("velocity"),
        effort: number("effort"),
        follows,
    }
}

fn kind(name: &str, written: &str, findings: &mut Findings) -> JointKind {
    match written {
        "revolute" => JointKind::Revolute,
        "continuous" => JointKind::Continuous,
        "prismatic" => JointKind::Prismatic,
        "fixed" => JointKind::Fixed,
        other => {
            findings.assumed(format!("joint {name} is of type {other:?}: it is taken to be fixed"));
            JointKind::Fixed
        }
    }
}

fn number(node: Node<'_, '_>, key: &str) -> Option<f64> {
    node.attribute(key)?.trim().parse().ok().filter(|number: &f64| number.is_finite())
}

fn vector(node: Node<'_, '_>, key: &str) -> Option<Vector3<f64>> {
    let parts: Vec<f64> =
        node.attribute(key)?.split_whitespace().filter_map(|part| part.parse().ok()).collect();
    let vector = Vector3::from_column_slice(parts.get(..3)?);
    vector.iter().all(|part| part.is_finite()).then_some(vector)
}

fn origin(node: Node<'_, '_>) -> Isometry3<f64> {
    let origin = elements(node, "origin").next();
    let part = |key| origin.and_then(|origin| vector(origin, key)).unwrap_or_default();
    let (xyz, rpy) = (part("xyz"), part("rpy"));
    let rotation = UnitQuaternion::from_euler_angles(rpy.x, rpy.y, rpy.z);
    Isometry3::from_parts(Translation3::from(xyz), rotation)
}

fn link(node: Node<'_, '_>, findings: &mut Findings) -> Link {
    let name = attribute(node, "name").to_owned();
    let mut pieces = |kind: &str| {
        let pieces = elements(node, kind).filter_map(|piece| {
            let geometry = elements(piece, "geometry").next()?;
            let shape = geometry.children().find(Node::is_element)?;
            match form(shape) {
                Some(form) => Some(Piece { origin: origin(piece), form }),
                None => {
                    let tag = shape.tag_name().name();
                    findings.ignored(format!("link {name} has a <{tag}> without a size"));
                    None
                }
            }
        });
        pieces.collect::<Vec<_>>()
    };
    let (collision, visual) = (pieces("collision"), pieces("visual"));
    Link { name, carrier: None, collision, visual }
}

fn form(shape: Node<'_, '_>) -> Option<Form> {
    let size = |key: &str| number(shape, key).filter(|size| *size > 0.0);
    let round =
        |length, is_capsule| Some(Form::Round { radius: size("radius")?, length, is_capsule });
    match shape.tag_name().name() {
        "box" => Some(Form::Box(vector(shape, "size")?.abs())),
        "cylinder" => round(size("length")?, false),
        "capsule" => round(number(shape, "length")?.abs(), true),
        "sphere" => round(0.0, true),
        "mesh" => {
            let scale = vector(shape, "scale").unwrap_or_else(|| Vector3::repeat(1.0));
            Some(Form::Mesh(shape.attribute("filename")?.trim().to_owned(), scale))
        }
        _ => None,
    }
}

/// Combines chained rules, so that each follower names a joint that follows none.
fn resolved(mut joints: Vec<Joint>) -> Vec<Joint> {
    for start in 0..joints.len() {
        let Some(mut rule) = joints[start].follows else { continue };
        for _ in 0..joints.len() {
            let Some(next) = joints.get(rule.joint).and_then(|joint| joint.follows) else { break };
            rule = Follows {
                joint: next.joint,
                factor: rule.factor * next.factor,
                offset: rule.factor * next.offset + rule.offset,
            };
        }
        let leads = joints.get(rule.joint).is_some_and(|other| other.follows.is_none());
        joints[start].follows = Some(rule).filter(|_| leads);
    }
    joints
}

/// Puts parents before children.
fn ordered(name: String, links: Vec<Link>, mut joints: Vec<Joint>) -> Result<Source, String> {
    let mut carriers = vec![None; links.len()];
    for (index, joint) in joints.iter().enumerate() {
        if carriers[joint.child].replace(index).is_some() {
            return Err(format!("link {:?} has two parents", links[joint.child].name));
        }
    }
    let mut order: Vec<usize> = (0..links.len()).filter(|link| carriers[*link].is_none()).collect();
    if order.len() != 1 {
        let names: Vec<&str> = order.iter().map(|link| links[*link].name.as_str()).collect();
        return Err(format!("expected one link without a parent, found {names:?}"));
    }
    let mut next = 0;
    while let Some(&at) = order.get(next) {
        order.extend(joints.iter().filter(|joint| joint.parent == at).map(|joint| joint.child));
        next += 1;
    }
    if order.len() != links.len() {
        return Err("the joints form a loop".to_owned());
    }
    let mut place = vec![0; links.len()];
    order.iter().enumerate().for_each(|(new, old)| place[*old] = new);
    for joint in &mut joints {
        (joint.parent, joint.child) = (place[joint.parent], place[joint.child]);
    }
    let links = order.iter().map(|old| Link { carrier: carriers[*old], ..links[*old].clone() });
    Ok(Source { name, links: links.collect(), joints })
}
