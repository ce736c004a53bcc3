//! Planning apart from the reducer: a request states all that a plan depends on, and its result comes
//! back as an input. The service solves requests on a thread of its own, a simulation in its only one.
//!
//! A flight holds neither the world of a request nor the plan: both follow from what the node was given
//! before, and a node that is given a result without its plan makes the plan itself.

use crate::executor::Program;
use crate::program::{Planner, Refusal};
use crate::state::{ArmState, Held};
use crate::world::World;
use crate::{ArmNode, Config, Fx, Out};
use arm_driver::Measured;
use manipulation::Limb;
use messages::pick::Pick;
use scene::ObjectId;
use serde::{Deserialize, Serialize};
use service::Time;
use std::sync::Arc;

/// Change of the fingers' width that a plan bears, metres: the pause after they open covers it.
const WIDTH_M: f64 = 0.002;

/// A motion that the arm wants.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum Motion {
    /// Take the object of a pick and bring it to where it is let go.
    Take(Pick),
    /// Carry the held object on to where it is let go.
    Carry(Pick, Held),
    /// Let go of the held object.
    Release(Pick, Held),
    /// Aim at an object.
    Aim(ObjectId),
    /// Bring a limb to rest.
    Rest(Limb),
}

/// The facts that a plan rests on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Basis {
    pub(crate) motion: Motion,
    pub(crate) state: ArmState,
    pub(crate) measured: Measured,
    pub(crate) world: Arc<World>,
}

/// A motion to be planned.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanRequest {
    /// Number in this run of the service.
    number: u64,
    motion: Motion,
    state: ArmState,
    measured: Measured,
    /// None in a request that was read from a flight.
    #[serde(skip)]
    around: Option<(Arc<Config>, Arc<World>)>,
}

/// Result of a request.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Planned {
    /// Number of the request.
    number: u64,
    /// None in a result that was read from a flight.
    #[serde(skip)]
    program: Option<Result<Program, Refusal>>,
}

/// Planning of the wanted motion. At most one request counts; the results of earlier ones are dropped.
#[derive(Debug, Default)]
pub(crate) struct Planning {
    /// Number of the latest request.
    number: u64,
    stage: Stage,
}

#[derive(Debug, Default)]
enum Stage {
    #[default]
    Idle,
    Requested(Box<Basis>, Time),
    Done(Box<Basis>, Result<Program, Refusal>),
}

impl Basis {
    fn solve(&self, config: &Config) -> Result<Program, Refusal> {
        let planner = Planner::new(config, &self.world, &self.state, &self.measured);
        match &self.motion {
            Motion::Take(pick) => planner.take(pick),
            Motion::Carry(pick, held) => planner.carry(pick, held),
            Motion::Release(pick, held) => Ok(planner.release(pick.id, held)),
            Motion::Aim(object) => planner.aim(*object),
            Motion::Rest(limb) => planner.rest(*limb),
        }
    }

    /// Returns whether a plan that rests on these facts can be carried out on the present ones: the same
    /// motion among the same objects, and the arm where it was.
    fn fits(&self, present: &Self) -> bool {
        self.motion == present.motion
            && self.state.has_same_objects(&present.state)
            && stands_as(&self.measured, &present.measured)
            && self.world.fits(&present.world)
    }
}

fn stands_as(planned: &Measured, present: &Measured) -> bool {
    let near =
        |a: &[f64], b: &[f64], within: f64| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= within);
    let (own, others) = (&planned.posture, &present.posture);
    Limb::BOTH
        .into_iter()
        .all(|limb| near(&own.joints[limb], &others.joints[limb], planned.accuracy_rad))
        && near(&own.width_m, &others.width_m, WIDTH_M)
}

impl PlanRequest {
    /// Plans the motion. Equal requests have equal results.
    pub fn solve(self) -> Planned {
        let Self { number, motion, state, measured, around } = self;
        let program = around.map(|(config, world)| {
            let basis = Basis { motion, state, measured, world };
            basis.solve(&config)
        });
        Planned { number, program }
    }
}

impl Planning {
    /// Takes the result of the latest request. Returns whether it is one.
    pub(crate) fn on_planned(&mut self, planned: Planned, config: &Config) -> bool {
        if planned.number != self.number {
            return false;
        }
        match std::mem::take(&mut self.stage) {
            Stage::Requested(basis, _) => {
                let program = planned.program.unwrap_or_else(|| basis.solve(config));
                self.stage = Stage::Done(basis, program);
                true
            }
            other => {
                self.stage = other;
                false
            }
        }
    }

    /// Returns whether nothing is planned, and no plan waits.
    pub(crate) fn is_idle(&self) -> bool {
        matches!(self.stage, Stage::Idle)
    }

    /// Returns the number of the latest request.
    pub(crate) fn number(&self) -> u64 {
        self.number
    }

    /// Counts requests from that number on.
    pub(crate) fn go_on_from(&mut self, number: u64) {
        self.number = number;
    }

    /// Gives up the plan.
    pub(crate) fn cancel(&mut self) {
        self.stage = Stage::Idle;
    }

    /// Returns the time of the request that is being solved.
    pub(crate) fn requested(&self) -> Option<Time> {
        match self.stage {
            Stage::Requested(_, at) => Some(at),
            Stage::Idle | Stage::Done(..) => None,
        }
    }
}

impl ArmNode {
    /// Returns the plan of `motion`, or the reason why there is none. `None` means that it is being
    /// planned: it is requested unless it was, once every record so far is durable.
    pub(crate) fn plan(
        &mut self,
        motion: Motion,
        now: Time,
        fx: &mut Fx,
    ) -> Option<Result<Program, Refusal>> {
        let (state, measured) = (self.state.clone(), self.driver.measured());
        let basis = Basis { motion, state, measured, world: Arc::clone(&self.world) };
        match std::mem::take(&mut self.planning.stage) {
            Stage::Done(planned, program) if planned.fits(&basis) => {
                // Later estimates are compared with those that it rests on.
                self.planned_world = planned.world;
                return Some(program);
            }
            Stage::Requested(requested, at) if requested.fits(&basis) => {
                self.planning.stage = Stage::Requested(requested, at);
                return None;
            }
            // What it rested on has changed.
            Stage::Done(..) | Stage::Requested(..) | Stage::Idle => {}
        }
        self.planning.number += 1;
        fx.publish(Out::Plan(Box::new(PlanRequest {
            number: self.planning.number,
            motion: basis.motion,
            state: basis.state.clone(),
            measured: basis.measured,
            around: Some((Arc::clone(&self.config), Arc::clone(&basis.world))),
        })));
        self.planning.stage = Stage::Requested(Box::new(basis), now);
        None
    }
}
