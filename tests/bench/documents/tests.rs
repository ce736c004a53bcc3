//! What can be checked of the documents without measuring: every figure has its command, every command
//! exists, and every name is one that the benchmark gives.

#![allow(clippy::unwrap_used, reason = "tests")]

use super::markdown::{Table, plain, tables};
use super::measured::figure_of;
use super::number::{numbers, replaced, significant};
use super::{cells, covers, documents, is_bound, written};
use crate::options::Options;
use crate::report::Report;
use clap::Parser;
use std::path::Path;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

fn tables_of(document: &str) -> Vec<Table> {
    tables(&std::fs::read_to_string(Path::new(ROOT).join(document)).unwrap())
}

#[test]
fn every_table_of_the_benchmarks_names_its_command() {
    let without: Vec<usize> = tables_of("docs/benchmarks.md")
        .iter()
        .filter_map(|table| table.source.is_none().then_some(table.line))
        .collect();
    let help = "name the command in the paragraph above the table";
    assert!(
        without.is_empty(),
        "docs/benchmarks.md: no command at lines {without:?}; help: {help}"
    );
}

#[test]
fn every_command_of_a_table_exists() {
    for (name, path) in documents() {
        for table in tables(&std::fs::read_to_string(path).unwrap()) {
            let Some(source) = &table.source else { continue };
            let at = format!("{name}:{}: {}", table.line, source.command);
            let words = source.command.split_whitespace().skip_while(|word| word.contains('='));
            let words: Vec<&str> = words.collect();
            if words[0].starts_with("scripts/") {
                assert!(Path::new(ROOT).join(words[0]).exists(), "{at}: no such script");
            }
            if words[0] == "scripts/bench" {
                let parsed = Options::try_parse_from(&words);
                assert!(parsed.is_ok(), "{at}: {}", parsed.err().unwrap());
            }
        }
    }
}

/// Names of the figures in a table.
fn figures(table: &Table) -> Vec<String> {
    let names = |cells: &Vec<String>| {
        let row = plain(&cells[0]);
        let own = |head: &String| figure_of(&row, &plain(head)).map(|(name, ..)| name);
        let mut names: Vec<String> = table.heads.iter().filter_map(own).collect();
        if names.is_empty() {
            names.push(row);
        }
        names
    };
    table.rows.iter().flat_map(names).collect()
}

#[test]
fn tables_of_the_benchmarks_that_the_benchmark_prints_can_be_compared() {
    for table in tables_of("docs/benchmarks.md") {
        let command = table.source.as_ref().map_or("", |source| &source.command);
        let is_its = command.contains("scripts/bench");
        let help = "name the report's table behind the command, or a statistic in a head";
        let at = format!("docs/benchmarks.md:{}", table.line);
        assert!(
            !is_its || is_bound(&table),
            "{at}: bound to no figures of the report; help: {help}"
        );
    }
}

/// The names of figures and the titles of tables are string literals of the benchmark, with `{}` for
/// what is filled in.
#[test]
fn every_name_is_given_by_the_benchmark() {
    let mut source = String::new();
    read_sources(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/bench")), &mut source);
    let literals: Vec<&str> = source.split('"').collect();
    for (document, path) in documents() {
        for table in tables(&std::fs::read_to_string(path).unwrap()) {
            let Some(source) = table.source.as_ref().filter(|_| is_bound(&table)) else { continue };
            let names = match &source.title {
                Some(title) => vec![title.clone()],
                None => figures(&table),
            };
            for name in names {
                let what = name.split(": ").next().unwrap_or(&name);
                let is_given = |literal: &&str| matches(&name, literal) || matches(what, literal);
                let is_given = literals.iter().any(is_given);
                let help = "the benchmark's name of the figure, or the title of its table";
                let at = format!("{document}:{}", table.line);
                assert!(is_given, "{at}: `{name}` is not in tests/bench; help: expected {help}");
            }
        }
    }
}

fn read_sources(folder: &Path, text: &mut String) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            read_sources(&path, text);
        } else if folder.file_name().is_none_or(|name| name != "documents") {
            text.push_str(&std::fs::read_to_string(path).unwrap());
        }
    }
}

/// Returns whether a name is made from this literal, of which at least eight letters are its own.
fn matches(name: &str, literal: &str) -> bool {
    let literal = plain(literal);
    let mut pieces = literal.split('{').map(|piece| piece.rsplit('}').next().unwrap_or(piece));
    let own: usize = literal.split('{').map(|piece| piece.rsplit('}').next().unwrap().len()).sum();
    let Some(mut rest) = name.strip_prefix(pieces.next().unwrap_or_default()) else { return false };
    let mut is_open = false;
    for piece in pieces {
        let Some(at) = rest.find(piece) else { return false };
        (rest, is_open) = (&rest[at + piece.len()..], piece.is_empty());
    }
    own >= 8 && (rest.is_empty() || is_open)
}

