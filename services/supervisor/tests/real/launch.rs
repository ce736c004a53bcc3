//! The real program with the real settings, started as the command line starts it.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use std::fs;
use std::path::Path;

use service::control::{CallError, Reply, Request, call};
use service::exit::Exit;
use service::group::{GroupName, GroupPaths};
use service::launch::{LaunchError, Launched, Options, detached, wait_ready};
use service::status::GroupState;
use tempfile::TempDir;

use crate::harness::{PATIENCE, WAIT_MS, fixture};

/// A home with a configuration whose services are fixtures.
struct Home {
    folder: TempDir,
    paths: GroupPaths,
    options: Options,
}

impl Home {
    fn new() -> Self {
        let folder = tempfile::Builder::new().prefix("wo").tempdir().unwrap();
        let group = GroupName::new("lab").unwrap();
        let paths = GroupPaths::in_home(folder.path(), &group).unwrap();
        let config = folder.path().join("config");
        copy_scenes(&config.join("scenes"));
        let options = Options { group, config, profile: None, set: Vec::new(), fresh: false };
        let home = Self { folder, paths, options };
        home.write("group.toml", &services());
        home
    }

    fn write(&self, file: &str, text: &str) {
        fs::write(self.folder.path().join("config").join(file), text).unwrap();
    }

    fn launch(&self) -> Launched {
        detached(&fixture("fixture_group"), &self.options, &self.paths).unwrap()
    }

    fn up(&self) {
        self.launch().wait_listening(PATIENCE).unwrap();
        wait_ready(&self.paths, PATIENCE).unwrap();
    }

    fn call(&self, request: &Request) -> Result<Reply, CallError> {
        call(&self.paths.control_socket(), request, PATIENCE)
    }

    fn ask(&self, request: &Request) -> Reply {
        self.call(request).unwrap()
    }
}

impl Drop for Home {
    fn drop(&mut self) {
        let _ = call(&self.paths.control_socket(), &Request::Down, PATIENCE);
    }
}

fn copy_scenes(to: &Path) {
    fs::create_dir_all(to).unwrap();
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes");
    for entry in fs::read_dir(shipped).unwrap().flatten() {
        fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
    }
}

fn services() -> String {
    let fixture = fixture("fixture_service").display().to_string();
    let service = |name| format!("[services.{name}]\ncommand = [{fixture:?}, \"ready\"]\n");
    ["speech", "grounding", "policy", "arm", "console", "recorder"].map(service).concat()
}

/// The session of a process, from the sixth field of its `stat`. Not `getsid`, whose wrapper
/// panics where a session began outside this process namespace and has the number 0.
fn session_of(pid: u32) -> u32 {
    let stat = fs::read_to_string(format!("/proc/{pid}/stat")).unwrap();
    let after_name = stat.rsplit_once(')').unwrap().1;
    after_name.split_whitespace().nth(3).unwrap().parse().unwrap()
}

#[test]
fn detached_group_starts_and_stops() {
    let home = Home::new();
    home.up();
    let Reply::Status(status) = home.ask(&Request::Status) else { panic!("no status") };
    assert_eq!(status.state, GroupState::Ready);
    assert_eq!(status.scene, "bowls");
    let names: Vec<&str> = status.services.iter().map(|service| service.name.as_str()).collect();
    assert_eq!(names, ["speech", "grounding", "policy", "arm", "console", "recorder"]);
    assert_eq!(session_of(status.supervisor_pid), status.supervisor_pid, "a session of its own");
    let settings = home.paths.run().join(config::SNAPSHOT_FILE);
    assert!(settings.exists());
    let error = home.launch().wait_listening(PATIENCE).unwrap_err();
    assert_eq!(error.exit(), Exit::NotReached);
    let first = format!("group lab is already running (supervisor {})", status.supervisor_pid);
    assert!(error.to_string().contains(&first), "{error}");
    assert!(matches!(home.ask(&Request::Down), Reply::Down(_)));
    assert!(!home.paths.run().exists());
}

#[test]
fn invalid_configuration_is_reported_in_full() {
    let home = Home::new();
    home.write("arm.toml", "speed = \"fast\"\n");
    home.write("dialogue.toml", "epsilon = 2.0\n");
    let error = home.launch().wait_listening(PATIENCE).unwrap_err();
    assert_eq!(error.exit(), Exit::Config);
    assert!(matches!(error, LaunchError::Ended(..)));
    let error = error.to_string();
    assert!(error.contains("arm.toml") && error.contains("dialogue.toml"), "{error}");
}

#[test]
fn reload_restarts_services_that_read_changed_settings() {
    let home = Home::new();
    home.up();
    let call = || home.call(&Request::Reload { wait_ms: WAIT_MS });
    let reload = || call().unwrap();
    assert_eq!(reload(), Reply::Reloaded { restarted: vec![] });
    home.write("speech.toml", "# nothing but a remark\n");
    assert_eq!(reload(), Reply::Reloaded { restarted: vec![] });
    home.write("arm.toml", "time_scale = 7.0\n");
    // The console shows the robot that arm.toml names.
    let readers = ["arm", "console", "recorder"].map(str::to_owned).to_vec();
    assert_eq!(reload(), Reply::Reloaded { restarted: readers });
    home.write("group.toml", &format!("scene = \"tools\"\n{}", services()));
    let all =
        ["speech", "grounding", "policy", "arm", "console", "recorder"].map(str::to_owned).to_vec();
    assert_eq!(reload(), Reply::Reloaded { restarted: all });
    home.write("group.toml", "scene = \"nowhere\"\n");
    let Err(CallError::Refused(refusal)) = call() else { panic!("not refused") };
    assert!(refusal.details.iter().any(|line| line.contains("nowhere")), "{refusal:?}");
}
