//! Listing and verification of the arm's journal.

use std::collections::BTreeMap;

use messages::pick::Pick;
use messages::{MotionOrder, PickId, PickOutcome, PickPhase, Task};
use scene::{Scene, count};
use service::exit::Failure;
use service::inspection::{Part, SharedFacts};

use crate::journal_record::name;
use crate::state::{Cause, Record};

/// Renders a record as one line; without its scene, objects have numbers.
pub(crate) fn line(scene: Option<&Scene>, record: &Record) -> String {
    let state = &record.state;
    let pick = state.pick.as_ref().map_or("no pick yet".to_owned(), |pick| {
        let PickId { interaction, attempt } = pick.id;
        let object = name(scene, pick.object);
        let what = match pick.task {
            Task::Fetch => format!("pick {interaction}.{attempt} of {object}"),
            Task::PutBack => format!("putting back {object} ({interaction}.{attempt})"),
        };
        let opens = state.is_letting_go() && pick.phase == PickPhase::Holding;
        format!("{what}: {}", if opens { "letting go of it" } else { progress(pick) })
    });
    let held =
        state.held.as_ref().map(|held| format!(", {} in the gripper", name(scene, held.object)));
    let is_said = record.cause == Cause::Motion(MotionOrder::Stop);
    let stopped = if state.stopped && !is_said { ", motion stop latched" } else { "" };
    format!("{}: {pick}{}{stopped}", cause(record.cause), held.unwrap_or_default())
}

fn cause(cause: Cause) -> &'static str {
    match cause {
        Cause::Snapshot => "state at the start of the file",
        Cause::SceneChanged => "scene changed",
        Cause::Ordered => "order received",
        Cause::Phase => "next phase",
        Cause::Missed => "grasp missed",
        Cause::Ended => "pick ended",
        Cause::Motion(MotionOrder::Stop) => "motion stop latched",
        Cause::Motion(MotionOrder::Resume) => "motion stop released",
        Cause::Moved => "moved",
        Cause::Rested => "at rest",
        Cause::Blocked => "blocked",
        Cause::Shutdown => "shut down",
    }
}

fn progress(pick: &Pick) -> &'static str {
    match (pick.phase, pick.outcome) {
        (PickPhase::Idle, _) => "idle",
        (PickPhase::Accepted, _) => "accepted",
        (PickPhase::Moving, _) => "moving to it",
        (PickPhase::Closing, _) => "closing the gripper",
        (PickPhase::Holding, _) => "holding it",
        (PickPhase::Returning, _) => "returning it to its place",
        (PickPhase::Done, PickOutcome::Pending) => "done",
        (PickPhase::Done, PickOutcome::Delivered) => "delivered",
        (PickPhase::Done, PickOutcome::Unreachable) => "unreachable",
        (PickPhase::Done, PickOutcome::Interrupted) => "interrupted",
        (PickPhase::Done, PickOutcome::Cancelled) => "cancelled",
        (PickPhase::Done, PickOutcome::Missed) => "missed",
        (PickPhase::Done, PickOutcome::Blocked) => "blocked",
        (PickPhase::Done, PickOutcome::PutBack) => "put back",
        (PickPhase::Done, PickOutcome::Kept) => "called off, no way back: the gripper keeps it",
        (PickPhase::Done, PickOutcome::Vanished) => "no longer there",
    }
}

/// The picks taken on, with their objects, and the motion stop.
pub(crate) fn shared_facts(parts: &[Part<Record>]) -> SharedFacts {
    let records = || parts.iter().flat_map(|part| part.records());
    let picks = records().filter_map(|record| record.state.pick);
    let picks = picks.map(|pick| (pick.id.interaction.0, pick.id.attempt, pick.object.0));
    let stopped = records().last().is_some_and(|record| record.state.stopped);
    SharedFacts { picks: picks.collect(), stopped: Some(stopped), ..SharedFacts::default() }
}

/// Results of one interaction.
#[derive(Debug, Default)]
struct Tally {
    lifted: u32,
    delivered: u32,
    /// Deliveries put back.
    put_back: u32,
}

/// One object and task per pick, no step back, and in each interaction at most one grasp that lifts to
/// fetch and is not called off, one delivery, and one object put back.
pub(crate) fn verify(parts: &[Part<Record>]) -> Result<Vec<String>, Failure> {
    let mut tallies: BTreeMap<u64, Tally> = BTreeMap::new();
    let mut before: Option<Pick> = None;
    for part in parts {
        for (seq, record) in part.numbered() {
            let Some(pick) = record.state.pick else { continue };
            step(before.as_ref(), &pick, &mut tallies).map_err(|what| part.broken(seq, what))?;
            before = Some(pick);
        }
    }
    let delivered: u32 = tallies.values().map(|tally| tally.delivered).sum();
    let delivered = count(delivered, "interaction");
    Ok(vec![format!("delivered in {delivered}, at most once each")])
}

