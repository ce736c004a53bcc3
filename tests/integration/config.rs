//! An invalid configuration is refused as a whole, with every problem, its file and its key.

use crate::dashboard::{Terminal, has};
use rustix::process::{Pid, Signal, kill_process};
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use whichone_tests::{Group, program, wait_for};

fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../config")
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let target = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy(&path, &target);
        } else {
            std::fs::copy(&path, &target).unwrap();
        }
    }
}

/// A copy of the shipped configuration in which `file` is changed by `edit`.
pub(crate) fn edited(file: &str, edit: impl Fn(String) -> String) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    copy(&shipped(), folder.path());
    let path = folder.path().join(file);
    let text = std::fs::read_to_string(&path).unwrap();
    let changed = edit(text.clone());
    assert_ne!(text, changed, "the edit changes something");
    std::fs::write(path, changed).unwrap();
    folder
}

/// Both `check` and `up` refuse it with exit code 78 and all of `words`.
fn assert_refused(folder: &tempfile::TempDir, words: &[&str]) {
    let mut group = Group::with_config(folder.path().to_owned());
    let config = folder.path().display().to_string();
    let checked = group.call(&["check", "--config", &config]);
    let started = group.start(&[]);
    for ended in [checked, started] {
        assert_eq!(ended.code, Some(78), "{ended:?}");
        for word in words {
            let text = format!("{}{}", ended.stdout, ended.stderr);
            assert!(text.contains(word), "no {word} in: {text}");
        }
    }
    assert!(group.processes().is_empty());
}

#[test]
fn check_and_up_report_every_problem() {
    let folder = edited("dialogue.toml", |text| {
        text.replace("epsilon = 0.01", "epsilon = 1.5").replace("p_l = 0.95", "p_el = 0.95")
    });
    let path = folder.path().join("scenes/bowls.toml");
    let scene = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, scene.replace("name = \"white2\"", "name = \"white\"")).unwrap();
    assert_refused(&folder, &["dialogue.toml", "epsilon", "p_el", "bowls.toml", "white"]);
}

/// An edit of a file's text.
type Edit = fn(String) -> String;

#[test]
fn check_and_up_name_file_and_key_of_a_fault() {
    let cases: [(&str, Edit, &[&str]); 5] = [
        (
            "scenes/bowls.toml",
            |text| text.replacen("xyz = [0.", "xyz = [4.", 1),
            &["bowls.toml", "xyz", "reach"],
        ),
        (
            "scenes/bowls.toml",
            |text| text[..text.find("[[objects]]").expect("objects")].to_owned(),
            &["bowls.toml", "objects"],
        ),
        (
            "scenes/bowls.toml",
            |text| {
                text.replacen("[{ name = \"round\"", "[{ name = \"round\" }, { name = \"round\"", 1)
            },
            &["bowls.toml", "round", "listed twice"],
        ),
        (
            "group.toml",
            |text| text.replace("scene = \"bowls\"", "scene = \"plates\""),
            &["group.toml", "scene", "plates"],
        ),
        ("arm.toml", |text| format!("{text}\nthis is not = = toml"), &["arm.toml"]),
    ];
    for (file, edit, words) in cases {
        assert_refused(&edited(file, edit), words);
    }
}

#[test]
fn up_refuses_settings_with_the_key_and_a_fix() {
    let open_to_all = ["console.access=open", "console.listen=0.0.0.0:0"];
    for (settings, words) in [
        (&["dialogue.planner=oracle"][..], &dialogue::registry::names()[..]),
        (&["arm.driver=baxter"], &["time_scale", "real time"]),
        (&open_to_all, &["console.listen", "token", "127.0.0.1"]),
    ] {
        let refused = Group::new().start(settings);
        assert_eq!(refused.code, Some(78), "{refused:?}");
        for word in words {
            assert!(refused.stderr.contains(word), "no {word} in: {}", refused.stderr);
        }
    }
}

