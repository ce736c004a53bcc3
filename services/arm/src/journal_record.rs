//! The arm's journal records for programs.

use config::Settings;
use messages::pick::Pick;
use scene::{ObjectId, Scene};
use service::journal_record::{ArmCause, ArmRecord, HeldRecord, PickRecord, PostureRecord};

use crate::state::{Cause, Held, Record};

/// Returns the scene that a record is about; none where no settings have it.
pub(crate) fn scene<'a>(settings: &'a [Settings], record: &Record) -> Option<&'a Scene> {
    let mut scenes = settings.iter().map(|settings| &settings.scene);
    scenes.find(|scene| scene.key() == record.state.scene_key)
}

/// Returns an object's name. Objects from perception, and those of an unknown scene, have numbers only.
pub(crate) fn name(scene: Option<&Scene>, object: ObjectId) -> String {
    let known = scene.and_then(|scene| scene.objects().get(object.index()));
    known.map_or_else(|| format!("object {}", object.0), |object| object.name.clone())
}

/// Translates a record; without its scene, objects have numbers for names.
pub(crate) fn explain(scene: Option<&Scene>, record: &Record) -> ArmRecord {
    let state = &record.state;
    let posture = [0, 1].map(|limb| PostureRecord {
        joints_rad: state.posture.joints[limb],
        width_m: state.posture.width_m[limb],
    });
    ArmRecord {
        cause: cause(record.cause),
        pick: state.pick.as_ref().map(|pick| pick_record(scene, pick)),
        limb: state.limb.map(|limb| limb.name().to_owned()),
        misses: state.misses,
        held: state.held.as_ref().map(|held| held_record(scene, held)),
        gone: state.gone.iter().map(|object| name(scene, *object)).collect(),
        offered: state.offered.as_ref().map(|offered| name(scene, offered.object)),
        stopped: state.stopped,
        obeyed_ns: state.obeyed.ns(),
        waits_for_person: state.waits_for_person,
        posture,
    }
}

fn cause(cause: Cause) -> ArmCause {
    match cause {
        Cause::Snapshot => ArmCause::Snapshot,
        Cause::SceneChanged => ArmCause::SceneChanged,
        Cause::Ordered => ArmCause::Ordered,
        Cause::Phase => ArmCause::Phase,
        Cause::Missed => ArmCause::Missed,
        Cause::Ended => ArmCause::Ended,
        Cause::Motion(order) => ArmCause::Motion { order },
        Cause::Moved => ArmCause::Moved,
        Cause::Rested => ArmCause::Rested,
        Cause::Blocked => ArmCause::Blocked,
        Cause::Shutdown => ArmCause::Shutdown,
    }
}

fn pick_record(scene: Option<&Scene>, pick: &Pick) -> PickRecord {
    PickRecord {
        interaction: pick.id.interaction.0,
        attempt: pick.id.attempt,
        object: name(scene, pick.object),
        task: pick.task,
        phase: pick.phase,
        outcome: pick.outcome,
    }
}

fn held_record(scene: Option<&Scene>, held: &Held) -> HeldRecord {
    let [x, y, z, rotation @ ..] = held.in_gripper;
    HeldRecord {
        object: name(scene, held.object),
        limb: held.limb.name().to_owned(),
        position_m: [x, y, z],
        rotation_xyzw: rotation,
    }
}

#[cfg(test)]
mod tests {
    use manipulation::Limb;
    use messages::{InteractionId, MotionOrder, PickId, PickOutcome, PickPhase, Service, Task};
    use service::Time;
    use service::journal_record::{JournalRecord, golden};

    use super::*;
    use crate::inspection;
    use crate::state::{ArmState, Offered};
    use arm_driver::Posture;

    fn bowls() -> Scene {
        let text = include_str!("../../../config/scenes/bowls.toml");
        Scene::from_toml("bowls.toml", text).unwrap()
    }

    /// One record of each cause.
    fn records(scene_key: u64) -> Vec<Record> {
        let joints = [0.0, -0.5, 0.0, 0.75, 0.0, 1.25, 0.0];
        let in_gripper = [0.0, 0.01, 0.02, 0.0, 0.0, 0.0, 1.0];
        let held = Held { object: ObjectId(1), limb: Limb::Left, in_gripper };
        let offered = Offered { object: ObjectId(1), limb: Limb::Left, pose: in_gripper };
        let state = |phase, outcome| ArmState {
            scene_key,
            posture: Posture { joints: [joints; 2], width_m: [0.03, 0.125] },
            pick: Some(Pick {
                id: PickId { interaction: InteractionId(4), attempt: 1 },
                object: ObjectId(1),
                task: Task::Fetch,
                phase,
                outcome,
            }),
            limb: Some(Limb::Left),
            misses: 0,
            held: (phase == PickPhase::Holding).then_some(held),
            gone: Vec::new(),
            handed_over: Vec::new(),
            offered: None,
            stopped: false,
            obeyed: Time(0),
            waits_for_person: false,
        };
        use PickOutcome::{Delivered, Pending};
        let moving = state(PickPhase::Moving, Pending);
        let done = ArmState {
            gone: vec![ObjectId(1)],
            offered: Some(offered),
            ..state(PickPhase::Done, Delivered)
        };
        let stopped = ArmState { stopped: true, obeyed: Time(5_000_000_000), ..moving.clone() };
        let missed = ArmState { misses: 1, ..moving.clone() };
        let steps = [
            (Cause::Snapshot, ArmState { pick: None, limb: None, ..moving.clone() }),
            (Cause::SceneChanged, ArmState { pick: None, limb: None, ..moving.clone() }),
            (Cause::Ordered, ArmState { limb: None, ..state(PickPhase::Accepted, Pending) }),
            (Cause::Phase, moving.clone()),
            (Cause::Motion(MotionOrder::Stop), stopped),
            (Cause::Motion(MotionOrder::Resume), moving.clone()),
            (Cause::Missed, missed),
            (Cause::Moved, moving.clone()),
            (Cause::Phase, state(PickPhase::Closing, Pending)),
            (Cause::Phase, state(PickPhase::Holding, Pending)),
            (Cause::Ended, done.clone()),
            (Cause::Blocked, ArmState { waits_for_person: true, ..done.clone() }),
            (Cause::Rested, ArmState { offered: None, ..done.clone() }),
            (Cause::Shutdown, done),
        ];
        let record = |(n, (cause, state)): (usize, (Cause, ArmState))| Record {
            cause,
            at: Time(1_000_000_000 * (n as u64 + 1)),
            state,
        };
        steps.into_iter().enumerate().map(record).collect()
    }

    /// Programs read it. `WHICHONE_BLESS=1` rewrites the golden file.
    #[test]
    fn records_for_programs_match_the_golden_file() {
        let scene = bowls();
        let described = |record: Record| {
            let explained = JournalRecord::Arm(Box::new(explain(Some(&scene), &record)));
            (record.at, inspection::line(Some(&scene), &record), explained)
        };
        let found = golden::lines(records(scene.key()).into_iter().map(described));
        golden::check(Service::Arm, &found);
    }

    #[test]
    fn objects_of_an_unknown_scene_have_numbers() {
        let records = records(7);
        let explained = explain(None, &records[3]);
        assert_eq!(explained.pick.unwrap().object, "object 1");
        assert_eq!(
            inspection::line(None, &records[9]),
            "next phase: pick 4.1 of object 1: holding it, object 1 in the gripper"
        );
    }
}
