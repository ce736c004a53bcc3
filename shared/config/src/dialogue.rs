//! `dialogue.toml`: how the robot understands, believes and decides.

use dialogue::user_model::Reaction;
use dialogue::{Actions, Attribution, Costs, Fault, Mode, Params, Prior, TurnTaking};
use language::Language;

use crate::gesture::{self, Gesture};
use crate::prior;
use diagnostics::Fields;

/// The dialogue.
#[derive(Clone, Debug, PartialEq)]
pub struct Dialogue {
    /// How utterances are read.
    pub language: Language,
    /// Parameters of the observation model (section 3.6 of the paper).
    pub params: Params,
    /// Name of the planner; one of [`dialogue::registry::names`].
    pub planner: String,
    /// What the robot may do.
    pub actions: Actions,
    /// What its actions cost.
    pub costs: Costs,
    /// Where the costs of its questions come from.
    pub costs_from: CostsFrom,
    /// How turns are taken.
    pub turns: TurnTaking,
    /// What is believed before anything is said.
    pub prior: Prior,
    /// How pointing gestures are understood.
    pub gesture: Gesture,
}

/// Where the costs of questions come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CostsFrom {
    /// The numbers that are written down, one for each kind of question.
    #[default]
    Config,
    /// The robot's own voice and arm in the scene at hand, for each question alone.
    Robot,
}

pub(crate) fn read(f: &mut Fields<'_>) -> Dialogue {
    let planner = f.text("planner");
    if !f.is_wrong("planner") && !dialogue::registry::names().contains(&planner.as_str()) {
        f.not_one_of("planner", &planner, &dialogue::registry::names());
    }
    let (costs, costs_from) = f.table("costs", costs);
    Dialogue {
        language: f
            .choice("language", &[("careful", Language::Careful), ("paper", Language::Paper)]),
        params: params(f),
        planner,
        actions: Actions {
            mode: f.choice("mode", &[("remote", Mode::Remote), ("present", Mode::Present)]),
            attribute: f.flag("attribute_questions"),
            which: f.flag("open_questions"),
        },
        costs,
        costs_from,
        turns: f.table("turns", turns),
        prior: f.table("prior", prior::read),
        gesture: f.table("gesture", gesture::read),
    }
}

fn params(f: &mut Fields<'_>) -> Params {
    let params = Params {
        p_l: f.any_number("p_l"),
        epsilon: f.any_number("epsilon"),
        alpha: f.any_number("alpha"),
    };
    tell(params.check(), f);
    params
}

fn costs(f: &mut Fields<'_>) -> (Costs, CostsFrom) {
    let costs = Costs {
        wait_s: f.any_number("wait_s"),
        attribute_s: f.any_number("attribute_s"),
        which_s: f.any_number("which_s"),
        point_s: f.any_number("point_s"),
        correct: f.any_number("correct"),
        wrong: f.any_number("wrong"),
        discount: f.any_number("discount"),
    };
    tell(costs.check(), f);
    (costs, f.choice("from", &[("config", CostsFrom::Config), ("robot", CostsFrom::Robot)]))
}

fn turns(f: &mut Fields<'_>) -> TurnTaking {
    TurnTaking {
        response_window_s: f.number("response_window_s", 0.05..=600.0),
        repeats_max: f.whole("repeats_max", 0..=100),
        questions_max: f.whole("questions_max", 0..=1000),
        attribution: f.choice(
            "attribution",
            &[
                ("mixture", Attribution::Mixture),
                ("onset", Attribution::Onset),
                ("naive", Attribution::Naive),
            ],
        ),
        defers: true,
        repeats_same: true,
        spoken: reaction(f, "reaction_median_s", "reaction_log_sd"),
        typed: reaction(f, "typing_median_s", "typing_log_sd"),
    }
}

fn reaction(f: &mut Fields<'_>, median_s: &'static str, log_sd: &'static str) -> Reaction {
    Reaction::new(f.number(median_s, 0.05..=60.0), f.number(log_sd, 0.05..=2.0))
}

/// The model's own checks, for the values that are numbers at all.
fn tell(faults: Vec<Fault>, f: &mut Fields<'_>) {
    for (key, what, help) in faults {
        if !f.is_wrong(key) {
            f.problem(key, what, help);
        }
    }
}