#[test]
fn reload_adopts_valid_and_refuses_invalid_files() {
    let folder = edited("dialogue.toml", |text| text.replace("epsilon = 0.01", "epsilon = 0.02"));
    let mut group = Group::with_config(folder.path().to_owned());
    assert_eq!(group.start(&[]).code, Some(0));
    let (policy, arm) = (group.incarnation("policy"), group.incarnation("arm"));
    let path = folder.path().join("dialogue.toml");
    let text = std::fs::read_to_string(&path).unwrap();

    std::fs::write(&path, text.replace("epsilon = 0.02", "epsilon = 7")).unwrap();
    let refused = group.call(&["reload"]);
    assert_ne!(refused.code, Some(0));
    assert!(refused.stderr.contains("epsilon"), "{}", refused.stderr);
    assert_eq!(group.incarnation("policy"), policy, "nothing was restarted");

    std::fs::write(&path, text.replace("epsilon = 0.02", "epsilon = 0.05")).unwrap();
    group.must(&["reload"]);
    group.wait_for_restart("policy", policy);
    assert_eq!(group.incarnation("arm"), arm, "unaffected services keep running");
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.down();
}

/// A configuration whose bowls are all out of reach, so that a better place is searched for each: it takes seconds.
fn out_of_reach() -> tempfile::TempDir {
    edited("scenes/bowls.toml", |text| {
        let mut y = -1.2;
        let mut moved = |line: &str| {
            if !line.starts_with("xyz = ") {
                return format!("{line}\n");
            }
            y += 0.3;
            format!("xyz = [1.6, {y:.1}, -0.13]\n")
        };
        text.lines().map(&mut moved).collect()
    })
}

fn whichone(words: &[&str]) -> Command {
    let mut command = Command::new(program("whichone"));
    command.args(words);
    command
}

/// The terminal shows what a verb is at, and a line that is erased at the end.
#[test]
fn verbs_that_take_long_say_what_they_are_at_and_are_interrupted_at_once() {
    let folder = out_of_reach();
    let config = folder.path().to_str().unwrap();
    let scene = folder.path().join("scenes/bowls.toml");
    let before = std::fs::read(&scene).unwrap();
    let check = ["check", "--config", config];
    let place = ["scene", "place", scene.to_str().unwrap(), "--write", "--config", config];
    for words in [&check[..], &place[..]] {
        let mut terminal = Terminal::start_with(&mut whichone(words), (100, 20), |errors| errors);
        let process = Pid::from_child(&terminal.child);
        // A fast machine gets through in less than the second after which the line appears.
        std::thread::sleep(Duration::from_millis(300));
        kill_process(process, Signal::STOP).unwrap();
        std::thread::sleep(Duration::from_millis(1_200));
        kill_process(process, Signal::CONT).unwrap();
        let is_at = |lines: &[String]| {
            ["checking reach: ", "looking for a better place", "finding places: "]
                .iter()
                .any(|at| has(lines, at))
        };
        terminal.wait_for("the progress", is_at);
        kill_process(process, Signal::INT).unwrap();
        let began = Instant::now();
        let ended = wait_for("the end", 20.0, || terminal.child.try_wait().unwrap());
        assert_eq!(ended.signal(), Some(2), "{words:?}: {ended:?}");
        assert!(began.elapsed() < Duration::from_secs(1), "{words:?}: {:?}", began.elapsed());
        terminal.wait_for("the erased line", |lines| !is_at(lines));
    }
    assert_eq!(std::fs::read(&scene).unwrap(), before);
    let files = std::fs::read_dir(folder.path().join("scenes")).unwrap();
    assert_eq!(files.count(), std::fs::read_dir(shipped().join("scenes")).unwrap().count());

    // Whole, with the line gone; without a terminal or with --json there is none.
    let mut terminal = Terminal::start_with(&mut whichone(&check), (100, 20), |errors| errors);
    let ended = wait_for("the end", 60.0, || terminal.child.try_wait().unwrap());
    assert_eq!(ended.code(), Some(78));
    terminal.wait_for("the problems", |lines| has(lines, "6 problems") && !has(lines, "place of"));
    let piped = whichone(&check).stderr(Stdio::piped()).output().unwrap();
    assert!(!piped.stderr.contains(&0x1b), "{}", String::from_utf8_lossy(&piped.stderr));
    let json = [&check[..], &["--json"]].concat();
    let mut terminal = Terminal::start_with(&mut whichone(&json), (100, 20), |errors| errors);
    wait_for("the end", 60.0, || terminal.child.try_wait().unwrap());
    terminal.wait_for("the problems", |lines| has(lines, "\"ok\":false"));
    assert!(!has(&terminal.lines(), "place of `"), "{:?}", terminal.lines());
}
