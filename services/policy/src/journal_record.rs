//! The policy's journal records for programs.

use std::borrow::Cow;

use config::Settings;
use dialogue::manager::{Act, Cause, Interaction, MotionStop, Record, State};
use dialogue::rendering;
use scene::{ObjectId, Scene, WordId};
use service::journal_record::{
    AlternativeRecord, DecisionRecord, EndedRecord, InterpretationRecord, Named, PickKey,
    PolicyCause, PolicyRecord, PresentationKey, UserRecord,
};
use service::view::{ActionView, QuestionView};
use vocabulary::{Action, Ended, Interpretation, Presentation};

/// Scenes of up to this many objects have their descriptions in every record.
const DESCRIBED_MAX: usize = 64;

/// Returns the scene that a record is about, with the objects of its table; `None` if no settings
/// have it.
pub(crate) fn scene<'a>(settings: &'a [Settings], record: &Record) -> Option<Cow<'a, Scene>> {
    let State { table, scene_key, .. } = &record.state;
    let scenes = settings.iter().map(|settings| &settings.scene);
    let mut laid = scenes.map(|scene| match table {
        Some(table) => Cow::Owned(scene.with_objects(&table.objects)),
        None => Cow::Borrowed(scene),
    });
    laid.find(|scene| scene.key() == *scene_key)
}

/// Translates a record; without its scene, names are those that the record has itself.
pub(crate) fn explain(scene: Option<&Scene>, record: &Record) -> PolicyRecord {
    let state = &record.state;
    let names = Names { scene, open: state.open.as_ref() };
    let open = state.open.as_ref();
    let mut belief = open.map_or_else(Vec::new, |open| open.belief().probabilities());
    let count = match scene {
        Some(scene) => scene.objects().len(),
        None => belief.len(),
    };
    let absent = belief.split_off(count.min(belief.len())).into_iter().next().unwrap_or(0.0);
    let belief = belief.into_iter().enumerate();
    PolicyRecord {
        cause: cause(&names, &record.cause),
        applied: state.applied.0,
        interaction: open.map_or(0, |open| open.id.0),
        opened_ns: open.map(|open| open.opened.ns()),
        questions: open.map_or(0, |open| open.questions),
        belief: Named(belief.map(|(i, p)| (names.object(i.into()), p)).collect()),
        objects: scene.filter(|_| open.is_some()).map_or_else(Named::default, descriptions),
        absent,
        user: user(state),
        decision: decision(&names, &state.act),
        attributed: state.attributed.clone(),
        deferred_since_ns: open
            .and_then(|open| open.deferred.as_ref())
            .map(|deferred| deferred.since.ns()),
        queue: state.queue.iter().map(|words| words.join(" ")).collect(),
        ended: state.ended.as_ref().map(ended),
        refusable: state
            .handed_over
            .as_ref()
            .and_then(|handed_over| handed_over.object())
            .map(|object| names.object(object)),
        putting_back: state.putting_back.as_ref().map(|back| names.object(back.object)),
        stopped: state.stop.motion.is_latched(),
    }
}

/// Names for the numbers in a record.
struct Names<'a> {
    scene: Option<&'a Scene>,
    open: Option<&'a Interaction>,
}

impl Names<'_> {
    fn object(&self, object: ObjectId) -> String {
        let in_scene = self.scene.and_then(|scene| scene.objects().get(object.index()));
        let known = || self.open?.objects.get(object.index()).map(|known| known.name.clone());
        let numbered = || format!("object {}", object.0);
        in_scene.map(|object| object.name.clone()).or_else(known).unwrap_or_else(numbered)
    }

    fn words(&self, words: &[WordId]) -> Vec<String> {
        let Some(scene) = self.scene else { return Vec::new() };
        let word = |word: &WordId| scene.words().get(word.index()).cloned();
        words.iter().filter_map(word).collect()
    }
}

fn descriptions(scene: &Scene) -> Named<String> {
    let objects = scene.objects();
    let described = objects.iter().enumerate().take_while(|_| objects.len() <= DESCRIBED_MAX);
    Named(described.map(|(i, object)| (object.name.clone(), scene.describe(i.into()))).collect())
}

