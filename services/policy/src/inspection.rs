//! Listing and verification of the policy's journal.

use setup::DialogueSettings;
use std::collections::BTreeMap;

use config::Settings;
use dialogue::manager::{Act, Cause, Manager, MotionStop, Record, refold_since};
use dialogue::rendering;
use scene::{Scene, count};
use service::exit::{Exit, Failure};
use service::flight::Decision;
use service::inspection::{Part, SharedFacts};
use service::journal_set::NUMBERS_SKIPPED;
use vocabulary::{ActKind, Action, Outcome, PickOutcome};

/// Renders a record as one line. Without its scene, the robot's words are left out.
pub(crate) fn line(scene: Option<&Scene>, record: &Record) -> String {
    let Record { cause, state, .. } = record;
    let open = state.open.as_ref().map(|open| {
        let belief = open.belief();
        let best = belief.most_likely();
        let known = scene.and_then(|scene| scene.objects().get(best.index()));
        let name = known.map_or("likeliest object", |object| object.name.as_str());
        let percent = belief.probability(best) * 100.0;
        format!("interaction {}: {name} {percent:.1} %", open.id)
    });
    let open = open.as_deref().unwrap_or("no open interaction");
    let (why, does) = (why(cause), does(scene, &state.act));
    format!("{why} → {does} ({open}{})", reasons(scene, &state.act))
}

fn why(cause: &Cause) -> String {
    match cause {
        Cause::Snapshot => "state at the start of the file".to_owned(),
        Cause::Utterance(heard) if heard.from.is_nobody() => format!("utterance {}", heard.seq),
        Cause::Utterance(heard) => format!("utterance {} of {}", heard.seq, heard.from),
        Cause::Silence => "silence".to_owned(),
        Cause::Quiet => "the user has finished".to_owned(),
        Cause::PickEnded { pick, outcome } => {
            let outcome = format!("{outcome:?}").to_lowercase();
            format!("pick {}.{} ended: {outcome}", pick.interaction, pick.attempt)
        }
        Cause::Reconfigured => "started with other settings".to_owned(),
        Cause::Objects(table) => {
            let objects = count(table.objects.len(), "object");
            format!("change {} of the table: {objects}", table.version)
        }
        Cause::MotionStop(MotionStop::Released) => "motion stop released".to_owned(),
        Cause::MotionStop(MotionStop::Stopping) => "motion stop latched".to_owned(),
        Cause::MotionStop(MotionStop::Stopped) => "stopped".to_owned(),
        Cause::StopReport { confirmed: true } => "ordered stop confirmed".to_owned(),
        Cause::StopReport { confirmed: false } => "ordered stop not confirmed in time".to_owned(),
        Cause::SetAside(over) => format!("journal set aside, numbers up to {over} are over"),
        Cause::Forget(person) => format!("{person} is forgotten"),
    }
}

fn does(scene: Option<&Scene>, act: &Act) -> String {
    let text = scene.map(|scene| rendering::text(scene, act)).filter(|text| !text.is_empty());
    let text = text.map(|text| format!(" \"{text}\"")).unwrap_or_default();
    match act.kind {
        ActKind::Wait => "wait".to_owned(),
        ActKind::Ask => format!("ask{text}"),
        ActKind::Say => format!("say{text}"),
        ActKind::Pick => format!("pick{text}"),
        ActKind::Cancel => format!("call off the pick{text}"),
        ActKind::PutBack => format!("put back{text}"),
    }
}

/// The decision of a record, for replays to compare.
pub(crate) fn decision(scene: Option<&Scene>, Record { state, .. }: &Record) -> Decision {
    let interaction = state.open.as_ref().map_or(0, |open| open.id.0);
    let what = does(scene, &state.act);
    // A mere remark has no value.
    let value = Some(state.act.value).filter(|value| *value != 0.0);
    Decision { interaction, what, value }
}

/// Returns the reasons of a decision: the value with its bounds, the questions to come, and the
/// alternatives, in seconds. A mere remark has no reasons.
fn reasons(scene: Option<&Scene>, act: &Act) -> String {
    if act.value == 0.0 && act.alternatives.is_empty() {
        return String::new();
    }
    let bounds = act.bounds.map(|(low, high)| format!(", optimum {low:.2} to {high:.2} s"));
    let value = format!("value {:.2} s{}", act.value, bounds.unwrap_or_default());
    let other = |(action, value): &(Action, f64)| {
        let action = scene.map_or(format!("{action:?}"), |scene| rendering::action(scene, *action));
        format!("{action} {value:.2} s")
    };
    let others: Vec<String> = act.alternatives.iter().map(other).collect();
    let instead = if others.is_empty() { "" } else { "; alternatives: " };
    let questions = act.expected_questions;
    format!("; {value}; {questions:.1} further questions expected{instead}{}", others.join(", "))
}

