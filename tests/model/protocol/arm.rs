//! Steps of the arm.

use messages::pick::{Order, Pick, judge};
use messages::{InteractionId, PickId, PickOutcome, PickPhase, Task};
use scene::ObjectId;

use super::state::{Arm, Ordered, Phase, State, bit};
use super::{Broken, Cut, Protocol, Service, Step, Visit, commit};

impl Protocol {
    pub(super) fn arm(&self, state: &State, visit: Visit<'_>) {
        let Some(arm) = state.arm else { return };
        if let Some((_, order, called_off)) = state.bus.act.filter(|(_, it, _)| it.object != 0) {
            match called_off {
                false => self.on_order(state, arm, order, visit),
                true => self.call_off(state, arm, order, visit),
            }
        }
        let move_now = |next: &mut State| {
            let stop_seen = next.world.stop_seen;
            next.world.must(!stop_seen, "the arm moves after its stop was confirmed");
        };
        match (arm.phase, state.world.holding) {
            _ if arm.stopped => {}
            (Phase::Accepted, 0) => visit(Step::Grasp, grasp(state, arm, move_now)),
            (Phase::Accepted, _) => {
                let after = Arm { phase: Phase::Holding, ..arm };
                self.record_arm(state, after, &Step::Held, visit);
            }
            (Phase::LettingGo, 0) => {
                let after = Arm { phase: Phase::Delivered, ..arm };
                self.record_arm(state, after, &Step::Done, visit);
            }
            (Phase::Holding, 0) if self.is(Broken::OpenBeforeRecord) => {
                let after = Arm { phase: Phase::Delivered, ..arm };
                self.record_arm(state, after, &Step::Done, visit);
            }
            (Phase::Holding, _) if !self.is(Broken::OpenBeforeRecord) => {
                let after = Arm { phase: Phase::LettingGo, ..arm };
                self.record_arm(state, after, &Step::LetGo, visit);
            }
            (Phase::Returning, 1..) if !self.is(Broken::HandOverCalledOff) => {
                let mut next = state.clone();
                move_now(&mut next);
                next.world.holding = 0;
                visit(Step::PutDown, next);
            }
            (Phase::Returning, 0) => {
                let after = Arm { phase: Phase::Cancelled, ..arm };
                self.record_arm(state, after, &Step::Done, visit);
            }
            (Phase::Holding | Phase::LettingGo | Phase::Returning, _) => {
                let mut next = state.clone();
                move_now(&mut next);
                let world = &mut next.world;
                world
                    .must(world.delivered & bit(arm.pick) == 0, "I4: an object is delivered twice");
                world.must(
                    world.called_off & bit(arm.pick) == 0,
                    "I5: what was called off is handed over",
                );
                world.delivered |= bit(arm.pick);
                world.holding = 0;
                visit(Step::Release, next);
            }
            _ => {}
        }
        if self.stops && state.world.stops == 0 {
            let mut next = state.clone();
            next.world.stops = 1;
            let after = Arm { stopped: true, ..arm };
            self.record_arm(&next, after, &Step::Stop, visit);
        }
        if arm.stopped && state.world.stop_seen {
            let mut next = state.clone();
            next.world.stop_seen = false;
            self.record_arm(&next, Arm { stopped: false, ..arm }, &Step::Resume, visit);
        }
        let mut next = state.clone();
        publish_status(&mut next, arm);
        visit(Step::ArmTick, next);
    }

    pub(super) fn on_order(&self, state: &State, arm: Arm, order: Ordered, visit: Visit<'_>) {
        let latest = latest(arm);
        let id = id(order);
        let judged = judge(latest.as_ref(), id, ObjectId(order.object.into()), Some(Task::Fetch));
        let again = judged == Order::Known && self.is(Broken::RepeatOrder);
        use Phase::{Accepted, Holding, LettingGo, Returning};
        let is_over = !matches!(arm.phase, Accepted | Holding | LettingGo | Returning);
        let by_id = judged == Order::Conflict && self.is(Broken::ReuseAndCompareIdOnly);
        if (judged == Order::Accept || again && is_over) && !by_id {
            if self.is(Broken::MoveBeforeRecord) && state.world.holding == 0 {
                let ready = Arm { pick: order, ..arm };
                let next = grasp(state, ready, |_| {});
                return visit(Step::Grasp, next);
            }
            let after = Arm { pick: order, phase: Phase::Accepted, ..arm };
            self.record_arm(state, after, &|cut| Step::Order(order.interaction, cut), visit);
        }
    }

