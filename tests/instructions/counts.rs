//! Instructions of the hot paths beside those recorded in `tests/golden/instructions.txt`. Counts are those
//! of a release build and of one compiler: `scripts/test instructions` runs this, and
//! `WHICHONE_BLESS=1 scripts/test instructions` records them.

#![cfg(not(debug_assertions))]
#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeMap;
use std::process::Command;

const PROGRAM: &str = env!("CARGO_BIN_EXE_instructions");
const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/golden/instructions.txt");
/// Share by which counts may differ: the C library chooses its functions by the processor.
const TOLERANCE: f64 = 0.03;

fn output(command: &mut Command) -> (String, String) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let [stdout, stderr] =
        [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(output.status.success(), "{command:?}: {stderr}");
    (stdout, stderr)
}

/// The compiler and its target, as the first line of the golden file has them.
fn compiler() -> String {
    let (text, _) = output(Command::new("rustc").arg("-vV"));
    let host = text.lines().find_map(|line| line.strip_prefix("host: ")).unwrap();
    format!("{}, {host}", text.lines().next().unwrap())
}

/// Instructions of a whole run.
fn count(path: &str, times: u64) -> u64 {
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]);
    let (_, log) = output(valgrind.args([PROGRAM, path, &times.to_string()]));
    let refs = log.lines().find_map(|line| line.split_once("refs:")).unwrap().1;
    refs.replace(',', "").trim().parse().unwrap()
}

/// Instructions of one pass of each path.
fn counts() -> BTreeMap<String, u64> {
    let (paths, _) = output(&mut Command::new(PROGRAM));
    let per_pass = |line: &str| {
        let (times, path) = line.split_once(' ').unwrap();
        let times = times.parse().unwrap();
        let taken = count(path, 2 * times) - count(path, times);
        (path.to_owned(), taken / times)
    };
    paths.lines().map(per_pass).collect()
}

#[test]
#[ignore = "needs valgrind"]
fn hot_paths_take_as_many_instructions_as_recorded() {
    let counts = counts();
    if std::env::var_os("WHICHONE_BLESS").is_some() {
        let lines: String = counts.iter().map(|(path, n)| format!("{path}: {n}\n")).collect();
        std::fs::write(GOLDEN, format!("# {}\n{lines}", compiler())).unwrap();
    }
    let golden = std::fs::read_to_string(GOLDEN).unwrap();
    let mut lines = golden.lines();
    let recorded_with = lines.next().unwrap().trim_start_matches("# ");
    let help = "record them with WHICHONE_BLESS=1 scripts/test instructions";
    assert_eq!(recorded_with, compiler(), "counts of another compiler; help: {help}");
    let recorded: BTreeMap<String, u64> = lines
        .map(|line| line.rsplit_once(": ").unwrap())
        .map(|(path, n)| (path.to_owned(), n.parse().unwrap()))
        .collect();
    let off: Vec<String> = counts
        .iter()
        .filter_map(|(path, found)| {
            let expected = recorded.get(path).copied().unwrap_or(0);
            let change = *found as f64 / expected as f64 - 1.0;
            let is_off = change.abs() > TOLERANCE;
            let percent = 100.0 * change;
            let text = format!(
                "{path}: expected {expected} instructions, found {found} ({percent:+.1} %)"
            );
            is_off.then_some(text)
        })
        .collect();
    assert!(off.is_empty(), "{}\nhelp: if the change is intended, {help}", off.join("\n"));
    assert_eq!(recorded.len(), counts.len(), "recorded paths that are gone; help: {help}");
}
