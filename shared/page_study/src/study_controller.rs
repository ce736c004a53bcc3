//! The study's rules: what may be done at which stage, and what follows from it. Pure.
//!
//! Invariant: [`StudyController::people`] is the fold of what was written down. Whatever is asked for or robot
//! gives events; only when these are on the disk does [`StudyController::apply`] take them in.

use scene::ObjectId;
use serde_json::{Map, Value as Json};
use user_study::{
    Begun, Counts, Drawn, Entry, Event, Participant, Protocol, Stage, VERSION, draw, new_id, plan,
};

use super::trial_monitor::{NotReady, RobotState};

#[derive(Debug)]
pub(super) struct StudyController {
    protocol: Protocol,
    group: String,
    /// Everybody, in the order in which they came.
    people: Vec<Participant>,
    /// Since when a service has been away, monotonic milliseconds.
    pub(super) missing_since: Option<f64>,
}

/// Requests of a participant's page (which has a secret of its own) or of the experimenter.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    Begin,
    Resume(String),
    Consent,
    /// The participant has read what is shown.
    Next,
    Start,
    Answer(Map<String, Json>),
    /// The participant withdraws; the data is deleted if it is true.
    Withdraw(bool),
    /// The experimenter ends a participant who has left.
    Close(String),
    /// The experimenter calls the running interaction spoilt.
    Spoilt(String, String),
    /// The experimenter deletes a participant's data.
    Delete(String),
}

/// Whom events are about, and the events; none where all was so already.
pub(super) type Outcome = Result<(String, Vec<Event>), String>;

impl StudyController {
    pub(super) fn new(protocol: Protocol, group: String, people: Vec<Participant>) -> Self {
        Self { protocol, group, people, missing_since: None }
    }

    /// Returns the settings for the next participant.
    pub(super) fn protocol(&self) -> &Protocol {
        &self.protocol
    }

    /// Everybody, in the order in which they came.
    pub(super) fn people(&self) -> &[Participant] {
        &self.people
    }

    pub(super) fn active(&self) -> Option<&Participant> {
        self.people.iter().rev().find(|person| !person.stage.is_final())
    }

    /// Whom a page is about.
    pub(super) fn of_page(&self, page: &str) -> Option<&Participant> {
        self.people.iter().rev().find(|person| person.session == page)
    }

    /// Takes in what was written down.
    pub(super) fn apply(&mut self, id: &str, entry: &Entry) {
        match (&entry.event, self.people.iter_mut().find(|person| person.id() == id)) {
            (Event::Begun(_), _) => {
                self.people.extend(Participant::fold(std::slice::from_ref(entry)));
            }
            (Event::Deleted, Some(person)) => {
                let kept = kept(person, entry);
                *person = Participant::fold(&kept).unwrap_or_else(|| person.clone());
            }
            (_, Some(person)) => person.apply(entry),
            (_, None) => {}
        }
    }

    /// Applies a request; `seed` is fresh.
    pub(super) fn handle(
        &self,
        page: &str,
        command: &Command,
        robot: &RobotState<'_>,
        seed: u64,
    ) -> Outcome {
        match command {
            Command::Begin => self.begin(page, seed),
            Command::Resume(code) => self.resume(page, code),
            Command::Close(id) => self.about(id, |person| match person.stage.is_final() {
                true => Err(format!("{id} has ended already")),
                false => Ok(vec![Event::Left]),
            }),
            Command::Spoilt(id, why) => self.about(id, |person| match person.stage {
                Stage::Running => {
                    let fault = user_study::Fault::Experimenter;
                    Ok(vec![Event::Faulted { fault, why: why.clone() }])
                }
                _ => Err("no interaction runs; it can be called spoilt only while it does".into()),
            }),
            Command::Delete(id) => self.about(id, |person| match person.deleted {
                true => Ok(Vec::new()),
                false => Ok(vec![Event::Deleted]),
            }),
            _ => self.of_participant(page, command, robot),
        }
    }

    fn begin(&self, page: &str, seed: u64) -> Outcome {
        match self.active() {
            Some(person) if person.session == page => return Ok((person.id().to_owned(), vec![])),
            Some(_) => return Err("Another participant is active. Please wait.".to_owned()),
            None => {}
        }
        let mut seed = seed;
        let is_taken = |id: &str| self.people.iter().any(|person| person.id() == id);
        while is_taken(&new_id(seed)) {
            seed = seed.wrapping_add(1);
        }
        let begun = Begun {
            version: VERSION,
            participant: new_id(seed),
            session: page.to_owned(),
            seed,
            plan: plan(&self.protocol, &self.counts(), seed),
            protocol: self.protocol.clone(),
            group: self.group.clone(),
            software: build_info::full_version(),
        };
        Ok((begun.participant.clone(), vec![Event::Begun(Box::new(begun))]))
    }

    fn resume(&self, page: &str, code: &str) -> Outcome {
        let person = self.active().filter(|person| person.id().eq_ignore_ascii_case(code.trim()));
        let Some(person) = person else {
            return Err("No active participant has this code.".to_owned());
        };
        let is_new = person.session != page;
        let resumed = is_new.then(|| Event::Resumed { session: page.to_owned() });
        Ok((person.id().to_owned(), resumed.into_iter().collect()))
    }

