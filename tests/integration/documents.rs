//! The commands of the documents, run as a reader runs them: the `sh` blocks of a page from the first to
//! the last, in a folder that looks like a checkout, with a home of its own.
//!
//! The fence's marks say what is not run: `sh norun REASON`, or `sh needs PROGRAM…`, which runs where these
//! programs, or files, are there. `whichone up` and `scripts/run` start the built group, in the background, with a
//! fast arm and without sound. A page that presumes a running group gets one (`PAGES`).

#![allow(clippy::print_stdout, reason = "which blocks have run, and how long")]

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;
use whichone_tests::markdown::{Block, TOP, page, pages};
use whichone_tests::{program, run};

/// Timeout of a block, seconds.
const BLOCK_S: f64 = 120.0;

const UP: &str = "whichone up";
const A_DIALOGUE: &str =
    "whichone up; whichone say 'the bowl'; whichone await pick --answer-as white2";

/// The program on the reader's path. A page's own settings come later and count more.
const UP_FOR_TESTS: &str = r#"case "$1" in
up | chat)
    verb=$1
    shift
    # The robots of profiles move in real time.
    case " $* " in
    *" --profile "*) ;;
    *) set -- --set arm.time_scale=60 "$@" ;;
    esac
    set -- "$verb" --set speech.voice=print --set console.listen=127.0.0.1:0 "$@"
    case " $* " in
    *" --detach "* | " chat "*) ;;
    *) set -- "$@" --detach --wait ready --timeout 60 ;;
    esac
    ;;
esac
exec WHICHONE "$@""#;

/// Declares a test for each page with commands: its name, the page, and what its reader has done before.
macro_rules! documents {
    ($($name:ident: $page:literal after $before:expr;)*) => {
        const PAGES: &[&str] = &[$($page),*];
        $(#[test]
        fn $name() {
            run_page($page, $before);
        })*
    };
}

documents! {
    document_readme: "README.md" after "";
    document_baxter: "docs/baxter.md" after "";
    document_concepts: "docs/concepts.md" after "";
    document_home_assistant: "docs/home-assistant.md" after UP;
    document_http: "docs/http.md" after UP;
    document_stability: "docs/stability.md" after "";
    document_journals: "docs/journals.md" after A_DIALOGUE;
    document_operations: "docs/operations.md" after "";
    document_perception: "docs/perception.md" after "";
    document_planners: "docs/planners.md" after "";
    document_pomdp: "docs/pomdp.md" after "";
    document_people: "docs/people.md" after UP;
    document_recording: "docs/recording.md" after A_DIALOGUE;
    document_replay: "docs/replay.md" after A_DIALOGUE;
    document_robots: "docs/robots.md" after "";
    document_scenes: "docs/scenes.md" after "";
    document_services: "docs/services.md" after UP;
    document_tour: "docs/tour.md" after "";
    document_troubleshooting: "docs/troubleshooting.md" after UP;
}

/// What a fence's marks say of a block of commands.
#[derive(Debug, PartialEq, Eq)]
enum Mark<'a> {
    Run,
    NotRun,
    Needs(Vec<&'a str>),
    /// Not a block of commands.
    Other,
}

fn mark<'a>(place: &str, block: &'a Block) -> Mark<'a> {
    let mut words = block.info.split_whitespace();
    match (words.next(), words.next()) {
        (Some("sh"), None) => Mark::Run,
        (Some("sh"), Some("norun")) => {
            assert!(words.next().is_some(), "{place}: norun without a reason");
            Mark::NotRun
        }
        (Some("sh"), Some("needs")) => Mark::Needs(words.collect()),
        (Some("sh" | "bash" | "shell" | "console"), _) => {
            panic!("{place}: expected `sh`, `sh norun REASON` or `sh needs PROGRAM`")
        }
        _ => Mark::Other,
    }
}

