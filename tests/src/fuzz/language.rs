//! Texts to readings, with any confidences, about several scenes and after any question.

use std::sync::LazyLock;

use language::{READINGS_MAX, Reader};

use messages::{ASKED_MAX, Interpretation, WireReading};
use scene::{AttributeId, ObjectId, Question, Reading, Scene, ValueId};
use vocabulary::Language;

use super::bytes::{Input, chosen, project_file};

const SCENES: [&str; 4] = [
    "config/scenes/bowls.toml",
    "config/scenes/tools.toml",
    "tests/fixtures/utterances/garments.toml",
    "tests/fixtures/utterances/pantry.toml",
];

static READERS: LazyLock<[(Scene, [Reader; 2]); 4]> = LazyLock::new(|| {
    SCENES.map(|path| {
        let text = String::from_utf8(project_file(path)).expect("a scene is text");
        let scene = Scene::from_toml(path, &text).expect("a scene of the project");
        let languages = [Language::Careful, Language::Paper];
        let readers = languages.map(|language| Reader::new(&scene, language));
        (scene, readers)
    })
});

pub(super) fn run(input: &[u8]) {
    let mut input = Input(input);
    let (scene, [careful, paper]) = &READERS[usize::from(input.byte()) % SCENES.len()];
    let question = question(scene, &mut input);
    let count = usize::from(input.byte() % 12);
    let confidence: Vec<f32> = (0..count).map(|_| f32::from_le_bytes(input.array())).collect();
    let text = String::from_utf8_lossy(input.0);
    let spotted = paper.readings(&text, &confidence, question);
    assert!(spotted.len() == 1 && spotted[0].1 == paper.read(&text, question));
    let readings = careful.readings(&text, &confidence, question);
    assert!((1..=READINGS_MAX).contains(&readings.len()));
    let total: f64 = readings.iter().map(|(weight, _)| weight).sum();
    assert!((total - 1.0).abs() < 1e-9, "the weights sum to {total}");
    let (best, certain) = (&readings[0].1, careful.read(&text, question));
    assert!(best.says_the_same(&certain), "{best:?}, {certain:?}");
    readings.into_iter().chain(spotted).for_each(|reading| travels(reading, scene));
    let unknown = careful.unknown_words(&text, Question::None);
    assert!(unknown.iter().all(|word| !word.text.is_empty()), "{unknown:?}");
}

/// Checks that a reading is about the scene and that the policy would accept it.
fn travels((weight, reading): (f64, Reading), scene: &Scene) {
    let words = reading.base.iter().chain(reading.excluded.iter().flatten());
    words.for_each(|word| assert!(word.index() < scene.words().len()));
    let doubts = reading.doubt.base.iter().chain(&reading.doubt.excluded);
    for doubt in doubts.chain([&reading.doubt.response]) {
        assert!((0.0..=1.0).contains(doubt), "{:?}", reading.doubt);
    }
    let (wire, _) = WireReading::new(&Interpretation { weight, answers: Some(1), reading });
    let accepted = wire.interpretation(scene.words().len(), ASKED_MAX);
    accepted.unwrap_or_else(|error| panic!("refused: {error}"));
}

/// A question of the scene.
fn question(scene: &Scene, input: &mut Input<'_>) -> Question {
    let [kind, a, b] = input.array().map(usize::from);
    let k = a % scene.attributes().len();
    let attribute = AttributeId(k as u16);
    match kind % 4 {
        0 => Question::None,
        1 => Question::Point(ObjectId((a % scene.objects().len()) as u16)),
        2 => {
            Question::Attribute(attribute, ValueId((b % scene.attributes()[k].values.len()) as u16))
        }
        _ => Question::Which(attribute),
    }
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let public = String::from_utf8(project_file("tests/fixtures/utterances/public.jsonl"));
    let public = public.expect("a fixture is text");
    let seed = |line: &str| {
        let json: serde_json::Value = serde_json::from_str(line).expect("a fixture is JSON");
        let scene = u8::from(json["scene"] == "tools");
        let text = json["text"].as_str().unwrap_or_default();
        chosen(scene, [&[2, 1, 0, 0], text.as_bytes()].concat())
    };
    let mut seeds: Vec<_> = public.lines().map(seed).collect();
    let confident =
        [&[3, 0, 1, 2][..], &0.5_f32.to_le_bytes(), &1.0_f32.to_le_bytes(), b"no not that one"];
    seeds.push(chosen(0, confident.concat()));
    seeds
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;

    #[test]
    fn reader_time_is_linear_in_the_length() {
        let (_, [reader, _]) = &READERS[0];
        let pieces = [
            "white ",
            "not the white one or ",
            "no ",
            "counter foo ",
            "a",
            "dish ",
            "yes and ",
            "my shirt is white ",
            "the red uh ",
            "mmm",
            "but not ",
            "\u{301}",
            "whiteone",
            "x-",
        ];
        for piece in pieces {
            // The quickest of a few runs: other work on the machine only ever adds.
            let seconds = |chars: usize| {
                let text: String = piece.chars().cycle().take(chars).collect();
                let run = || {
                    let start = Instant::now();
                    reader.read(&text, Question::None);
                    start.elapsed().as_secs_f64()
                };
                (0..5).map(|_| run()).fold(f64::INFINITY, f64::min)
            };
            // 64 times the text: a quadratic reader takes 4,096 times as long, and between the two
            // there is room for a busy machine.
            let growth = seconds(16_000) / seconds(250);
            assert!(growth < 1_000.0, "{piece:?} grows {growth:.0} times");
        }
    }
}
