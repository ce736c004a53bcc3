//! Listing and verification of the policy's journal.

use std::borrow::Cow;
use std::collections::BTreeMap;

use config::Settings;
use dialogue::manager::{Act, Cause, Manager, Record, State, refold_since};
use dialogue::{ActKind, Action, Outcome, PickOutcome, rendering};
use scene::Scene;
use service::exit::{Exit, Failure};
use service::flight::Decision;
use service::inspection::{Part, SharedFacts, count};
use service::journal_set::NUMBERS_SKIPPED;

/// Renders a record as one line. Without the scene that it is about, the robot's words are left out.
pub(crate) fn line(scene: Option<&Scene>, record: &Record) -> String {
    let Record { cause, state, .. } = record;
    let scene = scene.and_then(|scene| scene_of(scene, state));
    let scene = scene.as_deref();
    let why = match cause {
        Cause::Snapshot => "started over".to_owned(),
        Cause::Utterance(heard) => format!("utterance {}", heard.seq),
        Cause::Silence => "silence".to_owned(),
        Cause::Quiet => "quiet".to_owned(),
        Cause::PickEnded { pick, outcome } => {
            format!("pick {}.{} {outcome:?}", pick.interaction, pick.attempt).to_lowercase()
        }
        Cause::Reconfigured => "reconfigured".to_owned(),
        Cause::Objects(table) => format!("table {} of {}", table.version, table.objects.len()),
        Cause::MotionStop(true) => "stopped".to_owned(),
        Cause::MotionStop(false) => "released".to_owned(),
        Cause::SetAside(over) => format!("set aside, {over} over"),
    };
    let does = does(scene, &state.act);
    let where_ = state.open.as_ref().map(|open| {
        let belief = open.belief();
        let best = belief.probability(belief.most_likely());
        format!("interaction {}, best {:.1} %", open.id, best * 100.0)
    });
    let where_ = where_.as_deref().unwrap_or("at rest");
    format!("{why:<16}  {does}  ({where_}{})", reasons(scene, &state.act))
}

/// Returns the scene that a state is about: none where that is another one, whose numbers have no words here.
fn scene_of<'a>(scene: &'a Scene, state: &State) -> Option<Cow<'a, Scene>> {
    let table = state.table.as_ref().map(|table| scene.with_objects(&table.objects));
    let scene = table.map_or(Cow::Borrowed(scene), Cow::Owned);
    (scene.key() == state.scene_key).then_some(scene)
}

fn does(scene: Option<&Scene>, act: &Act) -> String {
    match act.kind {
        ActKind::Wait => "wait".to_owned(),
        kind => {
            let text = scene.map(|scene| rendering::text(scene, act));
            format!("{kind:?}: {}", text.unwrap_or_default())
        }
    }
}

/// The decision of a record, for replays to compare.
pub(crate) fn decision(scene: &Scene, Record { state, .. }: &Record) -> Decision {
    let interaction = state.open.as_ref().map_or(0, |open| open.id.0);
    let what = does(scene_of(scene, state).as_deref(), &state.act);
    // A mere remark has no value.
    let value = Some(state.act.value).filter(|value| *value != 0.0);
    Decision { interaction, what, value }
}

/// Why the robot decided so: the value with its bounds, the questions to come, and what else it
/// weighed. A mere remark has no reasons.
fn reasons(scene: Option<&Scene>, act: &Act) -> String {
    if act.value == 0.0 && act.alternatives.is_empty() {
        return String::new();
    }
    let bounds = act.bounds.map(|(low, high)| format!(", best {low:.2} to {high:.2}"));
    let value = format!("value {:.2}{}", act.value, bounds.unwrap_or_default());
    let other = |(action, value): &(Action, f64)| {
        let action = scene.map_or(format!("{action:?}"), |scene| rendering::action(scene, *action));
        format!("{action} {value:.2}")
    };
    let others: Vec<String> = act.alternatives.iter().map(other).collect();
    let before = if others.is_empty() { "" } else { ", before " };
    let questions = act.expected_questions;
    format!("; {value}, {questions:.1} questions to come{before}{}", others.join(", "))
}

