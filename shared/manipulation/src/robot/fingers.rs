//! Opening, closed gap and reach of a gripper, from the shapes of its fingers.

use nalgebra::{Isometry3, Vector3};
use robot_model::{Body, JointKind, Robot as Description, Shape};

use super::Unsuitable;
use crate::gripper::Gripper;

/// Shapes that end further than this behind the fingertips are not what grips, metres.
const TIP_M: f64 = 0.02;

/// Extents of a fingertip in the frame of the gripper, metres.
#[derive(Clone, Copy)]
struct Tip {
    /// Along the travel of the fingers.
    y: (f64, f64),
    /// End beyond the frame.
    beyond: f64,
}

/// Returns the gripper of a limb: two fingers on prismatic joints below the parent of
/// `<limb>_gripper`, whose shapes (for collision, or else for drawing) face each other along the y axis of
/// that frame; or one jaw, see [`Description::jaw`]. A description without such joints gets [`Gripper::default`].
///
/// # Errors
/// [`Unsuitable`] for fingers that have no shapes at the tips, or that never open.
pub(super) fn gripper(description: &Description, limb: &str) -> Result<Gripper, Unsuitable> {
    let name = format!("{limb}_gripper");
    if let Some(gripper) = one_jaw(description, limb) {
        return Ok(gripper);
    }
    let Some((frame, [a, b])) = of(description, limb) else { return Ok(Gripper::default()) };
    let refuse = |what: &str| Unsuitable {
        what: format!("the fingers of {name:?} {what}"),
        help:
            "give both finger links box, cylinder, capsule or sphere shapes that face each other \
               along the y axis of that link"
                .to_owned(),
    };
    let gap_at = |upper: bool| {
        let poses = description.poses(|joint| match (joint.kind, &joint.limits) {
            (JointKind::Prismatic, Some(limits)) if upper => limits.upper,
            (JointKind::Prismatic, Some(limits)) => limits.lower,
            _ => 0.0,
        });
        let tip = |finger| tip(description, finger, &poses, &poses[frame].inverse());
        let (a, b) = (tip(a)?, tip(b)?);
        let middle = |tip: &Tip| tip.y.0 + tip.y.1;
        let (low, high) = if middle(&a) < middle(&b) { (a, b) } else { (b, a) };
        Some((high.y.0 - low.y.1, f64::max(a.beyond, b.beyond)))
    };
    let ends = gap_at(false).zip(gap_at(true));
    let ((one_m, beyond_m), (other_m, _)) =
        ends.ok_or_else(|| refuse("have no shape at the tip"))?;
    let gripper = Gripper {
        stop_m: one_m.min(other_m),
        open_m: one_m.max(other_m),
        beyond_m: beyond_m.max(0.0),
        force_n: description.carrier(a).and_then(|joint| joint.limits).map_or(0.0, |l| l.effort),
        jaw: None,
    };
    if gripper.open_m - gripper.closed_m() < 1e-3 {
        return Err(refuse("never open"));
    }
    Ok(gripper)
}

/// Returns the gripper of a jaw, see [`Description::jaw`].
fn one_jaw(description: &Description, limb: &str) -> Option<Gripper> {
    let jaw = description.jaw(limb)?;
    let (stop_m, open_m) = jaw.ends_m();
    let limits = description.carrier(jaw.link).and_then(|joint| joint.limits);
    let force_n = limits.map_or(0.0, |limits| limits.effort) / jaw.radius_m();
    Some(Gripper { stop_m, open_m, beyond_m: jaw.beyond_m(), force_n, jaw: Some(jaw) })
}

/// Returns the link `<limb>_gripper` and those of the two fingers, if it has two.
pub(super) fn of(description: &Description, limb: &str) -> Option<(usize, [usize; 2])> {
    let frame = description.link_index(&format!("{limb}_gripper"))?;
    let base = description.carrier(frame).map_or(frame, |joint| joint.parent);
    let is_finger = |link: usize| {
        let joint = description.carrier(link)?;
        (joint.kind == JointKind::Prismatic && below(description, link, base)).then_some(link)
    };
    let fingers: Vec<usize> = (0..description.links().len()).filter_map(is_finger).collect();
    Some((frame, fingers.try_into().ok()?))
}

/// Returns whether `link` hangs on `base`.
fn below(description: &Description, mut link: usize, base: usize) -> bool {
    while let Some(joint) = description.carrier(link) {
        link = joint.parent;
        if link == base {
            return true;
        }
    }
    false
}

