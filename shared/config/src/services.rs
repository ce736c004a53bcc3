//! `[services.NAME]` of `group.toml`.

use std::time::Duration;

use diagnostics::{Fields, Node, Report, Source, Table, suggestion};
use messages::{SUPERVISOR, Service, Topic, topics};
use serde_json::json;

use crate::files::one_of;
use crate::part;

/// Defaults of a service.
const EACH: &str = r#"
after = []
reads = []
writes = []
critical = false
observer = false
start_deadline_s = 10.0
watchdog_s = 3.0
stop_deadline_s = 5.0
nice = 0
restart = "always"
"#;

/// Longest name of a service: it is part of a socket's path, which must be short.
const NAME_LEN_MAX: usize = 19;

/// One service as configured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ServiceConfig {
    /// Unique name: 1 to 19 of `a–z 0–9 -`.
    pub name: String,
    /// Program and arguments. `None`, for services that ship only: the program `whichone-NAME` next
    /// to this one.
    pub command: Option<Vec<String>>,
    /// Services that must be ready before this one is started for the first time. When the group
    /// stops, they are stopped only once this one has ended.
    pub after: Vec<String>,
    /// Topics that wake this service in addition to those of its own table.
    pub reads: Vec<String>,
    /// Topics that this service writes: those of clients, and its own, `NAME/…`.
    pub writes: Vec<String>,
    /// Stop the whole group when this service is held.
    pub critical: bool,
    /// The group is whole and ready without this service.
    pub observer: bool,
    /// Time from start to readiness.
    pub start_deadline: Duration,
    /// Maximum time between two heartbeats once ready; `None` without a watchdog.
    pub watchdog: Option<Duration>,
    /// Time from the stop request to the kill.
    pub stop_deadline: Duration,
    /// Scheduling niceness, −20 … 19.
    pub nice: i32,
    /// Exits that are followed by a restart.
    pub restart: Restart,
}

/// Exits that are followed by a restart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Restart {
    /// Every unexpected exit, even a clean one.
    Always,
    /// Every exit but a clean one (code 0).
    OnFailure,
    /// None.
    Never,
}

/// Completes every service of `group` with the defaults.
pub(crate) fn complete(group: &mut Table, report: &mut Report) {
    let source = Source::built_in();
    let each = Table::parse(EACH, &source, report).expect("the defaults are TOML");
    for (name, node) in &mut group.table_at("services").entries {
        if let Node::Table(service) = node {
            let own = std::mem::replace(service, each.clone());
            let mut path = ["group", "services", name].map(str::to_owned).to_vec();
            service.source = own.source.clone();
            service.merge(own, &mut path, report);
        }
    }
}

pub(crate) fn read(f: &mut Fields<'_>) -> Vec<ServiceConfig> {
    let services = f.each("services", |name, f| {
        check_name(name, f);
        one(name, f)
    });
    f.note("services", || {
        let others = NAME_LEN_MAX - 1;
        json!({ "propertyNames": { "pattern": format!("^[a-z0-9][a-z0-9-]{{0,{others}}}$") } })
    });
    check_order(&services, f);
    check_topics(&services, f);
    services
}

fn one(name: &str, f: &mut Fields<'_>) -> ServiceConfig {
    let command = f.optional_command("command");
    let knows_its_program = Service::from_name(name).is_some() || part::has_program(name);
    if command.is_none() && !f.is_wrong("command") && !knows_its_program {
        let help = "write `command = [\"program\", \"argument\"]`";
        f.problem("command", "missing: only services that ship have a default program", help);
    }
    let watchdog = f.seconds("watchdog_s", 0.0..=3600.0);
    ServiceConfig {
        name: name.to_owned(),
        command,
        after: f.texts("after"),
        reads: f.texts("reads"),
        writes: f.texts("writes"),
        critical: f.flag("critical"),
        observer: f.flag("observer"),
        start_deadline: f.seconds("start_deadline_s", 0.1..=3600.0),
        watchdog: (!watchdog.is_zero()).then_some(watchdog),
        stop_deadline: f.seconds("stop_deadline_s", 0.0..=3600.0),
        nice: f.whole("nice", -20..=19),
        restart: f.choice(
            "restart",
            &[
                ("always", Restart::Always),
                ("on-failure", Restart::OnFailure),
                ("never", Restart::Never),
            ],
        ),
    }
}