/// Every utterance applied once and in order, every belief a distribution, no interaction with two
/// deliveries, and every state the one that follows, bit for bit.
pub(crate) fn verify(
    settings: &[Settings],
    parts: &[Part<Record>],
) -> Result<Vec<String>, Failure> {
    let newest = parts.last().and_then(|part| part.records().last());
    let settings_key = newest.map_or(0, |record| record.state.settings_key);
    let known = settings.iter().find(|settings| settings.makes_key(settings_key));
    // Where there are none of that key, the newest are taken to be those at the journal's end.
    let Some(settings) = known.or(settings.first()) else {
        let what =
            "no settings are kept beside the journal; help: start the group with `whichone up`";
        return Err(Failure::new(Exit::Config, what));
    };
    let manager = settings.manager_of_key(settings_key);
    let mut manager = manager.map_err(|e| Failure::new(Exit::Config, e.to_string()))?;
    let mut delivered: BTreeMap<u64, u32> = BTreeMap::new();
    let mut applied = None;
    for part in parts {
        for (seq, record) in part.numbered() {
            step(record, &mut applied, &mut delivered).map_err(|what| part.broken(seq, what))?;
        }
    }
    let total: usize = parts.iter().map(|part| part.records().len()).sum();
    let refolded: usize =
        parts.iter().map(|part| fold(&mut manager, part, settings_key)).sum::<Result<_, _>>()?;
    let mut facts = vec![
        format!("{} applied once and in order", count(since_set_aside(applied), "utterance")),
        format!("delivered in {}, at most once each", count(delivered.len() as u64, "interaction")),
        format!("{} reproduced bit for bit from the one before", count(refolded as u64, "state")),
    ];
    if refolded < total {
        let skipped = count((total - refolded) as u64, "earlier state");
        facts.push(format!("{skipped} of other settings skipped"));
    }
    Ok(facts)
}

/// Number of utterances since the last setting aside.
fn since_set_aside(applied: Option<u64>) -> u64 {
    applied.unwrap_or(0) % NUMBERS_SKIPPED
}

/// The last utterance applied, and the orders.
pub(crate) fn shared_facts(parts: &[Part<Record>]) -> SharedFacts {
    let records = || parts.iter().flat_map(|part| part.records());
    let order = |record: &Record| {
        let (id, object) = record.state.ordered()?;
        // The arm knows perceived objects by their numbers.
        let number = record.state.table.as_ref().map(|table| table.objects.get(object.index()));
        let object = number.map_or(Some(object), |perceived| Some(perceived?.number))?;
        Some((id.interaction.0, id.attempt, object.0))
    };
    let is_complete = |record: &&Record| {
        parts.first().is_some_and(|part| part.first_seq() == 1)
            && !matches!(record.cause, Cause::SetAside(_))
    };
    SharedFacts {
        utterance: records().last().map_or(0, |record| record.state.applied.0),
        picks: records().filter_map(order).collect(),
        since: match records().next() {
            Some(first) if is_complete(&first) => 0,
            first => first.map_or(0, |record| record.state.last_interaction.0),
        },
        delivered: records().last().map_or(0, delivered),
    }
}

/// The latest interaction that ended, if it did with a delivery; else 0.
fn delivered(record: &Record) -> u64 {
    let ended = record
        .state
        .ended
        .as_ref()
        .filter(|ended| matches!(ended.outcome, Outcome::Delivered | Outcome::Refused));
    ended.map_or(0, |ended| ended.interaction.0)
}

