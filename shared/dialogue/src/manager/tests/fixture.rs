//! Settings, readings and causes for the tests of the manager.

use crate::manager::{Cause, Manager, Setup, State, Utterance};
use crate::{Model, registry, rendering};
use scene::{Reading, Response, Scene, StableHash};
use vocabulary::gesture::Gestures;
use vocabulary::ids::{PickId, PromptId, UtteranceSeq};
use vocabulary::time::Time;
use vocabulary::{
    Acquaintance, ActKind, Actions, Announce, Costs, Durations, Interpretation, Mode, Params,
    PickOutcome, Presentation, Prior, PriorObjects, TurnTaking,
};

const BOWLS: &str = include_str!("../../../../../config/scenes/bowls.toml");
const MARKERS: &str = include_str!("../../../../../config/scenes/markers.toml");

/// Parts of a manager; each test changes those that it is about.
#[derive(Clone, Debug)]
pub(super) struct Settings {
    pub(super) scene: Scene,
    pub(super) planner: &'static str,
    pub(super) params: Params,
    /// Smoothing of words that are certain; none in the paper's language.
    pub(super) certain_alpha: Option<f64>,
    /// Rate of misperception of every attribute.
    pub(super) misperception: f64,
    pub(super) durations: Option<Durations>,
    pub(super) mode: Mode,
    pub(super) prior: Prior,
    pub(super) people: Acquaintance,
    pub(super) gestures: bool,
    /// Whether choices are asked.
    pub(super) choices: bool,
    pub(super) turns: TurnTaking,
}

pub(super) type Change = fn(&mut Settings);

impl Settings {
    pub(super) fn manager(&self) -> Manager {
        let setup = self.setup();
        let mut hash = StableHash::default();
        hash.text(self.planner);
        hash.text(&format!("{setup:?}"));
        Manager::new(setup, registry::planner(self.planner).unwrap(), hash.value())
    }

    fn setup(&self) -> Setup {
        let model = Model::new(&self.scene, self.params);
        let model = match self.certain_alpha {
            Some(alpha) => model.with_certain_words(alpha),
            None => model,
        };
        let rates = vec![self.misperception; model.attributes()];
        let model = model.with_misperceptions(&rates);
        Setup {
            scene: self.scene.clone(),
            model,
            costs: Costs::SECONDS,
            durations: self.durations.clone(),
            actions: Actions {
                mode: self.mode,
                attribute: true,
                which: false,
                choice: self.choices,
            },
            announce: Announce { heard: 0.0, cost_s: 8.0 },
            prior: self.prior,
            gestures: self.gestures.then(|| (Gestures::default(), [1.6, 0.0, 0.45])),
            turns: self.turns,
            perceives: false,
            people: self.people,
        }
    }
}

/// The values of the shipped configuration, over the six bowls.
pub(super) fn settings() -> Settings {
    Settings {
        scene: scene_of(BOWLS),
        planner: "lookahead",
        params: Params { p_l: 0.95, epsilon: 0.01, alpha: 0.2, ..Params::default() },
        certain_alpha: Some(1e-6),
        misperception: 0.0125,
        durations: None,
        mode: Mode::Remote,
        prior: Prior { objects: PriorObjects::Uniform, smoothing: 1.0, absent: 0.0 },
        people: Acquaintance::default(),
        gestures: false,
        choices: false,
        turns: TurnTaking::default(),
    }
}

pub(super) fn settings_with(change: impl FnOnce(&mut Settings)) -> Settings {
    let mut settings = settings();
    change(&mut settings);
    settings
}

/// The shipped settings over the scene of that file.
pub(super) fn settings_of(scene: &str) -> Settings {
    Settings { scene: scene_of(scene), ..settings() }
}

fn scene_of(file: &str) -> Scene {
    Scene::from_toml("test.toml", file).unwrap_or_else(|problems| panic!("{problems}"))
}

pub(super) fn markers() -> Settings {
    settings_of(MARKERS)
}

/// The bowls' file without the objects in `gone`, and with these lines behind it.
pub(super) fn bowls_file(gone: &[&str], more: &str) -> String {
    let mut parts = BOWLS.split("[[objects]]");
    let head = parts.next().unwrap();
    let is_gone = |part: &&str| gone.iter().any(|name| part.contains(&format!("\"{name}\"\n")));
    let kept = parts.filter(|part| !is_gone(part)).map(|part| format!("[[objects]]{part}"));
    format!("{head}{}\n{more}", kept.collect::<String>())
}

pub(super) fn manager() -> Manager {
    settings().manager()
}

/// An utterance typed after that prompt had been said, if any had.
pub(super) fn heard(seq: u64, prompt: PromptId, reading: Reading) -> Cause {
    Cause::Utterance(typed(seq, prompt, reading))
}

pub(super) fn typed(seq: u64, prompt: PromptId, reading: Reading) -> Utterance {
    let accepted = at(seq);
    let began = Time(accepted.ns() - 500_000_000);
    let asking = Presentation {
        prompt,
        number: 1,
        began,
        ended: Some(began),
        complete: true,
        ..Presentation::default()
    };
    let asked = if prompt == PromptId(0) { Vec::new() } else { vec![asking] };
    let as_answer_to =
        |question| Interpretation { weight: 1.0, answers: question, reading: reading.clone() };
    let meant = (0..asked.len()).map(Some).chain([None]).map(as_answer_to).collect();
    let (seq, onset, end) = (UtteranceSeq(seq), accepted, accepted);
    Utterance {
        seq,
        presentations: asked,
        typed: true,
        onset,
        end,
        accepted,
        interpretations: meant,
        ..Utterance::default()
    }
}

pub(super) fn answer(response: Response) -> Reading {
    Reading { response, ..Reading::default() }
}

pub(super) fn at(seconds: u64) -> Time {
    Time(seconds * 1_000_000_000)
}

/// A reading of the scene's words.
pub(super) fn words(words: &[&str]) -> Reading {
    let scene = settings().scene;
    let base = words.iter().map(|word| scene.word_named(word).expect("a word of the scene"));
    Reading { base: base.collect(), ..Reading::default() }
}

/// The state after the first utterance.
pub(super) fn first(manager: &mut Manager, reading: Reading) -> State {
    let nothing_said = manager.first();
    remark(manager, &nothing_said, reading)
}

/// The state after an utterance that answers the standing prompt, typed a second per utterance.
pub(super) fn reply(manager: &mut Manager, state: &State, reading: Reading) -> State {
    let seq = state.applied.0 + 1;
    manager.next(state, &heard(seq, state.act.prompt, reading), at(seq))
}

/// The state after an utterance that answers no prompt.
pub(super) fn remark(manager: &mut Manager, state: &State, reading: Reading) -> State {
    let seq = state.applied.0 + 1;
    manager.next(state, &heard(seq, PromptId(0), reading), at(seq))
}

pub(super) fn delivered(pick: PickId) -> Cause {
    Cause::PickEnded { pick, outcome: PickOutcome::Delivered }
}

/// A dialogue after the first request, with a question standing.
pub(super) fn asked(manager: &mut Manager) -> State {
    let state = first(manager, Reading::default());
    assert_eq!(state.act.kind, ActKind::Ask);
    state
}

/// The English of the standing line.
pub(super) fn text(state: &State) -> String {
    rendering::text(&settings().scene, &state.act)
}

pub(super) fn belief(state: &State) -> Vec<f64> {
    state.open.as_ref().expect("an open interaction").belief().probabilities()
}
