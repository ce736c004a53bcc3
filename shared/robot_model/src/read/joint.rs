//! Joints: kind, axis and limits.

use diagnostics::suggestion;
use nalgebra::{Isometry3, Unit, Vector3};
use roxmltree::Node;

use crate::model::{JointKind, Limits};

use super::reader::{Reader, child};

/// A joint as the file writes it: other parts are still names.
pub(super) struct Written<'a> {
    pub(super) name: &'a str,
    /// Its name in diagnostics.
    pub(super) element: String,
    pub(super) kind: JointKind,
    pub(super) parent: &'a str,
    pub(super) child: &'a str,
    pub(super) origin: Isometry3<f64>,
    pub(super) axis: Unit<Vector3<f64>>,
    pub(super) limits: Option<Limits>,
    pub(super) mimic: Option<WrittenMimic<'a>>,
}

#[derive(Clone, Copy)]
pub(super) struct WrittenMimic<'a> {
    pub(super) joint: &'a str,
    pub(super) multiplier: f64,
    pub(super) offset: f64,
}

pub(super) fn read<'a>(reader: &mut Reader<'a>, node: Node<'a, 'a>) -> Written<'a> {
    let (name, element) = reader.named(node);
    let kind = kind(reader, node, &element);
    let parent = end(reader, node, &element, "parent");
    let child_link = end(reader, node, &element, "child");
    let origin = reader.origin(node, &element);
    let moves = kind != JointKind::Fixed;
    let axis = if moves { axis(reader, node, &element) } else { Vector3::x_axis() };
    let limits = if moves { limits(reader, node, &element, kind) } else { None };
    let mimic = child(node, "mimic").filter(|_| moves).map(|rule| WrittenMimic {
        joint: reader.text(rule, &element, "joint"),
        multiplier: reader.number_if_any(rule, &element, "multiplier").unwrap_or(1.0),
        offset: reader.number_if_any(rule, &element, "offset").unwrap_or(0.0),
    });
    Written { name, element, kind, parent, child: child_link, origin, axis, limits, mimic }
}

fn kind<'a>(reader: &mut Reader<'a>, node: Node<'a, 'a>, element: &str) -> JointKind {
    const KINDS: [JointKind; 4] =
        [JointKind::Fixed, JointKind::Revolute, JointKind::Continuous, JointKind::Prismatic];
    let text = node.attribute("type").unwrap_or_default().trim();
    KINDS.into_iter().find(|kind| kind.name() == text).unwrap_or_else(|| {
        let what = match text {
            "" => "it has no type".to_owned(),
            "floating" | "planar" => format!("its type {text} is not supported"),
            _ => format!("its type {text:?} is unknown"),
        };
        let otherwise = "write type=\"fixed\", \"revolute\", \"continuous\" or \"prismatic\"";
        let help = suggestion(text, KINDS.iter().map(|kind| kind.name()), || otherwise.to_owned());
        reader.problem(node, element, what, help);
        JointKind::Fixed
    })
}

/// The name of the link at one end; empty, and a fault, if there is none.
fn end<'a>(
    reader: &mut Reader<'a>,
    node: Node<'a, 'a>,
    element: &str,
    which: &'static str,
) -> &'a str {
    let help = format!("write <{which} link=\"…\"/>");
    match reader.part(node, element, which, &help) {
        Some(end) => reader.text(end, element, "link"),
        None => "",
    }
}

fn axis<'a>(reader: &mut Reader<'a>, node: Node<'a, 'a>, element: &str) -> Unit<Vector3<f64>> {
    let Some(written) = child(node, "axis") else { return Vector3::x_axis() };
    let Some(xyz) = reader.numbers_if_any::<3>(written, element, "xyz") else {
        reader.problem(written, element, "<axis> has no xyz", "write xyz=\"x y z\"");
        return Vector3::x_axis();
    };
    let axis = Vector3::from(xyz);
    // Beyond these lengths the direction is lost to rounding.
    if !(1e-6..1e6).contains(&axis.amax()) {
        let text = written.attribute("xyz").unwrap_or_default();
        reader.unreadable(written, element, "xyz", text, "write a vector of length 1");
        return Vector3::x_axis();
    }
    Unit::new_normalize(axis)
}

fn limits<'a>(
    reader: &mut Reader<'a>,
    node: Node<'a, 'a>,
    element: &str,
    kind: JointKind,
) -> Option<Limits> {
    let turns_for_ever = kind == JointKind::Continuous;
    let Some(limit) = child(node, "limit") else {
        if !turns_for_ever {
            let help = "write <limit lower=\"…\" upper=\"…\" velocity=\"…\" effort=\"…\"/>";
            reader.problem(
                node,
                element,
                format!("it is {} and has no <limit>", kind.name()),
                help,
            );
        }
        return None;
    };
    let (lower, upper) = match turns_for_ever {
        true => (f64::NEG_INFINITY, f64::INFINITY),
        false => range(reader, limit, element),
    };
    Some(Limits {
        lower,
        upper,
        velocity: reader.magnitude(limit, element, "velocity", true),
        effort: reader.magnitude(limit, element, "effort", true),
        acceleration: bound(reader, limit, element, "acceleration"),
        jerk: bound(reader, limit, element, "jerk"),
    })
}

/// Least and greatest position. One of the two may be left out and is then 0, as URDF has it.
fn range<'a>(reader: &mut Reader<'a>, limit: Node<'a, 'a>, element: &str) -> (f64, f64) {
    let lower = reader.number_if_any(limit, element, "lower");
    let upper = reader.number_if_any(limit, element, "upper");
    if lower.is_none() && upper.is_none() {
        let help = "write both, or make the joint continuous or fixed";
        reader.problem(limit, element, "<limit> has neither lower nor upper", help);
    }
    let (lower, upper) = (lower.unwrap_or(0.0), upper.unwrap_or(0.0));
    if lower > upper {
        let what = format!("<limit> has lower={lower} above upper={upper}");
        reader.problem(limit, element, what, "exchange them");
    }
    (lower, upper)
}

fn bound<'a>(
    reader: &mut Reader<'a>,
    limit: Node<'a, 'a>,
    element: &str,
    key: &str,
) -> Option<f64> {
    limit.attribute(key)?;
    Some(reader.magnitude(limit, element, key, false))
}
