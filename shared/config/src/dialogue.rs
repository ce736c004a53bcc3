//! `dialogue.toml`: understanding, belief and decisions.

use std::ops::RangeInclusive;

use diagnostics::{Diagnostic, Fields, Node, Report, Scalar, Table};
use scene::{Scene, View};
use serde_json::json;
use vocabulary::gesture::{Direction, Gestures};
use vocabulary::reaction::Reaction;
use vocabulary::{
    Acquaintance, Actions, Announce, Attribution, Costs, Fault, Language, Mode, PLANNERS, Params,
    Prior, PriorObjects, Reliability, TurnTaking,
};

/// The dialogue.
#[derive(Clone, Debug, PartialEq)]
pub struct Dialogue {
    /// Reading of utterances.
    pub language: Language,
    /// Parameters of the observation model (section 3.6 of the paper).
    pub params: Params,
    /// Smoothing of certain words besides misperception, in snapshots of earlier versions.
    pub alpha_typed: Option<f64>,
    /// Probability that a user takes a value for another one, and sticks to it; 0 with
    /// [`Language::Paper`].
    pub misperception: f64,
    /// Probabilities for single attributes, by name.
    pub misperceptions: Vec<(String, f64)>,
    /// Name of the planner; one of [`PLANNERS`].
    pub planner: String,
    /// Kinds of questions that are allowed.
    pub actions: Actions,
    /// Costs and rewards of actions.
    pub costs: Costs,
    /// Source of the costs of questions.
    pub costs_from: CostsFrom,
    /// Whether an announced pick can be denied.
    pub announce: Announce,
    /// Turn-taking.
    pub turns: TurnTaking,
    /// Prior belief.
    pub prior: Prior,
    /// Settings of learning about people who give their name; none with [`Language::Paper`].
    pub people: Acquaintance,
    /// Pointing gestures.
    pub gesture: Gesture,
}

/// Source of the costs of questions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CostsFrom {
    /// Configured numbers, one per kind of question.
    #[default]
    Config,
    /// Durations of voice and arm in the scene, one per question.
    Robot,
}

/// Pointing gestures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gesture {
    /// Accept gestures.
    pub enabled: bool,
    /// Parameters of the observation model.
    pub model: Gestures,
    /// Origin of the pointing ray, metres, frame `base`.
    pub person_xyz_m: [f64; 3],
}

impl Dialogue {
    /// Returns the scene in which like objects are distinguished by place, as the user sees them if
    /// the user's place is known; in the paper's language the unchanged scene.
    pub fn by_place(&self, scene: Scene) -> Scene {
        let view = match self.gesture.enabled {
            true => View::User(self.gesture.person_xyz_m),
            false => View::Robot,
        };
        match self.language {
            Language::Careful => scene.by_place(view),
            Language::Paper => scene,
        }
    }
}

pub(crate) fn read(f: &mut Fields<'_>) -> Dialogue {
    let planner = f.text("planner");
    f.note_choices("planner", PLANNERS.into_iter());
    if !f.is_wrong("planner") && !PLANNERS.contains(&planner.as_str()) {
        f.not_one_of("planner", &planner, &PLANNERS);
    }
    let (costs, costs_from) = f.table("costs", costs);
    let language =
        f.choice("language", &[("careful", Language::Careful), ("paper", Language::Paper)]);
    Dialogue {
        language,
        params: Params {
            open: Some(f.table("open", reliability)),
            choice: Some(f.table("choice", reliability)),
            ..params(f)
        },
        alpha_typed: f.former_number(ALPHA_TYPED, ALPHA_TYPED_RANGE),
        misperception: f.number("misperception", 0.0..=MISPERCEPTION_MAX),
        misperceptions: f.table("misperceptions", misperceptions),
        planner,
        actions: Actions {
            mode: f.choice("mode", &[("remote", Mode::Remote), ("present", Mode::Present)]),
            attribute: f.flag("attribute_questions"),
            which: f.flag("open_questions"),
            choice: f.flag("choice_questions"),
        },
        costs,
        costs_from,
        announce: f.table("announce", announce),
        turns: f.table("turns", turns),
        prior: f.table("prior", prior),
        people: {
            let people = f.table("people", people);
            Acquaintance { learns: people.learns && language == Language::Careful, ..people }
        },
        gesture: f.table("gesture", gesture),
    }
}

