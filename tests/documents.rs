//! The documents: no dead link, every page in the book, no command that does not exist.
//!
//! `integration::documents` runs the blocks of commands.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::HashSet;
use std::path::{Component, Path, PathBuf};

use clap::Command;
use whichone::cli::Cli;
use whichone_tests::markdown::{Page, TOP, page, pages};

/// The path without `.` and `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(plain.pop()),
            Component::CurDir => {}
            part => plain.push(part),
        }
    }
    plain
}

fn dead_links(page: &Page) -> Vec<String> {
    let folder = page.path.parent().unwrap();
    let dead = |(line, target): (usize, String)| {
        let report = |why: &str| Some(format!("{}:{line}: {target}: {why}", page.path.display()));
        if ["http://", "https://", "mailto:"].iter().any(|scheme| target.starts_with(scheme)) {
            return None;
        }
        let (file, anchor) = target.split_once('#').unwrap_or((&target, ""));
        let path = if file.is_empty() { page.path.clone() } else { plain(&folder.join(file)) };
        if !Path::new(TOP).join(&path).exists() {
            return report("no such file");
        }
        let has_anchor = || whichone_tests::markdown::page(&path).anchors().contains(anchor);
        if !anchor.is_empty() && !has_anchor() {
            return report("no such heading");
        }
        None
    };
    page.links().into_iter().filter_map(dead).collect()
}

#[test]
fn documents_have_no_dead_link() {
    let pages = pages();
    let links: usize = pages.iter().map(|page| page.links().len()).sum();
    assert!(links > 100, "{links}");
    let dead: Vec<String> = pages.iter().flat_map(dead_links).collect();
    assert!(dead.is_empty(), "{}", dead.join("\n"));
}

#[test]
fn dead_links_are_found() {
    let text = "[a](README.md#no-such) [b](gone.md) [c](tests) [d](https://x.y) [e](#e)\n# E\n";
    let dead = dead_links(&Page { path: "x.md".into(), text: text.to_owned() });
    assert_eq!(dead.len(), 3, "{dead:?}");
}

/// A page that is in no table of contents is not found by readers.
#[test]
fn every_page_is_in_the_book_and_in_the_index() {
    let index = |name: &str| {
        let page = page(Path::new(name));
        page.links().into_iter().map(|(_, target)| target).collect::<Vec<_>>()
    };
    let (summary, readme) = (index("docs/SUMMARY.md"), index("docs/README.md"));
    for page in pages() {
        let Ok(name) = page.path.strip_prefix("docs") else { continue };
        let name = name.to_str().unwrap();
        if ["SUMMARY.md", "README.md"].contains(&name) {
            continue;
        }
        assert!(summary.iter().any(|it| it == name), "docs/SUMMARY.md has no line for {name}");
        assert!(readme.iter().any(|it| it == name), "docs/README.md has no line for {name}");
    }
}

/// Reports what does not exist of a command of the program: the verb, or an option.
fn wrong_command(words: &[&str]) -> Option<String> {
    let root = Cli::definition();
    let mut path: Vec<&Command> = vec![&root];
    for word in words.iter().take_while(|word| **word != "--") {
        let at = *path.last().unwrap();
        // Their own programs read the rest.
        if ["link", "fleet", "gateway"].contains(&at.get_name()) {
            return None;
        }
        if let Some(option) = word.strip_prefix("--") {
            let name = option.split('=').next().unwrap();
            let has = |command: &&Command| {
                command.get_arguments().any(|argument| argument.get_long() == Some(name))
            };
            if !path.iter().any(has) && !["help", "version"].contains(&name) {
                return Some(format!("{} has no option --{name}", at.get_name()));
            }
        } else if let Some(verb) = at.find_subcommand(word) {
            path.push(verb);
        } else if path.len() == 1 && word.starts_with(char::is_lowercase) {
            return Some(format!("no verb {word}"));
        }
    }
    None
}

/// The words of each command `whichone …` in a line of a shell.
fn commands(line: &str) -> Vec<Vec<&str>> {
    let line = line.split(" #").next().unwrap();
    let parts = line.split([';', '|', '(', ')']).flat_map(|part| part.split("&&"));
    let words = parts.map(|part| {
        let words = part.split_whitespace().take_while(|word| !word.starts_with(['<', '>', '…']));
        words.collect::<Vec<_>>()
    });
    let is_ours = |words: &Vec<&str>| {
        words.first().is_some_and(|word| *word == "whichone" || word.ends_with("/whichone"))
    };
    words.filter(is_ours).map(|words| words[1..].to_vec()).collect()
}

