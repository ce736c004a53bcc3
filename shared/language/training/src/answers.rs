//! Labelled answers to a question of yes or no: `scene | question | meaning | words`.
//!
//! The question is in words (`Is it white?`), or points to an object (`This one? @red_mug`); the meaning is `yes`, `no`,
//! `unsure`, `any` or `none`.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

use language::{ANSWER_ROWS, ANSWERS, AnswerJudge};
use scene::{AttributeId, ObjectId, Question, Response, Role, Scene, ValueId};
use vocabulary::Rng;

use crate::line::Line;
use crate::linear::{Lesson, Linear};
use crate::scenes::{Scenes, files, question};
use crate::slips::with_typo;
use crate::sources::{TABLES, read};
use crate::table::{Row, table};

/// Passes over the lessons, and the rate of the first step of a weight.
const EPOCHS: usize = 5;
const RATE: f64 = 0.01;
/// Factor of the sums, chosen by the scores of authors who were not seen.
const SHARE: f64 = 0.7;
/// How much a lesson with a slip counts.
const SLIP: f64 = 0.5;
/// Least probability of a certain statement.
const CERTAIN: f64 = 0.9;
/// Name of the reader's own tables among the sources.
const OWN: &str = "own tables";
/// The same of the values, said plainly.
const VALUES: &str = "values";

/// A labelled answer.
#[derive(Clone, Debug)]
pub struct Answer {
    /// Name of its scene.
    pub scene: String,
    /// What it answers.
    pub asked: Question,
    /// The words.
    pub text: String,
    /// The number of its meaning among [`ANSWERS`].
    pub meaning: usize,
}

/// Answers by author.
pub type Answers = BTreeMap<String, Vec<Answer>>;

/// Reads all answers that are trained on.
///
/// # Errors
/// A file that cannot be read, or has a wrong line.
pub fn answers(scenes: &Scenes) -> Result<Answers, String> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all = Answers::new();
    for path in files(&here.join("answers")) {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        all.insert(name, answers_of(scenes, &path)?);
    }
    for file in TABLES {
        let rows = table(scenes, &here.join("../../..").join(file))?;
        all.entry(OWN.into())
            .or_default()
            .extend(rows.into_iter().filter_map(|row| of_row(scenes, row)));
    }
    all.insert(VALUES.into(), scenes.names().flat_map(|name| by_value(scenes, name)).collect());
    Ok(all)
}

/// Each value, in the robot's own words, as an answer to the question about it and to that about its neighbour.
fn by_value(scenes: &Scenes, name: &str) -> Vec<Answer> {
    let Ok((scene, _)) = scenes.get(name) else { return Vec::new() };
    let mut answers = Vec::new();
    for (k, attribute) in scene.attributes().iter().enumerate() {
        for (v, value) in attribute.values.iter().enumerate() {
            for (response, yes_or_no) in [(Response::Yes, "yes"), (Response::No, "no")] {
                let about = (v + usize::from(response == Response::No)) % attribute.values.len();
                if about == v && response == Response::No {
                    continue;
                }
                let asked = Question::Attribute(AttributeId::from(k), ValueId::from(about));
                let said = &value.spoken;
                let noun = scene.noun();
                let named = match value.role() {
                    Role::Quality => {
                        [format!("the {said} one"), format!("get me the {said} {noun}")]
                    }
                    Role::Kind => [format!("{said}, please"), format!("get me {said}")],
                    Role::Place | Role::Part => {
                        let after = value.after_noun();
                        [format!("the one {after}"), format!("get me the {noun} {after}")]
                    }
                };
                let texts = [
                    said.clone(),
                    format!("it is {said}"),
                    format!("it's {said}"),
                    format!("{yes_or_no}, it is {said}"),
                    format!("the one that is {said}"),
                    format!("it should be {said}"),
                    format!("hmm, {said} I think"),
                ];
                let texts = texts.into_iter().chain(named);
                let (scene, meaning) = (name.to_owned(), number(response));
                answers.extend(texts.map(|text| Answer {
                    scene: scene.clone(),
                    asked,
                    text,
                    meaning,
                }));
            }
        }
    }
    answers
}

/// Reads the answers of a file.
///
/// # Errors
/// The file cannot be read, or has a wrong line.
pub fn answers_of(scenes: &Scenes, path: &Path) -> Result<Vec<Answer>, String> {
    let is_line = |(_, line): &(usize, &str)| !line.is_empty() && !line.starts_with('#');
    let answer = |(n, line)| {
        answer(scenes, line).map_err(|why| format!("{}:{}: {why}", path.display(), n + 1))
    };
    read(path)?.lines().map(str::trim).enumerate().filter(is_line).map(answer).collect()
}

fn answer(scenes: &Scenes, line: &str) -> Result<Answer, String> {
    let fields: Vec<&str> = line.splitn(4, " | ").collect();
    let [scene, question, meaning, text] = fields[..] else {
        return Err(format!("expected 4 fields, found {}", fields.len()));
    };
    let response = match meaning {
        "yes" => Response::Yes,
        "no" => Response::No,
        "unsure" => Response::CannotTell,
        "any" => Response::DoesNotMatter,
        "none" => Response::None,
        other => return Err(format!("expected yes, no, unsure, any or none, found {other}")),
    };
    let asked = asked(&scenes.get(scene)?.0, question)?;
    let (scene, text) = (scene.to_owned(), text.to_owned());
    Ok(Answer { scene, asked, text, meaning: number(response) })
}

fn number(response: Response) -> usize {
    ANSWERS.iter().position(|it| *it == response).unwrap_or(0)
}

