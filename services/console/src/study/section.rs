//! The section `study`: what pages are shown.

use evaluation::user_study::{End, Participant, Stage, Status, Trial};
use serde_json::{Value as Json, json};

use super::desk::Desk;
use super::seen::Seen;

/// The section. A page finds itself by the code that it was given at its beginning.
pub(super) fn section(desk: &Desk, seen: &Seen<'_>, trouble: Option<&str>) -> Json {
    let counting = desk.people().iter().filter(|person| person.status().counts());
    let of = |status: Status| desk.people().iter().filter(|p| p.status() == status).count();
    json!({
        "title": desk.protocol().title,
        "active": desk.active().map(|person| participant(person, seen)),
        "last": desk.people().last().filter(|p| p.stage.is_final()).map(|p| participant(p, seen)),
        "participants": desk.people().len(),
        "complete": of(Status::Complete),
        "withdrawn": of(Status::Withdrawn) + of(Status::Deleted),
        "interactions": counting.map(|person| person.counted().count()).sum::<usize>(),
        "trouble": trouble,
    })
}

fn participant(person: &Participant, seen: &Seen<'_>) -> Json {
    let protocol = &person.begun.protocol;
    let total = person.begun.plan.iter().filter(|step| !step.practice).count();
    json!({
        "participant": person.id(),
        "stage": person.stage.name(),
        "done": person.counted().count(),
        "total": total,
        "title": protocol.title,
        "consent": protocol.consent,
        "instructions": protocol.instructions,
        "questionnaire": protocol.questionnaire,
        "show_belief": protocol.show_belief,
        "seconds_max": protocol.seconds_max,
        "begun_at": person.begun_at,
        "consented": person.consented,
        "trial": person.trial().map(|trial| of_trial(person, trial, seen)),
        "next": person.next_step().is_some(),
        "deleted": person.deleted,
    })
}

fn of_trial(person: &Participant, trial: &Trial, seen: &Seen<'_>) -> Json {
    let counted = person.counted().count();
    let number = if trial.counts() { counted } else { counted + 1 };
    let waits =
        (person.stage == Stage::Drawn).then(|| seen.hindrance(&trial.step.policy)).flatten();
    let (outcome, fault) = match &trial.end {
        Some(End::Verdict { verdict, .. }) => (Some(verdict.name()), None),
        Some(End::Fault(_, why)) => (Some("fault"), Some(why)),
        None => (None, None),
    };
    let picked = match &trial.end {
        Some(End::Verdict { object, .. }) => object.as_ref(),
        _ => None,
    };
    json!({
        "picked": picked,
        "number": (!trial.step.practice).then_some(number),
        "practice": trial.step.practice,
        "policy": trial.step.policy,
        "desired": trial.drawn.object,
        "scene_key": trial.drawn.scene_key,
        "waits_for": waits.map(|hindrance| hindrance.name()),
        "started_at": trial.started_at,
        "said": trial.utterances(),
        "questions": trial.asked.len(),
        "outcome": outcome,
        "fault": fault,
        "seconds": trial.seconds().map(|seconds| (10.0 * seconds).round() / 10.0),
    })
}
