//! A participant, folded from the journal.

use serde_json::{Map, Value as Json};

use crate::event::{Begun, Entry, Event, FormatError, parse};
use crate::trial::{End, Trial};

/// Stage of a participant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Reads the consent form.
    Consent,
    /// Reads the instructions.
    Instructions,
    /// Sees the desired object of the interaction to come.
    Drawn,
    /// Talks to the robot.
    Running,
    /// Sees how the interaction ended.
    Over,
    /// Answers the questionnaire.
    Questionnaire,
    /// Has finished, and has been thanked.
    Thanks,
    /// Has withdrawn.
    Withdrawn,
    /// Has left without a word.
    Left,
}

impl Stage {
    /// Returns the stage's name on the wire.
    pub fn name(self) -> &'static str {
        match self {
            Self::Consent => "consent",
            Self::Instructions => "instructions",
            Self::Drawn => "drawn",
            Self::Running => "running",
            Self::Over => "over",
            Self::Questionnaire => "questionnaire",
            Self::Thanks => "thanks",
            Self::Withdrawn => "withdrawn",
            Self::Left => "left",
        }
    }

    /// Returns whether nothing comes any more.
    pub fn is_final(self) -> bool {
        matches!(self, Self::Thanks | Self::Withdrawn | Self::Left)
    }
}

/// Status of a participant's data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Still taking part.
    Running,
    /// Has done everything.
    Complete,
    /// Left before the end; the data so far count.
    Left,
    /// Withdrew; nothing counts.
    Withdrawn,
    /// Withdrew, and the data is deleted.
    Deleted,
}

impl Status {
    /// Returns the status's name in the data.
    pub fn name(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Complete => "complete",
            Self::Left => "left",
            Self::Withdrawn => "withdrawn",
            Self::Deleted => "deleted",
        }
    }

    /// Returns whether the participant's interactions count.
    pub fn counts(self) -> bool {
        !matches!(self, Self::Withdrawn | Self::Deleted)
    }
}

/// Returns the participants of these journals, each with its file's name, in the order in which
/// they came. A journal without a first line is skipped.
///
/// # Errors
/// The name of an invalid file, and the reason.
pub fn people<N>(files: Vec<(N, String)>) -> Result<Vec<Participant>, (N, FormatError)> {
    let mut people = Vec::new();
    for (name, text) in files {
        match parse(&text) {
            Ok(entries) => people.extend(Participant::fold(&entries)),
            Err(error) => return Err((name, error)),
        }
    }
    people.sort_by(|a, b| (a.begun_at, a.id()).cmp(&(b.begun_at, b.id())));
    Ok(people)
}

/// A participant.
#[derive(Clone, Debug, PartialEq)]
pub struct Participant {
    /// The first line.
    pub begun: Begun,
    /// Start of the session, milliseconds since 1970.
    pub begun_at: u64,
    /// The latest line.
    pub latest_at: u64,
    /// The page that the participant uses.
    pub session: String,
    /// Present stage.
    pub stage: Stage,
    /// Whether consent was given, if it is required.
    pub consented: bool,
    /// Every interaction, the spoilt ones too, in order.
    pub trials: Vec<Trial>,
    /// The planner that the policy was switched to and not yet given back.
    pub switched: Option<String>,
    /// The questionnaire's answers.
    pub answers: Map<String, Json>,
    /// `true` if the data was deleted.
    pub deleted: bool,
}

impl Participant {
    /// Folds a journal; `None` without a first line.
    pub fn fold(entries: &[Entry]) -> Option<Self> {
        let (first, rest) = entries.split_first()?;
        let Event::Begun(begun) = &first.event else { return None };
        let mut participant = Self::new((**begun).clone(), first.at);
        rest.iter().for_each(|entry| participant.apply(entry));
        Some(participant)
    }

    fn new(begun: Begun, at: u64) -> Self {
        let asks = !begun.protocol.consent.is_empty();
        Self {
            begun_at: at,
            latest_at: at,
            session: begun.session.clone(),
            stage: if asks { Stage::Consent } else { Stage::Instructions },
            consented: false,
            trials: Vec::new(),
            switched: None,
            answers: Map::new(),
            deleted: false,
            begun,
        }
    }

    /// Takes in a further line.
    pub fn apply(&mut self, entry: &Entry) {
        self.latest_at = entry.at;
        match &entry.event {
            Event::Begun(_) | Event::Instructed => {}
            Event::Consented => (self.consented, self.stage) = (true, Stage::Instructions),
            Event::Drawn(drawn) => {
                if let Some(step) = self.begun.plan.get(drawn.step) {
                    self.trials.push(Trial::new(step.clone(), drawn.clone(), entry.at));
                    self.stage = Stage::Drawn;
                }
            }
            Event::Switched { planner } => self.switched = Some(planner.clone()),
            Event::Restored => self.switched = None,
            Event::Started { .. } => self.stage = Stage::Running,
            Event::Ended(_) | Event::Faulted { .. } => self.stage = Stage::Over,
            Event::Questioned => self.stage = Stage::Questionnaire,
            Event::Answered { answers } => self.answers.clone_from(answers),
            Event::Finished => self.stage = Stage::Thanks,
            Event::Resumed { session } => self.session.clone_from(session),
            Event::Left => self.stage = Stage::Left,
            Event::Withdrawn => self.stage = Stage::Withdrawn,
            Event::Deleted => (self.stage, self.deleted) = (Stage::Withdrawn, true),
            Event::Heard(_) | Event::Asked(_) | Event::Decided { .. } => {}
        }
        if let Some(trial) = self.trials.last_mut().filter(|trial| trial.end.is_none()) {
            trial.apply(entry.at, &entry.event);
        }
    }

    /// Returns the participant's name in the data.
    pub fn id(&self) -> &str {
        &self.begun.participant
    }

    /// Returns the status of the data.
    pub fn status(&self) -> Status {
        match self.stage {
            _ if self.deleted => Status::Deleted,
            Stage::Thanks => Status::Complete,
            Stage::Left => Status::Left,
            Stage::Withdrawn => Status::Withdrawn,
            _ => Status::Running,
        }
    }

    /// Returns the interaction that is shown or runs, or that ended last.
    pub fn trial(&self) -> Option<&Trial> {
        self.trials.last()
    }

    /// Returns the place of the next step in the plan: after a fault the same again. `None` after
    /// the last.
    pub fn next_step(&self) -> Option<usize> {
        let next = match self.trials.last() {
            None => 0,
            Some(trial) => match trial.end {
                Some(End::Verdict(_)) => trial.drawn.step + 1,
                Some(End::Fault(..)) | None => trial.drawn.step,
            },
        };
        (next < self.begun.plan.len()).then_some(next)
    }

    /// Returns the interactions that count, in order.
    pub fn counted(&self) -> impl Iterator<Item = &Trial> {
        self.trials.iter().filter(|trial| trial.counts())
    }
}
