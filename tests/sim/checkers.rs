//! What must hold after any dialogue, read from the journals as an outsider would.

use crate::world::World;
use config::Settings;
use dialogue::manager::{Cause, refold, refold_since};
use messages::{Outcome, PickOutcome, PickPhase};
use speech::record::Record as Spoken;

type Verdict = Result<(), String>;

/// Every check, the most telling first.
pub(crate) fn check(world: &World) -> Verdict {
    ensure(world.change.is_none(), || "the scene has never changed".to_owned())?;
    delivered_the_right_one(world)?;
    picked_once(world)?;
    numbered_without_gap(world)?;
    applied_each_once(world)?;
    nothing_premature(world)?;
    belief_refolds(world)
}

fn ensure(holds: bool, what: impl FnOnce() -> String) -> Verdict {
    if holds { Ok(()) } else { Err(what()) }
}

fn delivered_the_right_one(world: &World) -> Verdict {
    let wanted = (Outcome::Delivered, Some(world.person.wanted));
    ensure(world.outcome() == Some(wanted), || format!("the end was {:?}", world.outcome()))
}

/// At most one grasp that holds and one end for each interaction (I4), of the ordered object (I5).
fn picked_once(world: &World) -> Verdict {
    let picks: Vec<_> = world.arm.journal().iter().filter_map(|r| r.state.pick).collect();
    let entered = |phase| {
        picks.windows(2).filter(|w| w[1].phase == phase && w[0].phase != phase).count()
            + usize::from(picks.first().is_some_and(|pick| pick.phase == phase))
    };
    ensure(entered(PickPhase::Holding) <= 1, || "held more than once".to_owned())?;
    ensure(entered(PickPhase::Done) <= 1, || "done more than once".to_owned())?;
    let Some(last) = picks.last() else { return Err("no pick in the arm's journal".to_owned()) };
    ensure(last.outcome == PickOutcome::Delivered, || format!("the pick ended as {last:?}"))?;
    ensure(last.object == world.person.wanted, || format!("{last:?} was not wanted"))
}

fn numbered_without_gap(world: &World) -> Verdict {
    let accepted = world.speech.journal().iter().filter_map(|record| match record {
        Spoken::Accepted(accepted) => Some((accepted.seq.0, accepted.key)),
        Spoken::Presented(_) => None,
    });
    let (numbers, keys): (Vec<_>, Vec<_>) = accepted.unzip();
    let expected: Vec<u64> = (1..=numbers.len() as u64).collect();
    ensure(numbers == expected, || format!("accepted as {numbers:?}"))?;
    let mut distinct = keys.clone();
    distinct.sort_unstable();
    distinct.dedup();
    ensure(distinct.len() == keys.len(), || "one sentence was accepted twice".to_owned())?;
    let lost = world.person.accepted.iter().find(|key| !keys.contains(key));
    ensure(lost.is_none(), || format!("{lost:?} was acknowledged but is not in the journal"))
}

/// Applied in order, each exactly once (I1).
fn applied_each_once(world: &World) -> Verdict {
    let applied = world.policy.journal().iter().filter_map(|record| match &record.cause {
        Cause::Utterance(heard) => Some(heard.seq.0),
        _ => None,
    });
    let applied: Vec<u64> = applied.collect();
    let expected: Vec<u64> = (1..=applied.len() as u64).collect();
    ensure(applied == expected, || format!("applied as {applied:?}"))
}

/// Nothing is seen before it is durable (I3).
fn nothing_premature(world: &World) -> Verdict {
    ensure(world.premature.is_empty(), || world.premature.join("; "))
}

/// The belief and every decision follow from the journal, bit for bit (I8), those before a change
/// of the scene under the former settings and the change itself under the new ones.
fn belief_refolds(world: &World) -> Verdict {
    let manager = |settings: &Settings| settings.manager().map_err(|e| e.to_string());
    let records = world.policy.journal();
    let mut former = 0;
    if let Some((settings, count)) = &world.before {
        let folded = refold(&mut manager(settings)?, &records[..*count]);
        folded.map_err(|e| format!("before the change: {e}"))?;
        former = *count;
    }
    let settings_key = records.last().map_or(0, |record| record.state.settings_key);
    let mut now = manager(&world.settings)?;
    let own = refold_since(&mut now, records, settings_key);
    let own = own.map_err(|e| e.to_string())?;
    ensure(own + former == records.len(), || format!("{own} and {former} of {}", records.len()))
}