fn asked(scene: &Scene, words: &str) -> Result<Question, String> {
    let Some((_, name)) = words.split_once('@') else {
        return match question(scene, words) {
            asked @ Question::Attribute(..) => Ok(asked),
            _ => Err(format!("expected a question with a value of the scene, found {words}")),
        };
    };
    let at = scene.objects().iter().position(|object| object.name == name);
    at.map(|at| Question::Point(ObjectId::from(at))).ok_or_else(|| format!("no object {name}"))
}

/// What is neither yes nor no in a table is no answer, unless the rules know it as another one. A "maybe" may be
/// either.
fn of_row(scenes: &Scenes, row: Row) -> Option<Answer> {
    let Row { scene, question: asked, text, response, kind, .. } = row;
    (kind != "hedge" || response.is_some()).then_some(())?;
    let (_, proposed) = scenes.get(&scene).ok()?.1.answer_features(&text, asked)?;
    let other = match proposed {
        Response::Yes | Response::No => Response::None,
        other => other,
    };
    let response = response.unwrap_or(other);
    Some(Answer { scene, asked, text, meaning: number(response) })
}

/// Trains on the answers, each with a slip of the finger besides.
///
/// # Errors
/// A scene that does not exist.
pub fn train_answers<'a>(
    scenes: &Scenes,
    answers: impl Iterator<Item = &'a Answer>,
    hash: u64,
) -> Result<Vec<u8>, String> {
    let (mut lessons, mut random) = (Vec::new(), Rng::new(1));
    for answer in answers {
        let reader = &scenes.get(&answer.scene)?.1;
        let slip = with_typo(&Line { text: answer.text.clone(), ..Line::default() }, &mut random);
        let said = [(Some(answer.text.clone()), 1.0), (slip.map(|slip| slip.text), SLIP)];
        for (text, weight) in said {
            let judged = text.and_then(|text| reader.answer_features(&text, answer.asked));
            lessons.extend(judged.map(|(rows, _)| Lesson { rows, label: answer.meaning, weight }));
        }
    }
    let linear: Linear<{ ANSWERS.len() }> = Linear::train(&lessons, ANSWER_ROWS, EPOCHS, RATE, 1);
    let weights = || (0..ANSWER_ROWS).flat_map(|row| linear.row(row));
    let step = weights().fold(1e-9, |most: f64, it| most.max(it.abs())) / f64::from(i8::MAX);
    let mut bytes = hash.to_le_bytes().to_vec();
    bytes.extend(((step * SHARE) as f32).to_le_bytes());
    bytes.extend(weights().map(|weight| (weight / step).round() as i8 as u8));
    Ok(bytes)
}

/// How answers were read.
#[derive(Clone, Debug, Default)]
pub struct AnswerScore {
    /// Probabilities of all answers as the policy gets them, with the number of the meaning.
    read: Vec<([f64; ANSWERS.len()], usize)>,
}

impl AnswerScore {
    /// Reads an answer; returns the probability of its meaning.
    ///
    /// # Errors
    /// A scene that does not exist.
    pub fn add(&mut self, scenes: &Scenes, answer: &Answer) -> Result<f64, String> {
        let reader = &scenes.get(&answer.scene)?.1;
        let mut stated = [0.0; ANSWERS.len()];
        for (weight, reading) in reader.readings(&answer.text, &[], answer.asked) {
            let doubt = reading.doubt.response;
            stated[number(reading.response)] += weight * (1.0 - doubt);
            stated[number(Response::None)] += weight * doubt;
        }
        self.read.push((stated, answer.meaning));
        Ok(stated[answer.meaning])
    }

    /// Adds another score.
    pub fn extend(&mut self, other: Self) {
        self.read.extend(other.read);
    }

    fn share(&self, holds: impl Fn(usize, f64, usize) -> bool) -> f64 {
        let best =
            |stated: &[f64]| (0..stated.len()).max_by(|a, b| stated[*a].total_cmp(&stated[*b]));
        let holds = |(stated, meaning): &&([f64; ANSWERS.len()], usize)| {
            best(stated).is_some_and(|best| holds(best, stated[best], *meaning))
        };
        self.read.iter().filter(holds).count() as f64 / self.read.len().max(1) as f64
    }
}

impl fmt::Display for AnswerScore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let loss =
            |(stated, meaning): &([f64; ANSWERS.len()], usize)| -stated[*meaning].max(1e-3).ln();
        write!(
            f,
            "{:5} answers  right {:.3}  certain {:.3}  certain and wrong {:.3}  yes or no certain and wrong {:.3}  log loss {:.3}",
            self.read.len(),
            self.share(|best, _, meaning| best == meaning),
            self.share(|_, stated, _| stated >= CERTAIN),
            self.share(|best, stated, meaning| best != meaning && stated >= CERTAIN),
            self.share(|best, stated, meaning| best != meaning && best < 2 && stated >= CERTAIN),
            self.read.iter().map(loss).sum::<f64>() / self.read.len().max(1) as f64,
        )
    }
}

/// Returns how an author's answers are read after training without them.
///
/// # Errors
/// A scene that does not exist.
pub fn answers_without(
    scenes: &Scenes,
    all: &Answers,
    author: &str,
) -> Result<AnswerScore, String> {
    let others = all.iter().filter(|(name, _)| *name != author).flat_map(|(_, answers)| answers);
    let bytes = train_answers(scenes, others, 0)?;
    let judge = AnswerJudge::from_bytes(&bytes).ok_or("expected all weights")?;
    let scenes = scenes.with_answer_judge(&Arc::new(judge));
    let mut score = AnswerScore::default();
    for answer in &all[author] {
        score.add(&scenes, answer)?;
    }
    Ok(score)
}
