//! Shared parts of a study's interactions, and its dialogue manager.

use dialogue::manager::{Manager, Setup};
use dialogue::{DecisionProblem, Planner};
use language::Reader;
use preflight::{Motions, Pace, Voice};
use scene::Scene;
use vocabulary::{Acquaintance, Attribution, Prior, PriorObjects, TurnTaking};

use crate::simulation::cached_planner::CachedPlanner;
use crate::simulation::users::Domain;

/// Everything about a study but policy and people.
#[derive(Clone, Copy, Debug)]
pub struct Room<'a> {
    /// The objects.
    pub scene: &'a Scene,
    /// Reader of people's words about the objects.
    pub reader: &'a Reader,
    /// Decision rule and costs.
    pub problem: DecisionProblem<'a>,
    /// Turn-taking rules.
    pub turns: TurnTaking,
    /// Duration model of the robot's speech.
    pub voice: Voice,
    /// Duration model of people's speech and of the recogniser.
    pub pace: &'a Pace,
    /// Duration model of the arm; none: it takes no time.
    pub motions: Option<&'a Motions>,
    /// Settings of learning about people, in dialogues with the same ones.
    pub people: Acquaintance,
    /// `true` if people begin with a request; else the robot begins without knowledge.
    pub request: bool,
    /// Whether people deny a wrong announced object, as they can until it is gripped.
    pub denials: bool,
}

impl<'a> Room<'a> {
    /// The objects that users talk about.
    pub fn domain(&self) -> Domain<'a> {
        Domain { scene: self.scene, model: self.problem.model }
    }

    /// Returns a dialogue manager that decides by a planner. Each utterance follows the question
    /// that it answers, so it is attributed by its onset.
    pub fn manager(&self, planner: CachedPlanner) -> Manager {
        // Nothing is read again but to learn from it.
        self.learning_manager(planner).without_recall()
    }

    /// Returns the same manager, which learns about those who give their name.
    pub fn learning_manager(&self, planner: CachedPlanner) -> Manager {
        let DecisionProblem { model, costs, actions, durations, announce, .. } = self.problem;
        let setup = Setup {
            scene: self.scene.clone(),
            model: model.clone(),
            costs,
            durations: durations.cloned(),
            actions,
            announce,
            prior: Prior { objects: PriorObjects::Uniform, smoothing: 1.0, absent: 0.0 },
            gestures: None,
            perceives: false,
            people: self.people,
            turns: TurnTaking { attribution: Attribution::Onset, ..self.turns },
        };
        let planner: Box<dyn Planner + Send> = Box::new(planner);
        Manager::new(setup, planner, 0)
    }
}