fn step(
    record: &Record,
    applied: &mut Option<u64>,
    delivered: &mut BTreeMap<u64, u32>,
) -> Result<(), String> {
    let now = record.state.applied.0;
    if let Cause::Utterance(heard) = &record.cause
        && !heard.is_consistent()
    {
        return Err(format!(
            "utterance {} answers a presentation that it does not list",
            heard.seq
        ));
    }
    match (&record.cause, *applied) {
        (Cause::Utterance(heard), before) if before.is_some_and(|b| heard.seq.0 != b + 1) => {
            let before = before.unwrap_or(0);
            return Err(format!("utterance {} applied after {before}", heard.seq));
        }
        (Cause::Utterance(heard), None) if heard.seq.0 != 1 => {
            return Err(format!("utterance {} applied first", heard.seq));
        }
        (Cause::Utterance(heard), _) if heard.seq.0 != now => {
            return Err(format!("utterance {} applied, {now} marked", heard.seq));
        }
        (Cause::Utterance(_) | Cause::Snapshot | Cause::SetAside(_), _) | (_, None) => {}
        (_, Some(before)) if before != now => {
            return Err(format!("{now} marked without an utterance, {before} before"));
        }
        _ => {}
    }
    *applied = Some(now);
    if let Cause::PickEnded { pick, outcome: PickOutcome::Delivered } = record.cause {
        let count = delivered.entry(pick.interaction.0).or_default();
        *count += 1;
        if *count > 1 {
            return Err(format!("interaction {} delivered {count} times", pick.interaction));
        }
    }
    Ok(())
}

/// Refolds the records that were decided under the settings with that key; how many those are.
fn fold(manager: &mut Manager, part: &Part<Record>, settings_key: u64) -> Result<usize, Failure> {
    refold_since(manager, part.records(), settings_key).map_err(|mismatch| {
        let seq = part.first_seq() + mismatch.index as u64;
        let what = format!("the state does not follow from the one before it: {}", mismatch.part);
        part.broken(seq, format!("{what} differs (with these settings)"))
    })
}

#[cfg(test)]
mod tests {
    use dialogue::manager::Utterance;
    use messages::{InteractionId, PickId, UtteranceSeq};

    use super::*;

    fn heard(seq: u64) -> Record {
        let heard = Utterance { seq: UtteranceSeq(seq), ..Utterance::default() };
        let state = State { applied: UtteranceSeq(seq), ..State::default() };
        Record { cause: Cause::Utterance(heard), at: service::Time(0), state }
    }

    fn delivered(applied: u64, interaction: u64) -> Record {
        let pick = PickId { interaction: InteractionId(interaction), attempt: 1 };
        let cause = Cause::PickEnded { pick, outcome: PickOutcome::Delivered };
        let state = State { applied: UtteranceSeq(applied), ..State::default() };
        Record { cause, at: service::Time(0), state }
    }

    fn check(records: &[Record]) -> Result<(), String> {
        let (mut applied, mut counts) = (None, BTreeMap::new());
        records.iter().try_for_each(|record| step(record, &mut applied, &mut counts))
    }

    #[test]
    fn utterances_are_applied_once_and_in_order() {
        assert_eq!(check(&[heard(1), heard(2), delivered(2, 1), heard(3)]), Ok(()));
        let wrong = [
            vec![heard(2)],
            vec![heard(1), heard(3)],
            vec![heard(1), heard(1)],
            vec![heard(1), delivered(2, 1)],
        ];
        for records in wrong {
            assert!(check(&records).is_err(), "{records:?}");
        }
        let snapshot = Record { cause: Cause::Snapshot, ..heard(7) };
        assert_eq!(check(&[snapshot, heard(8)]), Ok(()));
    }

    #[test]
    fn no_interaction_delivers_twice() {
        assert_eq!(check(&[heard(1), delivered(1, 1), delivered(1, 2)]), Ok(()));
        let error = check(&[heard(1), delivered(1, 1), delivered(1, 1)]).unwrap_err();
        assert_eq!(error, "interaction 1 delivered 2 times");
    }
}