    fn about(
        &self,
        id: &str,
        events: impl FnOnce(&Participant) -> Result<Vec<Event>, String>,
    ) -> Outcome {
        let person = self.people.iter().find(|person| person.id() == id);
        let person = person.ok_or_else(|| format!("unknown participant {id}"))?;
        Ok((id.to_owned(), events(person)?))
    }

    fn of_participant(&self, page: &str, command: &Command, robot: &RobotState<'_>) -> Outcome {
        let Some(person) = self.of_page(page) else {
            return Err("This page has not begun; reload it.".to_owned());
        };
        let not_now = || Err(format!("Not now: the page is at “{}”.", person.stage.name()));
        let events = match (command, person.stage) {
            (Command::Withdraw(true), _) if person.deleted => Vec::new(),
            (Command::Withdraw(true), _) => vec![Event::Deleted],
            (Command::Withdraw(false), Stage::Withdrawn) => Vec::new(),
            (Command::Withdraw(false), _) => vec![Event::Withdrawn],
            (Command::Consent, Stage::Consent) => vec![Event::Consented],
            (Command::Next, Stage::Instructions) => {
                vec![Event::Instructed, self.drawn(person, robot)?]
            }
            (Command::Next, Stage::Over) => self.after_interaction(person, robot)?,
            (Command::Start, Stage::Drawn) => vec![start(person, robot)?],
            (Command::Start, Stage::Running) => Vec::new(),
            (Command::Answer(answers), Stage::Questionnaire) => answered(person, answers)?,
            _ => return not_now(),
        };
        Ok((person.id().to_owned(), events))
    }

    fn after_interaction(
        &self,
        person: &Participant,
        robot: &RobotState<'_>,
    ) -> Result<Vec<Event>, String> {
        match person.next_step() {
            Some(_) => Ok(vec![self.drawn(person, robot)?]),
            None if person.begun.protocol.questionnaire.is_empty() => Ok(vec![Event::Finished]),
            None => Ok(vec![Event::Questioned]),
        }
    }

    fn drawn(&self, person: &Participant, robot: &RobotState<'_>) -> Result<Event, String> {
        let step = person.next_step().ok_or("Nothing is left to do.")?;
        let objects = robot.scene.objects();
        let how_often = |people: &mut dyn Iterator<Item = &Participant>| {
            let mut counts = vec![0_usize; objects.len()];
            for trial in people.flat_map(Participant::counted) {
                let at = objects.iter().position(|object| object.name == trial.drawn.object);
                at.into_iter().for_each(|at| counts[at] += 1);
            }
            counts
        };
        let own = how_often(&mut std::iter::once(person));
        let all = how_often(&mut self.people.iter().filter(|person| person.status().counts()));
        let number = u32::try_from(person.trials.len()).unwrap_or(u32::MAX);
        let (kind, seed) = (person.begun.protocol.objects, person.begun.seed);
        let object = draw(kind, &own, &all, seed, number);
        Ok(Event::Drawn(Drawn {
            step,
            object: objects[object].name.clone(),
            label: robot.scene.describe(ObjectId::from(object)),
            scene: robot.scene.name().to_owned(),
            scene_key: robot.scene_key(),
            among: objects.iter().map(|object| object.name.clone()).collect(),
        }))
    }

    /// Returns the records so far, for the next participant.
    fn counts(&self) -> Counts {
        let mut policies: Vec<(String, usize)> = Vec::new();
        for person in self.people.iter().filter(|person| person.status().counts()) {
            let Some(step) = person.begun.plan.first() else { continue };
            match policies.iter_mut().find(|(policy, _)| *policy == step.policy) {
                Some((_, count)) => *count += 1,
                None => policies.push((step.policy.clone(), 1)),
            }
        }
        Counts { begun: self.people.len(), policies }
    }
}

/// Returns the record of a participant whose data is deleted: the drawn plan, so that the design stays
/// balanced; the planner that is still to be restored; and the deletion itself.
pub(super) fn kept(person: &Participant, deleted: &Entry) -> Vec<Entry> {
    let begun = Event::Begun(Box::new(person.begun.clone()));
    let switched =
        person.switched.iter().map(|planner| Event::Switched { planner: planner.clone() });
    let before = std::iter::once(begun).chain(switched);
    let mut kept: Vec<Entry> = before.map(|event| Entry { at: person.begun_at, event }).collect();
    kept.push(deleted.clone());
    kept
}

fn start(person: &Participant, robot: &RobotState<'_>) -> Result<Event, String> {
    let trial = person.trial().ok_or("Nothing was drawn yet.")?;
    match robot.not_ready(&trial.step.policy) {
        None => Ok(Event::Started { after: robot.latest_interaction() }),
        Some(NotReady::Stopped) => {
            Err("The robot is stopped. Please call the experimenter.".to_owned())
        }
        Some(_) => Err("The robot is not ready yet. Please wait a moment.".to_owned()),
    }
}

fn answered(person: &Participant, given: &Map<String, Json>) -> Result<Vec<Event>, String> {
    let items = &person.begun.protocol.questionnaire;
    if let Some(unknown) = given.keys().find(|id| items.iter().all(|item| item.id != **id)) {
        return Err(format!("the questionnaire has no question `{unknown}`"));
    }
    let mut answers = Map::new();
    for item in items {
        let answer = item.check(given.get(&item.id).unwrap_or(&Json::Null))?;
        answers.extend(answer.map(|answer| (item.id.clone(), answer)));
    }
    Ok(vec![Event::Answered { answers }, Event::Finished])
}