#[test]
fn commands_in_the_documents_exist() {
    let (mut wrong, mut count) = (Vec::new(), 0);
    for page in pages() {
        // What was done once stays in the changelog.
        if page.path == Path::new("CHANGELOG.md") {
            continue;
        }
        let blocks = page.blocks();
        let blocks = blocks.iter().filter(|block| block.info.starts_with("sh"));
        let lines = blocks.flat_map(|block| {
            block.text.lines().enumerate().map(|(at, line)| (block.line + at + 1, line))
        });
        let indented = page.prose().into_iter().filter(|(_, line)| line.starts_with("    "));
        for (line, text) in page.spans().into_iter().chain(lines).chain(indented) {
            let place = format!("{}:{line}", page.path.display());
            for words in commands(text) {
                count += 1;
                wrong.extend(wrong_command(&words).map(|why| format!("{place}: {why}")));
            }
            let script = text.split_whitespace().next().filter(|it| it.starts_with("scripts/"));
            let is_gone = |script: &&str| !Path::new(TOP).join(script).exists();
            wrong.extend(script.filter(is_gone).map(|it| format!("{place}: no script {it}")));
        }
    }
    assert!(count > 150, "{count}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn wrong_commands_are_found() {
    let wrong = |line: &str| commands(line).iter().filter_map(|it| wrong_command(it)).count();
    for right in [
        "whichone say \"a; b\" --json | jq .",
        "X=1 ls; whichone await pick --answer-as SERVICE",
        "target/release/whichone down",
        "whichone swap grounding -- python3 x.py --fast",
        "whichone link init keys --router relay.example",
    ] {
        assert_eq!(wrong(right), 0, "{right}");
    }
    assert_eq!(wrong("whichone dance; whichone say --loud x"), 2);
}

/// Returns the value of a constant in the text of a source file: a product of numbers, some of them shifted.
fn constant(text: &str, name: &str) -> Option<f64> {
    let line = text.lines().find(|line| line.contains(&format!("const {name}: ")))?;
    let (_, value) = line.trim_end_matches(';').split_once(" = ")?;
    let number = |text: &str| text.trim().replace('_', "").parse::<f64>().ok();
    value.split('*').try_fold(1.0, |product, factor| {
        let factor = match factor.split_once("<<") {
            Some((number_of, bits)) => number(number_of)? * number(bits)?.exp2(),
            None => number(factor)?,
        };
        Some(product * factor)
    })
}

/// Reads "64 KiB" or "64"; what follows is left out.
fn amount(cell: &str) -> f64 {
    let mut words = cell.split_whitespace();
    let number: f64 = words.next().unwrap().parse().unwrap_or_else(|_| panic!("{cell}"));
    number
        * [("KiB", 1024.0), ("MiB", 1_048_576.0)]
            .into_iter()
            .find_map(|(unit, bytes)| (words.clone().next() == Some(unit)).then_some(bytes))
            .unwrap_or(1.0)
}

/// Checks the number in a cell against the constant that it names, if any.
fn checked_amount(cell: &str) -> f64 {
    let stated = amount(cell);
    let named = cell.split_once("[`").and_then(|(_, rest)| rest.split_once("`]("));
    if let Some((name, rest)) = named {
        let path = rest.split(')').next().unwrap();
        let text = std::fs::read_to_string(Path::new(TOP).join(path)).unwrap();
        assert_eq!(constant(&text, name), Some(stated), "{name} of {path}, in SECURITY.md");
    }
    stated
}

/// For each listener: what one peer may take, times the number of peers, is what is documented.
#[test]
fn peers_take_no_more_than_documented() {
    const MIB: f64 = 1_048_576.0;
    let text = page(Path::new("SECURITY.md")).text;
    let (_, section) = text.split_once("## What peers may take").unwrap();
    let section = section.split("\n## ").next().unwrap();
    let mut sums = std::collections::BTreeMap::<&str, f64>::new();
    for line in section.lines().filter(|line| line.starts_with("| ")).skip(1) {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        let [process, of_what, most, each, together] = cells[..] else { panic!("{line}") };
        let product = checked_amount(most) * checked_amount(each);
        let stated = amount(together);
        assert!((0.0..0.1 * MIB).contains(&(stated - product)), "{of_what}: {}", product / MIB);
        let times = if of_what.contains("each of 11 topics") { 11.0 } else { 1.0 };
        *sums.entry(process).or_default() += times * stated;
    }
    for (process, most) in [
        ("console", 64.0),
        ("gateway", 512.0),
        ("ROS 1", 128.0),
        ("ROS 2", 512.0),
        ("supervisor", 8.0),
        ("arm", 8.0),
    ] {
        let sum = sums[process] / MIB;
        assert!(sum <= most, "{process}: {sum} MiB");
        assert!(section.contains(&format!("{most} MiB")), "{process}: {most} MiB");
    }
    let orders = "const ORDERS: usize = 16;";
    let socket =
        std::fs::read_to_string(Path::new(TOP).join("services/gateway/src/socket.rs")).unwrap();
    assert!(socket.contains(orders) && socket.contains("const QUEUE: usize = 8;"), "{orders}");
}

#[test]
fn constants_are_read() {
    let text =
        "pub const A: usize = 64 << 10;\nconst B: u64 = 3 * 1_024;\nconst AB: usize = f();\n";
    assert_eq!(constant(text, "A"), Some(65_536.0));
    assert_eq!(constant(text, "B"), Some(3_072.0));
    assert_eq!((constant(text, "AB"), constant(text, "C")), (None, None));
}

/// Names of the tests in a table's third column.
fn named_tests(text: &str) -> Vec<&str> {
    let cells = text.lines().filter_map(|line| line.strip_prefix("| ")?.split(" | ").nth(2));
    let words = cells.flat_map(|cell| cell.split('`').skip(1).step_by(2));
    words.filter(|word| word.contains('_') && !word.contains([' ', '.'])).collect()
}

#[test]
fn tests_of_hazards_and_requirements_exist() {
    let kinds = ["-rhoE", "--include=*.rs", "--include=*.py"];
    let grep = [&kinds[..], &[r"(fn|def) [a-z0-9_]+\(", "services", "shared", "tests"]].concat();
    let found = std::process::Command::new("grep").args(grep).current_dir(TOP).output().unwrap();
    let functions = String::from_utf8(found.stdout).unwrap();
    let names = functions.lines().filter_map(|line| line.split([' ', '(']).nth(1));
    let names: HashSet<&str> = names.collect();
    for (file, least) in [("docs/safety.md", 20), ("docs/home-assistant.md", 15)] {
        let text = page(Path::new(file)).text;
        let named = named_tests(&text);
        assert!(named.len() > least, "{file}: {named:?}");
        for test in named {
            assert!(names.contains(test), "{file}: expected the name of a test, found {test}");
        }
    }
}
