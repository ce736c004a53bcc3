//! A controller with its disk, a robot and services, for the tests of the study's rules.

use messages::{Ended, Outcome, PolicyView, Receipt};
use page_part::DialogueEvent;
use scene::Scene;
use user_study::{
    Design, Entry, Event, Item, Kind, Objects, Order, Participant, Protocol, Stage, Status,
};
use vocabulary::ids::{InteractionId, UtteranceSeq};

use crate::study_controller::{Command, StudyController, kept};
use crate::trial_monitor::{RobotRequest, RobotState};

pub(super) const FAULT_MS: f64 = 10_000.0;
pub(super) const PAGE: &str = "0123456789abcdef0123456789abcdef";

pub(super) fn bowls() -> Scene {
    let text = include_str!("../../../../config/scenes/bowls.toml");
    Scene::from_toml("bowls.toml", text).unwrap_or_else(|problems| panic!("{problems:?}"))
}

pub(super) fn protocol() -> Protocol {
    let quick = Item {
        id: "quick".to_owned(),
        text: "It was quick.".to_owned(),
        kind: Kind::Likert,
        options: Vec::new(),
        low: String::new(),
        high: String::new(),
        points: 5,
        required: true,
    };
    Protocol {
        title: "Bowls".to_owned(),
        consent: "I agree.".to_owned(),
        instructions: vec!["Command for it.".to_owned()],
        interactions: 2,
        warmup: 1,
        objects: Objects::Uniform,
        design: Design::Within,
        policies: vec!["lookahead".to_owned(), "entropy".to_owned()],
        order: Order::Latin,
        seconds_max: 60.0,
        show_belief: false,
        keep_words: false,
        questionnaire: vec![quick],
    }
}

/// A controller with its disk and a robot.
pub(super) struct SimulatedStudy {
    pub(super) controller: StudyController,
    pub(super) disk: Vec<(String, Vec<Entry>)>,
    pub(super) scene: Scene,
    pub(super) view: PolicyView,
    pub(super) missing: Option<&'static str>,
    pub(super) arm_is_stopped: bool,
    pub(super) ms: f64,
}

impl SimulatedStudy {
    pub(super) fn new(protocol: Protocol) -> Self {
        let scene = bowls();
        let view = PolicyView {
            scene_key: scene.key(),
            planner: "lookahead".to_owned(),
            ..PolicyView::default()
        };
        let controller = StudyController::new(protocol, "lab".to_owned(), Vec::new());
        Self {
            controller,
            disk: Vec::new(),
            scene,
            view,
            missing: None,
            arm_is_stopped: false,
            ms: 1e6,
        }
    }

