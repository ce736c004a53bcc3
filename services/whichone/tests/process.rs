//! The program as a process: exit codes, streams, and what happens where nothing runs.
#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// A home without any group.
struct Home(tempfile::TempDir);

impl Home {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_whichone"));
        command.args(line.split_whitespace()).current_dir(self.0.path());
        command.env_clear().env("WHICHONE_HOME", self.0.path()).stdin(Stdio::null());
        command
    }

    fn run(&self, line: &str) -> Output {
        self.command(line).output().unwrap()
    }

    #[track_caller]
    fn check(&self, line: &str, code: i32, part: &str) {
        let output = self.run(line);
        let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
        let (out, err) = (text(&output.stdout), text(&output.stderr));
        assert_eq!(output.status.code(), Some(code), "{line}: {out}{err}");
        assert!(format!("{out}{err}").contains(part), "{line}: {out}{err}");
        if code > 1 {
            assert_eq!(out, "", "{line}: errors go to standard error");
        }
    }
}

#[test]
fn wrong_calls_exit_64_and_help_0() {
    let home = Home::new();
    home.check("", 64, "Usage");
    home.check("dance", 64, "dance");
    home.check("fk", 64, "--limb");
    home.check("fk --limb middle", 64, "left");
    home.check("swap grounding", 64, "COMMAND");
    home.check("await supper", 64, "pick");
    home.check("status --group No", 64, "a-z");
    home.check("up --set scene", 64, "KEY=VALUE");
    home.check("up --wait ready", 64, "--detach");
    home.check("sya hello", 64, "similar subcommand exists: 'say'");
    home.check("record strat", 64, "'start'");
    home.check("objects ad", 64, "'add'");
    home.check("say --timeout soon hello", 64, "seconds");
    home.check("--help", 0, "whichone");
    home.check("ik --help", 0, "--limb");
    home.check("--version", 0, concat!("whichone ", env!("CARGO_PKG_VERSION"), " (commit "));
}