    /// The order is called off: what is held goes back, unless the gripper opens for the user already.
    fn call_off(&self, state: &State, arm: Arm, order: Ordered, visit: Visit<'_>) {
        let object = ObjectId(order.object.into());
        let phase = match (judge(latest(arm).as_ref(), id(order), object, None), arm.phase) {
            (Order::Accept, _) => Phase::Cancelled,
            (Order::Known, Phase::Accepted) if state.world.holding == 0 => Phase::Cancelled,
            (Order::Known, Phase::Accepted | Phase::Holding) => Phase::Returning,
            _ => return,
        };
        let after = Arm { pick: order, phase, ..arm };
        let forgets = self.is(Broken::CallOffInMemory);
        let record = move |next: &mut State| {
            next.world.called_off |= bit(order);
            if !forgets {
                next.arm_journal = after;
            }
        };
        self.commit_arm(state, after, record, &Step::TurnBack, visit);
    }

    pub(super) fn record_arm(
        &self,
        state: &State,
        after: Arm,
        step: &dyn Fn(Cut) -> Step,
        visit: Visit<'_>,
    ) {
        self.commit_arm(state, after, |next| next.arm_journal = after, step, visit);
    }

    fn commit_arm(
        &self,
        state: &State,
        after: Arm,
        record: impl Fn(&mut State),
        step: &dyn Fn(Cut) -> Step,
        visit: Visit<'_>,
    ) {
        let mut next = state.clone();
        next.arm = Some(after);
        let publish = |next: &mut State| publish_status(next, after);
        for cut in self.cuts(state, false) {
            visit(step(cut), commit(&next, cut, Service::Arm, &record, &[&publish]));
        }
    }
}

fn publish_status(next: &mut State, arm: Arm) {
    next.bus.status = Some((arm.pick, arm.phase));
    next.world.stop_seen |= arm.stopped;
}

fn id(order: Ordered) -> PickId {
    PickId { interaction: InteractionId(order.interaction.into()), attempt: 1 }
}

/// The latest pick as the real judge takes it.
fn latest(arm: Arm) -> Option<Pick> {
    let (phase, outcome) = match arm.phase {
        Phase::None => return None,
        Phase::Accepted => (PickPhase::Accepted, PickOutcome::Pending),
        Phase::Holding | Phase::LettingGo => (PickPhase::Holding, PickOutcome::Pending),
        Phase::Returning => (PickPhase::Returning, PickOutcome::Pending),
        Phase::Cancelled => (PickPhase::Done, PickOutcome::Cancelled),
        Phase::Delivered => (PickPhase::Done, PickOutcome::Delivered),
        Phase::Failed => (PickPhase::Done, PickOutcome::Interrupted),
    };
    let object = ObjectId(arm.pick.object.into());
    Some(Pick { id: id(arm.pick), object, task: Task::Fetch, phase, outcome })
}

/// The arm closes its gripper on the object of its pick.
fn grasp(state: &State, arm: Arm, moves: impl Fn(&mut State)) -> State {
    let mut next = state.clone();
    moves(&mut next);
    let (order, journal) = (arm.pick, state.arm_journal);
    let recorded = journal.pick == order && journal.phase == Phase::Accepted;
    next.world.must(recorded, "I6: the arm moves for a pick that is not in its journal");
    let ordered = next.world.ordered & bit(order) != 0;
    next.world.must(ordered, "I3, I5: the arm grasps what no durable record orders");
    let again = next.world.grasped & 1 << order.interaction != 0;
    next.world.must(!again, "I4: the arm grasps twice");
    next.world.grasped |= 1 << order.interaction;
    next.world.holding = order.object;
    next
}