/// Returns the extents of a finger's shapes that reach to the tip, in the gripper's frame.
fn tip(
    description: &Description,
    finger: usize,
    poses: &[Isometry3<f64>],
    to_frame: &Isometry3<f64>,
) -> Option<Tip> {
    let links = description.links().iter().enumerate();
    let own = links.filter(|(link, _)| *link == finger || below(description, *link, finger));
    let own: Vec<_> = own.collect();
    let solid = own.iter().any(|(_, link)| !link.collision.is_empty());
    let shapes = own.iter().flat_map(|(index, link)| {
        let bodies = if solid { &link.collision } else { &link.visual };
        bodies.iter().map(move |body| (*index, body))
    });
    let tips = shapes.filter_map(|(index, body)| {
        let pose = to_frame * poses[index] * body.origin;
        let half = half_extents(body, &pose)?;
        let at = pose.translation.vector;
        let tip = Tip { y: (at.y - half.y, at.y + half.y), beyond: at.z + half.z };
        (tip.beyond > -TIP_M).then_some(tip)
    });
    tips.reduce(|a, b| Tip {
        y: (a.y.0.min(b.y.0), a.y.1.max(b.y.1)),
        beyond: a.beyond.max(b.beyond),
    })
}

/// Returns half the extents of a shape at `pose` along the axes of the frame; none for a mesh.
fn half_extents(body: &Body, pose: &Isometry3<f64>) -> Option<Vector3<f64>> {
    let rotation = pose.rotation.to_rotation_matrix();
    let axis = rotation.matrix().column(2).abs();
    let disc = axis.map(|cosine| (1.0 - cosine * cosine).max(0.0).sqrt());
    Some(match &body.shape {
        Shape::Box { size } => rotation.matrix().abs() * size * 0.5,
        Shape::Cylinder { radius, length } => axis * (0.5 * length) + disc * *radius,
        Shape::Capsule { radius, length } => (axis * (0.5 * length)).add_scalar(*radius),
        Shape::Sphere { radius } => Vector3::repeat(*radius),
        Shape::Mesh { .. } => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::limb::Limb;
    use robot_model::{BAXTER_SRDF, BAXTER_URDF};

    fn shipped(change: impl Fn(&str) -> String) -> [Result<Gripper, Unsuitable>; 2] {
        let description = Description::parse(&change(BAXTER_URDF), Some(BAXTER_SRDF)).unwrap();
        Limb::BOTH.map(|limb| gripper(&description, limb.name()))
    }

    fn ends_mm(gripper: &Gripper) -> [f64; 3] {
        [gripper.closed_m(), gripper.open_m, gripper.beyond_m].map(|m| (m * 1e5).round() / 100.0)
    }

    /// The manufacturer's meshes stand 15.3 mm (paddles) and 11.1 mm (half-round tips) apart in slot
    /// 2, closed; slot 1 is 9.5 mm further in on either side.
    #[test]
    fn shipped_fingers_open_and_close_as_their_shapes_and_slot_say() {
        let [left, right] = shipped(str::to_owned).map(Result::unwrap);
        assert_eq!(ends_mm(&left), [0.0, 37.97, 3.5]);
        assert_eq!(ends_mm(&right), [0.0, 33.77, 3.5]);
        assert_eq!(left.force_n, 20.0);
        let slot_2 = |urdf: &str| {
            urdf.replace("xyz=\"0 -0.011 0.02\"", "xyz=\"0 -0.0015 0.02\"")
                .replace("xyz=\"0 0.011 0.02\"", "xyz=\"0 0.0015 0.02\"")
        };
        let [left, right] = shipped(slot_2).map(Result::unwrap);
        assert_eq!(ends_mm(&left), [15.3, 56.97, 3.5]);
        assert_eq!(ends_mm(&right), [11.1, 52.77, 3.5]);
    }

    #[test]
    fn fingers_without_tips_are_refused() {
        let meshes = |urdf: &str| {
            let mesh = "<mesh filename=\"finger.stl\"/>";
            urdf.replace("<box size=\"0.042 0.0072 0.037\"/>", mesh)
                .replace("<box size=\"0.01 0.0135 0.11105\"/>", mesh)
        };
        let error = shipped(meshes)[0].clone().unwrap_err();
        assert!(error.what.contains("\"left_gripper\" have no shape at the tip"), "{error}");
    }
}
