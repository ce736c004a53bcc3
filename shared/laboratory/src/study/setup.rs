//! Setup of a study: the scene, the problem, and the durations.

use std::path::Path;

use ::setup::DialogueSettings;
use command_line::output::note;
use evaluation::simulation::Room;
use language::Reader;
use manipulation::Robot;
use preflight::{ArmSetup, Extent, Motions, Pace, Voice, measure};
use service::exit::{Exit, Failure};
use vocabulary::{Acquaintance, Durations, Language, Mode, TurnTaking};

use crate::args::{Preset, ProblemArgs, StudyArgs};
use crate::batch::Problem;
use crate::planning::{of_scene, planner_of};

/// Everything that the interactions of a study share.
pub(super) struct Setup {
    reader: Reader,
    problem: Problem,
    turns: TurnTaking,
    people: Acquaintance,
    voice: Voice,
    pace: Pace,
    motions: Option<Motions>,
    request: bool,
    /// In the publication's evaluations a pick was final.
    denials: bool,
}

/// The scene of the paper's evaluations.
const PAPER_SCENE: &str = "bowls";

impl Setup {
    /// Prepares the study: reads the files, and plans every motion of the arm.
    pub(super) fn new(args: &StudyArgs) -> Result<Self, Failure> {
        let scene = args.scene.as_deref().unwrap_or(Path::new(PAPER_SCENE));
        // A preset has its own problem.
        let follows = args.preset.is_none() && args.problem.config.is_given();
        let mut problem = of_scene(scene, &preset(args), follows)?;
        if let (None, Some(settings)) = (args.preset, &problem.settings) {
            // A study compares planners of the robot that runs.
            problem.model = settings.model_of(&problem.scene);
            let configured = settings.dialogue.actions;
            problem.actions.attribute &= configured.attribute;
            problem.actions.which &= configured.which;
            problem.actions.choice |= configured.choice && !args.problem.no_choice;
            if args.problem.announce.is_none() {
                problem.announce = settings.dialogue.announce;
            }
        }
        let settings = problem.settings.as_ref();
        let turns = settings.map_or_else(TurnTaking::default, |it| it.dialogue.turns);
        let people = settings.map_or_else(Acquaintance::default, |it| it.dialogue.people);
        let voice = settings.map_or_else(Voice::default, |settings| Voice {
            words_per_minute: f64::from(settings.speech.voice_words_per_minute),
        });
        let language = settings.map_or(Language::default(), |s| s.dialogue.language);
        let (reader, request) = (Reader::new(&problem.scene, language), !args.no_request);
        let (motions, pace) = (motions(&problem)?, Pace::default());
        let denials = args.preset.is_none();
        let mut setup =
            Self { reader, problem, turns, people, voice, pace, motions, request, denials };
        if args.measured_costs {
            setup.problem.durations = Some(setup.durations());
        }
        Ok(setup)
    }

    /// Returns the room that interactions take place in.
    pub(super) fn room(&self) -> Room<'_> {
        Room {
            scene: &self.problem.scene,
            reader: &self.reader,
            problem: self.problem.decision(),
            turns: self.turns,
            voice: self.voice,
            pace: &self.pace,
            motions: self.motions.as_ref(),
            people: self.people,
            request: self.request,
            denials: self.denials,
        }
    }

    /// Returns the name of the planner that is configured.
    pub(super) fn planner(&self) -> &str {
        planner_of(&self.problem)
    }

    /// Returns the arm's motions, if objects have places.
    pub(super) fn motions(&self) -> Option<&Motions> {
        self.motions.as_ref()
    }

    /// Returns whether picks take the arm's time.
    pub(super) fn moves(&self) -> bool {
        self.motions.is_some()
    }

    /// Durations of this robot's questions and picks.
    pub(super) fn durations(&self) -> Durations {
        measure(&self.problem.scene, &self.voice, &self.pace, self.motions.as_ref())
    }

    /// Seconds from the end of a question to its usual answer recognised.
    pub(super) fn answer_s(&self) -> f64 {
        self.pace.mean_answer_s()
    }
}

/// Returns the problem of a preset, unless the arguments say otherwise.
fn preset(args: &StudyArgs) -> ProblemArgs {
    let mut problem = args.problem.clone();
    match args.preset {
        None => {}
        Some(Preset::PaperPresent) => {
            (problem.mode, problem.no_which) = (Some(Mode::Present), true)
        }
        Some(Preset::PaperRemote) => problem.no_which = true,
    }
    problem
}

/// Returns the arm's motions in a scene with places.
fn motions(problem: &Problem) -> Result<Option<Motions>, Failure> {
    let scene = &problem.scene;
    if scene.objects().iter().any(|object| object.placement.is_none()) {
        note("the scene gives no places: the arm is taken to need no time");
        return Ok(None);
    }
    let arm = problem.settings.as_ref().map(ArmSetup::new).transpose()?;
    let plan = arm.as_ref().map(|arm| arm.plan).unwrap_or_default();
    let limb = arm.as_ref().and_then(|arm| arm.limb);
    let robot = arm.as_ref().map_or(Robot::baxter(), |arm| &arm.robot);
    let pointing = problem.actions.mode == Mode::Present;
    let extent = if pointing { Extent::Pairs } else { Extent::Picks };
    Motions::plan(robot, scene, limb, &plan, extent)
        .map(Some)
        .map_err(|error| Failure::new(Exit::Config, error.to_string()))
}