/// Largest rate of misperception: beyond it a word says next to nothing.
const MISPERCEPTION_MAX: f64 = 0.5;

/// The key that `misperception` replaces, and its values.
const ALPHA_TYPED: &str = "alpha_typed";
const ALPHA_TYPED_RANGE: RangeInclusive<f64> = 1e-6..=100.0;

/// Replaces `alpha_typed` in a layer, and returns a warning of it.
///
/// `alpha_typed = A` doubted typed words by `A : 1`. It becomes the misperception `A / (1 + A)`,
/// with the same odds for two values, unless the layer states a rate or `below` has a higher one.
pub(crate) fn replace_former_key(layer: &mut Table, below: &Table) -> Option<Diagnostic> {
    const RATE: &str = "misperception";
    let rate_of = |dialogue: &Table| dialogue.get(RATE).and_then(Node::as_number);
    let usual = below.get("dialogue").and_then(Node::as_table).and_then(rate_of);
    let dialogue = layer.entries.iter_mut().find(|(section, _)| section == "dialogue");
    let Some((_, Node::Table(dialogue))) = dialogue else { return None };
    let alpha = dialogue.get(ALPHA_TYPED).and_then(Node::as_number);
    let alpha = alpha.filter(|alpha| ALPHA_TYPED_RANGE.contains(alpha))?;
    let source = dialogue.take(ALPHA_TYPED)?.source().clone();
    let rate = (alpha / (1.0 + alpha)).min(MISPERCEPTION_MAX);
    let is_enough = dialogue.get(RATE).is_some() || usual.is_some_and(|usual| usual >= rate);
    let help = match is_enough {
        true => "remove it".to_owned(),
        false => format!("write `{RATE} = {rate}`, which is taken"),
    };
    if !is_enough {
        let rate = Node::Scalar(Scalar::Float(rate), source.clone());
        dialogue.entries.push((RATE.to_owned(), rate));
    }
    let path = ["dialogue", ALPHA_TYPED].map(str::to_owned);
    Some(source.diagnostic(&path, "replaced by dialogue.misperception", help))
}

fn misperceptions(f: &mut Fields<'_>) -> Vec<(String, f64)> {
    let names = f.names().into_iter();
    names.map(|name| (name.to_owned(), f.number(name, 0.0..=MISPERCEPTION_MAX))).collect()
}

impl Dialogue {
    /// Probability that a user takes a value of that attribute for another one.
    pub fn misperception_of(&self, attribute: &str) -> f64 {
        let own = self.misperceptions.iter().find(|(name, _)| name == attribute);
        match self.language {
            Language::Paper => 0.0,
            Language::Careful => own.map_or(self.misperception, |(_, rate)| *rate),
        }
    }
}

fn params(f: &mut Fields<'_>) -> Params {
    let params = Params {
        p_l: f.any_number("p_l"),
        epsilon: f.any_number("epsilon"),
        alpha: f.any_number("alpha"),
        open: None,
        choice: None,
    };
    report(params.check(), f);
    f.note("p_l", || json!({ "exclusiveMinimum": 0, "exclusiveMaximum": 1 }));
    f.note("epsilon", || json!({ "exclusiveMinimum": 0, "exclusiveMaximum": 0.5 }));
    f.note("alpha", || json!({ "exclusiveMinimum": 0 }));
    params
}

fn reliability(f: &mut Fields<'_>) -> Reliability {
    let reliability = Reliability { p_l: f.any_number("p_l"), epsilon: f.any_number("epsilon") };
    report(reliability.check(), f);
    f.note("p_l", || json!({ "exclusiveMinimum": 0, "exclusiveMaximum": 1 }));
    f.note("epsilon", || json!({ "exclusiveMinimum": 0, "exclusiveMaximum": 0.5 }));
    reliability
}

