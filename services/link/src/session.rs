//! Sessions with the router. QUIC, never the library's TLS links: those share a connection between
//! two tasks without a lock (eclipse-zenoh/zenoh#2557).

use std::path::Path;
use std::time::Duration;

use serde_json::{Value, json};
use service::exit::{Exit, Failure};
use zenoh::qos::{CongestionControl, Priority};
use zenoh::query::{Query, Reply};
use zenoh::{Config, Session, Wait};

use crate::identity::{AUTHORITY, CERTIFICATE, Identity, KEY, Role, absolute};
use crate::names::{Call, Keys};

/// Time without any message after which a connection counts as lost, milliseconds.
const LEASE_MS: u32 = 3_000;
/// Timeout for a connection of a robot or the router, milliseconds. A whole fleet asks a restarted
/// router: with the library's 10 s no robot of 1,000 came back within 300 s (`scripts/fleet`).
pub(crate) const OPEN_MS: u32 = 60_000;
/// As [`OPEN_MS`], for a person, who waits for it, milliseconds.
const PERSONS_OPEN_MS: u32 = 10_000;
/// Bytes that are sent at once: an urgent message waits for no more than that.
const BATCH_BYTES: u32 = 4_096;
/// Timeout of the router's goodbye.
const CLOSE_PATIENCE: Duration = Duration::from_millis(500);
/// First and longest pause before the next attempt to connect.
const PAUSE: (Duration, Duration) = (Duration::from_millis(500), Duration::from_secs(5));

/// Settings of every link; `keys` is the owner's folder.
pub(crate) fn transport(keys: &Path) -> Value {
    let file = |name: &str| keys.join(name).display().to_string();
    json!({
        "link": {
            "protocols": ["quic"],
            "tx": { "lease": LEASE_MS, "keep_alive": 4, "batch_size": BATCH_BYTES },
            "rx": { "max_message_size": 16 << 20 },
            "tls": {
                "root_ca_certificate": file(AUTHORITY),
                "enable_mtls": true,
                "verify_name_on_connect": true,
                "close_link_on_expiration": true,
                "connect_certificate": file(CERTIFICATE),
                "connect_private_key": file(KEY),
                "listen_certificate": file(CERTIFICATE),
                "listen_private_key": file(KEY),
            },
        },
    })
}

fn config(identity: &Identity, keys: &Path) -> Result<Config, Failure> {
    let mut transport = transport(&absolute(keys));
    let password = &identity.password;
    transport["auth"] = json!({ "usrpwd": { "user": identity.user(), "password": password } });
    let open_ms = if identity.role == Role::Robot { OPEN_MS } else { PERSONS_OPEN_MS };
    transport["unicast"] = json!({ "open_timeout": open_ms });
    let config = json!({
        "mode": "client",
        "connect": {
            "endpoints": [format!("quic/{}", identity.router)],
            "timeout_ms": 0,
            "exit_on_failure": true,
            "retry": { "period_init_ms": 200, "period_max_ms": 1_000, "period_increase_factor": 2 },
        },
        "scouting": { "multicast": { "enabled": false }, "gossip": { "enabled": false } },
        "transport": transport,
    });
    Config::from_json5(&config.to_string())
        .map_err(|error| Failure::new(Exit::Config, format!("{}: {error}", keys.display())))
}

/// Connects once.
///
/// # Errors
/// The router does not answer, or refuses these keys.
pub fn connect(identity: &Identity, keys: &Path) -> Result<Session, Failure> {
    zenoh::open(config(identity, keys)?).wait().map_err(|error| {
        let Identity { router, .. } = identity;
        let what = format!(
            "router {router}, as {}: no connection ({error}); help: see that it runs and knows these keys \
             ({})",
            identity.user(),
            keys.display()
        );
        Failure::new(Exit::NotReached, what)
    })
}

/// Connects, trying again until it succeeds or `is_ending` says that it is not wanted any more. A
/// connection that is lost later is made again by the library.
pub(crate) fn connect_patiently(
    identity: &Identity,
    keys: &Path,
    is_ending: &dyn Fn() -> bool,
) -> Option<Session> {
    let (mut pause, longest) = PAUSE;
    let mut reported = String::new();
    while !is_ending() {
        match connect(identity, keys) {
            Ok(session) => {
                tracing::info!(router = identity.router, "connected");
                return Some(session);
            }
            Err(error) => {
                let error = error.to_string();
                if error != reported {
                    tracing::warn!("{error}; trying again");
                    reported = error;
                }
            }
        }
        let mut left = pause;
        while !left.is_zero() && !is_ending() {
            let step = left.min(Duration::from_millis(100));
            std::thread::sleep(step);
            left -= step;
        }
        pause = (pause * 2).min(longest);
    }
    None
}

/// Makes a request; `take` gets each answer, on a thread of the library, and must not wait. It is
/// dropped when the request has ended, answered or not.
pub fn request(
    session: &Session,
    keys: &Keys,
    call: Call,
    payload: Vec<u8>,
    timeout: Duration,
    take: impl Fn(Vec<u8>) + Send + Sync + 'static,
) {
    let priority = match call {
        Call::Motion => Priority::RealTime,
        Call::Say => Priority::InteractiveLow,
        Call::Presence | Call::Hello | Call::Line => Priority::DataHigh,
    };
    request_at(session, keys, (call, priority), payload, timeout, take);
}

/// As [`request`], at a priority. Each priority has a stream of its own.
pub(crate) fn request_at(
    session: &Session,
    keys: &Keys,
    (call, priority): (Call, Priority),
    payload: Vec<u8>,
    timeout: Duration,
    take: impl Fn(Vec<u8>) + Send + Sync + 'static,
) {
    let answered = move |reply: Reply| {
        if let Ok(sample) = reply.result() {
            take(sample.payload().to_bytes().into_owned());
        }
    };
    let asked = session
        .get(keys.call(call))
        .payload(payload)
        .priority(priority)
        // Requests that find no room are repeated.
        .congestion_control(CongestionControl::Drop)
        .timeout(timeout)
        .callback(answered)
        .wait();
    if let Err(error) = asked {
        tracing::debug!(%error, ?call, "not asked");
    }
}

/// Answers a request. It may wait for room, so only a thread with no other work may answer.
pub(crate) fn reply(query: &Query, bytes: Vec<u8>, keys: &Keys, call: Call) {
    if let Err(error) = query.reply(keys.call(call), bytes).wait() {
        tracing::debug!(%error, ?call, "not answered; it is asked again");
    }
}

/// Drops the holder of a session, which says goodbye to the router without waiting for it.
pub(crate) fn close(holder: impl Send + 'static) {
    let (done, closed) = std::sync::mpsc::channel();
    let close = move || {
        drop(holder);
        // Nobody listens any more if it took too long.
        let _ = done.send(());
    };
    if std::thread::Builder::new().name("close".into()).spawn(close).is_ok() {
        let _ = closed.recv_timeout(CLOSE_PATIENCE);
    }
}
