//! `status`: the state of a group for operators.

use command_line::Outcome;
use command_line::output::{Ink, Output, Style, table};
use messages::PromptId;
use serde::Serialize;
use service::console_link;
use service::control::CallError;
use service::exit::Exit;
use service::group::{GroupName, GroupPaths};
use service::launch;
use service::status::{GroupState, GroupStatus, ServiceState, ServiceStatus};
use service::view::HearingView;

use super::conversation::glance;
use super::operate::status_of;
use super::{hearing, words};

/// Shows the group. The exit code is 0 if every service that is wanted up is ready.
pub(super) fn status(paths: &GroupPaths, out: &mut Output<'_>) -> Outcome {
    let status = match status_of(paths) {
        Ok(status) => status,
        Err(CallError::NoGroup(_)) => return down(paths, out),
        Err(other) => return Err(other.into()),
    };
    // Policy and speech state theirs each by itself.
    let latest = glance(paths, |it| it.view.is_some() && it.hearing.is_some()).unwrap_or_default();
    let hearing = latest.hearing;
    if out.is_json() {
        out.json(&Printed {
            status: &status,
            console: console_link::address(paths),
            hearing: hearing.as_ref().map(HearingView::new),
            prompt: latest.view.is_some().then(|| latest.prompt()),
        })?;
    } else {
        let mut lines = lines(&status, out.style());
        let console = console_link::address(paths);
        lines.extend(console.map(|url| format!("console {url} (log in: whichone console)")));
        lines.extend(hearing.map(|hearing| hearing::line(&hearing, out.style())));
        for line in lines {
            out.line(line)?;
        }
    }
    Ok(if status.state == GroupState::Ready { Exit::Ok } else { Exit::NotReached })
}

/// A running group with `--json`.
#[derive(Serialize)]
struct Printed<'a> {
    #[serde(flatten)]
    status: &'a GroupStatus,
    console: Option<String>,
    hearing: Option<HearingView<'a>>,
    /// The robot's latest line, which `say --seen` names.
    prompt: Option<PromptId>,
}

/// A group that is not running yet or any more, with `--json`.
#[derive(Serialize)]
struct Down<'a> {
    name: &'a GroupName,
    state: &'static str,
    services: [(); 0],
}

fn down(paths: &GroupPaths, out: &mut Output<'_>) -> Outcome {
    let (name, supervisor) = (paths.name(), launch::holder(paths));
    if out.is_json() {
        let state = if supervisor.is_some() { "starting" } else { "down" };
        out.json(&Down { name, state, services: [] })?;
    } else if let Some(supervisor) = supervisor {
        out.line(format_args!(
            "group {name} is starting: supervisor {supervisor} checks the configuration"
        ))?;
    } else {
        out.line(CallError::NoGroup(name.to_string()))?;
    }
    Ok(Exit::NotReached)
}

/// The group in a line and each service in one, with the end of the log of those that are held.
pub(super) fn lines(status: &GroupStatus, style: Style) -> Vec<String> {
    let heads = ["SERVICE", "STATE", "PID", "UP", "STARTS", "BEAT", "INPUT", "MEMORY", "NOTE"];
    let rows: Vec<Vec<String>> = status.services.iter().map(row).collect();
    let mut lines = vec![head(status, style)];
    let mut table = table(&heads, &rows).into_iter();
    lines.extend(table.next().map(|heads| style.paint(Ink::Dim, heads).to_string()));
    for (service, line) in status.services.iter().zip(table) {
        lines.push(coloured(service, line, style));
        let tail = service.log_tail.iter();
        lines.extend(tail.map(|line| format!("    {}", style.paint(Ink::Dim, line))));
    }
    lines
}

fn head(status: &GroupStatus, style: Style) -> String {
    let (ink, state) = group_state(status.state);
    let state = style.paint(ink, state);
    let mut head = format!(
        "group {} is {state}: scene {}, up {}, supervisor {}, configuration {}",
        style.paint(Ink::Bold, &status.name),
        status.scene,
        words::time(status.uptime_s),
        status.supervisor_pid,
        status.config.display(),
    );
    if let Some(profile) = &status.profile {
        head += &format!(" with profile {profile}");
    }
    if status.orphans_killed > 0 {
        let orphans = scene::count(status.orphans_killed, "orphan");
        head += &format!(", {orphans} killed");
    }
    head
}