fn step(
    before: Option<&Pick>,
    pick: &Pick,
    tallies: &mut BTreeMap<u64, Tally>,
) -> Result<(), String> {
    let PickId { interaction, attempt } = pick.id;
    let name = format!("pick {interaction}.{attempt}");
    let same = before.filter(|before| before.id == pick.id);
    if before.is_some_and(|before| pick.id < before.id) {
        return Err(format!("{name} follows a later one"));
    }
    if same.is_some_and(|before| before.object != pick.object) {
        return Err(format!("{name} is of two objects"));
    }
    if same.is_some_and(|before| before.task != pick.task) {
        return Err(format!("{name} is of two tasks"));
    }
    if same.is_some_and(|before| before.phase > pick.phase) {
        return Err(format!("{name} goes back to {:?}", pick.phase));
    }
    let phase_before = same.map(|before| before.phase);
    let tally = tallies.entry(interaction.0).or_default();
    let lifts = pick.phase == PickPhase::Holding && phase_before != Some(PickPhase::Holding);
    if lifts && pick.task == Task::Fetch {
        tally.lifted += 1;
    }
    let returned = phase_before == Some(PickPhase::Returning);
    if returned && pick.outcome == PickOutcome::Delivered {
        return Err(format!("{name} was delivered though it was called off"));
    }
    if pick.phase == PickPhase::Returning && phase_before == Some(PickPhase::Holding) {
        tally.lifted = tally.lifted.saturating_sub(1);
    }
    if pick.phase == PickPhase::Done && phase_before != Some(PickPhase::Done) {
        tally.delivered += u32::from(pick.outcome == PickOutcome::Delivered);
        tally.put_back += u32::from(pick.outcome == PickOutcome::PutBack);
    }
    match tally {
        Tally { lifted: 0..=1, delivered: 0..=1, put_back: 0..=1 } => Ok(()),
        Tally { lifted, delivered, put_back } => {
            let times = |number: &u32| count(*number, "time");
            let (lifted, delivered, put_back) = (times(lifted), times(delivered), times(put_back));
            Err(format!(
                "interaction {interaction} lifted {lifted}, delivered {delivered} and put back {put_back}"
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use messages::InteractionId;
    use scene::ObjectId;

    use super::*;

    fn pick(interaction: u64, attempt: u32, phase: PickPhase) -> Pick {
        let outcome = match phase {
            PickPhase::Done => PickOutcome::Delivered,
            _ => PickOutcome::Pending,
        };
        let id = PickId { interaction: InteractionId(interaction), attempt };
        Pick { id, object: ObjectId(1), task: Task::Fetch, phase, outcome }
    }

    fn put_back(attempt: u32, phase: PickPhase) -> Pick {
        let pick = Pick { task: Task::PutBack, ..pick(3, attempt, phase) };
        match phase {
            PickPhase::Done => Pick { outcome: PickOutcome::PutBack, ..pick },
            _ => pick,
        }
    }

    fn check(picks: &[Pick]) -> Result<(), String> {
        let mut tallies = BTreeMap::new();
        let mut before: Option<Pick> = None;
        picks.iter().try_for_each(|pick| {
            let judged = step(before.as_ref(), pick, &mut tallies);
            before = Some(*pick);
            judged
        })
    }

    #[test]
    fn arm_advances_a_pick_and_completes_it_once() {
        use PickPhase::{Accepted, Closing, Done, Holding, Moving, Returning};
        let phases = [Accepted, Moving, Closing, Closing, Holding, Holding, Done, Done];
        let picks: Vec<Pick> = phases.map(|phase| pick(3, 1, phase)).to_vec();
        assert_eq!(check(&picks), Ok(()));
        assert_eq!(check(&[picks.clone(), vec![pick(4, 1, Done)]].concat()), Ok(()));
        let and_back = [picks, vec![put_back(2, Holding), put_back(2, Done)]].concat();
        assert_eq!(check(&and_back), Ok(()));
        let twice = [and_back, vec![put_back(3, Holding), put_back(3, Done)]].concat();
        assert!(check(&twice).is_err());
        let called_off = [Holding, Returning, Returning].map(|phase| pick(3, 1, phase));
        let cancelled = Pick { outcome: PickOutcome::Cancelled, ..pick(3, 1, Done) };
        let other = [Holding, Done].map(|phase| pick(3, 2, phase));
        assert_eq!(check(&[&called_off[..], &[cancelled], &other].concat()), Ok(()));
        let wrong = [
            vec![pick(3, 1, Returning), pick(3, 1, Holding)],
            vec![pick(3, 1, Holding), pick(3, 1, Returning), pick(3, 1, Done)],
            vec![pick(3, 1, Moving), pick(3, 1, Accepted)],
            vec![pick(3, 1, Done), pick(3, 2, Done)],
            vec![pick(3, 1, Holding), pick(3, 2, Holding)],
            vec![pick(3, 1, Moving), pick(2, 1, Moving)],
            vec![pick(3, 1, Moving), Pick { object: ObjectId(2), ..pick(3, 1, Closing) }],
            vec![pick(3, 1, Moving), put_back(1, Closing)],
        ];
        for picks in wrong {
            assert!(check(&picks).is_err(), "{picks:?}");
        }
    }
}
