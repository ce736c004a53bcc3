//! Invariants of any dialogue, checked on the journals.

use config::Settings;
use dialogue::manager::{Cause, refold, refold_since};
use messages::{InteractionId, Outcome, PickOutcome, PickPhase};
use scene::ObjectId;
use setup::DialogueSettings;
use speech::record::Record as Spoken;
use vocabulary::Ended;
use whichone_tests::simulated_group::SimulatedGroup;

type Verdict = Result<(), String>;

/// Checks all invariants, the most informative first; `wanted` are the objects of a user at a
/// terminal, in order.
pub(crate) fn check(group: &SimulatedGroup, wanted: &[ObjectId]) -> Verdict {
    ensure(group.change.is_none(), || "the scene has never changed".to_owned())?;
    if group.client.is_some() {
        delivered_in_order(group, wanted)?;
        deliveries_are_picks(group)?;
        put_back_once(group)?;
        called_off_stays(group)?;
    } else {
        delivered_the_right_one(group)?;
        picked_once(group)?;
    }
    numbered_without_gap(group)?;
    applied_each_once(group)?;
    nothing_premature(group)?;
    belief_refolds(group)
}

fn ensure(holds: bool, what: impl FnOnce() -> String) -> Verdict {
    if holds { Ok(()) } else { Err(what()) }
}

fn delivered_the_right_one(group: &SimulatedGroup) -> Verdict {
    let wanted = (Outcome::Delivered, group.user.wanted());
    ensure(group.outcome() == Some(wanted), || format!("the end was {:?}", group.outcome()))
}

/// What was wanted was delivered, each once and nothing else, and nobody was given up who had time to
/// answer. Where the client was dead for most of the robot's patience, the person asks again.
fn delivered_in_order(group: &SimulatedGroup, wanted: &[ObjectId]) -> Verdict {
    let mut ends: Vec<&Ended> = Vec::new();
    for ended in group.policy.journal().iter().filter_map(|record| record.state.ended.as_ref()) {
        if ends.last().is_none_or(|last| last.interaction != ended.interaction) {
            ends.push(ended);
        }
    }
    let is_left = |ended: &&Ended| ended.outcome == Outcome::Cancelled;
    let (left, ends): (Vec<&Ended>, Vec<&Ended>) = ends.into_iter().partition(is_left);
    let mut ends = ends;
    let known = group.client.as_ref().map_or(0, |client| client.left as usize);
    ensure(known <= left.len() && left.len() <= 1, || format!("left {left:?}, known {known}"))?;
    let given_up = group.client.as_ref().map_or(0, |client| client.given_up);
    ensure(given_up == 0, || format!("a user who could answer was given up {given_up} times"))?;
    ends.retain(|ended| ended.outcome != Outcome::Abandoned);
    let found: Vec<_> = ends.iter().map(|ended| (ended.outcome, ended.object)).collect();
    let expected: Vec<_> =
        wanted.iter().map(|object| (Outcome::Delivered, Some(*object))).collect();
    ensure(found == expected, || format!("wanted {wanted:?}, the ends were {found:?}"))
}

/// Each delivery is backed by a pick of this very object, delivered in the arm's own journal and held
/// once (I4, I5).
fn deliveries_are_picks(group: &SimulatedGroup) -> Verdict {
    let Some(arm) = &group.arm else { return Err("no arm".to_owned()) };
    let picks: Vec<_> = arm.journal().iter().filter_map(|r| r.state.pick).collect();
    for record in group.policy.journal() {
        let Cause::PickEnded { pick, outcome: PickOutcome::Delivered } = record.cause else {
            continue;
        };
        let object = record.state.ended.as_ref().and_then(|ended| ended.object);
        let of_pick: Vec<_> = picks.iter().filter(|it| it.id == pick).collect();
        let delivered = of_pick
            .iter()
            .any(|it| Some(it.object) == object && it.outcome == PickOutcome::Delivered);
        ensure(delivered, || format!("{pick:?} of {object:?} was not delivered by the arm"))?;
        let holds = |it: &messages::pick::Pick| it.phase == PickPhase::Holding;
        let held = of_pick.windows(2).filter(|w| holds(w[1]) && !holds(w[0])).count();
        ensure(held <= 1, || format!("{pick:?} was held {held} times"))?;
    }
    Ok(())
}

/// What the arm knew to be called off was not handed over (I5).
fn called_off_stays(group: &SimulatedGroup) -> Verdict {
    let Some(arm) = &group.arm else { return Err("no arm".to_owned()) };
    let picks: Vec<_> = arm.journal().iter().filter_map(|r| r.state.pick).collect();
    let is_called_off = |pick: &messages::pick::Pick| {
        let mut of_it = picks.iter().filter(|other| other.id == pick.id);
        of_it.any(|other| other.phase == PickPhase::Returning)
    };
    let mut delivered = picks.iter().filter(|pick| pick.outcome == PickOutcome::Delivered);
    let wrong = delivered.find(|pick| is_called_off(pick));
    ensure(wrong.is_none(), || format!("{wrong:?} was called off"))
}

