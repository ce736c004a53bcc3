//! Objects from perception: where they are is what the table says, until the fingers close.

use super::*;
use messages::{TableObject, TableView};
use scene::Perceived;

/// Number of the object that is fetched. The test's robot knows the objects by their places in the
/// scene, so the table numbers them alike.
const NUMBER: u16 = 1;

fn perceiving() -> Config {
    Config { perceives: true, ..config_at(5.0) }
}

/// The scene's objects as perceived, the one that is fetched `offset_m` from its place along y.
fn table(config: &Config, offset_m: f64, gone: bool) -> In<'static> {
    let object = |(number, like): (u16, &scene::Object)| {
        let placement = like.placement.unwrap();
        let [x, y, z] = placement.xyz;
        let known = Perceived {
            number: ObjectId(number),
            name: format!("{}-{number}", like.name),
            classes: vec![(like.name.clone(), 1.0)],
            attributes: Vec::new(),
            xyz: placement.xyz,
            yaw: placement.yaw,
            seen_by: Vec::new(),
            taken: false,
        };
        let is_it = number == NUMBER;
        let place = [x, y + if is_it { offset_m } else { 0.0 }, z, placement.yaw];
        TableObject { known, place, sd: [0.0; 4], seen_ns: 1, gone: gone && is_it }
    };
    let objects = (0..).zip(config.scene.objects()).map(object).collect();
    In::Table(Box::new(TableView { version: 1, objects, ..TableView::default() }))
}

impl Machine {
    fn sees(&mut self, offset_m: f64, gone: bool) {
        self.waiting.push(table(&self.config, offset_m, gone));
    }

    /// Distance of the gripper from the object's place in the scene, along y.
    fn beside_m(&self) -> f64 {
        let limb = self.node.state().limb.unwrap();
        let y = self.config.scene.object(ObjectId(1)).placement.unwrap().xyz[1];
        self.tip(limb).translation.y - y
    }
}

/// Where the gripper closes on an object that is moved that far during the approach.
fn closes_beside_m(moved_m: f64) -> f64 {
    let mut machine = Machine::new(perceiving());
    machine.sees(0.0, false);
    machine.act(pick(1, NUMBER));
    machine.reaches(PickPhase::Moving);
    machine.run(0.1);
    machine.sees(moved_m, false);
    machine.reaches(PickPhase::Closing);
    let beside_m = machine.beside_m();
    machine.delivers(1, NUMBER);
    beside_m
}

#[test]
fn an_object_that_moves_during_the_approach_is_grasped_where_it_is() {
    let before = closes_beside_m(0.0);
    let after = closes_beside_m(0.04);
    assert!((after - before - 0.04).abs() < 0.005, "{before} {after}");
    assert_eq!(closes_beside_m(0.005), before, "a grasp forgives that");
}

#[test]
fn an_object_that_vanishes_is_not_grasped_at() {
    let mut machine = Machine::new(perceiving());
    machine.sees(0.0, false);
    machine.act(pick(1, NUMBER));
    machine.reaches(PickPhase::Moving);
    machine.run(0.1);
    machine.sees(0.0, true);
    machine.reaches(PickPhase::Done);
    assert_eq!(machine.outcome(), PickOutcome::Vanished);
    machine.run_until("at rest", Machine::rests);
    assert_eq!(machine.robot.grasps(), 0);
    machine.robot.assert_well_behaved();
}

#[test]
fn an_order_waits_for_the_table_and_not_for_ever() {
    let mut machine = Machine::new(perceiving());
    machine.act(pick(1, NUMBER));
    machine.run(1.0);
    assert_eq!(machine.phase(), PickPhase::Accepted);
    machine.sees(0.0, false);
    machine.delivers(1, NUMBER);
    let numbers = &machine.worlds.last().unwrap().numbers;
    assert_eq!(numbers.len(), config().scene.objects().len());
    machine.act(pick(2, 77));
    machine.run_until("given up", |m| {
        m.node
            .state()
            .pick
            .is_some_and(|it| it.id.interaction.0 == 2 && it.phase == PickPhase::Done)
    });
    assert_eq!(machine.outcome(), PickOutcome::Vanished);
}

#[test]
fn a_killed_arm_fetches_from_where_the_object_is_by_then() {
    let mut machine = Machine::new(perceiving());
    machine.sees(0.0, false);
    machine.act(pick(1, NUMBER));
    machine.reaches(PickPhase::Moving);
    machine.restart();
    machine.sees(0.03, false);
    machine.run(0.05);
    machine.restart();
    machine.run(0.2);
    assert_eq!(machine.phase(), PickPhase::Moving, "it knows no table yet");
    machine.sees(0.03, false);
    machine.delivers(1, NUMBER);
}
