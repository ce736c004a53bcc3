//! `doctor`: missing dependencies of this machine, with help.

use std::env;
use std::fs;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use command_line::output::{Ink, Output, Style};
use command_line::{Outcome, configuration, program};
use config::Settings;
use messages::{SUPERVISOR, Service};
use service::console_link;
use service::exit::{Exit, Failure};
use service::group::{GroupName, GroupPaths, SHM};
use service::inspection::{Condition, Finding};
use service::launch;
use service::shm_cleanup;

use super::{inspection, leftovers, up};
use crate::cli::ConfigArgs;

/// Examines everything that a group needs and suggests fixes.
pub(super) fn doctor(paths: &GroupPaths, args: &ConfigArgs, out: &mut Output<'_>) -> Outcome {
    let settings = configuration::settings(args);
    let mut findings = vec![
        programs(),
        folder(paths),
        match &settings {
            Ok(settings) => {
                Finding::good("configuration", format!("scene {}", settings.group.scene))
            }
            Err(error) => Finding::bad("configuration", error.to_string()),
        },
        shared_memory(settings.as_ref().ok()),
        left_behind(paths),
    ];
    if let Ok(settings) = &settings {
        findings.push(page(paths, settings));
        findings.extend(devices(settings)?);
    }
    for finding in &findings {
        if out.is_json() {
            out.json(finding)?;
        } else {
            out.line(line(finding, out.style()))?;
        }
    }
    let ill = findings.iter().any(|finding| finding.state == Condition::Bad);
    Ok(if ill { Exit::NotReached } else { Exit::Ok })
}

/// Checks the devices of the speech service by its own program.
fn devices(settings: &Settings) -> Result<Vec<Finding>, Failure> {
    let snapshot = inspection::snapshot(settings)?;
    let mut command = program::command(Service::Speech.name(), "doctor");
    command.arg("--settings").arg(snapshot.path()).stderr(Stdio::inherit());
    let Ok(output) = command.output() else { return Ok(Vec::new()) };
    let lines = output.stdout.split(|&byte| byte == b'\n');
    Ok(lines.filter_map(|line| serde_json::from_slice(line).ok()).collect())
}

fn line(finding: &Finding, style: Style) -> String {
    let mark = match finding.state {
        Condition::Good => style.paint(Ink::Green, "good"),
        Condition::Poor => style.paint(Ink::Yellow, "poor"),
        Condition::Bad => style.paint(Ink::Red, "bad "),
    };
    let note = finding.note.replace('\n', "\n                       ");
    format!("{mark}  {:<16} {note}", finding.what)
}

/// Checks the programs of the group, beside this one or in it.
fn programs() -> Finding {
    let folder = env::current_exe().ok().and_then(|own| Some(own.parent()?.to_owned()));
    let folder = folder.unwrap_or_default();
    let names = Service::BUILT_IN.map(Service::name).into_iter().chain([SUPERVISOR]);
    let names = names.map(|name| format!("whichone-{name}"));
    let is_there = |name: &String| {
        let path = folder.join(name);
        path.is_file() || launch::host_of(&path).is_some()
    };
    let missing: Vec<String> = names.filter(|name| !is_there(name)).collect();
    if missing.is_empty() {
        return Finding::good("programs", folder.display().to_string());
    }
    let help = "help: build all programs with `cargo build --release --workspace`";
    Finding::bad("programs", format!("{} lacks {}; {help}", folder.display(), missing.join(", ")))
}

/// Checks the page: its address, or else its port.
fn page(paths: &GroupPaths, settings: &Settings) -> Finding {
    const WHAT: &str = Service::Console.name();
    if settings.console.access == config::Access::Open {
        let help = "help: set console.access = \"token\"";
        let what = "console.access is open: every user of this machine can operate the robot";
        return Finding::poor(WHAT, format!("{what}; {help}"));
    }
    if let Some(url) = console_link::address(paths) {
        return Finding::good(WHAT, format!("served at {url}"));
    }
    let wanted = settings.console.listen;
    match TcpListener::bind(wanted) {
        Ok(_) => Finding::good(WHAT, format!("{wanted} is free")),
        Err(error) => {
            let help = "help: one of the next 15 ports will be used, or set console.listen";
            Finding::poor(WHAT, format!("{wanted}: {error}; {help}"))
        }
    }
}

/// Checks that the groups' folder is writable.
fn folder(paths: &GroupPaths) -> Finding {
    const WHAT: &str = "groups' folder";
    let home = paths.home();
    match fs::create_dir_all(home).and_then(|()| safe_files::probe(home)) {
        Ok(()) => Finding::good(WHAT, home.display().to_string()),
        Err(error) => {
            let help = "help: make it writable, or set WHICHONE_HOME to another folder";
            Finding::bad(WHAT, format!("{}: {error}; {help}", home.display()))
        }
    }
}

fn shared_memory(settings: Option<&Settings>) -> Finding {
    const WHAT: &str = "shared memory";
    let needed = settings.map_or(32, |settings| settings.group.shared_memory_free_min_mib);
    if let Err(error) = shm_cleanup::check_room(needed.into()) {
        return Finding::bad(WHAT, error.to_string());
    }
    match safe_files::probe(Path::new(SHM)) {
        Ok(()) => Finding::good(WHAT, format!("more than {needed} MiB are free")),
        Err(error) => Finding::bad(WHAT, format!("{SHM}: {error}; mount a writable tmpfs there")),
    }
}

/// Checks for leftovers of killed groups.
fn left_behind(paths: &GroupPaths) -> Finding {
    const WHAT: &str = "leftovers";
    let groups = groups(paths.home());
    let dead = |group: &&GroupPaths| {
        let traces = group.run().exists() || !shm_cleanup::leftovers(group).is_empty();
        traces && !leftovers::some_service_lives(group) && !up::is_running(group).unwrap_or(true)
    };
    let dead: Vec<&str> = groups.iter().filter(dead).map(|group| group.name().as_str()).collect();
    match dead.as_slice() {
        [] => Finding::good(WHAT, format!("none of {}", scene::count(groups.len(), "group"))),
        [first, ..] => {
            let help = format!("help: remove them with `whichone down --group {first}`");
            Finding::poor(WHAT, format!("of killed groups: {}; {help}", dead.join(", ")))
        }
    }
}

fn groups(home: &Path) -> Vec<GroupPaths> {
    let entries = fs::read_dir(home).into_iter().flatten().flatten();
    let name = |path: PathBuf| GroupName::new(path.file_name()?.to_str()?).ok();
    let names = entries.filter_map(|entry| name(entry.path()));
    names.filter_map(|name| GroupPaths::in_home(home, &name).ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::super::lab;
    use super::*;

    #[test]
    fn doctor_finds_the_leftovers_of_a_killed_group() {
        let (_home, paths) = lab();
        assert_eq!(left_behind(&paths).note, "none of 0 groups");
        fs::create_dir_all(paths.run()).unwrap();
        let finding = left_behind(&paths);
        assert_eq!(finding.state, Condition::Poor);
        assert!(finding.note.contains("whichone down --group lab"), "{}", finding.note);
    }

    #[test]
    fn doctor_reports_a_folder_that_cannot_be_written() {
        let (home, paths) = lab();
        assert_eq!(folder(&paths).state, Condition::Good);
        let file = home.path().join("file");
        fs::write(&file, "").unwrap();
        let inside = GroupPaths::in_home(&file, &"lab".parse().unwrap()).unwrap();
        let finding = folder(&inside);
        assert_eq!(finding.state, Condition::Bad);
        assert!(finding.note.contains("WHICHONE_HOME"), "{}", finding.note);
    }
}
