//! Fault injection into a running simulated robot, and what people do at its table: for people and tests.

use config::Settings;
use messages::robot::{Drill, DrillKind};
use messages::topics::robot;
use scene::ObjectId;
use service::Span;
use service::bus::Writer;
use service::client::{Client, random_key};
use service::exit::{Exit, Failure};
use service::group::{ENV_GROUP, GroupName, GroupPaths};
use std::f64::consts::TAU;
use std::process::ExitCode;

/// Duration and interval of sending a drill; a repeated one takes effect once.
const SENT_FOR: Span = Span::from_ms(600);
const SENT_EVERY: std::time::Duration = std::time::Duration::from_millis(50);
/// Farthest coordinate at which a person puts an object, metres.
const FAR_M: f64 = 2.0;

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
        "put" => DrillKind::Put,
        "take" => DrillKind::Take,
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
    let usage = |e: service::group::GroupError| Failure::new(Exit::Usage, e.to_string());
    let name = std::env::var(ENV_GROUP).unwrap_or_else(|_| GroupName::DEFAULT.to_owned());
    let name = GroupName::new(&name);
    let paths = GroupPaths::resolve(&name.map_err(usage)?).map_err(usage)?;
    let mut drill = drill(kind, arguments, || Ok(Settings::load_snapshot(&paths.run())?))?;
    let reached = |e: &dyn std::fmt::Display| Failure::new(Exit::NotReached, e.to_string());
    let client = Client::join(&paths).map_err(|e| reached(&e))?;
    let writer: Writer<Drill> = client.bus().writer(&robot::DRILL).map_err(|e| reached(&e))?;
    let mut key = [0; 8];
    key.copy_from_slice(&random_key().0[..8]);
    drill.key = u64::from_le_bytes(key);
    let until = service::clock::now() + SENT_FOR;
    while service::clock::now() < until {
        writer.send(&drill).map_err(|e| reached(&e))?;
        std::thread::sleep(SENT_EVERY);
    }
    Ok(())
}

/// Returns the drill of that kind. `settings` are those of the group, which know its objects.
fn drill(
    kind: DrillKind,
    arguments: &[String],
    settings: impl FnOnce() -> Result<Settings, Failure>,
) -> Result<Drill, Failure> {
    let drill = Drill { kind: kind.code(), ..Drill::default() };
    match kind {
        DrillKind::Silence | DrillKind::Miss | DrillKind::Obstruct => match arguments {
            [text] => Ok(Drill { amount: amount(text)?, ..drill }),
            _ => Err(usage("expected one number after the drill; help: give seconds or a count")),
        },
        DrillKind::Put | DrillKind::Take => by_hand(drill, arguments, &settings()?),
        _ if arguments.is_empty() => Ok(drill),
        _ => Err(usage("unexpected argument; help: this drill takes none")),
    }
}

/// Completes a drill in which a person puts or takes an object.
fn by_hand(drill: Drill, arguments: &[String], settings: &Settings) -> Result<Drill, Failure> {
    let (name, numbers) = match (drill.kind.get(), arguments) {
        (DrillKind::Take, [name]) => (name, &[][..]),
        (DrillKind::Put, [name, numbers @ ..]) if (2..=4).contains(&numbers.len()) => {
            (name, numbers)
        }
        (DrillKind::Put, _) => return Err(usage("expected put OBJECT X Y [Z [YAW]]")),
        _ => return Err(usage("expected take OBJECT")),
    };
    let scene = &settings.scene;
    let object = scene.object_named(name);
    let placed = object.and_then(|it| Some((it, scene.object(it).placement?)));
    let Some((ObjectId(object), known)) = placed else {
        let names: Vec<_> = scene.objects().iter().map(|it| it.name.as_str()).collect();
        let names = names.join(", ");
        return Err(usage(format!("no object `{name}` with a size; help: name one of {names}")));
    };
    let on_table = settings.arm.motion.table_z_m + known.size[2] / 2.0;
    let mut place = [0.0, 0.0, on_table, known.yaw];
    for (axis, text) in numbers.iter().enumerate() {
        let most = if axis < 3 { FAR_M } else { TAU };
        let number = text.parse().ok().filter(|n: &f64| n.abs() <= most);
        place[axis] = number.ok_or_else(|| {
            let help = "give metres in frame `base`, at most 2, and radians, at most 2π";
            usage(format!("invalid coordinate {text}; help: {help}"))
        })?;
    }
    Ok(Drill { scene_key: scene.key(), place, object, ..drill })
}

fn amount(text: &str) -> Result<f64, Failure> {
    let number = text.parse().ok().filter(|n: &f64| n.is_finite() && *n >= 0.0);
    number.ok_or_else(|| usage(format!("invalid amount {text}; help: give a number, e.g. 1.5")))
}

fn usage(what: impl Into<String>) -> Failure {
    Failure::new(Exit::Usage, what.into())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    fn read(words: &[&str]) -> Result<Drill, String> {
        let config = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config"));
        let settings = || Ok(Settings::load(config, Some("camera"), &[]).unwrap());
        let arguments: Vec<String> = words[1..].iter().map(|word| (*word).to_owned()).collect();
        drill(kind(words[0]).unwrap(), &arguments, settings).map_err(|failure| failure.to_string())
    }

    #[test]
    fn objects_are_put_on_the_table_unless_a_height_is_given() {
        let put = read(&["put", "white", "0.65", "0.25"]).unwrap();
        assert_eq!((put.object, put.place), (0, [0.65, 0.25, -0.155 + 0.025, 0.0]));
        let put = read(&["put", "metal", "0.7", "-0.4", "0.1", "1.5"]).unwrap();
        assert_eq!((put.object, put.place), (3, [0.7, -0.4, 0.1, 1.5]));
        let take = read(&["take", "clear"]).unwrap();
        assert_eq!((take.object, take.kind.get()), (5, DrillKind::Take));
        assert_ne!(take.scene_key, 0);
    }

    #[test]
    fn wrong_arguments_are_refused_with_help() {
        for (words, part) in [
            (&["put", "white", "0.65"][..], "put OBJECT X Y"),
            (&["put", "teapot", "0.6", "0.1"], "name one of white, white2"),
            (&["put", "white", "0.6", "NaN"], "coordinate NaN"),
            (&["put", "white", "0.6", "25"], "coordinate 25"),
            (&["take"], "take OBJECT"),
            (&["miss"], "one number"),
            (&["silence", "-1"], "amount -1"),
            (&["fail", "now"], "takes none"),
        ] {
            let failure = read(words).unwrap_err();
            assert!(failure.contains(part), "{words:?}: {failure}");
        }
    }
}
