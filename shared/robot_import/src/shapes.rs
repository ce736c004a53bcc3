//! Hulls of the links, and the shapes that whichone's descriptions have: capsules on the arm, boxes too on the body.

use std::path::Path;

use nalgebra::{Isometry3, Translation3, Vector3};

use crate::capsule::{Capsule, enclosing};
use crate::gripper::Gripper;
use crate::mesh;
use crate::points::Hull;
use crate::report::{Findings, Fit};
use crate::source::{Form, Piece, Source};
use crate::structure::Arm;

/// Links of more pieces than this are enclosed as a whole.
const PIECES_MAX: usize = 4;

/// Times that a link's hull may be cut for a closer fit.
const CUTS: usize = 2;

/// Radius of a link whose meshes are missing, as a share of the arm's length, and its bounds, metres.
const GUESS: f64 = 0.05;
const GUESS_M: (f64, f64) = (0.02, 0.065);

/// Points on a shape at which its distance from the hull is measured.
const SURFACE: usize = 96;

/// A shape of a link, in the link's frame.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Capsule(Capsule),
    Box { pose: Isometry3<f64>, size: Vector3<f64> },
}

/// Returns the hulls of each link; those whose meshes are missing get the joints' spacing, and their number is second.
pub(crate) fn hulls(
    source: &Source,
    file: &Path,
    findings: &mut Findings,
) -> (Vec<Vec<Hull>>, Vec<bool>) {
    let mut is_missing = vec![false; source.links.len()];
    let mut all = Vec::new();
    for (index, link) in source.links.iter().enumerate() {
        let solid = if link.collision.is_empty() { &link.visual } else { &link.collision };
        let mut own: Vec<Hull> =
            solid.iter().filter_map(|piece| hull(piece, file, findings)).collect();
        if own.is_empty() && !link.collision.is_empty() {
            own = link.visual.iter().filter_map(|piece| hull(piece, file, findings)).collect();
        }
        is_missing[index] = own.is_empty() && !solid.is_empty();
        if own.len() > PIECES_MAX {
            let points: Vec<_> = own.iter().flat_map(|hull| hull.points.clone()).collect();
            own = Hull::new(&points).into_iter().collect();
        }
        all.push(own);
    }
    findings.lost_meshes.sort();
    findings.lost_meshes.dedup();
    if let Some(first) = findings.lost_meshes.first() {
        findings.missing(format!(
            "{} mesh files that were not found beside the robot's file, as {first}: with them, shapes are those of the links",
            findings.lost_meshes.len()
        ));
    }
    (all, is_missing)
}

fn hull(piece: &Piece, file: &Path, findings: &mut Findings) -> Option<Hull> {
    let points = match &piece.form {
        Form::Mesh(written, scale) => mesh::vertices(written, scale, file, findings)?,
        Form::Box(size) => corners(size),
        Form::Round { radius, length, is_capsule } => {
            let end = Vector3::z() * (0.5 * length);
            if *is_capsule {
                Capsule { a: -end, b: end, radius: *radius }.surface(256).collect()
            } else {
                rim(*radius, 0.5 * length)
            }
        }
    };
    let placed = Hull::new(&points)?.at(&piece.origin);
    Hull::new(&placed.points)
}

fn corners(size: &Vector3<f64>) -> Vec<Vector3<f64>> {
    let side = |k: usize, i: usize| if k >> i & 1 == 1 { 0.5 * size[i] } else { -0.5 * size[i] };
    (0..8).map(|k| Vector3::new(side(k, 0), side(k, 1), side(k, 2))).collect()
}

fn rim(radius: f64, half: f64) -> Vec<Vector3<f64>> {
    let around = (0..48).map(|k| (f64::from(k) * std::f64::consts::TAU / 48.0).sin_cos());
    around
        .flat_map(|(s, c)| [-half, half].map(|z| Vector3::new(radius * c, radius * s, z)))
        .collect()
}

/// Gives links of the arm whose meshes are missing the size that the spacing of their joints suggests.
pub(crate) fn guess(
    source: &Source,
    arm: &Arm,
    hulls: &mut [Vec<Hull>],
    is_missing: &[bool],
    findings: &mut Findings,
) -> Vec<bool> {
    let spacing = arm
        .joints
        .iter()
        .skip(1)
        .map(|joint| source.joints[*joint].origin.translation.vector.norm());
    let radius = (GUESS * spacing.sum::<f64>()).clamp(GUESS_M.0, GUESS_M.1);
    let mut is_guessed = vec![false; source.links.len()];
    let fingers: Vec<usize> = arm.fingers.iter().map(|joint| source.joints[*joint].child).collect();
    for link in 0..source.links.len() {
        let is_own = link == arm.base || source.is_below(link, source.joints[arm.joints[0]].child);
        let is_finger = fingers.iter().any(|finger| source.is_below(link, *finger));
        if !is_own || is_finger || !is_missing[link] {
            continue;
        }
        is_guessed[link] = true;
        hulls[link] = spaced(source, arm, link, radius);
    }
    let names: Vec<&str> = (0..source.links.len())
        .filter(|link| is_guessed[*link])
        .map(|link| source.links[link].name.as_str())
        .collect();
    if !names.is_empty() {
        findings.assumed(format!(
            "shape of {}: as long as the spacing of their joints and {:.0} mm thick, since their meshes are missing",
            names.join(", "),
            2e3 * radius
        ));
    }
    is_guessed
}

