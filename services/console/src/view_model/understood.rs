//! The meaning of an utterance in words, weighted by the policy's attribution.

use dialogue::Attributed;
use messages::{Observation, UtteranceSeq};
use scene::{Intent, Reading, Reference, Response, Scene};

use super::line::{Answered, Meaning};
use super::prompts::Prompts;

/// Most meanings and questions that are shown.
const SHOWN_MAX: usize = 4;
/// Less probable ones are not shown.
const WEIGHT_MIN: f64 = 0.01;

/// The readings of an utterance before its attribution is known.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Readings {
    pub(super) seq: UtteranceSeq,
    readings: Vec<WeightedReading>,
}

#[derive(Clone, Debug, PartialEq)]
struct WeightedReading {
    text: String,
    /// Probability among the readings that answer the same question.
    weight: f64,
    /// Prompt and presentation of that question.
    answers: Option<(u64, u32)>,
}

/// The displayed view of an utterance.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Understood {
    pub(super) meanings: Vec<Meaning>,
    pub(super) answers: Vec<Answered>,
}

/// Reads an observation; none if it is of another scene or invalid.
pub(super) fn read(scene: &Scene, observation: &Observation) -> Option<Readings> {
    if observation.scene_key != scene.key() {
        return None;
    }
    let interpretations = observation.interpretations(scene.words().len()).ok()?;
    let asked = observation.asked().ok()?;
    let readings = interpretations.iter().map(|interpretation| WeightedReading {
        text: words(scene, &interpretation.reading),
        weight: interpretation.weight,
        answers: (interpretation.answers)
            .and_then(|at| asked.get(at))
            .map(|asked| (asked.prompt, asked.presentation)),
    });
    let seq = UtteranceSeq(observation.seq);
    Some(Readings { seq, readings: readings.collect() })
}

impl Readings {
    /// Weights the readings by the shares of the questions that they answer, as the belief does.
    pub(super) fn attribute(&self, attributed: &Attributed, prompts: &Prompts) -> Understood {
        let share = |answers: Option<(u64, u32)>| match answers {
            None => attributed.none,
            Some(key) => (attributed.questions.iter())
                .find(|question| (question.prompt.0, question.presentation) == key)
                .map_or(0.0, |question| question.share),
        };
        let mut meanings: Vec<Meaning> = Vec::new();
        for reading in &self.readings {
            let weight = reading.weight * share(reading.answers);
            match meanings.iter_mut().find(|known| known.text == reading.text) {
                Some(known) => known.weight += weight,
                None => meanings.push(Meaning { text: reading.text.clone(), weight }),
            }
        }
        meanings.sort_by(|a, b| b.weight.total_cmp(&a.weight));
        meanings.retain(|meaning| meaning.weight >= WEIGHT_MIN);
        meanings.truncate(SHOWN_MAX);
        meanings.iter_mut().for_each(|meaning| meaning.weight = rounded(meaning.weight));
        let mut shares = attributed.questions.clone();
        shares.sort_by(|a, b| b.share.total_cmp(&a.share));
        let answers = shares.iter().filter(|question| question.share >= WEIGHT_MIN);
        let answers = answers.filter_map(|question| {
            let prompt = prompts.find(question.prompt.0, question.presentation)?;
            Some(Answered { question: prompt.text.clone(), share: rounded(question.share) })
        });
        Understood { meanings, answers: answers.take(SHOWN_MAX).collect() }
    }
}

fn rounded(weight: f64) -> f64 {
    (weight * 1e3).round() / 1e3
}

fn words(scene: &Scene, reading: &Reading) -> String {
    let word = |id: &scene::WordId| scene.words().get(id.index()).map_or("?", String::as_str);
    let intent = match reading.intent {
        Intent::Inform => None,
        Intent::None => return "nothing for me".to_owned(),
        Intent::Stop => Some("stop"),
        Intent::Cancel => Some("never mind"),
        Intent::Repeat => Some("say that again"),
        Intent::StartOver => Some("start over"),
        Intent::AskBack
        | Intent::AskCount
        | Intent::AskWhich
        | Intent::AskWhether
        | Intent::AskWhere
        | Intent::AskWhy
        | Intent::AskStatus
        | Intent::AskHelp => Some("a question to me"),
        Intent::Greet => Some("a greeting"),
        Intent::Leave => Some("a farewell"),
        Intent::Thank => Some("thanks"),
        Intent::PutBack => Some("put it back"),
    };
    let response = match reading.response {
        Response::Yes => Some("yes"),
        Response::No => Some("no"),
        Response::CannotTell => Some("cannot tell"),
        Response::DoesNotMatter => Some("does not matter"),
        Response::None => None,
    };
    let refers = match reading.refers {
        Reference::None => None,
        Reference::Other => Some("the other one"),
        Reference::Same => Some("the same one"),
        Reference::Smaller => Some("the smaller one"),
        Reference::Larger => Some("the bigger one"),
        Reference::Smallest => Some("the smallest one"),
        Reference::Largest => Some("the biggest one"),
        Reference::Any => Some("any one"),
    };
    let given = [intent, response, refers].into_iter().flatten();
    let mut parts: Vec<String> = given.map(str::to_owned).collect();
    parts.extend(reading.base.iter().map(|id| word(id).to_owned()));
    parts.extend(reading.excluded.iter().map(|group| {
        let group: Vec<&str> = group.iter().map(word).collect();
        format!("not {}", group.join(" and "))
    }));
    parts.extend(reading.further.iter().map(|group| {
        let group: Vec<&str> = group.iter().map(word).collect();
        format!("then {}", group.join(" "))
    }));
    if parts.is_empty() { "a request".to_owned() } else { parts.join(" · ") }
}