/// What was refused after its delivery is back in its place, put there once; nothing else was, and no
/// order is open.
fn put_back_once(group: &SimulatedGroup) -> Verdict {
    let Some(arm) = &group.arm else { return Err("no arm".to_owned()) };
    let mut refused: Vec<(InteractionId, Option<ObjectId>)> = Vec::new();
    for ended in group.policy.journal().iter().filter_map(|record| record.state.ended.as_ref()) {
        let is_new = refused.iter().all(|(interaction, _)| *interaction != ended.interaction);
        if ended.outcome == Outcome::Refused && is_new {
            refused.push((ended.interaction, ended.object));
        }
    }
    let mut picks: Vec<_> = arm.journal().iter().filter_map(|r| r.state.pick).collect();
    picks.retain(|pick| pick.outcome == PickOutcome::PutBack);
    picks.dedup();
    let done: Vec<_> = picks.iter().map(|pick| (pick.id.interaction, Some(pick.object))).collect();
    ensure(done == refused, || format!("refused {refused:?}, put back {done:?}"))?;
    let learned = group.policy.journal().iter().filter(|record| {
        matches!(record.cause, Cause::PickEnded { outcome: PickOutcome::PutBack, .. })
    });
    ensure(learned.count() == done.len(), || "the policy has not learned of it once".to_owned())?;
    let open = group.policy.journal().last().and_then(|record| record.state.putting_back.as_ref());
    ensure(open.is_none(), || format!("{open:?} is still under way"))?;
    let told = group.client.as_ref().map_or(0, |client| client.put_back);
    ensure(told as usize <= done.len(), || format!("{told} reported, {done:?} put back"))
}

/// At most one grasp that holds and one end for each interaction (I4), of the ordered object (I5).
fn picked_once(group: &SimulatedGroup) -> Verdict {
    let Some(arm) = &group.arm else { return Err("no arm".to_owned()) };
    let picks: Vec<_> = arm.journal().iter().filter_map(|r| r.state.pick).collect();
    let entered = |phase| {
        picks.windows(2).filter(|w| w[1].phase == phase && w[0].phase != phase).count()
            + usize::from(picks.first().is_some_and(|pick| pick.phase == phase))
    };
    ensure(entered(PickPhase::Holding) <= 1, || "held more than once".to_owned())?;
    ensure(entered(PickPhase::Done) <= 1, || "done more than once".to_owned())?;
    let Some(last) = picks.last() else { return Err("no pick in the arm's journal".to_owned()) };
    ensure(last.outcome == PickOutcome::Delivered, || format!("the pick ended as {last:?}"))?;
    ensure(Some(last.object) == group.user.wanted(), || format!("{last:?} was not wanted"))
}

fn numbered_without_gap(group: &SimulatedGroup) -> Verdict {
    let accepted = group.speech.journal().iter().filter_map(|record| match record {
        Spoken::Accepted(accepted) => Some((accepted.seq.0, accepted.key)),
        _ => None,
    });
    let (numbers, keys): (Vec<_>, Vec<_>) = accepted.unzip();
    let expected: Vec<u64> = (1..=numbers.len() as u64).collect();
    ensure(numbers == expected, || format!("accepted as {numbers:?}"))?;
    let mut distinct = keys.clone();
    distinct.sort_unstable();
    distinct.dedup();
    ensure(distinct.len() == keys.len(), || "one sentence was accepted twice".to_owned())?;
    let accepted = group.client.as_ref().map_or(&group.user.accepted, |client| &client.accepted);
    let lost = accepted.iter().find(|key| !keys.contains(key));
    ensure(lost.is_none(), || format!("{lost:?} was acknowledged but is not in the journal"))
}

/// Applied in order, each exactly once (I1).
fn applied_each_once(group: &SimulatedGroup) -> Verdict {
    let applied = group.policy.journal().iter().filter_map(|record| match &record.cause {
        Cause::Utterance(heard) => Some(heard.seq.0),
        _ => None,
    });
    let applied: Vec<u64> = applied.collect();
    let expected: Vec<u64> = (1..=applied.len() as u64).collect();
    ensure(applied == expected, || format!("applied as {applied:?}"))
}

/// Nothing becomes visible before it is durable (I3).
fn nothing_premature(group: &SimulatedGroup) -> Verdict {
    ensure(group.premature.is_empty(), || group.premature.join("; "))
}

/// The belief and every decision follow from the journal, bit for bit (I8), those before a change
/// of the scene under the former settings and the change itself under the new ones.
fn belief_refolds(group: &SimulatedGroup) -> Verdict {
    let manager = |settings: &Settings| settings.manager().map_err(|e| e.to_string());
    let records = group.policy.journal();
    let mut former = 0;
    if let Some((settings, count)) = &group.before {
        let folded = refold(&mut manager(settings)?, &records[..*count]);
        folded.map_err(|e| format!("before the change: {e}"))?;
        former = *count;
    }
    let settings_key = records.last().map_or(0, |record| record.state.settings_key);
    let mut now = manager(&group.settings)?;
    let own = refold_since(&mut now, records, settings_key);
    let own = own.map_err(|e| e.to_string())?;
    ensure(own + former == records.len(), || format!("{own} and {former} of {}", records.len()))
}