/// Returns the hulls of a link as long as the way to the joints that it carries.
fn spaced(source: &Source, arm: &Arm, link: usize, radius: f64) -> Vec<Hull> {
    let ends = source.children(link).map(|joint| &source.joints[joint]);
    let ends = ends.filter(|joint| {
        source.is_below(arm.last, joint.child) || source.is_below(arm.hand, joint.child)
    });
    let mut ends: Vec<_> = ends.map(|joint| joint.origin.translation.vector).collect();
    if ends.is_empty() {
        ends.push(Vector3::zeros());
    }
    // The base stands on something, and reaches no lower than its frame.
    let start = |b: &Vector3<f64>| match link == arm.base && b.norm() > 2.0 * radius {
        true => b.normalize() * radius,
        false => Vector3::zeros(),
    };
    let pieces = ends.into_iter().map(|b| Capsule { a: start(&b), b, radius });
    pieces.filter_map(|own| Hull::new(&own.surface(128).collect::<Vec<_>>())).collect()
}

/// Returns the shapes of a link of the arm; those of the hand end at the fingertips.
pub(crate) fn of_arm(hulls: &[Hull], tips: &[Isometry3<f64>]) -> Vec<Shape> {
    let capsules = hulls.iter().flat_map(|hull| enclosing(hull, CUTS));
    capsules.map(|capsule| Shape::Capsule(tips.iter().fold(capsule, ended))).collect()
}

/// Moves ends of a capsule back that reach beyond the fingertips: they would touch what objects stand on.
fn ended(capsule: Capsule, tips: &Isometry3<f64>) -> Capsule {
    let mut own = capsule.at(&tips.inverse());
    for end in [&mut own.a, &mut own.b] {
        end.z = end.z.min(-own.radius);
    }
    own.at(tips)
}

/// Returns the shape of a part of the body at `pose` in the root's frame: an upright box or capsules, whichever stands out
/// less.
pub(crate) fn of_body(hulls: &[Hull], pose: &Isometry3<f64>) -> Vec<Shape> {
    let shape = |hull: &Hull| {
        let placed = hull.at(pose);
        let ends = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| placed.extent(&axis));
        let size = Vector3::from(ends.map(|(low, high)| (high - low).max(1e-3)));
        let centre = Vector3::from(ends.map(|(low, high)| 0.5 * (low + high)));
        let pose = pose.inverse() * Translation3::from(centre);
        let boxed = vec![Shape::Box { pose, size }];
        let round: Vec<Shape> = enclosing(hull, CUTS).into_iter().map(Shape::Capsule).collect();
        let out =
            |shapes: &[Shape]| fit("", std::slice::from_ref(hull), shapes, false).stands_out_mm;
        if out(&round) < out(&boxed) { round } else { boxed }
    };
    hulls.iter().flat_map(shape).collect()
}

/// Returns the shapes of two fingers that the files do not show, in the gripper's frame, and of the hand behind them
/// where that is drawn as well.
pub(crate) fn drawn(gripper: &Gripper) -> Vec<Shape> {
    const RADIUS_M: f64 = 0.012;
    let aside = 0.5 * gripper.open_m + RADIUS_M;
    let finger = |y: f64| Capsule {
        a: Vector3::new(0.0, y, -0.05),
        b: Vector3::new(0.0, y, -RADIUS_M),
        radius: RADIUS_M,
    };
    let hand = Capsule {
        a: Vector3::new(0.0, 0.0, 0.04 - crate::gripper::LENGTH_M),
        b: Vector3::new(0.0, 0.0, 0.02 - 0.5 * crate::gripper::LENGTH_M - 0.05),
        radius: 0.04,
    };
    let fingers = [aside, -aside].map(finger).into_iter();
    let all = fingers.chain(gripper.is_drawn.then_some(hand));
    all.map(Shape::Capsule).collect()
}

/// Measures how well shapes enclose a link.
pub(crate) fn fit(name: &str, hulls: &[Hull], shapes: &[Shape], is_guessed: bool) -> Fit {
    let distance = |shape: &Shape, at: &Vector3<f64>| match shape {
        Shape::Capsule(capsule) => capsule.distance(at),
        Shape::Box { pose, size } => {
            let local = pose.inverse_transform_point(&(*at).into()).coords;
            let beyond = local.abs() - size * 0.5;
            beyond.map(|part| part.max(0.0)).norm() + beyond.max().min(0.0)
        }
    };
    let out =
        |at: &Vector3<f64>| shapes.iter().map(|own| distance(own, at)).fold(f64::MAX, f64::min);
    let left = hulls.iter().flat_map(|hull| &hull.points).map(out).fold(0.0, f64::max);
    let surface = shapes.iter().flat_map(|shape| match shape {
        Shape::Capsule(capsule) => capsule.surface(SURFACE).collect::<Vec<_>>(),
        Shape::Box { pose, size } => {
            corners(size).iter().map(|at| (pose * nalgebra::Point3::from(*at)).coords).collect()
        }
    });
    // What lies within another shape of the link is no surface.
    let surface = surface.filter(|at| out(at) > -1e-6);
    let stands = surface.map(|at| {
        let point = Hull { points: vec![at], centre: at, radius: 0.0 };
        hulls.iter().map(|hull| hull.distance(&point, f64::INFINITY)).fold(f64::MAX, f64::min)
    });
    let stands_out = stands.filter(|it| *it < f64::MAX).fold(0.0, f64::max);
    let mm = |m: f64| (m * 1e4).round() / 10.0;
    Fit {
        link: name.to_owned(),
        shapes: shapes.len(),
        stands_out_mm: mm(stands_out),
        left_out_mm: mm(left),
        is_guessed,
    }
}
