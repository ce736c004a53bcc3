//! Feeds unlikely text to the reader and compares its reading time with that of plausible text.
//!
//! ```sh
//! cargo run --release -p language --example fuzz [N] [SEED]
//! ```
//!
//! A panic ends it, with the input. So does a reading that breaks a promise of
//! [`Reader::readings`].
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program for the terminal")]

use std::hint::black_box;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use language::{Language, READINGS_MAX, Reader};
use scene::{AttributeId, ObjectId, Question, Scene, ValueId};

const SCENES: [(&str, &str); 4] = [
    ("bowls", include_str!("../../../config/scenes/bowls.toml")),
    ("tools", include_str!("../../../config/scenes/tools.toml")),
    ("garments", include_str!("../../../tests/fixtures/utterances/garments.toml")),
    ("pantry", include_str!("../../../tests/fixtures/utterances/pantry.toml")),
];
const TABLES: [&str; 3] = [
    include_str!("../src/tests/cases.txt"),
    include_str!("../../../tests/fixtures/utterances/fresh_1.txt"),
    include_str!("../../../tests/fixtures/utterances/fresh_2.txt"),
];
const QUESTIONS: [Question; 4] = [
    Question::None,
    Question::Point(ObjectId(3)),
    Question::Attribute(AttributeId(0), ValueId(1)),
    Question::Which(AttributeId(1)),
];
/// Letters of the longest inputs.
const LONG: usize = 10_000;

/// The 64-bit generator of Steele, Lea and Flood 2014 ("SplitMix").
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound.max(1) as u64) as usize
    }

    fn of<'a, T: ?Sized>(&mut self, list: &[&'a T]) -> &'a T {
        list[self.below(list.len())]
    }
}

/// The corpus: the sentences of the tables, and every word in them.
struct Corpus {
    sentences: Vec<&'static str>,
    words: Vec<&'static str>,
}

impl Corpus {
    fn new() -> Self {
        let lines = TABLES.into_iter().flat_map(str::lines).filter(|line| line.contains("=>"));
        let text = |line: &'static str| {
            let (input, _) = line.rsplit_once("=>")?;
            Some(input.split_once(':')?.1.trim())
        };
        let sentences: Vec<&str> = lines.filter_map(text).collect();
        let words = sentences.iter().flat_map(|sentence| sentence.split_whitespace()).collect();
        Self { sentences, words }
    }

    fn salad(&self, random: &mut Random, words: usize) -> String {
        let words: Vec<&str> = (0..words).map(|_| random.of(&self.words)).collect();
        words.join(" ")
    }
}

const KINDS: [&str; 5] = ["random bytes", "random characters", "mutations", "salads", "long"];

fn input(kind: usize, corpus: &Corpus, random: &mut Random) -> String {
    match kind {
        0 => bytes(random, 64),
        1 => (0..random.below(48))
            .filter_map(|_| char::from_u32(random.next() as u32 % 0x11_0000))
            .collect(),
        2 => mutated(corpus, random),
        3 => {
            let words = random.below(24);
            corpus.salad(random, words)
        }
        _ => long(corpus, random),
    }
}

