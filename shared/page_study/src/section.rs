//! The section `study` of the pages.

use serde::Serialize;
use user_study::{End, Item, Participant, Protocol, Stage, Status, Trial};

use super::study_controller::StudyController;
use super::trial_monitor::{NotReady, RobotState};

/// The section. A page finds its participant by the code that it was given at its beginning.
#[derive(Debug, Serialize)]
pub(super) struct StudySection<'a> {
    title: &'a str,
    active: Option<ParticipantView<'a>>,
    last: Option<ParticipantView<'a>>,
    participants: usize,
    complete: usize,
    withdrawn: usize,
    interactions: usize,
    trouble: Option<&'a str>,
}

#[derive(Debug, Serialize)]
struct ParticipantView<'a> {
    participant: &'a str,
    stage: &'static str,
    done: usize,
    total: usize,
    title: &'a str,
    consent: &'a str,
    instructions: &'a [String],
    questionnaire: &'a [Item],
    show_belief: bool,
    seconds_max: f64,
    begun_at: u64,
    consented: bool,
    trial: Option<TrialView<'a>>,
    next: bool,
    deleted: bool,
}

#[derive(Debug, Serialize)]
struct TrialView<'a> {
    picked: Option<&'a str>,
    number: Option<usize>,
    practice: bool,
    policy: &'a str,
    desired: &'a str,
    scene_key: &'a str,
    waits_for: Option<NotReady>,
    started_at: Option<u64>,
    said: u32,
    questions: usize,
    outcome: Option<&'static str>,
    fault: Option<&'a str>,
    seconds: Option<f64>,
}

impl<'a> StudySection<'a> {
    pub(super) fn new(
        controller: &'a StudyController,
        robot: &RobotState<'_>,
        trouble: Option<&'a str>,
    ) -> Self {
        let people = controller.people();
        let counting = people.iter().filter(|person| person.status().counts());
        let of = |status: Status| people.iter().filter(|p| p.status() == status).count();
        let last = people.last().filter(|person| person.stage.is_final());
        Self {
            title: &controller.protocol().title,
            active: controller.active().map(|person| ParticipantView::new(person, robot)),
            last: last.map(|person| ParticipantView::new(person, robot)),
            participants: people.len(),
            complete: of(Status::Complete),
            withdrawn: of(Status::Withdrawn) + of(Status::Deleted),
            interactions: counting.map(|person| person.counted().count()).sum(),
            trouble,
        }
    }
}

impl<'a> ParticipantView<'a> {
    fn new(person: &'a Participant, robot: &RobotState<'_>) -> Self {
        let Protocol { title, consent, instructions, questionnaire, .. } = &person.begun.protocol;
        Self {
            participant: person.id(),
            stage: person.stage.name(),
            done: person.counted().count(),
            total: person.begun.plan.iter().filter(|step| !step.practice).count(),
            title,
            consent,
            instructions,
            questionnaire,
            show_belief: person.begun.protocol.show_belief,
            seconds_max: person.begun.protocol.seconds_max,
            begun_at: person.begun_at,
            consented: person.consented,
            trial: person.trial().map(|trial| TrialView::new(person, trial, robot)),
            next: person.next_step().is_some(),
            deleted: person.deleted,
        }
    }
}

impl<'a> TrialView<'a> {
    fn new(person: &'a Participant, trial: &'a Trial, robot: &RobotState<'_>) -> Self {
        let counted = person.counted().count();
        let number = if trial.counts() { counted } else { counted + 1 };
        let is_drawn = person.stage == Stage::Drawn;
        let waits_for = is_drawn.then(|| robot.not_ready(&trial.step.policy)).flatten();
        let (outcome, fault, picked) = match &trial.end {
            Some(End::Verdict(ending)) => {
                (Some(ending.verdict.name()), None, ending.object.as_deref())
            }
            Some(End::Fault(_, why)) => (Some("fault"), Some(why.as_str()), None),
            None => (None, None, None),
        };
        Self {
            picked,
            number: (!trial.step.practice).then_some(number),
            practice: trial.step.practice,
            policy: &trial.step.policy,
            desired: &trial.drawn.object,
            scene_key: &trial.drawn.scene_key,
            waits_for,
            started_at: trial.started_at,
            said: trial.utterances(),
            questions: trial.asked.len(),
            outcome,
            fault,
            seconds: trial.seconds().map(|seconds| (10.0 * seconds).round() / 10.0),
        }
    }
}