fn user(state: &State) -> Option<UserRecord> {
    let open = state.open.as_ref().and_then(|open| open.posterior.person());
    let params = open.or(state.users.person.as_ref())?.params(vocabulary::Params::default());
    Some(UserRecord { p_l: params.p_l, epsilon: params.epsilon })
}

fn cause(names: &Names<'_>, cause: &Cause) -> PolicyCause {
    match cause {
        Cause::Snapshot => PolicyCause::Snapshot,
        Cause::Utterance(heard) => PolicyCause::Utterance {
            utterance: heard.seq.0,
            typed: heard.typed,
            from: Some(heard.from.to_string()).filter(|from| !from.is_empty()),
            onset_ns: heard.onset.ns(),
            end_ns: heard.end.ns(),
            accepted_ns: heard.accepted.ns(),
            gesture_m: heard.gesture,
            more: heard.more,
            unknown: heard.unknown.as_ref().map(|unknown| unknown.text.clone()),
            interpretations: heard
                .interpretations
                .iter()
                .map(|one| interpretation(names, &heard.presentations, one))
                .collect(),
        },
        Cause::Silence => PolicyCause::Silence,
        Cause::Quiet => PolicyCause::Quiet,
        Cause::PickEnded { pick, outcome } => PolicyCause::PickEnded {
            interaction: pick.interaction.0,
            attempt: pick.attempt,
            outcome: *outcome,
        },
        Cause::Reconfigured => PolicyCause::Reconfigured,
        Cause::Objects(table) => PolicyCause::Objects {
            version: table.version,
            objects: table.objects.iter().map(|object| object.name.clone()).collect(),
        },
        Cause::MotionStop(MotionStop::Released) => PolicyCause::Released,
        Cause::MotionStop(MotionStop::Stopping) => PolicyCause::Stopping,
        Cause::MotionStop(MotionStop::Stopped) => PolicyCause::Stopped,
        Cause::StopReport { confirmed } => PolicyCause::StopReport { confirmed: *confirmed },
        Cause::SetAside(numbers_over) => PolicyCause::SetAside { numbers_over: *numbers_over },
        Cause::Forget(person) => PolicyCause::Forget { person: person.to_string() },
    }
}

fn interpretation(
    names: &Names<'_>,
    presentations: &[Presentation],
    one: &Interpretation,
) -> InterpretationRecord {
    let Interpretation { weight, answers, reading } = one;
    let is_known = |scene: &&Scene| {
        let groups = reading.excluded.iter().chain(&reading.further).flatten();
        reading.base.iter().chain(groups).all(|word| word.index() < scene.words().len())
    };
    let answers = answers.and_then(|at| presentations.get(at));
    InterpretationRecord {
        weight: *weight,
        answers: answers
            .map(|put| PresentationKey { prompt: put.prompt.0, presentation: put.number }),
        text: names.scene.filter(is_known).map(|scene| reading.text(scene)).unwrap_or_default(),
        base: names.words(&reading.base),
        response: reading.response,
        intent: reading.intent,
        excluded: reading.excluded.iter().map(|group| names.words(group)).collect(),
    }
}

fn decision(names: &Names<'_>, act: &Act) -> DecisionRecord {
    let scene = names.scene;
    let alternative = |(action, value): &(Action, f64)| {
        let action = ActionView::new(scene?, *action);
        Some(AlternativeRecord { action, value_s: *value })
    };
    DecisionRecord {
        act: act.id.0,
        kind: act.kind,
        prompt: act.prompt.0,
        presentation: act.presentation,
        text: scene.map(|scene| rendering::text(scene, act)).unwrap_or_default(),
        question: scene.and_then(|scene| QuestionView::new(scene, act.question)),
        pick: act.pick.map(|(pick, object)| PickKey {
            interaction: pick.interaction.0,
            attempt: pick.attempt,
            object: names.object(object),
        }),
        utterance: act.utterance.0,
        decided_ns: act.decided.ns(),
        value_s: act.value,
        bounds_s: act.bounds.map(|(low, high)| [low, high]),
        alternatives: act.alternatives.iter().filter_map(alternative).collect(),
        expected_questions: act.expected_questions,
    }
}

fn ended(ended: &Ended) -> EndedRecord {
    EndedRecord {
        interaction: ended.interaction.0,
        object: ended.name.clone(),
        outcome: ended.outcome,
        questions: ended.questions,
        duration_s: ended.seconds,
    }
}
