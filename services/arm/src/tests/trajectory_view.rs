//! The way that people see.

use super::*;
use messages::{MotionPhase, TRAJECTORY_POINTS_MAX};

fn latest(machine: &Machine) -> &TrajectoryView {
    machine.trajectories.last().unwrap()
}

fn names(view: &TrajectoryView) -> Vec<MotionPhase> {
    view.phases.iter().map(|way| way.phase).collect()
}

fn assert_makes_sense(view: &TrajectoryView) {
    let points: usize = view.phases.iter().map(|way| way.points_m.len()).sum();
    assert!((2..=TRAJECTORY_POINTS_MAX).contains(&points), "{points} points");
    assert!(view.phases.iter().all(|way| way.points_m.len() == way.t_s.len()));
    let times: Vec<f64> = view.phases.iter().flat_map(|way| way.t_s.clone()).collect();
    assert!(times.is_sorted() && times[0] == 0.0, "{times:?}");
    for pair in view.phases.windows(2) {
        let (end, begin) = (pair[0].points_m.last().unwrap(), pair[1].points_m[0]);
        assert!(
            (0..3).all(|k| (end[k] - begin[k]).abs() < 1e-6),
            "a leap before {:?}",
            pair[1].phase
        );
    }
}

fn distance_m(machine: &Machine, view: &TrajectoryView, point: [f64; 3]) -> f64 {
    let tip = machine.tip(Limb::BOTH[usize::from(view.limb)]).translation.vector;
    (tip - nalgebra::Vector3::from(point)).norm()
}

#[test]
fn starting_arm_publishes_an_empty_trajectory() {
    let machine = Machine::new(config());
    assert_eq!(machine.trajectories, [TrajectoryView::default()]);
}

#[test]
fn arm_publishes_the_trajectory_of_a_pick_with_each_phase_and_an_empty_one_at_the_end() {
    let mut machine = Machine::new(config_at(10.0));
    machine.act(pick(7, 3));
    machine.reaches(PickPhase::Moving);
    machine.run(0.01);
    let view = latest(&machine).clone();
    assert_makes_sense(&view);
    assert_eq!((view.interaction, view.attempt, view.object), (7, 1, Some(3)));
    assert_eq!(names(&view).last(), Some(&MotionPhase::Return));
    machine.run_until("at rest", |m| m.outcome() == PickOutcome::Delivered && m.rests());
    machine.run(0.1);
    assert_eq!(*latest(&machine), TrajectoryView::default());
    let published = machine.trajectories.iter().filter(|sent| sent.phases == view.phases).count();
    assert_eq!(published, view.phases.len(), "once a phase");
    assert_eq!(machine.trajectories.len(), published + 2, "and empty before and after");
}

#[test]
fn gripper_follows_its_published_trajectory() {
    let mut machine = Machine::picking(config_at(2.0), 0, PickPhase::Moving);
    while machine.outcome() == PickOutcome::Pending {
        machine.run(0.05);
        let view = latest(&machine);
        let s = (machine.now.ns() as f64 - view.began_ns as f64) / 1e9;
        let ways = view.phases.iter();
        let mut points = ways.flat_map(|way| way.t_s.iter().zip(&way.points_m));
        let Some((_, point)) = points.find(|(t_s, _)| **t_s >= s) else { continue };
        // The next point of the way is at most one stretch ahead.
        assert!(distance_m(&machine, view, *point) < 0.08, "{s} s");
    }
}

#[test]
fn stopped_arm_publishes_no_trajectory_and_a_released_one_a_new_one() {
    let mut machine = Machine::picking(config(), 2, PickPhase::Moving);
    machine.run(1.0);
    let before = latest(&machine).clone();
    machine.motion(MotionOrder::Stop);
    machine.run(0.5);
    assert_eq!(*latest(&machine), TrajectoryView::default());
    machine.motion(MotionOrder::Resume);
    machine.run(0.5);
    let after = latest(&machine);
    assert_makes_sense(after);
    assert_eq!((after.interaction, after.object), (1, Some(2)));
    assert!(after.began_ns > before.began_ns);
    assert!(distance_m(&machine, after, after.phases[0].points_m[0]) < 0.3);
}

#[test]
fn trajectory_is_republished_after_a_restart_of_the_arm() {
    let mut machine = Machine::picking(config(), 4, PickPhase::Holding);
    machine.trajectories.clear();
    machine.restart();
    machine.run(0.2);
    let view = latest(&machine);
    assert_makes_sense(view);
    assert_eq!((view.interaction, view.attempt, view.object), (1, 1, Some(4)));
    assert!(!names(view).contains(&MotionPhase::Approach), "it is held already");
}

#[test]
fn arm_publishes_the_trajectory_and_object_of_pointing() {
    let mut machine = Machine::new(config_at(10.0));
    machine.act(point(1, 2));
    machine.run(0.05);
    let view = latest(&machine);
    assert_makes_sense(view);
    assert_eq!((view.interaction, view.object), (0, Some(2)));
    assert_eq!(names(view), [MotionPhase::Aim]);
    machine.run_until("aimed", |m| m.status().aimed_at().is_some());
    machine.run(0.05);
    assert_eq!(*latest(&machine), TrajectoryView::default());
}
