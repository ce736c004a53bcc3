//! The camera above the simulated Baxter's table.

use crate::world::World;
use messages::robot::DrillKind;
use messages::{Change, PickOutcome, PickPhase, Sighting, TableObject, TableView};
use perception::Detection;
use scene::{ObjectId, Perceived};

const CAMERA: [(&str, &str); 5] = [
    ("group.perception.enabled", "true"),
    ("arm.simulated.camera.enabled", "true"),
    ("arm.simulated.camera.misses", "0.0"),
    ("arm.simulated.camera.noise_m", "0.002"),
    ("arm.restock", "false"),
];
/// The object that is fetched, by its place in the scene file.
const CLEAR: u16 = 5;

fn shown(sighting: &Sighting) -> &[Detection] {
    match &sighting.change {
        Change::Look(look) => &look.seen,
        change => panic!("{change:?}"),
    }
}

fn names(sighting: &Sighting) -> Vec<&str> {
    shown(sighting).iter().map(|it| it.classes[0].0.as_str()).collect()
}

impl World {
    /// Lets the camera look once more at what is there now.
    fn look(&mut self) -> Sighting {
        self.run(0.3);
        self.sightings.last().unwrap().clone()
    }

    /// Orders a pick of an object that is believed to be where `seen` shows it.
    fn pick_seen(&mut self, interaction: u64, seen: &Detection) {
        let number = ObjectId(self.scene().objects().len() as u16 + interaction as u16);
        let [x, y, z] = seen.xyz;
        let known = Perceived {
            number,
            name: "it".to_owned(),
            classes: seen.classes.clone(),
            attributes: Vec::new(),
            xyz: seen.xyz,
            yaw: seen.yaw,
            seen_by: Vec::new(),
            taken: false,
        };
        let place = [x, y, z, seen.yaw];
        let object = TableObject { known, place, sd: [0.0; 4], seen_ns: 1, gone: false };
        self.table(TableView {
            version: interaction,
            objects: vec![object],
            ..TableView::default()
        });
        self.pick(interaction, number.0);
        self.run_until("taken on", |w| w.phase() != PickPhase::Done);
    }
}

#[test]
fn camera_reports_what_stands_on_the_table() {
    let mut world = World::new(&CAMERA);
    let first = world.look();
    assert_eq!(names(&first), ["white", "white2", "white3", "metal", "metal2", "clear"]);
    for (seen, object) in shown(&first).iter().zip(world.scene().objects()) {
        let xyz = object.placement.unwrap().xyz;
        let off = xyz.iter().zip(seen.xyz).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off > 0.0 && off < 0.01, "{}: {off} m", object.name);
        assert_eq!(seen.attributes.len(), 3, "colour, material and size are qualities");
    }
    world.by_hand(DrillKind::Take, 0, [0.0; 4]);
    world.by_hand(DrillKind::Put, CLEAR, [0.6, 0.35, -0.12, 0.5]);
    let second = world.look();
    assert_eq!(names(&second), ["white2", "white3", "metal", "metal2", "clear"]);
    let (before, after) = (shown(&first).last().unwrap(), shown(&second).last().unwrap());
    assert!((after.xyz[0] - 0.6).abs() < 0.01 && after.yaw == 0.5, "{after:?}");

    world.kill_robot();
    world.start_robot();
    let third = world.look();
    assert_eq!(names(&third), names(&second), "the world outlives the process");
    assert_eq!(shown(&third).last().unwrap().attributes, before.attributes, "and so do its errors");
}

#[test]
fn camera_does_not_see_what_the_gripper_hides_or_holds() {
    let mut world = World::new(&CAMERA);
    let seen = world.look();
    let clear = shown(&seen).last().unwrap().clone();
    world.pick_seen(1, &clear);
    world.run_until("closing", |w| w.phase() == PickPhase::Closing);
    assert!(!names(&world.look()).contains(&"clear"), "it is below the gripper");
    world.run_until("over", |w| w.phase() == PickPhase::Done);
    assert_eq!(world.outcome(), PickOutcome::Delivered);
    world.run_until("at rest", |w| w.status().moving == 0);
    assert_eq!(names(&world.look()), ["white", "white2", "white3", "metal", "metal2"]);
}

/// The simulated fingers close on the table as it is, not as it is believed to be.
#[test]
fn grasp_beside_the_object_fails() {
    let mut world = World::new(&CAMERA);
    let seen = world.look();
    let mut clear = shown(&seen).last().unwrap().clone();
    clear.xyz[1] += 0.05;
    world.pick_seen(1, &clear);
    world.run_until("over", |w| w.phase() == PickPhase::Done);
    assert_eq!((world.outcome(), world.grasps), (PickOutcome::Missed, 0));
    // Once the gripper has left, all of them are seen where they stood.
    world.run_until("six objects", |w| w.sightings.last().is_some_and(|it| names(it).len() == 6));
}
