//! `whichone ground --calibrate`: the calibration of a language model by labelled utterances.

use std::collections::BTreeSet;
use std::path::Path;
use std::time::{Duration, Instant};

use command_line::Outcome;
use command_line::output::Output;
use language::Reader;
use model_reader::{Calibration, LanguageModel};
use model_reader::{Case, Client, fit, held_out_loss, log_loss, parse, utterance};
use scene::{Question, Reading, Scene, question_from_json, reading_to_json};
use serde::Deserialize;
use serde_json::{Value as Json, json};
use service::exit::{Exit, Failure};
use vocabulary::Language;

/// Reads labelled utterances with a model and with the built-in reader.
pub struct Calibrator {
    scene: Scene,
    reader: Reader,
    model: LanguageModel,
    client: Client,
}

/// A labelled utterance; other keys are not read.
#[derive(Deserialize)]
struct Line {
    #[serde(default)]
    id: Json,
    text: String,
    #[serde(default)]
    last_question: Json,
    /// The scene that the line is about; without one, any.
    scene: Option<String>,
    expect: Label,
    /// Other meanings that count as right.
    #[serde(default)]
    accept: Vec<Label>,
}

/// A meaning in the published form.
#[derive(Deserialize)]
struct Label {
    base: BTreeSet<String>,
    response: String,
    excluded: BTreeSet<BTreeSet<String>>,
    intent: String,
}

/// Result of reading the lines.
#[derive(Default)]
struct Found {
    /// Lines about other scenes.
    elsewhere: usize,
    cases: Vec<Case>,
    seconds: Vec<f64>,
    /// Lines that the model did not answer, or not in the agreed form: `id`, `error`.
    failures: Vec<Json>,
    /// Lines that the model misread: `id`, `text`, `read`.
    misread: Vec<Json>,
}

/// Fits the calibration to the lines of `file` and prints it.
///
/// # Errors
/// The file cannot be read; a line is not a labelled utterance of the scene; no line is about the
/// scene, or the model answers none.
pub fn calibrate(calibrator: &Calibrator, file: &Path, out: &mut Output<'_>) -> Outcome {
    let text = config::read_file(file).map_err(|error| Failure::file(file, &error))?;
    let mut found = Found::default();
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let bad = |what: String| {
            let place = format!("{}:{}", file.display(), number + 1);
            Failure::new(Exit::Config, format!("{place}: {what}; help: see docs/grounding.md"))
        };
        let line: Line = serde_json::from_str(line).map_err(|error| bad(error.to_string()))?;
        if line.scene.as_ref().is_some_and(|name| name != calibrator.scene.name()) {
            found.elsewhere += 1;
            continue;
        }
        let asked = question_from_json(&calibrator.scene, &line.last_question)
            .map_err(|error| bad(format!("last_question: {error}")))?;
        calibrator.read(&line, asked, &mut found);
    }
    if found.cases.is_empty() {
        let why = match found.failures.first() {
            Some(first) => format!("the model answered no line: {}", first["error"]),
            None => format!("no line is about the scene `{}`", calibrator.scene.name()),
        };
        return Err(Failure::new(Exit::NotReached, format!("{}: {why}", file.display())));
    }
    print(&found, calibrator.model.calibration, out)?;
    Ok(Exit::Ok)
}

impl Calibrator {
    /// Prepares for a scene.
    ///
    /// # Errors
    /// The model cannot be asked as it is configured.
    pub fn new(scene: Scene, model: LanguageModel) -> Result<Self, Failure> {
        let client = Client::new(&model, &scene)
            .map_err(|error| Failure::new(Exit::Config, error.to_string()))?;
        let reader = Reader::new(&scene, Language::Careful);
        Ok(Self { scene, reader, model, client })
    }

