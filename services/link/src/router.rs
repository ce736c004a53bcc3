//! The router that robots and people connect to: the library in its router's mode, in this program.
//! Its configuration is one for `zenohd` of the same version, too.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use roster::Name;
use serde_json::{Value, json};
use service::exit::{Exit, Failure};
use zenoh::{Config, Wait};

use crate::identity::{AUTHORITY, Role, absolute};
use crate::keyring::{Member, PORT, Ring, write_private};
use crate::names::{Call, Keys};
use crate::session::{OPEN_MS, close, transport};

const FILE: &str = "router.json";
const PASSWORDS: &str = "passwords";
/// Sessions at a time.
const SESSIONS_MAX: usize = 2_000;

/// Writes the configuration and the passwords into the router's folder.
pub(crate) fn configure(folder: &Path, ring: &Ring) -> Result<(), Failure> {
    let lines =
        ring.members.iter().map(|member| format!("{}:{}\n", member.user(), member.password));
    write_private(&folder.join(PASSWORDS), lines.collect::<String>().as_bytes())?;
    let port = ring.router.rsplit_once(':').and_then(|(_, port)| port.parse().ok()).unwrap_or(PORT);
    let text = serde_json::to_vec_pretty(&json!({
        "mode": "router",
        "listen": {
            "endpoints": [format!("quic/[::]:{port}")],
            // A port that is still taken is tried again.
            "timeout_ms": -1,
            "exit_on_failure": true,
        },
        "scouting": { "multicast": { "enabled": false }, "gossip": { "enabled": false } },
        "access_control": access(&ring.members),
    }));
    let text = text.map_err(|error| Failure::new(Exit::Invariant, error.to_string()))?;
    write_private(&folder.join(FILE), &text)
}

/// Rights of the members; everything else is denied.
fn access(members: &[Member]) -> Value {
    let mut rules = Vec::new();
    let mut subjects = Vec::new();
    let mut policies = Vec::new();
    for member in members {
        let user = member.user();
        let own = match member.role {
            Role::Robot => robot_rules(&user, &Keys::of(&member.name)),
            Role::Operator | Role::Viewer => person_rules(&user, member),
        };
        let names: Vec<Value> = own.iter().map(|rule| rule["id"].clone()).collect();
        subjects.push(json!({
            "id": user,
            "cert_common_names": [user],
            "usernames": [user],
        }));
        policies.push(json!({ "rules": names, "subjects": [user] }));
        rules.extend(own);
    }
    json!({
        "enabled": true,
        "default_permission": "deny",
        "rules": rules,
        "subjects": subjects,
        "policies": policies,
    })
}

fn rule(id: String, keys: &[String], messages: &[&str], flow: &str) -> Value {
    json!({
        "id": id,
        "key_exprs": keys,
        "messages": messages,
        "flows": [flow],
        "permission": "allow",
    })
}

/// Rules of a robot: it publishes under its own name, and gets messages to it.
fn robot_rules(user: &str, keys: &Keys) -> Vec<Value> {
    let shown =
        ["put", "delete", "reply", "declare_queryable", "declare_subscriber", "liveliness_token"];
    let got = ["put", "query", "declare_subscriber"];
    vec![
        rule(format!("{user}-shows"), &[keys.all()], &shown, "ingress"),
        rule(format!("{user}-gets"), &[keys.all()], &got, "egress"),
    ]
}

/// A person sees robots; an operator also commands them. None can speak for a robot.
fn person_rules(user: &str, member: &Member) -> Vec<Value> {
    let one = |name: &Name| Keys::of(name);
    let robots: Vec<Keys> = match member.robots.is_empty() {
        true => vec![Keys::of_all()],
        false => member.robots.iter().map(one).collect(),
    };
    let keys = |key: &dyn Fn(&Keys) -> Vec<String>| -> Vec<String> {
        robots.iter().flat_map(key).collect()
    };
    let all = keys(&|robot| vec![robot.all()]);
    let calls = |call: &Call| member.role == Role::Operator || call.only_reads();
    let calls: Vec<Call> = Call::ALL.into_iter().filter(calls).collect();
    let called = keys(&|robot| calls.iter().map(|call| robot.call(*call)).collect());
    let looks = ["declare_subscriber", "declare_liveliness_subscriber", "liveliness_query"];
    let gets = ["put", "delete", "reply", "liveliness_token", "declare_queryable"];
    let mut rules = vec![
        rule(format!("{user}-looks"), &all, &looks, "ingress"),
        rule(format!("{user}-asks"), &called, &["query"], "ingress"),
        rule(format!("{user}-gets"), &all, &gets, "egress"),
    ];
    if member.role == Role::Operator {
        let sound = keys(&|robot| vec![robot.audio()]);
        rules.push(rule(format!("{user}-talks"), &sound, &["put"], "ingress"));
    }
    rules
}

/// Runs the router until SIGTERM or SIGINT.
///
/// # Errors
/// The folder is not one of a router, or its port cannot be had.
pub fn run(folder: &Path) -> Result<(), Failure> {
    let is_ending = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT] {
        signal_hook::flag::register(signal, Arc::clone(&is_ending))
            .map_err(|error| Failure::new(Exit::NotReached, format!("signals: {error}")))?;
    }
    let folder = absolute(folder);
    let path = folder.join(FILE);
    let bad = |what: &dyn std::fmt::Display| {
        let help = "help: give the folder `router` that `whichone link init` made";
        Failure::new(Exit::Config, format!("{}: {what}; {help}", path.display()))
    };
    let text = safe_files::read_regular(&path).map_err(|error| bad(&error))?;
    let mut config: Value = serde_json::from_str(&text).map_err(|error| bad(&error))?;
    if !folder.join(AUTHORITY).exists() {
        return Err(bad(&format!("{AUTHORITY} is missing beside it")));
    }
    // Only this code knows the folder's place.
    let mut transport = transport(&folder);
    transport["unicast"] = json!({
        "max_sessions": SESSIONS_MAX,
        "accept_pending": SESSIONS_MAX,
        "accept_timeout": OPEN_MS,
    });
    let passwords = folder.join(PASSWORDS).display().to_string();
    transport["auth"] = json!({ "usrpwd": { "dictionary_file": passwords } });
    config["transport"] = transport;
    let config = Config::from_json5(&config.to_string()).map_err(|error| bad(&error))?;
    let session = zenoh::open(config).wait().map_err(|error| bad(&error))?;
    tracing::info!(folder = %folder.display(), "router runs");
    while !is_ending.load(Ordering::Relaxed) {
        std::thread::sleep(Duration::from_millis(100));
    }
    close(session);
    Ok(())
}