fn costs(f: &mut Fields<'_>) -> (Costs, CostsFrom) {
    let costs = Costs {
        wait_s: f.any_number("wait_s"),
        attribute_s: f.any_number("attribute_s"),
        which_s: f.any_number("which_s"),
        choice_s: f.any_number("choice_s"),
        option_s: f.any_number("option_s"),
        point_s: f.any_number("point_s"),
        correct: f.any_number("correct"),
        wrong: f.any_number("wrong"),
        discount: f.any_number("discount"),
    };
    report(costs.check(), f);
    let asked = ["wait_s", "attribute_s", "which_s", "choice_s", "option_s", "point_s"];
    for amount in asked.into_iter().chain(["correct", "wrong"]) {
        f.note(amount, || json!({ "exclusiveMinimum": 0 }));
    }
    f.note("discount", || json!({ "exclusiveMinimum": 0, "exclusiveMaximum": 1 }));
    (costs, f.choice("from", &[("config", CostsFrom::Config), ("robot", CostsFrom::Robot)]))
}

fn announce(f: &mut Fields<'_>) -> Announce {
    let announce = Announce { heard: f.any_number("heard"), cost_s: f.any_number("cost_s") };
    report(announce.check(), f);
    f.note("heard", || json!({ "minimum": 0, "exclusiveMaximum": 1 }));
    f.note("cost_s", || json!({ "minimum": 0 }));
    announce
}

fn turns(f: &mut Fields<'_>) -> TurnTaking {
    TurnTaking {
        response_window_s: f.number("response_window_s", 0.05..=600.0),
        repeats_max: f.whole("repeats_max", 0..=100),
        questions_max: f.whole("questions_max", 0..=1000),
        refusal_s: f.number("refusal_s", 0.0..=3600.0),
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

fn prior(f: &mut Fields<'_>) -> Prior {
    let objects = [("uniform", PriorObjects::Uniform), ("history", PriorObjects::History)];
    Prior {
        objects: f.choice("objects", &objects),
        smoothing: f.number("smoothing", 0.01..=1e6),
        absent: f.number("absent", 0.0..=0.9),
    }
}

/// Maximum coordinate of the user, metres.
const PERSON_MAX_M: f64 = 20.0;

fn people(f: &mut Fields<'_>) -> Acquaintance {
    Acquaintance { learns: f.flag("learn"), prior_from: f.whole("prior_from", 0..=1_000_000) }
}

fn gesture(f: &mut Fields<'_>) -> Gesture {
    let enabled = f.flag("enabled");
    let model = Gestures {
        p_g: f.any_number("p_g"),
        std_theta_rad: f.any_number("std_theta_rad"),
        stray: f.any_number("stray"),
    };
    report(model.check(), f);
    for share in ["p_g", "stray"] {
        f.note(share, || json!({ "exclusiveMinimum": 0, "exclusiveMaximum": 1 }));
    }
    let std_theta_max = Gestures::STD_THETA_MAX;
    f.note("std_theta_rad", || json!({ "exclusiveMinimum": 0, "maximum": std_theta_max }));
    f.note("person_xyz", || {
        json!({ "items": { "type": "number", "minimum": -PERSON_MAX_M, "maximum": PERSON_MAX_M } })
    });
    let person_xyz_m = f.triple("person_xyz");
    if !f.is_wrong("person_xyz") && person_xyz_m.iter().any(|x| x.abs() > PERSON_MAX_M) {
        let what = format!("expected -{PERSON_MAX_M} to {PERSON_MAX_M} m, found {person_xyz_m:?}");
        f.problem("person_xyz", what, "");
    }
    Gesture { enabled, model, person_xyz_m }
}

/// Reports an object at the position of the user, at which a ray cannot point.
pub(crate) fn check_person(scene: &Scene, gesture: &Gesture, tree: &Table, report: &mut Report) {
    if !gesture.enabled {
        return;
    }
    let directions = Direction::to_objects(gesture.person_xyz_m, scene);
    let objects = scene.objects().iter().zip(directions);
    let inside = |(object, direction): &(&scene::Object, Option<Direction>)| {
        object.placement.is_some() && direction.is_none()
    };
    for (object, _) in objects.filter(inside) {
        let path = ["dialogue", "gesture", "person_xyz"];
        let what = format!("the person stands where `{}` does", object.name);
        let help = "use a place from which people see the objects, e.g. [1.6, 0.0, 0.45]";
        report.add(tree.source_of(&path).diagnostic(&path.map(str::to_owned), what, help));
    }
}

/// Reports the faults that a model finds in its parameters, except for values that are not numbers.
fn report(faults: Vec<Fault>, f: &mut Fields<'_>) {
    for (key, what, help) in faults {
        if !f.is_wrong(key) {
            f.problem(key, what, help);
        }
    }
}