/// Every utterance applied once and in order, every belief a distribution, no interaction with two
/// deliveries, and every state the one that follows, bit for bit, under the settings of its time.
pub(crate) fn verify(
    settings: &[Settings],
    parts: &[Part<Record>],
) -> Result<Vec<String>, Failure> {
    if settings.is_empty() {
        let what =
            "no settings are kept beside the journal; help: start the group with `whichone up`";
        return Err(Failure::new(Exit::Config, what));
    }
    let mut delivered: BTreeMap<u64, u32> = BTreeMap::new();
    let mut applied = None;
    for part in parts {
        for (seq, record) in part.numbered() {
            step(record, &mut applied, &mut delivered).map_err(|what| part.broken(seq, what))?;
        }
    }
    let mut managers = Managers::new(settings, parts);
    let mut folded = Folded::default();
    for part in parts {
        fold(&mut managers, part, &mut folded)?;
    }
    let under = match managers.used() {
        0 | 1 => String::new(),
        many => format!(" under {many} settings"),
    };
    let Folded { reproduced, not_kept, by_program } = folded;
    let states = count(reproduced, "state");
    let mut facts = vec![
        format!("{} applied once and in order", count(since_set_aside(applied), "utterance")),
        format!("delivered in {}, at most once each", count(delivered.len(), "interaction")),
        format!("{states} reproduced bit for bit from the one before{under}"),
    ];
    if by_program > 0 {
        let states = count(by_program, "state");
        facts.push(format!("{states} not reproduced: a program that was swapped in decided"));
    }
    if not_kept > 0 {
        let states = count(not_kept, "earlier state");
        facts
            .push(format!("{states} not reproduced: the settings of that time are no longer kept"));
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
        ..SharedFacts::default()
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
        let times = delivered.entry(pick.interaction.0).or_default();
        *times += 1;
        if *times > 1 {
            let times = count(*times, "time");
            return Err(format!("interaction {} delivered {times}", pick.interaction));
        }
    }
    Ok(())
}

/// Dialogue managers by the key of their settings.
struct Managers<'a> {
    settings: &'a [Settings],
    /// Key of the newest state.
    newest: u64,
    /// Managers needed so far; `None` if the settings are no longer kept.
    known: BTreeMap<u64, Option<Manager>>,
}

impl<'a> Managers<'a> {
    fn new(settings: &'a [Settings], parts: &[Part<Record>]) -> Self {
        let newest = parts.last().and_then(|part| part.records().last());
        let newest = newest.map_or(0, |record| record.state.settings_key);
        Self { settings, newest, known: BTreeMap::new() }
    }

    /// Whether a planner program (`--planner-program`) decided: only it can repeat decisions.
    fn is_program(&self, key: u64) -> bool {
        self.settings.iter().any(|settings| settings.manager_key(planner_program::NAME) == key)
    }

    /// Returns the manager that decided under these settings.
    fn of_key(&mut self, key: u64) -> Result<Option<&mut Manager>, Failure> {
        if !self.known.contains_key(&key) {
            let fitting = self.settings.iter().find(|settings| settings.makes_key(key));
            // Without settings of that key, the newest are taken to be those at the journal's end.
            let is_newest = key == self.newest && !self.is_program(key);
            let newest = self.settings.first().filter(|_| is_newest);
            let manager = fitting.or(newest).map(|settings| settings.manager_of_key(key));
            let manager = manager.transpose();
            let manager = manager.map_err(|e| Failure::new(Exit::Config, e.to_string()))?;
            self.known.insert(key, manager);
        }
        Ok(self.known.get_mut(&key).and_then(Option::as_mut))
    }

    /// Number of settings under which states were reproduced.
    fn used(&self) -> usize {
        self.known.values().flatten().count()
    }
}

/// Numbers of states.
#[derive(Default)]
struct Folded {
    reproduced: usize,
    /// Their settings are no longer kept.
    not_kept: usize,
    /// A planner decided that is a program.
    by_program: usize,
}

/// Refolds the records of a file under the settings of their time.
fn fold(
    managers: &mut Managers<'_>,
    part: &Part<Record>,
    folded: &mut Folded,
) -> Result<(), Failure> {
    let mut end = 0;
    let is_same = |a: &Record, b: &Record| a.state.settings_key == b.state.settings_key;
    for run in part.records().chunk_by(is_same) {
        end += run.len();
        let key = run[0].state.settings_key;
        let is_program = managers.is_program(key);
        let Some(manager) = managers.of_key(key)? else {
            *(if is_program { &mut folded.by_program } else { &mut folded.not_kept }) += run.len();
            continue;
        };
        folded.reproduced +=
            refold_since(manager, &part.records()[..end], key).map_err(|mismatch| {
                let seq = part.first_seq() + mismatch.index as u64;
                let what =
                    format!("the state does not follow from the one before it: {}", mismatch.part);
                part.broken(seq, format!("{what} differs (with the settings of that time)"))
            })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use dialogue::manager::{State, Utterance};
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