fn check_name(name: &str, f: &mut Fields<'_>) {
    let allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    let fits = (1..=NAME_LEN_MAX).contains(&name.len()) && !name.starts_with('-');
    if !fits || !name.chars().all(allowed) {
        let help =
            format!("use 1 to {NAME_LEN_MAX} of a-z, 0-9 and -, beginning with a letter or digit");
        f.problem_at(&[], "not a valid name of a service", help);
    } else if name == SUPERVISOR {
        f.problem_at(&[], "this name is reserved for the supervisor", "choose another one");
    }
}

/// Reports an `after` that names no service, and cycles.
fn check_order(services: &[ServiceConfig], f: &mut Fields<'_>) {
    let names: Vec<&str> = services.iter().map(|service| &*service.name).collect();
    for service in services {
        for missing in service.after.iter().filter(|other| !names.contains(&other.as_str())) {
            let what = format!("there is no service `{missing}`");
            let key = ["services", &service.name, "after"];
            f.problem_at(
                &key,
                what,
                suggestion(missing, names.iter().copied(), || one_of(names.iter().copied())),
            );
        }
    }
    if let Some(cycle) = cycle(services) {
        let names = cycle.iter().chain(&cycle[..1]).copied().collect::<Vec<_>>();
        let what = format!("these services wait for each other: {}", names.join(" after "));
        f.problem_at(&["services", cycle[0], "after"], what, "remove one of them from an `after`");
    }
}

/// Reports topics that a service cannot write, and topics that nobody writes to.
fn check_topics(services: &[ServiceConfig], f: &mut Fields<'_>) {
    let shipped = || topics::ALL.iter().chain(&topics::robot::ALL);
    for service in services {
        for topic in &service.writes {
            let key = ["services", &service.name, "writes"];
            let own = format!("{}/", service.name);
            let writer = Topic::named(topic).map(|topic| topic.writer);
            let of_clients = shipped().filter(|topic| topic.writer.is_none()).map(|it| it.name);
            let help = || {
                format!(
                    "a topic of its own begins with `{own}`; of the others, {}",
                    one_of(of_clients)
                )
            };
            match writer {
                Some(Some(writer)) if writer.name() != service.name => {
                    let what = format!("`{topic}` is written by {} alone", writer.name());
                    f.problem_at(&key, what, help());
                }
                None if !topic.starts_with(&own) || topic.len() == own.len() => {
                    f.problem_at(&key, format!("there is no topic `{topic}`"), help());
                }
                _ => {}
            }
        }
    }
    let own = services.iter().flat_map(|service| &service.writes).map(String::as_str);
    let known: Vec<&str> = shipped().map(|topic| topic.name).chain(own).collect();
    for service in services {
        for missing in service.reads.iter().filter(|topic| !known.contains(&topic.as_str())) {
            let otherwise = || one_of(known.iter().copied());
            let help = suggestion(missing, known.iter().copied(), otherwise);
            let key = ["services", &service.name, "reads"];
            f.problem_at(&key, format!("no service writes a topic `{missing}`"), help);
        }
    }
}

/// Returns a cycle along `after`.
fn cycle(services: &[ServiceConfig]) -> Option<Vec<&str>> {
    let find = |name: &str| services.iter().find(|service| service.name == name);
    let mut done: Vec<&str> = Vec::new();
    for start in services {
        let mut way: Vec<(&ServiceConfig, usize)> = vec![(start, 0)];
        while let Some((service, next)) = way.last_mut() {
            let Some(name) = service.after.get(*next) else {
                done.push(&service.name);
                way.pop();
                continue;
            };
            *next += 1;
            if let Some(from) = way.iter().position(|(service, _)| service.name == *name) {
                return Some(way[from..].iter().map(|(service, _)| &*service.name).collect());
            }
            if !done.contains(&name.as_str()) {
                way.extend(find(name).map(|service| (service, 0)));
            }
        }
    }
    None
}