#[test]
fn every_page_with_commands_has_a_test() {
    let mut commands = 0;
    for page in pages() {
        let name = page.path.display().to_string();
        let blocks = page.blocks();
        let is_run = |block: &&Block| {
            let mark = mark(&format!("{name}:{}", block.line), block);
            matches!(mark, Mark::Run | Mark::Needs(_))
        };
        let run: Vec<&Block> = blocks.iter().filter(is_run).collect();
        assert!(run.is_empty() || PAGES.contains(&&*name), "{name} has commands and no test");
        commands += run.iter().flat_map(|block| block.text.lines()).count();
    }
    assert!(commands > 60, "{commands}");
}

fn run_page(name: &str, before: &str) {
    let checkout = Checkout::new();
    if !before.is_empty() {
        checkout.run(&format!("before {name}"), before);
    }
    for block in page(Path::new(name)).blocks() {
        let place = format!("{name}:{}", block.line);
        match mark(&place, &block) {
            Mark::Run => checkout.run(&place, &block.text),
            Mark::Needs(programs) => match programs.iter().find(|program| !is_installed(program)) {
                None => checkout.run(&place, &block.text),
                Some(missing) => println!("{place}: not run without {missing}"),
            },
            Mark::NotRun | Mark::Other => {}
        }
    }
}

pub(crate) fn is_installed(program: &str) -> bool {
    if program.starts_with('/') {
        return Path::new(program).exists();
    }
    let folders = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&folders).any(|folder| folder.join(program).is_file())
}

/// A folder that looks like a checkout after a build, and a reader's home.
struct Checkout {
    folder: tempfile::TempDir,
    home: PathBuf,
    top: PathBuf,
}

impl Checkout {
    fn new() -> Self {
        let folder = tempfile::Builder::new().prefix("wo").tempdir().unwrap();
        let (home, top) = (folder.path().join("home"), folder.path().join("whichone"));
        let programs = top.join("target/release");
        for new in [&home, &programs, &top.join("scripts")] {
            fs::create_dir_all(new).unwrap();
        }
        copy(&Path::new(TOP).join("config"), &top.join("config"));
        for shared in ["docs", "tests"] {
            symlink(Path::new(TOP).join(shared), top.join(shared)).unwrap();
        }
        let whichone = program("whichone");
        for entry in fs::read_dir(whichone.parent().unwrap()).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            if path.is_file() && name.starts_with("whichone-") && !name.contains('.') {
                symlink(&path, programs.join(name)).unwrap();
            }
        }
        let whichone = whichone.display().to_string();
        script(&programs.join("whichone"), &UP_FOR_TESTS.replace("WHICHONE", &whichone));
        script(&top.join("scripts/run"), "exec whichone up \"$@\"");
        Self { folder, home, top }
    }

    fn run(&self, place: &str, text: &str) {
        let began = Instant::now();
        let mut command = Command::new("bash");
        command.args(["-euxo", "pipefail", "-c", text]).current_dir(&self.top);
        for (name, _) in std::env::vars_os() {
            let name = name.to_string_lossy();
            if name.starts_with("WHICHONE_") || name.starts_with("XDG_") {
                command.env_remove(&*name);
            }
        }
        let path = std::env::var("PATH").unwrap_or_default();
        let path = format!("{}:{path}", self.top.join("target/release").display());
        command.env("HOME", &self.home).env("PATH", path).env("TMPDIR", self.folder.path());
        let ended = run(&mut command, "", BLOCK_S);
        assert_eq!(ended.code, Some(0), "{place}:\n{}\n{}", ended.stdout, ended.stderr);
        println!("{place}: {:.1} s", began.elapsed().as_secs_f64());
    }
}

impl Drop for Checkout {
    fn drop(&mut self) {
        let mut down = Command::new(program("whichone"));
        down.arg("down").env("HOME", &self.home).env_remove("WHICHONE_HOME");
        let _ = down.env_remove("XDG_STATE_HOME").env_remove("WHICHONE_GROUP").output();
    }
}

fn script(path: &Path, text: &str) {
    fs::write(path, format!("#!/bin/sh\n{text}\n")).unwrap();
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let target = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy(&path, &target);
        } else {
            fs::copy(&path, &target).unwrap();
        }
    }
}