#[test]
fn version_names_the_commit_the_features_and_the_target() {
    let home = Home::new();
    let output = home.run("--version --json");
    let build: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(
        (&build["schema"], &build["version"]),
        (&1.into(), &env!("CARGO_PKG_VERSION").into())
    );
    assert!(build["target"].as_str().unwrap().contains("linux"), "{build}");
    assert!(build["features"].is_array(), "{build}");
    // These tests are built in a checkout, or from an archive that states its commit, or from neither.
    let git = Command::new("git")
        .args(["rev-parse", "HEAD"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output();
    let head =
        git.ok().filter(|it| it.status.success()).map(|it| String::from_utf8(it.stdout).unwrap());
    if let (Some(head), Some(commit)) = (head, build["commit"].as_str()) {
        assert_eq!(commit.len(), 12, "{build}");
        assert!(head.starts_with(commit), "{build}: HEAD is {head}");
    }
}

#[test]
fn without_a_group_every_verb_says_how_to_start_one() {
    let home = Home::new();
    let help = "whichone up";
    for line in ["say hello", "watch --once", "await pick", "stop-motion", "restart arm", "reload"]
    {
        home.check(line, 1, help);
    }
    home.check("status", 1, help);
    home.check(
        "status --json --group lab",
        1,
        "{\"schema\":1,\"name\":\"lab\",\"state\":\"down\",",
    );
    home.check("logs arm", 64, help);
    home.check("down", 0, "not running");
    home.check("journal speech", 1, help);
}

#[test]
fn configuration_is_found_and_checked() {
    let home = Home::new();
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
    let shipped = shipped.display();
    home.check(&format!("check --config {shipped}"), 0, "is right");
    home.check(&format!("check --values --config {shipped}"), 0, "dialogue.alpha");
    home.check(&format!("check --json --config {shipped}"), 0, "\"ok\":true");
    home.check(&format!("check --config {shipped} --set dialogue.alpa=1"), 78, "alpha");
    home.check(&format!("check --config {shipped} --profile nowhere"), 78, "nowhere");
    home.check("check --config nowhere", 78, "nowhere");
    home.check(&format!("up --config {shipped} --set arm.speed=2"), 78, "arm.speed");
    let output = home.run(&format!("check --json --config {shipped} --set dialogue.alpa=1"));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["problems"][0]["key"], "dialogue.alpa");
}

#[test]
fn batch_tools_read_standard_input_or_a_file() {
    let home = Home::new();
    let line = "{\"id\":1,\"q\":[0,0,0,0,0,0,0]}\n";
    let mut child = home
        .command("fk --limb left")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(line.as_bytes()).unwrap();
    let piped = child.wait_with_output().unwrap();
    assert_eq!(piped.status.code(), Some(0));
    std::fs::write(home.0.path().join("lines"), format!("{line}\nbad\n")).unwrap();
    let read = home.run("fk --limb left --input lines");
    assert_eq!(read.status.code(), Some(1));
    assert!(read.stdout.starts_with(&piped.stdout));
    home.check("fk --limb left --input nowhere", 74, "nowhere");
    home.check("ground --scene nowhere.toml", 74, "nowhere.toml");
}

#[test]
fn scene_of_a_batch_tool_is_a_file_or_a_name_in_the_configuration() {
    let home = Home::new();
    let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
    let config = config.display();
    let written = std::fs::write(home.0.path().join("belief"), "{\"id\":1,\"belief\":[0.5,0.5]}\n");
    written.unwrap();
    let ground = "ground --input belief --scene";
    home.check(&format!("{ground} bowls --config {config}"), 1, "\"line\":1");
    home.check(&format!("{ground} {config}/scenes/bowls.toml"), 1, "\"line\":1");
    home.check(&format!("{ground} nothing --config {config}"), 78, "name of a scene in");
    let plan = "plan --input belief --scene markers --config";
    home.check(&format!("{plan} {config}"), 0, "\"action\"");
}

#[test]
fn closed_output_pipe_is_not_a_failure() {
    let home = Home::new();
    let lines = "{\"id\":1,\"q\":[0,0,0,0,0,0,0]}\n".repeat(2_000);
    std::fs::write(home.0.path().join("lines"), lines).unwrap();
    let mut command = home.command("fk --limb left --input lines");
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(0), &b""[..]));
}

#[test]
fn every_verb_that_reads_a_file_refuses_a_pipe_at_once() {
    let home = Home::new();
    for name in ["pipe", "pipe.toml", "pipe.mcap", "arm-1.flight", "speech.journal"] {
        let made = Command::new("mkfifo").arg(home.0.path().join(name)).status().unwrap();
        assert!(made.success());
    }
    let flight = format!("pipe.{}", service::flight::EXTENSION);
    Command::new("mkfifo").arg(home.0.path().join(&flight)).status().unwrap();
    for line in [
        &format!("replay {flight}"),
        "export mcap pipe.mcap --out out.mcap",
        &format!("export mcap {flight} --out out.mcap"),
        "export mcap speech.journal --out out.mcap",
        "export trace speech.journal --out out.json",
        "scene check pipe.toml",
        "scene place pipe.toml",
        "listen pipe",
        "belief --input pipe",
        "ground --scene pipe.toml",
        "ground --scene bowls --input pipe",
        "plan --scene pipe.toml",
        "fk --robot pipe --tip x",
        "ik --robot pipe --tip x",
        "fk --limb left --input pipe",
    ] {
        let mut limited = Command::new("timeout");
        let plain = home.command(line);
        limited.args(["-s", "KILL", "60"]).arg(plain.get_program()).args(plain.get_args());
        limited.current_dir(home.0.path()).stdin(Stdio::null());
        limited.env("WHICHONE_HOME", home.0.path());
        let output = limited.output().unwrap();
        let said = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
        assert!(
            matches!(output.status.code(), Some(1 | 64 | 74 | 78)),
            "{line}: {:?} {said}",
            output.status
        );
        assert!(said.contains("expected a regular file"), "{line}: {said}");
    }
}
