//! The simulated arm: it carries out the orders of the manager in the phases of the robot's arm, and obeys the motion
//! stop. It plans no motion and reaches every object that has a place.

use dialogue::manager::{Act, MotionStop};
use scene::{ObjectId, Scene};
use vocabulary::ids::PickId;
use vocabulary::time::Time;
use vocabulary::{ActKind, PickOutcome, PickPhase, RESUME_AFTER, Task};

use crate::motion::{Kind, Mover};

/// Where the gripper rests, metres, frame `base`.
const REST: [f64; 3] = [0.36, 0.0, 0.3];
/// Where it hands over: forward, to the side of the object (positive: the robot's left), and up.
const HAND_OVER: [f64; 3] = [0.8, 0.3, 0.22];
/// Height above an object from which it descends, metres.
const HOVER_M: f64 = 0.15;
/// Times in which the fingers close and open, seconds.
const CLOSE_S: f64 = 0.6;
const OPEN_S: f64 = 0.9;
/// Time in which a user puts an object between the fingers, seconds.
const TAKE_S: f64 = 1.5;
/// Time in which the arm comes to rest after a stop, seconds.
const HALT_S: f64 = 0.1;

/// An order of the manager, and how far it has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Order {
    pub(crate) id: PickId,
    pub(crate) object: ObjectId,
    pub(crate) task: Task,
    pub(crate) phase: PickPhase,
    pub(crate) outcome: PickOutcome,
}

/// The arm and the objects in its reach.
#[derive(Clone, Debug)]
pub(crate) struct Arm {
    /// Place of each object, metres, frame `base`; `None` if unknown.
    places: Vec<Option<[f64; 3]>>,
    /// Objects that a user has.
    with_user: Vec<bool>,
    mover: Mover,
    order: Option<Order>,
    held: Option<ObjectId>,
    stopped: Option<Time>,
    /// Seconds until a stopped arm is at rest.
    halts_s: f64,
}

impl Arm {
    /// An arm at rest before the objects of a scene.
    pub(crate) fn new(scene: &Scene) -> Self {
        let place = |object: &scene::Object| object.placement.map(|placed| placed.xyz);
        let places: Vec<_> = scene.objects().iter().map(place).collect();
        Self {
            with_user: vec![false; places.len()],
            places,
            mover: Mover::new(REST),
            order: None,
            held: None,
            stopped: None,
            halts_s: 0.0,
        }
    }

    /// Returns the latest order.
    pub(crate) fn order(&self) -> Option<&Order> {
        self.order.as_ref()
    }

    /// Returns the object between the fingers.
    pub(crate) fn held(&self) -> Option<ObjectId> {
        self.held
    }

    /// Returns the place of the gripper, metres, frame `base`.
    pub(crate) fn gripper(&self) -> [f64; 3] {
        self.mover.at()
    }

    /// Returns the place of an object; `None` if a user has it, or it is unknown.
    pub(crate) fn place_of(&self, object: ObjectId) -> Option<[f64; 3]> {
        if self.held == Some(object) {
            return Some(self.mover.at());
        }
        self.places[object.index()].filter(|_| !self.with_user[object.index()])
    }

    /// Returns whether it moves.
    pub(crate) fn moves(&self) -> bool {
        let is_at_rest = self.stopped.is_some() && self.halts_s <= 0.0;
        self.mover.kind().is_some() && !is_at_rest
    }

    /// Returns the state of the motion stop.
    pub(crate) fn motion_stop(&self) -> MotionStop {
        match self.stopped {
            None => MotionStop::Released,
            Some(_) if self.halts_s > 0.0 => MotionStop::Stopping,
            Some(_) => MotionStop::Stopped,
        }
    }

    /// Returns the seconds until the order is done; 0 without one.
    pub(crate) fn remaining_s(&self) -> f64 {
        self.open().map_or(0.0, |_| self.mover.remaining_s())
    }

    /// Latches the motion stop; again, so that a release has to wait from now on.
    pub(crate) fn stop(&mut self, now: Time) {
        if self.stopped.is_none() && self.mover.kind().is_some() {
            self.halts_s = HALT_S;
        }
        self.stopped = Some(now);
    }

    /// Releases the motion stop; returns false if the stop is too young.
    pub(crate) fn resume(&mut self, now: Time) -> bool {
        let is_old = self.stopped.is_none_or(|at| now >= at + RESUME_AFTER);
        if is_old {
            (self.stopped, self.halts_s) = (None, 0.0);
        }
        is_old
    }

    /// Obeys the standing act. It may be given again and counts once.
    pub(crate) fn on_act(&mut self, act: &Act) {
        let Some((id, object)) = act.pick else { return };
        let is_known = self.order.is_some_and(|order| order.id == id);
        match act.kind {
            ActKind::Pick if !is_known => self.accept(id, object, Task::Fetch),
            ActKind::PutBack if !is_known => self.accept(id, object, Task::PutBack),
            ActKind::Cancel if is_known => self.cancel(),
            _ => {}
        }
    }

