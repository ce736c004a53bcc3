//! Durations of the robot's questions and picks, as text and as data.

use command_line::output::table;
use scene::{ObjectId, Question};
use serde_json::{Value as Json, json};
use vocabulary::{Action, Durations};

use super::setup::Setup;

/// Most rows of a table for people; the data has all.
const ROWS_MAX: usize = 24;

/// Tables of questions and objects, below a line on the costs of questions in this study.
pub(super) fn lines(setup: &Setup) -> Vec<String> {
    let durations = setup.durations();
    let room = setup.room();
    let says = if room.problem.durations.is_some() {
        "Questions cost what was measured: the robot's own seconds, each its own."
    } else {
        "Questions cost what is configured, alike for each kind; measured, they would take:"
    };
    let mut lines = vec![String::new(), says.to_owned()];
    let said_s = |question| room.voice.seconds(&room.scene.phrase(question));
    let questions: Vec<Question> = spoken(setup).collect();
    let rows: Vec<_> = questions
        .iter()
        .map(|question| {
            let whole_s = whole_s(setup, &durations, *question);
            let cost = room.problem.cost(Action::Ask(*question));
            let [said, whole, cost] = [said_s(*question), whole_s, cost].map(two_digits);
            vec![room.scene.phrase(*question), said, whole, cost]
        })
        .collect();
    lines.extend(capped(&["QUESTION", "SAY s", "TO THE ANSWER s", "COST s"], rows));
    let seconds = |found: Option<f64>| found.map_or_else(|| "-".to_owned(), two_digits);
    let rows = (0..room.scene.objects().len()).map(ObjectId::from).map(|i| {
        let aim_s = setup.motions().and_then(|motions| motions.point_s(None, i));
        let question = Question::Point(i);
        let cost = aim_s.map(|_| room.problem.cost(Action::Ask(question)));
        let name = room.scene.object(i).name.clone();
        let asked_s = durations.question_s(question);
        vec![name, seconds(aim_s), seconds(asked_s), seconds(cost), seconds(durations.pick_s(i))]
    });
    lines.push(String::new());
    let heads = ["OBJECT", "POINT s", "TO THE ANSWER s", "COST s", "PICK s"];
    lines.extend(capped(&heads, rows.collect()));
    lines
}

/// Returns the tables with names: if the arm's motions are unknown, its seconds are null.
pub(super) fn to_json(setup: &Setup) -> Json {
    let durations = setup.durations();
    let room = setup.room();
    let question = |question: Question| {
        let text = room.scene.phrase(question);
        json!({
            "question": scene::question_to_json(room.scene, question),
            "say_s": room.voice.seconds(&text),
            "text": text,
            "seconds": whole_s(setup, &durations, question),
        })
    };
    let object = |i: ObjectId| {
        json!({
            "object": room.scene.object(i).name,
            "aim_s": setup.motions().and_then(|motions| motions.point_s(None, i)),
            "point_s": durations.question_s(Question::Point(i)),
            "pick_s": durations.pick_s(i),
        })
    };
    let objects = (0..room.scene.objects().len()).map(ObjectId::from);
    json!({
        "answer_s": setup.answer_s(),
        "questions": spoken(setup).map(question).collect::<Vec<_>>(),
        "objects": objects.map(object).collect::<Vec<_>>(),
    })
}

/// Seconds of a question in words up to its answer; of a choice, without own costs, by its words.
fn whole_s(setup: &Setup, durations: &Durations, question: Question) -> f64 {
    let said_s = || setup.room().voice.seconds(&setup.room().scene.phrase(question));
    durations.question_s(question).unwrap_or_else(|| said_s() + setup.answer_s())
}

/// Returns the questions in words alone.
fn spoken(setup: &Setup) -> impl Iterator<Item = Question> {
    let problem = setup.room().problem;
    let questions = problem.model.questions(problem.actions).into_iter();
    questions.filter(|question| !matches!(question, Question::Point(_)))
}

fn capped(heads: &[&str], mut rows: Vec<Vec<String>>) -> Vec<String> {
    let more = rows.len().saturating_sub(ROWS_MAX);
    rows.truncate(ROWS_MAX);
    let mut lines = if rows.is_empty() { Vec::new() } else { table(heads, &rows) };
    lines.extend((more > 0).then(|| format!("… and {more} more")));
    lines
}

fn two_digits(seconds: f64) -> String {
    format!("{seconds:.2}")
}