fn bytes(random: &mut Random, at_most: usize) -> String {
    let bytes: Vec<u8> = (0..random.below(at_most)).map(|_| random.next() as u8).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// A sentence with some letters changed, lost, doubled, or parts of another one put in.
fn mutated(corpus: &Corpus, random: &mut Random) -> String {
    let mut letters: Vec<char> = random.of(&corpus.sentences).chars().collect();
    for _ in 0..=random.below(4) {
        let at = random.below(letters.len() + 1);
        match random.below(5) {
            0 => letters.insert(at, char::from(32 + random.below(95) as u8)),
            1 if at < letters.len() => drop(letters.remove(at)),
            2 if at + 1 < letters.len() => letters.swap(at, at + 1),
            3 => {
                let other: Vec<char> = random.of(&corpus.sentences).chars().collect();
                let from = random.below(other.len());
                letters.splice(at..at, other[from..].iter().copied());
            }
            _ => letters.truncate(at),
        }
    }
    letters.into_iter().collect()
}

/// One piece again and again, or a very long salad.
fn long(corpus: &Corpus, random: &mut Random) -> String {
    let piece = match random.below(4) {
        0 => return corpus.salad(random, LONG / 5).chars().take(LONG).collect(),
        1 => bytes(random, 12),
        2 => format!("{} ", random.of(&corpus.words)),
        _ => format!("{} {} ", random.of(&corpus.words), random.of(&corpus.words)),
    };
    piece.chars().cycle().take(LONG).collect()
}

/// Reads one input in every way and checks what comes out.
fn read(reader: &Reader, scene: &Scene, text: &str, random: &mut Random) -> Result<(), String> {
    let question = QUESTIONS[random.below(QUESTIONS.len())];
    let confidence: Vec<f32> =
        (0..random.below(12)).map(|_| random.below(300) as f32 / 255.0).collect();
    let understood = reader.read(text, question);
    let readings = reader.readings(text, &confidence, question);
    let known = |w: &scene::WordId| w.index() < scene.words().len();
    let total: f64 = readings.iter().map(|(weight, _)| weight).sum();
    let broken = if !(1..=READINGS_MAX).contains(&readings.len()) {
        "number of readings"
    } else if (total - 1.0).abs() > 1e-9 {
        "weights"
    } else if readings[0].1.base != understood.base
        || readings[0].1.response != understood.response
        || readings[0].1.excluded != understood.excluded
        || readings[0].1.intent != understood.intent
    {
        "the best reading is not what is read"
    } else if !readings.iter().all(|(_, reading)| {
        reading.base.iter().chain(reading.excluded.iter().flatten()).all(known)
            && reading.excluded.iter().all(|group| !group.is_empty())
    }) {
        "words that the scene does not have"
    } else {
        return Ok(());
    };
    Err(format!("{broken}: {text:?} after {question:?} with {confidence:?}"))
}

/// Median seconds of reading the tables' sentences, by `read` and by `readings`.
fn medians(readers: &[(Scene, Reader)], corpus: &Corpus) -> [Duration; 2] {
    let reader = &readers[0].1;
    let median = |mut times: Vec<Duration>| {
        times.sort_unstable();
        times.get(times.len() / 2).copied().unwrap_or_default()
    };
    let timed = |run: &dyn Fn(&str)| {
        let time = |text: &&str| {
            let start = Instant::now();
            run(text);
            start.elapsed()
        };
        median(corpus.sentences.iter().map(time).collect())
    };
    let confidence = [0.9; 12];
    [
        timed(&|text| drop(black_box(reader.read(text, QUESTIONS[2])))),
        timed(&|text| drop(black_box(reader.readings(text, &confidence, QUESTIONS[2])))),
    ]
}

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse::<u64>());
    let mut number = |default| arguments.next().unwrap_or(Ok(default));
    let (Ok(count), Ok(seed)) = (number(100_000), number(1)) else {
        eprintln!("usage: fuzz [N] [SEED], both whole numbers");
        return ExitCode::from(64);
    };
    let corpus = Corpus::new();
    let mut readers = Vec::new();
    for (name, text) in SCENES {
        match Scene::from_toml(name, text) {
            Ok(scene) => {
                let reader = Reader::new(&scene, Language::Careful);
                readers.push((scene, reader));
            }
            Err(problems) => {
                eprintln!("{name}: {problems:?}");
                return ExitCode::from(78);
            }
        }
    }
    println!("seed {seed}, {count} inputs");
    let mut random = Random(seed);
    let mut worst = [(0, Duration::ZERO, 0); KINDS.len()];
    for n in 0..count {
        // One long input in a hundred: they take as long as all the others.
        let kind = if n % 100 == 99 { 4 } else { random.below(4) };
        let text = input(kind, &corpus, &mut random);
        let (scene, reader) = &readers[random.below(readers.len())];
        let start = Instant::now();
        if let Err(broken) = read(reader, scene, &text, &mut random) {
            eprintln!("input {n}: {broken}");
            return ExitCode::FAILURE;
        }
        let time = start.elapsed();
        worst[kind].0 += 1;
        if time > worst[kind].1 {
            worst[kind] = (worst[kind].0, time, text.chars().count());
        }
    }
    for (kind, (count, time, length)) in KINDS.iter().zip(worst) {
        println!("{kind:18} {count:9} inputs, at most {time:?} ({length} characters), read twice");
    }
    let [read, readings] = medians(&readers, &corpus);
    let count = corpus.sentences.len();
    println!("{count} sentences, median: read {read:?}, readings {readings:?}");
    ExitCode::SUCCESS
}