    /// Moves for some seconds.
    pub(crate) fn advance(&mut self, seconds: f64) {
        if self.stopped.is_some() {
            self.halts_s = (self.halts_s - seconds).max(0.0);
            return;
        }
        if self.open().is_some_and(|order| order.phase == PickPhase::Accepted) {
            self.enter(PickPhase::Moving);
        }
        let mut left_s = seconds;
        while self.mover.kind().is_some() {
            match self.mover.advance(left_s) {
                None => return,
                Some(rest_s) => left_s = rest_s,
            }
            self.end_phase();
        }
    }

    fn open(&self) -> Option<Order> {
        self.order.filter(|order| order.phase != PickPhase::Done)
    }

    fn accept(&mut self, id: PickId, object: ObjectId, task: Task) {
        let (phase, outcome) = (PickPhase::Accepted, PickOutcome::Pending);
        self.order = Some(Order { id, object, task, phase, outcome });
        // In a simulated world what was handed over is put back by hand before it is fetched again.
        self.with_user[object.index()] = task == Task::PutBack;
        if self.places[object.index()].is_none() {
            self.end(PickOutcome::Unreachable);
        }
    }

    /// Calls the order off. What the fingers hold goes back to its place, unless they open for the user already.
    fn cancel(&mut self) {
        let Some(order) = self.open() else { return };
        match order.phase {
            PickPhase::Accepted | PickPhase::Moving => self.end(PickOutcome::Cancelled),
            PickPhase::Closing | PickPhase::Holding
                if order.task == Task::Fetch && !self.lets_go() =>
            {
                self.enter(PickPhase::Returning);
            }
            _ => {}
        }
    }

    fn lets_go(&self) -> bool {
        let phase = self.open().map(|order| order.phase);
        phase == Some(PickPhase::Holding) && self.mover.kind() == Some(Kind::Open)
    }

    /// Begins a phase with its movements.
    fn enter(&mut self, phase: PickPhase) {
        let Some(order) = &mut self.order else { return };
        order.phase = phase;
        let Some(place) = self.places[order.object.index()] else { return };
        let above = [place[0], place[1], place[2] + HOVER_M];
        let [x, y, z] = HAND_OVER;
        let user = [x, if place[1] < 0.0 { -y } else { y }, z];
        let travel = |to| (Kind::Travel, to, 0.0);
        let at = self.mover.at();
        match (phase, order.task) {
            (PickPhase::Moving, Task::Fetch) => self.mover.go(&[travel(above), travel(place)]),
            (PickPhase::Moving, Task::PutBack) => self.mover.go(&[travel(user)]),
            (PickPhase::Closing, Task::Fetch) => self.mover.go(&[(Kind::Close, at, CLOSE_S)]),
            (PickPhase::Closing, Task::PutBack) => {
                self.mover.go(&[(Kind::Close, at, TAKE_S + CLOSE_S)]);
            }
            (PickPhase::Holding, Task::Fetch) => {
                self.mover.go(&[travel(above), travel(user), (Kind::Open, user, OPEN_S)]);
            }
            (PickPhase::Returning, _) if self.held.is_none() => {
                self.mover.go(&[(Kind::Open, at, OPEN_S)]);
            }
            (PickPhase::Holding | PickPhase::Returning, _) => {
                self.mover.go(&[travel(above), travel(place), (Kind::Open, place, OPEN_S)]);
            }
            (PickPhase::Idle | PickPhase::Accepted | PickPhase::Done, _) => {}
        }
    }

    /// Goes on to the next phase once the movements of the present one have ended.
    fn end_phase(&mut self) {
        let Some(order) = self.open() else { return };
        match order.phase {
            PickPhase::Moving => self.enter(PickPhase::Closing),
            PickPhase::Closing => {
                self.held = Some(order.object);
                self.with_user[order.object.index()] = false;
                self.enter(PickPhase::Holding);
            }
            PickPhase::Holding if order.task == Task::Fetch => {
                self.with_user[order.object.index()] = true;
                self.end(PickOutcome::Delivered);
            }
            PickPhase::Holding => self.end(PickOutcome::PutBack),
            PickPhase::Returning => self.end(PickOutcome::Cancelled),
            PickPhase::Idle | PickPhase::Accepted | PickPhase::Done => {}
        }
    }

    /// Ends the order; the gripper goes to rest.
    fn end(&mut self, outcome: PickOutcome) {
        if let Some(order) = &mut self.order {
            (order.phase, order.outcome) = (PickPhase::Done, outcome);
        }
        self.held = None;
        if self.mover.at() != REST {
            self.mover.go(&[(Kind::Travel, REST, 0.0)]);
        }
    }
}
