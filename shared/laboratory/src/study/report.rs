//! The study as data: JSON and CSV.

use evaluation::simulation::Tally;
use serde_json::{Map, Value as Json, json};

use super::design::Row;
use super::seconds;
use super::setup::Setup;
use crate::args::StudyArgs;

/// Returns the whole study.
pub(super) fn to_json(args: &StudyArgs, setup: &Setup, results: &[(&Row, Tally)]) -> Json {
    let room = setup.room();
    let row = |(row, tally): &(&Row, Tally)| {
        let named = columns(row, tally).into_iter().map(|(name, value)| (name.to_owned(), value));
        let mut json: Map<String, Json> = named.collect();
        json.insert("questions_histogram".to_owned(), json!(tally.histogram.to_vec()));
        Json::Object(json)
    };
    json!({
        "scene": room.scene.name(),
        "seed": args.seed,
        "interactions": args.interactions,
        "request": room.request,
        "arm_moves": setup.moves(),
        "actions": room.problem.actions,
        "params": room.problem.model.params(),
        "costs": room.problem.costs,
        "announce": room.problem.announce,
        "costs_measured": room.problem.durations.is_some(),
        "durations": seconds::to_json(setup),
        "rows": results.iter().map(row).collect::<Vec<_>>(),
    })
}

/// Returns a line per row below the columns' names.
pub(super) fn to_csv(results: &[(&Row, Tally)]) -> String {
    let mut text = String::new();
    for (n, (row, tally)) in results.iter().enumerate() {
        let columns = columns(row, tally);
        if n == 0 {
            let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
            text += &(names.join(",") + "\n");
        }
        let cells: Vec<String> = columns.iter().map(|(_, value)| cell(value)).collect();
        text += &(cells.join(",") + "\n");
    }
    text
}

/// Returns a row's name and value for every column.
fn columns(row: &Row, tally: &Tally) -> Vec<(&'static str, Json)> {
    let success = tally.success_interval();
    let mut columns = vec![
        ("policy", json!(row.policy)),
        ("people", json!(row.people.name())),
        ("dialogue", json!(row.people.dialogue())),
        ("turn_taking", json!(row.people.rules())),
        ("interactions", json!(tally.interactions())),
        ("right", json!(tally.right)),
        ("wrong", json!(tally.wrong)),
        ("without_pick", json!(tally.without)),
        ("success", json!(tally.success())),
        ("success_low", json!(success.low)),
        ("success_high", json!(success.high)),
    ];
    let means = [
        (["questions", "questions_low", "questions_high"], &tally.questions),
        (["denied", "denied_low", "denied_high"], &tally.denied),
        (["talk_s", "talk_s_low", "talk_s_high"], &tally.talk_s),
        (["seconds", "seconds_low", "seconds_high"], &tally.seconds),
        (["return", "return_low", "return_high"], &tally.value),
        (["stated", "stated_low", "stated_high"], &tally.stated),
    ];
    for ([name, low, high], mean) in means {
        let interval = mean.interval();
        columns.extend([(name, json!(mean.mean())), (low, json!(interval.low))]);
        columns.push((high, json!(interval.high)));
    }
    columns.push(("misplaced_answers", json!(tally.misplaced_share())));
    columns
}

/// Names hold neither commas nor quotes.
fn cell(value: &Json) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
