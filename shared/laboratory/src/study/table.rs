//! The study as tables for people.

use command_line::output::table;
use evaluation::simulation::Tally;
use user_study::{Interval, Mean};

use super::design::Row;
use super::setup::Setup;

/// Returns the lines of the tables: dialogues in turns, then those in real time.
pub(super) fn lines(setup: &Setup, results: &[(&Row, Tally)]) -> Vec<String> {
    let (real_time, in_turns): (Vec<_>, Vec<_>) =
        results.iter().partition(|(row, _)| row.people.in_real_time());
    let mut lines = Vec::new();
    if !in_turns.is_empty() {
        let seconds = if setup.moves() { "SECONDS" } else { "SECONDS (NO ARM)" };
        let heads = [
            "POLICY",
            "PEOPLE",
            "SUCCESS %",
            "95 %",
            "STATED %",
            "QUESTIONS",
            seconds,
            "DENIED",
            "RETURN",
            "95 %",
        ];
        let rows: Vec<_> = in_turns.iter().map(|(row, tally)| cells(row, tally)).collect();
        lines.extend(table(&heads, &rows));
    }
    if !real_time.is_empty() {
        lines.extend((!lines.is_empty()).then(String::new));
        let heads =
            ["TURN-TAKING", "PEOPLE", "SUCCESS %", "95 %", "QUESTIONS", "SECONDS", "MISPLACED %"];
        let rows: Vec<_> = real_time.iter().map(|(row, tally)| timed_cells(row, tally)).collect();
        lines.extend(table(&heads, &rows));
    }
    lines
}

fn cells(row: &Row, tally: &Tally) -> Vec<String> {
    let mut cells = vec![row.policy.clone()];
    cells.extend(common(row, tally, &tally.seconds));
    cells.insert(4, format!("{:.2}", 100.0 * tally.stated.mean()));
    cells.push(format!("{:.3}", tally.denied.mean()));
    cells.push(format!("{:.3}", tally.value.mean()));
    cells.push(interval(tally.value.interval(), 1.0, 3));
    cells
}

fn timed_cells(row: &Row, tally: &Tally) -> Vec<String> {
    let mut cells = vec![row.people.rules()];
    cells.extend(common(row, tally, &tally.talk_s));
    cells.push(format!("{:.2}", 100.0 * tally.misplaced_share()));
    cells
}

fn common(row: &Row, tally: &Tally, seconds: &Mean) -> [String; 5] {
    [
        people(row),
        format!("{:.2}", 100.0 * tally.success()),
        interval(tally.success_interval(), 100.0, 2),
        format!("{:.3}", tally.questions.mean()),
        format!("{:.2}", seconds.mean()),
    ]
}

/// Returns the kind of people, and the number of the dialogue.
fn people(row: &Row) -> String {
    let name = row.people.name();
    row.people.dialogue().map_or_else(|| name.to_owned(), |n| format!("{name}, dialogue {n}"))
}

fn interval(interval: Interval, unit: f64, digits: usize) -> String {
    format!("{:.digits$} … {:.digits$}", unit * interval.low, unit * interval.high)
}
