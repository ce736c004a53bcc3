//! What an utterance was understood to say, in words.

use messages::{AskedQuestion, Interpretation, Observation};
use scene::{Intent, Question, Reading, Response, Scene};

use super::line::Meaning;
use super::prompts::Prompts;

/// Ways to understand an utterance that are shown.
const SHOWN_MAX: usize = 4;
/// Less likely ones are not.
const WEIGHT_MIN: f64 = 0.01;

/// What is shown of an observation.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Understood {
    pub(super) meanings: Vec<Meaning>,
    pub(super) answers: Option<String>,
}

/// What was understood while `interaction` was open; none where it speaks of another scene or makes no sense.
pub(super) fn read(
    scene: &Scene,
    observation: &Observation,
    prompts: &Prompts,
    interaction: u64,
) -> Option<Understood> {
    if observation.scene_key != scene.key() {
        return None;
    }
    let all = observation.interpretations(scene.words().len()).ok()?;
    let asked = observation.asked().ok()?;
    // What was asked in another interaction is answered no more.
    let stands = |asked: &AskedQuestion| {
        let prompt = prompts.find(asked.prompt, asked.presentation);
        prompt.is_none_or(|prompt| prompt.interaction == interaction)
    };
    let answered = answered(&all, asked, observation.onset_ns);
    let answered = answered.filter(|at| asked.get(*at).is_some_and(stands));
    let mut meant: Vec<&Interpretation> = all
        .iter()
        .filter(|meant| meant.answers == answered && meant.weight >= WEIGHT_MIN)
        .collect();
    meant.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    let meanings = meant.iter().take(SHOWN_MAX).map(|meant| Meaning {
        text: words(scene, &meant.reading),
        weight: (meant.weight * 1e3).round() / 1e3,
    });
    let question = answered.and_then(|at| asked.get(at));
    let answers = question.and_then(|asked| question_text(scene, asked, prompts));
    Some(Understood { meanings: meanings.collect(), answers })
}

/// The latest question whose sound had begun before the utterance, if the utterance means something
/// else as an answer to it than as no answer: it says yes or no, or says it with other words.
fn answered(all: &[Interpretation], asked: &[AskedQuestion], onset_ns: u64) -> Option<usize> {
    let latest = asked.iter().position(|asked| asked.began_ns <= onset_ns)?;
    let best = |question: Option<usize>| {
        let meant = all.iter().filter(|meant| meant.answers == question);
        meant.max_by(|a, b| a.weight.total_cmp(&b.weight)).map(|meant| &meant.reading)
    };
    let reading = best(Some(latest))?;
    let informs = reading.intent == Intent::Inform;
    let says = reading.response != Response::None || best(None).is_some_and(|none| none != reading);
    (informs && says).then_some(latest)
}

fn question_text(scene: &Scene, asked: &AskedQuestion, prompts: &Prompts) -> Option<String> {
    if let Some(prompt) = prompts.find(asked.prompt, asked.presentation) {
        return Some(prompt.text.clone());
    }
    let question = Question::try_from(asked.question).ok()?;
    let ours = asked.scene == scene.key() && scene.contains(question);
    ours.then(|| scene.phrase(question))
}

/// A reading in words.
fn words(scene: &Scene, reading: &Reading) -> String {
    let word = |id: &scene::WordId| scene.words().get(id.index()).map_or("?", String::as_str);
    let mut parts: Vec<String> = Vec::new();
    match reading.intent {
        Intent::Inform => {}
        Intent::None => return "nothing for me".to_owned(),
        Intent::Stop => parts.push("stop".to_owned()),
        Intent::Cancel => parts.push("never mind".to_owned()),
        Intent::Repeat => parts.push("say that again".to_owned()),
        Intent::StartOver => parts.push("start over".to_owned()),
        Intent::AskBack => parts.push("a question to me".to_owned()),
    }
    match reading.response {
        Response::Yes => parts.push("yes".to_owned()),
        Response::No => parts.push("no".to_owned()),
        Response::None => {}
    }
    parts.extend(reading.base.iter().map(|id| word(id).to_owned()));
    parts.extend(reading.excluded.iter().map(|group| {
        let group: Vec<&str> = group.iter().map(word).collect();
        format!("not {}", group.join(" and "))
    }));
    if parts.is_empty() { "a request".to_owned() } else { parts.join(" · ") }
}
