//! The page of the benchmarks. What stands in it between `<!-- bench:NAME -->` and `<!-- /bench -->` is replaced as a whole:
//! by the report's table of that title, or, where NAME is `--PART`, by the figures of that part.

use crate::report::{Figure, Report, markdown};
use std::path::{Path, PathBuf};

const BEGIN: &str = "<!-- bench:";
const NAMED: &str = " -->\n";
const END: &str = "<!-- /bench -->";

fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/benchmarks.md")
}

/// Writes what the report has into the page; its other sections stay.
pub(crate) fn write(report: &Report) -> std::io::Result<()> {
    let page = std::fs::read_to_string(path())?;
    std::fs::write(path(), written(&page, report))
}

fn written(page: &str, report: &Report) -> String {
    let mut pieces = page.split(BEGIN);
    let mut text = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        text += BEGIN;
        let section = piece.split_once(NAMED).and_then(|(name, rest)| {
            let (_, after) = rest.split_once(END)?;
            Some(format!("{name}{NAMED}\n{}\n{END}{after}", section(name, report)?))
        });
        text += &section.unwrap_or_else(|| piece.to_owned());
    }
    text
}

/// The table of that name, if the report has it.
fn section(name: &str, report: &Report) -> Option<String> {
    let Some(part) = name.strip_prefix("--") else {
        let table = report.tables.iter().find(|table| table.title == name)?;
        return Some(markdown(&table.heads, &table.rows));
    };
    let heads = ["figure", "p50", "p99", "max", "unit", "ratio of p50 to peer"];
    let figures = report.figures.iter().filter(|figure| figure.part == part);
    let rows: Vec<_> = figures.map(row).collect();
    (!rows.is_empty()).then(|| markdown(&heads.map(str::to_owned), &rows))
}

fn row(figure: &Figure) -> Vec<String> {
    let [p50, p99, max] = [figure.p50, figure.p99, figure.max].map(significant);
    let ratio =
        figure.peer.as_ref().map(|(peer, ratio)| format!("{} × {peer}", significant(*ratio)));
    vec![figure.what.clone(), p50, p99, max, figure.unit.clone(), ratio.unwrap_or_default()]
}

/// Returns a value with two significant digits, and at least up to the point.
fn significant(value: f64) -> String {
    let decimals = (1.0 - value.abs().log10().floor()).clamp(0.0, 9.0);
    if value == 0.0 { "0".to_owned() } else { format!("{value:.*}", decimals as usize) }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::options::Options;
    use clap::Parser;

    #[test]
    fn sections_of_the_report_replace_those_of_the_page() {
        let mut report = Report { part: "core", ..Report::default() };
        report.add("a peer", "ns", &[40.0], "");
        report.add_beside("decision", "ns", &[123.4], "a peer", "");
        report.part = "hops";
        report.add("hop", "µs", &[1.0], "");
        report.table("Values", "", ["scene", "value"], vec![vec!["bowls".into(), "1".into()]]);
        let page = "Before.\n\n<!-- bench:--core -->\nold\n<!-- /bench -->\n\nBetween.\n\
                    <!-- bench:Values -->\nold\n<!-- /bench -->\n<!-- bench:--size -->\nstays\n<!-- /bench -->\n";
        let expected = "Before.\n\n<!-- bench:--core -->\n
| figure | p50 | p99 | max | unit | ratio of p50 to peer |
|---|---|---|---|---|---|
| a peer | 40 | 40 | 40 | ns |  |
| decision | 123 | 123 | 123 | ns | 3.1 × a peer |

<!-- /bench -->\n\nBetween.\n<!-- bench:Values -->\n
| scene | value |
|---|---|
| bowls | 1 |

<!-- /bench -->\n<!-- bench:--size -->\nstays\n<!-- /bench -->\n";
        assert_eq!(written(page, &report), expected);
        assert_eq!(written(expected, &report), expected);
    }

    #[test]
    fn sections_of_the_page_end_and_name_parts_that_exist() {
        let page = std::fs::read_to_string(path()).unwrap();
        let sections: Vec<&str> = page.split(BEGIN).skip(1).collect();
        assert!(sections.len() > 10 && sections.len() == page.matches(END).count());
        for section in sections {
            let (name, rest) = section.split_once(NAMED).unwrap();
            assert!(rest.contains(END), "{name}");
            if name.starts_with("--") {
                assert!(Options::try_parse_from(["bench", name]).is_ok(), "{name}");
            }
        }
    }
}
