//! The way that people see.

use super::*;
use messages::{MotionPhase, TRAJECTORY_POINTS_MAX};

fn latest(machine: &Machine) -> &TrajectoryView {
    machine.courses.last().unwrap()
}

fn names(course: &TrajectoryView) -> Vec<MotionPhase> {
    course.phases.iter().map(|way| way.phase).collect()
}

fn assert_makes_sense(course: &TrajectoryView) {
    let points: usize = course.phases.iter().map(|way| way.points_m.len()).sum();
    assert!((2..=TRAJECTORY_POINTS_MAX).contains(&points), "{points} points");
    assert!(course.phases.iter().all(|way| way.points_m.len() == way.t_s.len()));
    let times: Vec<f64> = course.phases.iter().flat_map(|way| way.t_s.clone()).collect();
    assert!(times.is_sorted() && times[0] == 0.0, "{times:?}");
    for pair in course.phases.windows(2) {
        let (end, begin) = (pair[0].points_m.last().unwrap(), pair[1].points_m[0]);
        assert!(
            (0..3).all(|k| (end[k] - begin[k]).abs() < 1e-6),
            "a leap before {:?}",
            pair[1].phase
        );
    }
}

fn distance_m(machine: &Machine, course: &TrajectoryView, point: [f64; 3]) -> f64 {
    let tip = machine.tip(Limb::BOTH[usize::from(course.limb)]).translation.vector;
    (tip - nalgebra::Vector3::from(point)).norm()
}

#[test]
fn an_arm_that_begins_tells_that_it_goes_nowhere() {
    let machine = Machine::new(config());
    assert_eq!(machine.courses, [TrajectoryView::default()]);
}

#[test]
fn a_pick_tells_its_way_with_each_phase_and_an_empty_one_in_the_end() {
    let mut machine = Machine::new(config_at(10.0));
    machine.act(pick(7, 3));
    machine.run_until("moving", |m| m.phase() == PickPhase::Moving);
    machine.run(0.01);
    let course = latest(&machine).clone();
    assert_makes_sense(&course);
    assert_eq!((course.interaction, course.attempt, course.object), (7, 1, Some(3)));
    assert_eq!(names(&course).last(), Some(&MotionPhase::Return));
    machine.run_until("at rest", |m| m.outcome() == PickOutcome::Delivered && m.rests());
    machine.run(0.1);
    assert_eq!(*latest(&machine), TrajectoryView::default());
    let told = machine.courses.iter().filter(|told| told.phases == course.phases).count();
    assert_eq!(told, course.phases.len(), "once a phase");
    assert_eq!(machine.courses.len(), told + 2, "and empty before and after");
}

#[test]
fn the_gripper_is_where_its_way_says_at_any_time() {
    let mut machine = Machine::new(config_at(2.0));
    machine.act(pick(1, 0));
    machine.run_until("moving", |m| m.phase() == PickPhase::Moving);
    while machine.outcome() == PickOutcome::Pending {
        machine.run(0.05);
        let course = latest(&machine);
        let s = (machine.now.ns() as f64 - course.began_ns as f64) / 1e9;
        let ways = course.phases.iter();
        let mut points = ways.flat_map(|way| way.t_s.iter().zip(&way.points_m));
        let Some((_, point)) = points.find(|(t_s, _)| **t_s >= s) else { continue };
        // The next point of the way is at most one stretch ahead.
        assert!(distance_m(&machine, course, *point) < 0.08, "{s} s");
    }
}

#[test]
fn a_stopped_arm_has_no_way_and_a_released_one_a_new_one() {
    let mut machine = Machine::new(config());
    machine.act(pick(1, 2));
    machine.run_until("moving", |m| m.phase() == PickPhase::Moving);
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
fn the_way_survives_a_restart_of_the_arm() {
    let mut machine = Machine::new(config());
    machine.act(pick(1, 4));
    machine.run_until("held", |m| m.phase() == PickPhase::Holding);
    machine.courses.clear();
    machine.restart();
    machine.run(0.2);
    let course = latest(&machine);
    assert_makes_sense(course);
    assert_eq!((course.interaction, course.attempt, course.object), (1, 1, Some(4)));
    assert!(!names(course).contains(&MotionPhase::Approach), "it is held already");
}

#[test]
fn pointing_tells_its_way_and_what_it_is_for() {
    let mut machine = Machine::new(config_at(10.0));
    machine.act(point(1, 2));
    machine.run(0.05);
    let course = latest(&machine);
    assert_makes_sense(course);
    assert_eq!((course.interaction, course.object), (0, Some(2)));
    assert_eq!(names(course), [MotionPhase::Aim]);
    machine.run_until("aimed", |m| m.status().aimed_at().is_some());
    machine.run(0.05);
    assert_eq!(*latest(&machine), TrajectoryView::default());
}
