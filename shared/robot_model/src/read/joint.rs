//! Joints: kind, axis and limits.

use std::f64::consts::TAU;

use diagnostics::suggestion;
use nalgebra::{Isometry3, Unit, Vector3};

use crate::model::{JointKind, Limits};

use super::element::Element;

/// A joint as the file writes it: other parts are still names.
pub(super) struct Written<'a> {
    pub(super) element: Element<'a>,
    pub(super) name: &'a str,
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

pub(super) fn read(joint: Element<'_>) -> Written<'_> {
    let (name, element) = joint.named();
    let kind = kind(&element);
    let [parent, child] = ["parent", "child"].map(|which| end(&element, which));
    let origin = element.origin();
    let moves = kind != JointKind::Fixed;
    let axis = if moves { axis(&element) } else { Vector3::x_axis() };
    let limits = if moves { limits(&element, kind) } else { None };
    let mimic = element.child("mimic").filter(|_| moves).map(|rule| WrittenMimic {
        joint: rule.text("joint"),
        multiplier: rule.number_if_any("multiplier").unwrap_or(1.0),
        offset: rule.number_if_any("offset").unwrap_or(0.0),
    });
    Written { element, name, kind, parent, child, origin, axis, limits, mimic }
}

fn kind(joint: &Element<'_>) -> JointKind {
    const KINDS: [JointKind; 4] =
        [JointKind::Fixed, JointKind::Revolute, JointKind::Continuous, JointKind::Prismatic];
    let text = joint.attribute("type").unwrap_or_default().trim();
    KINDS.into_iter().find(|kind| kind.name() == text).unwrap_or_else(|| {
        let what = match text {
            "" => "it has no type".to_owned(),
            "floating" | "planar" => format!("its type {text} is not supported"),
            _ => format!("its type {text:?} is unknown"),
        };
        let otherwise = "write type=\"fixed\", \"revolute\", \"continuous\" or \"prismatic\"";
        let help = suggestion(text, KINDS.iter().map(|kind| kind.name()), || otherwise.to_owned());
        joint.problem(what, help);
        JointKind::Fixed
    })
}

/// The name of the link at one end; empty, and a fault, if there is none.
fn end<'a>(joint: &Element<'a>, which: &'static str) -> &'a str {
    let end = joint.part(which, &format!("write <{which} link=\"…\"/>"));
    end.map_or("", |end| end.text("link"))
}

fn axis(joint: &Element<'_>) -> Unit<Vector3<f64>> {
    let Some(written) = joint.child("axis") else { return Vector3::x_axis() };
    let Some(xyz) = written.numbers_if_any::<3>("xyz") else {
        written.problem("<axis> has no xyz", "write xyz=\"x y z\"");
        return Vector3::x_axis();
    };
    let axis = Vector3::from(xyz);
    // Beyond these lengths the direction is lost to rounding.
    if !(1e-6..1e6).contains(&axis.amax()) {
        written.unreadable("xyz", "write a vector of length 1");
        return Vector3::x_axis();
    }
    Unit::new_normalize(axis)
}

fn limits(joint: &Element<'_>, kind: JointKind) -> Option<Limits> {
    let turns_for_ever = kind == JointKind::Continuous;
    let Some(limit) = joint.child("limit") else {
        if !turns_for_ever {
            let help = "write <limit lower=\"…\" upper=\"…\" velocity=\"…\" effort=\"…\"/>";
            joint.problem(format!("it is {} and has no <limit>", kind.name()), help);
        }
        return None;
    };
    let (lower, upper) = match turns_for_ever {
        true => (f64::NEG_INFINITY, f64::INFINITY),
        false => range(&limit, kind),
    };
    let bound = |key| limit.attribute(key).map(|_| limit.magnitude(key, false));
    Some(Limits {
        lower,
        upper,
        velocity: limit.magnitude("velocity", true),
        effort: limit.magnitude("effort", true),
        acceleration: bound("acceleration"),
        jerk: bound("jerk"),
    })
}

/// Farthest position of a joint that turns, radians: two turns. Each turn within the limits is a posture of its own.
const TURN_RAD_MAX: f64 = 2.0 * TAU;

/// Least and greatest position. One of the two may be left out and is then 0, as URDF has it.
fn range(limit: &Element<'_>, kind: JointKind) -> (f64, f64) {
    let position = |key| match kind {
        JointKind::Prismatic => limit.length_if_any(key),
        _ => limit.number_if_any(key).map(|at| turned(limit, key, at)),
    };
    let [lower, upper] = ["lower", "upper"].map(position);
    if lower.is_none() && upper.is_none() {
        let help = "write both, or make the joint continuous or fixed";
        limit.problem("<limit> has neither lower nor upper", help);
    }
    let (lower, upper) = (lower.unwrap_or(0.0), upper.unwrap_or(0.0));
    if lower > upper {
        limit.problem(format!("<limit> has lower={lower} above upper={upper}"), "exchange them");
    }
    (lower, upper)
}

/// Returns the position of a joint that turns; reports one beyond [`TURN_RAD_MAX`].
fn turned(limit: &Element<'_>, key: &str, at: f64) -> f64 {
    if at.abs() <= TURN_RAD_MAX {
        return at;
    }
    let help = match at.abs() {
        ..=720.0 => format!("limits are in radians: {:.4} if it is {at} degrees", at.to_radians()),
        _ => "a joint has two turns at most: write e.g. -6.2832 and 6.2832".to_owned(),
    };
    limit.unreadable(key, &help);
    0.0
}
