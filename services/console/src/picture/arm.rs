//! The arm and the things around it.

use messages::WireCode;
use messages::{ArmStatus, MotionInhibit, PickOutcome, PickPhase, TrajectoryView, WorldView};
use scene::Scene;
use serde_json::{Value as Json, json};
use service::Time;

use crate::hub::ms;

/// The arm's section.
pub(super) fn section(scene: &Scene, arm: &ArmStatus) -> Json {
    let object = scene.objects().get(arm.object as usize).filter(|_| arm.interaction != 0);
    json!({
        "phase": PickPhase::from_code(arm.phase).ok(),
        "outcome": PickOutcome::from_code(arm.outcome).ok(),
        "object": object.map(|object| &object.name),
        "interaction": arm.interaction,
        "attempt": arm.attempt,
        "moving": arm.moving != 0,
        "stopped": arm.stopped != 0,
        "hindrance": MotionInhibit::from_code(arm.hindrance).ok(),
        "remaining_s": (arm.remaining_s * 10.0).round() / 10.0,
        "aimed": arm.aimed_act != 0,
    })
}

/// The section of the way that a gripper is going; null while nothing moves by plan. Places to a
/// millimetre, times to a millisecond.
pub(super) fn trajectory(way: &TrajectoryView) -> Json {
    if way.phases.is_empty() {
        return Json::Null;
    }
    let digits = |number: f64| (number * 1e3).round() / 1e3;
    let phases = way.phases.iter().map(|phase| {
        json!({
            "name": phase.phase,
            "points": phase.points_m.iter().map(|point| point.map(digits)).collect::<Vec<_>>(),
            "t_s": phase.t_s.iter().copied().map(digits).collect::<Vec<_>>(),
        })
    });
    json!({
        "pick": (way.interaction != 0).then(|| format!("{}.{}", way.interaction, way.attempt)),
        "limb": if way.limb == 0 { "left" } else { "right" },
        "phases": phases.collect::<Vec<_>>(),
        "began_ms": (way.began_ns != 0).then(|| ms(Time(way.began_ns))),
    })
}

/// The section of the things; poses to a tenth of a millimetre.
pub(super) fn world(world: &WorldView) -> Json {
    let pose = |pose: &[f64; 7]| pose.map(|number| (number * 1e4).round() / 1e4);
    json!({
        "objects": world.objects.iter().map(|object| object.as_ref().map(pose)).collect::<Vec<_>>(),
        "held": world.held,
        "grippers": world.grippers.iter().map(pose).collect::<Vec<_>>(),
    })
}
