//! Fault injection into a running simulated robot, for people and tests.

use messages::robot::{Drill, DrillKind};
use messages::topics::robot;
use service::Span;
use service::bus::Writer;
use service::client::{Client, random_key};
use service::exit::{Exit, Failure};
use service::group::{ENV_GROUP, GroupName, GroupPaths};
use std::process::ExitCode;

/// Duration and interval of sending a drill; a repeated one takes effect once.
const SENT_FOR: Span = Span::from_ms(600);
const SENT_EVERY: std::time::Duration = std::time::Duration::from_millis(50);

/// Returns the drill of that name.
pub fn kind(word: &str) -> Option<DrillKind> {
    Some(match word {
        "enable" => DrillKind::Enable,
        "disable" => DrillKind::Disable,
        "reset" => DrillKind::Reset,
        "press-estop" => DrillKind::PressEstop,
        "release-estop" => DrillKind::ReleaseEstop,
        "fail" => DrillKind::Fail,
        "silence" => DrillKind::Silence,
        "miss" => DrillKind::Miss,
        "obstruct" => DrillKind::Obstruct,
        _ => return None,
    })
}

/// Sends the drill to the robot of the group that the environment names.
pub fn run(kind: DrillKind, arguments: &[String]) -> ExitCode {
    let _log = service::logging::init();
    match send(kind, arguments) {
        Ok(()) => Exit::Ok.code(),
        Err(failure) => {
            tracing::error!(exit = failure.exit as u8, "{failure}");
            failure.exit.code()
        }
    }
}

fn send(kind: DrillKind, arguments: &[String]) -> Result<(), Failure> {
    let amount = amount(kind, arguments)?;
    let usage = |e: service::group::GroupError| Failure::new(Exit::Usage, e.to_string());
    let name = std::env::var(ENV_GROUP).unwrap_or_else(|_| GroupName::DEFAULT.to_owned());
    let name = GroupName::new(&name);
    let paths = GroupPaths::resolve(&name.map_err(usage)?).map_err(usage)?;
    let reached = |e: &dyn std::fmt::Display| Failure::new(Exit::NotReached, e.to_string());
    let client = Client::join(&paths).map_err(|e| reached(&e))?;
    let writer: Writer<Drill> = client.bus().writer(&robot::DRILL).map_err(|e| reached(&e))?;
    let mut key = [0; 8];
    key.copy_from_slice(&random_key().0[..8]);
    let key = u64::from_le_bytes(key);
    let drill = Drill { key, amount, kind: kind.code(), ..Drill::default() };
    let until = service::clock::now() + SENT_FOR;
    while service::clock::now() < until {
        writer.send(&drill).map_err(|e| reached(&e))?;
        std::thread::sleep(SENT_EVERY);
    }
    Ok(())
}

fn amount(kind: DrillKind, arguments: &[String]) -> Result<f64, Failure> {
    let needed = matches!(kind, DrillKind::Silence | DrillKind::Miss | DrillKind::Obstruct);
    let number = |text: &String| text.parse().ok().filter(|n: &f64| n.is_finite() && *n >= 0.0);
    match arguments {
        [] if !needed => Ok(0.0),
        [text] if needed => number(text).ok_or_else(|| {
            Failure::new(
                Exit::Usage,
                format!("invalid amount {text}; help: give a number, e.g. 1.5"),
            )
        }),
        _ if needed => Err(Failure::new(
            Exit::Usage,
            "expected a number after the drill; help: give seconds or a count",
        )),
        _ => Err(Failure::new(Exit::Usage, "unexpected argument: this drill takes none")),
    }
}