#[test]
fn names_match_the_literals_that_they_are_made_from() {
    assert!(matches("memory of arm", "memory of {name}"));
    assert!(matches("decision of lookahead, 6 bowls", "decision of {name}, {}"));
    assert!(matches("kill -9 of arm to ready again", "kill -9 of {service} to ready again"));
    assert!(!matches("memory of arm", "{what}: {situation}"), "too little of its own");
    assert!(!matches("memory of the arm", "memory of arm"));
    assert!(!matches("kill -9 of arm to ready", "kill -9 of {service} to ready again"));
}

#[test]
fn tables_know_the_command_above_them() {
    let text = "# A\n\nPrinted by `scripts/bench --core`, \"Exact\nvalues\":\n\n| a | b |\n|---|---|\n\
                | x | 1 |\n\nMore `text`.\n\n| c |\n|---|\n\n# B\n\n| d |\n|---|\n";
    let tables = tables(text);
    let sources: Vec<_> = tables.iter().map(|table| table.source.as_ref()).collect();
    let source = sources[0].unwrap();
    assert_eq!(source.command, "scripts/bench --core");
    assert_eq!(source.title.as_deref(), Some("Exact values"));
    assert_eq!(sources[1], Some(source), "the section's");
    assert_eq!(sources[2], None, "another section");
    assert_eq!((tables[0].line, tables[0].line_of(0)), (6, 8));
    assert_eq!(tables[0].rows, [["x", "1"]]);
}

#[test]
fn numbers_are_read_with_their_signs_and_digits() {
    let of = |text| numbers(text).iter().map(|n| (n.value, n.decimals)).collect::<Vec<_>>();
    assert_eq!(of("33.9732–33.9735, 2"), [(33.9732, 4), (33.9735, 4), (2.0, 0)]);
    assert_eq!(of("9,028 of -1.50 at p50"), [(9028.0, 0), (-1.5, 2)]);
    assert_eq!(of("5-20 %"), [(5.0, 0), (20.0, 0)]);
    assert_eq!(replaced("246 / 0.03 (of 9.95)", &[251.4, 0.004, 9.0]), "251 / 0.0040 (of 9.00)");
    assert_eq!(
        [significant(1234.5), significant(0.0123), significant(0.0)],
        ["1234", "0.012", "0"]
    );
}

#[test]
fn reports_cover_the_commands_that_measure_the_same() {
    let covers = |arguments: &[&str], command| {
        covers(&arguments.iter().map(|it| (*it).to_owned()).collect::<Vec<_>>(), command)
    };
    assert!(covers(&["--core"], "scripts/bench --core"));
    assert!(covers(&["--runs", "3", "--stops", "--core"], "scripts/bench --core"));
    assert!(covers(&[], "scripts/bench --core"), "all parts");
    assert!(!covers(&[], "scripts/bench --spoken"), "shorter among all parts");
    assert!(covers(&["--processes"], "scripts/bench --hops"), "a part of it");
    assert!(!covers(&["--hops"], "scripts/bench --processes"));
    assert!(!covers(&["--stops"], "scripts/bench --core"));
    assert!(!covers(&["--core", "--quick"], "scripts/bench --core"));
    assert!(!covers(&["--speech"], "scripts/bench --speech --quick"));
    let with_model = "WHICHONE_WHISPER_MODEL=… scripts/bench --spoken";
    assert!(covers(&["WHICHONE_WHISPER_MODEL", "--spoken"], with_model));
    assert!(!covers(&["--spoken"], with_model));
}

const DOCUMENT: &str = "`scripts/bench --core`\n\n| figure | p50 | p99 | unit | ratio |\n|---|---|---|---|---|\n\
                        | hop by `us` | 10 | 12 | µs | 0.50 |\n| peer's hop | 30 | – | ms | – |\n\n\
                        `scripts/bench --core`, \"Values\"\n\n| | value |\n|---|---|\n| six bowls | 33.97 |\n\
                        | ten tools | |\n| gone | 1 |\n";