fn row(service: &ServiceStatus) -> Vec<String> {
    let or_dash = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
    let age = |ms: Option<u64>| or_dash(ms.map(|ms| words::time(ms as f64 / 1e3)));
    vec![
        service.name.clone(),
        service.state.word().to_owned(),
        or_dash(service.pid.map(|pid| pid.to_string())),
        or_dash(service.uptime_s.map(words::time)),
        service.incarnation.to_string(),
        age(service.beat_age_ms),
        age(service.input_age_ms),
        or_dash(service.rss_kib.map(words::memory)),
        remarks(service),
    ]
}

fn remarks(service: &ServiceStatus) -> String {
    let swapped = service.swapped.as_ref().map(|command| format!("swapped: {}", command.join(" ")));
    let exit = service
        .last_exit
        .as_ref()
        .map(|exit| format!("last ended {} ago with {}", words::time(exit.age_s), exit.text));
    let rejected = (service.rejected > 0)
        .then(|| format!("{} rejected", scene::count(service.rejected, "message")));
    let help = service.help().map(|help| format!("help: {help}"));
    let remarks = [service.why.clone(), service.says.clone(), swapped, rejected, exit, help];
    remarks.into_iter().flatten().collect::<Vec<_>>().join("; ")
}

/// Only services that are not in their wanted state are coloured.
fn coloured(service: &ServiceStatus, line: String, style: Style) -> String {
    match state_ink(service.state) {
        Ink::Green => line,
        ink => style.paint(ink, line).to_string(),
    }
}

/// A group's state in a word, with its colour.
pub(super) fn group_state(state: GroupState) -> (Ink, &'static str) {
    match state {
        GroupState::Ready => (Ink::Green, "ready"),
        GroupState::Starting => (Ink::Yellow, "starting"),
        GroupState::Stopping => (Ink::Yellow, "stopping"),
        GroupState::Degraded => (Ink::Red, "degraded"),
    }
}

/// Colour of a state: red is for failures only.
pub(super) fn state_ink(state: ServiceState) -> Ink {
    match state {
        ServiceState::Ready => Ink::Green,
        ServiceState::Failed => Ink::Red,
        ServiceState::Down => Ink::Dim,
        ServiceState::Held => Ink::Cyan,
        ServiceState::Waiting
        | ServiceState::Starting
        | ServiceState::Stopping
        | ServiceState::Restarting
        | ServiceState::Short => Ink::Yellow,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn status_shows_the_reason_for_a_failed_service_and_the_way_out() {
        let service = json!({
            "name": "policy", "wanted": "up", "actual": "held", "state": "failed", "why": "5 exits in a short time",
            "incarnation": 5, "restarts": 4, "log_tail": ["it broke"],
            "last_exit": {"incarnation": 5, "exit": {"code": 1}, "failure": null, "killed": false,
                          "age_s": 2.0, "text": "exit 1"},
        });
        let status = json!({
            "name": "lab", "state": "degraded", "supervisor_pid": 7, "version": "0", "epoch": 1,
            "uptime_s": 61.0, "scene": "bowls", "profile": "ci", "config": "/c",
            "strays_killed": 1, "services": [service],
        });
        let status = serde_json::from_value(status).unwrap();
        let printed = lines(&status, Style::default());
        assert_eq!(
            printed,
            [
                "group lab is degraded: scene bowls, up 1 min 1 s, supervisor 7, configuration /c \
                 with profile ci, 1 orphan killed",
                "SERVICE  STATE   PID  UP  STARTS  BEAT  INPUT  MEMORY  NOTE",
                "policy   failed  -    -   5       -     -      -       5 exits in a short time; \
                 last ended 2.0 s ago with exit 1; help: whichone logs policy, then start policy",
                "    it broke",
            ]
        );
    }
}