    pub(super) fn robot(&self) -> RobotState<'_> {
        RobotState {
            at: self.ms as u64,
            ms: self.ms,
            scene: &self.scene,
            view: Some(&self.view),
            missing: self.missing,
            arm_is_busy: false,
            arm_is_stopped: self.arm_is_stopped,
            is_switching: self.controller.owing().is_some(),
        }
    }

    pub(super) fn ask_as(&mut self, page: &str, command: &Command) -> Result<String, String> {
        let seed = self.ms as u64;
        let (id, events) = self.controller.handle(page, command, &self.robot(), seed)?;
        self.write(&id, events);
        Ok(id)
    }

    pub(super) fn ask(&mut self, command: &Command) -> Result<String, String> {
        self.ask_as(PAGE, command)
    }

    pub(super) fn write(&mut self, id: &str, events: Vec<Event>) {
        for event in events {
            let entry = Entry { at: self.ms as u64, event };
            if !self.disk.iter().any(|(known, _)| known == id) {
                self.disk.push((id.to_owned(), Vec::new()));
            }
            let (_, file) = self.disk.iter_mut().find(|(known, _)| known == id).unwrap();
            match (&entry.event, self.controller.people().iter().find(|p| p.id() == id)) {
                (Event::Deleted, Some(person)) => *file = kept(person, &entry),
                _ => file.push(entry.clone()),
            }
            self.controller.apply(id, &entry);
        }
    }

    pub(super) fn look(&mut self) {
        let scene = self.scene.clone();
        let view = self.view.clone();
        let (ms, missing) = (self.ms, self.missing);
        let robot = RobotState {
            at: ms as u64,
            ms,
            scene: &scene,
            view: Some(&view),
            missing,
            arm_is_busy: false,
            arm_is_stopped: self.arm_is_stopped,
            is_switching: false,
        };
        while let Some((id, event)) = self.controller.look(&robot, FAULT_MS) {
            self.write(&id, vec![event]);
        }
    }

    /// Does what the study wishes, as the robot and the supervisor do.
    pub(super) fn grant(&mut self) {
        while let Some(request) = self.controller.request(&self.robot()) {
            match request {
                RobotRequest::Cancel => self.end(Outcome::Cancelled, None),
                RobotRequest::Switch(planner) => {
                    let id =
                        self.controller.active().expect("an active participant").id().to_owned();
                    self.write(&id, vec![Event::Switched { planner: planner.clone() }]);
                    self.view.planner = planner;
                }
                RobotRequest::Restore(id) => {
                    self.view.planner = "lookahead".to_owned();
                    self.write(&id, vec![Event::Restored]);
                }
            }
        }
    }

    pub(super) fn say(&mut self, seq: u64) {
        if self.view.interaction == 0 {
            let last = self.view.last.as_ref().map_or(0, |last| last.interaction.0);
            self.view.interaction = last + 1;
        }
        let onset_ns = ((self.ms - 500.0) * 1e6) as u64;
        let heard = DialogueEvent::Heard(Box::new(Receipt { seq, onset_ns, ..Receipt::default() }));
        if let Some((id, event)) = self.controller.said(&heard, &self.robot()) {
            self.write(&id, vec![event]);
        }
    }

    pub(super) fn end(&mut self, outcome: Outcome, name: Option<&str>) {
        if self.view.interaction == 0 {
            return;
        }
        let interaction = std::mem::take(&mut self.view.interaction);
        self.view.last = Some(Ended {
            interaction: InteractionId(interaction),
            object: None,
            name: name.map(str::to_owned),
            outcome,
            questions: 2,
            seconds: 9.5,
            utterances: (UtteranceSeq(1), UtteranceSeq(3)),
        });
    }

    pub(super) fn desired(&self) -> String {
        let trial = self.controller.active().and_then(|person| person.trial().cloned());
        trial.map_or(String::new(), |trial| trial.drawn.object)
    }

    pub(super) fn stage(&self) -> Option<Stage> {
        self.controller.of_page(PAGE).map(|person| person.stage)
    }

    /// Checks the invariants after every step.
    pub(super) fn check(&self) {
        let recovered: Vec<Participant> =
            self.disk.iter().filter_map(|(_, entries)| Participant::fold(entries)).collect();
        assert_eq!(
            recovered,
            self.controller.people(),
            "what is known is the fold of what is written"
        );
        for person in self.controller.people() {
            let total = person.begun.plan.iter().filter(|step| !step.practice).count();
            assert!(person.counted().count() <= total);
            let mut steps = person.counted().map(|trial| trial.drawn.step);
            let mut before = None;
            assert!(steps.all(|step| before.replace(step).is_none_or(|b| b < step)), "in order");
            let open = person.trials.iter().filter(|trial| trial.end.is_none()).count();
            assert!(open <= 1, "one interaction at a time");
            if person.status() == Status::Complete {
                assert_eq!(person.counted().count(), total);
                assert!(person.consented);
            }
        }
        let taking_part = self.controller.people().iter().filter(|p| !p.stage.is_final()).count();
        assert!(taking_part <= 1, "one participant at a time");
    }
}