    fn read(&self, line: &Line, asked: Question, found: &mut Found) {
        let began = Instant::now();
        let model = match self.by_model(&line.text, asked, self.model.timeout) {
            Ok(readings) => readings,
            Err(error) => {
                found.failures.push(json!({ "id": line.id, "error": error }));
                return;
            }
        };
        found.seconds.push(began.elapsed().as_secs_f64());
        let built_in = self.reader.readings(&line.text, &[], asked);
        let best = model.iter().max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, best)) = best.filter(|(_, best)| !self.is_right(line, best)) {
            let read = reading_to_json(&self.scene, best);
            found.misread.push(json!({ "id": line.id, "text": line.text, "read": read }));
        }
        let judged = |readings: &[(f64, Reading)]| -> Vec<(f64, bool)> {
            readings.iter().map(|(weight, it)| (*weight, self.is_right(line, it))).collect()
        };
        found.cases.push(Case { model: judged(&model), built_in: judged(&built_in) });
    }

    /// The model's readings as an answer to the question.
    fn by_model(
        &self,
        text: &str,
        asked: Question,
        within: Duration,
    ) -> Result<Vec<(f64, Reading)>, String> {
        let asked: Vec<(usize, Question)> =
            Some((0, asked)).filter(|_| asked != Question::None).into_iter().collect();
        let content = self.client.ask(&utterance(&self.scene, &[(1.0, text)], &asked), within)?;
        let numbers: Vec<usize> = asked.iter().map(|it| it.0).collect();
        let readings = parse(&self.scene, &numbers, &content).map_err(|error| error.to_string())?;
        let place = numbers.first().copied();
        let own = readings.into_iter().filter(|reading| reading.question == place);
        let mut distinct: Vec<(f64, Reading)> = Vec::new();
        for own in own {
            match distinct.iter_mut().find(|(_, known)| *known == own.reading) {
                Some((weight, _)) => *weight += own.weight,
                None => distinct.push((own.weight, own.reading)),
            }
        }
        match distinct.is_empty() {
            true => Err("answer refused: no reading for the line's question".to_owned()),
            false => Ok(distinct),
        }
    }

    fn is_right(&self, line: &Line, reading: &Reading) -> bool {
        let read = reading_to_json(&self.scene, reading);
        let Ok(read) = serde_json::from_value::<Label>(read) else { return false };
        std::iter::once(&line.expect).chain(&line.accept).any(|label| {
            (&label.base, &label.excluded) == (&read.base, &read.excluded)
                && (&label.response, &label.intent) == (&read.response, &read.intent)
        })
    }
}

/// Prints the result: as text, or with `--json` as one object.
fn print(found: &Found, configured: Calibration, out: &mut Output<'_>) -> Result<(), Failure> {
    let cases = &found.cases;
    let fitted = fit(cases);
    let built_in = log_loss(cases, Calibration { power: 1.0, built_in: 1.0 });
    let (before, after) = (log_loss(cases, configured), log_loss(cases, fitted));
    let held_out = held_out_loss(cases);
    let mut seconds = found.seconds.clone();
    seconds.sort_by(f64::total_cmp);
    let median = seconds[seconds.len() / 2];
    let slowest = seconds.last().copied().unwrap_or_default();
    let right = cases.len() - found.misread.len();
    if out.is_json() {
        return out.json(&json!({
            "lines": cases.len(), "lines_elsewhere": found.elsewhere, "right": right,
            "log_loss": {
                "built_in": built_in, "before": before, "after": after, "held_out": held_out,
            },
            "calibration": { "power": fitted.power, "built_in": fitted.built_in },
            "seconds": { "median": median, "slowest": slowest },
            "failures": found.failures, "misread": found.misread,
        }));
    }
    let failures = found.failures.len();
    let elsewhere = found.elsewhere;
    out.line(format!(
        "lines       {} answered, {failures} not; {elsewhere} about other scenes",
        cases.len()
    ))?;
    if let Some(first) = found.failures.first() {
        out.line(format!("            {}: {}", first["id"], first["error"]))?;
    }
    out.line(format!("right       {right} of {} by the likeliest reading", cases.len()))?;
    out.line(format!("answers     median {median:.3} s, slowest {slowest:.3} s"))?;
    out.line(format!(
        "log loss    built-in reader {built_in:.4}, model as configured {before:.4}, calibrated {after:.4}; on \
         lines that it is not fitted to {held_out:.4}"
    ))?;
    out.line("")?;
    out.line("# for dialogue.toml, fitted to these lines")?;
    out.line("[model.calibration]")?;
    out.line(format!("power = {:?}", fitted.power))?;
    out.line(format!("built_in = {:?}", fitted.built_in))
}