/// Two runs: the hop takes 9 to 11 µs in the first and 12 in the second, its peer 20.
fn report() -> Report {
    let mut report = Report::new(vec!["--runs=2".to_owned(), "--core".to_owned()]);
    for hops in [[9.0, 10.0, 11.0, 10.0, 10.0], [12.0; 5]] {
        report.add("peer's hop", "µs", &[20.0; 5], "");
        report.add_beside("hop by us", "µs", &hops, "peer's hop", "");
        let rows = [["six bowls", "33.9732"], ["ten tools", "30.1"]];
        let rows = rows.map(|row| row.map(str::to_owned).to_vec()).to_vec();
        report.exact_table("Values", "", ["scene", "value"], rows);
    }
    // As it is read from its file.
    serde_json::from_slice(&serde_json::to_vec(&report).unwrap()).unwrap()
}

#[test]
fn documented_cells_hold_within_the_spread_of_the_runs() {
    let reports = [report()];
    let judged: Vec<Vec<Option<bool>>> = tables(DOCUMENT)
        .iter()
        .map(|table| {
            let judge = |compared: super::Compared<'_>| match compared.outcome {
                super::Outcome::Unbound => None,
                super::Outcome::Found(cell) => {
                    Some(cell.holds(&table.rows[compared.row][compared.column]))
                }
            };
            cells(table, &reports).unwrap().into_iter().map(judge).collect()
        })
        .collect();
    let (holds, off) = (Some(true), Some(false));
    assert_eq!(judged[0], [holds, holds, holds, holds, off, off], "30 ms are not 20 µs");
    assert_eq!(judged[1], [holds, off, None], "an empty cell, and a row that is gone");
}

#[test]
fn situations_are_rows_and_their_figures_columns() {
    let mut report = Report::new(vec!["--stops".to_owned()]);
    report.add("stop to rest: full disk", "ms", &[3.0, 10.0, 3.0], "");
    let judge = |head: &str, value: &str| {
        let text =
            format!("`scripts/bench --stops`\n\n| | {head} |\n|-|-|\n| full disk | {value} |\n");
        let table = &tables(&text)[0];
        match cells(table, std::slice::from_ref(&report)).unwrap().remove(0).outcome {
            super::Outcome::Found(cell) => Some(cell.holds(value)),
            super::Outcome::Unbound => None,
        }
    };
    assert_eq!(judge("stop to rest, ms, p50", "3"), Some(true));
    assert_eq!(judge("stop to rest, ms, max", "20"), Some(false));
    assert_eq!(judge("stop to rest, s, max", "0.01"), None, "another unit");
    assert_eq!(judge("stop to rest, ms, p50", "1–2"), Some(false), "a range of runs");
    assert_eq!(judge("stop to rest, ms, p50", "1–3"), Some(true));
}

#[test]
fn figures_are_written_into_the_documents() {
    let text = written(DOCUMENT, &[report()]);
    assert!(text.contains("| hop by `us` | 12 | 12 | µs | 0.60 |"), "{text}");
    assert!(text.contains("| peer's hop | 20 | – | µs | – |"), "{text}");
    assert!(text.contains("| six bowls | 33.97 |\n| ten tools | 30.1 |\n| gone | 1 |"), "{text}");
    assert_eq!(text.lines().count(), DOCUMENT.lines().count());
}

#[test]
fn deviations_beyond_the_spread_are_off() {
    let reports = [report()];
    for (before, after) in [("| 10 | 12 |", "| 7.5 | 12 |"), ("33.97 ", "33.96 "), ("0.50", "0.75")]
    {
        let text = DOCUMENT.replace(before, after);
        let tables = tables(&text);
        let off = tables.iter().flat_map(|table| cells(table, &reports).unwrap()).filter(|it| {
            let cell = &it.table.rows[it.row][it.column];
            matches!(&it.outcome, super::Outcome::Found(found) if !found.holds(cell))
        });
        assert_eq!(off.count(), 4, "{after} is off, beside the three that are off anyway");
    }
}

/// README repeats figures of other pages, which name the commands.
#[test]
fn figures_of_the_readme_are_those_of_the_benchmarks() {
    let read = |name| std::fs::read_to_string(Path::new(ROOT).join(name)).unwrap();
    let pages = read("docs/benchmarks.md") + &read("docs/speech.md");
    let known: Vec<f64> = numbers(&pages).iter().map(|number| number.value).collect();
    let tables = tables_of("README.md");
    let table = tables.iter().find(|table| table.heads == ["what", "figure"]).unwrap();
    for cells in &table.rows {
        for number in numbers(&cells[1]) {
            let is_known = known.contains(&number.value);
            assert!(is_known, "README.md: {}: {} is in no other page", cells[0], number.value);
        }
    }
}
