//! Lists and changes the objects on the table, where they come from perception.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use command_line::Outcome;
use command_line::output::Output;
use config::Settings;
use messages::{Change, Detection, Sighting, TableView, topics};
use serde_json::{Value as Json, json};
use service::Time;
use service::bus::{EncodedReader, EncodedWriter};
use service::client::{Client, Polling, random_number};
use service::clock;
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::view::quiet;

use crate::args::{ObjectsArgs, ObjectsVerb};
use crate::feed::feed;

/// Interval at which a change is sent until it is answered.
const RESEND_EVERY: Duration = Duration::from_millis(200);

/// The table of a group, as the policy shows it.
struct Tables {
    reader: EncodedReader<TableView>,
    latest: Option<TableView>,
}

/// Lists or changes the objects. `is_up` fails if the policy does nothing for now.
///
/// # Errors
/// The objects are not perceived, the policy does not answer, or a change is refused.
pub fn objects(
    paths: &GroupPaths,
    args: &ObjectsArgs,
    is_up: impl FnOnce() -> Result<(), Failure>,
    out: &mut Output<'_>,
) -> Outcome {
    let client = Client::join(paths)?;
    let settings = Settings::load_snapshot(&paths.run())?;
    if !settings.group.perception.enabled {
        return Err(Failure::new(Exit::Usage, perception::Refusal::Off.to_string()));
    }
    is_up()?;
    let reader = client.bus().encoded_reader(&topics::OBJECTS)?;
    let mut tables = Tables { reader, latest: None };
    // Who only looks writes nothing: each writer that comes and goes has the policy connect once more.
    let sightings = || client.bus().encoded_writer(&topics::SIGHTING);
    let change = match args.what.as_ref().unwrap_or(&ObjectsVerb::List) {
        ObjectsVerb::List => return list(&mut tables, args.timeout, out),
        ObjectsVerb::Feed(args) => return feed(&sightings()?, args, &settings, out),
        ObjectsVerb::Add { class, place, values } => {
            let mut attributes: BTreeMap<String, Vec<(String, f64)>> = BTreeMap::new();
            for (attribute, value, p) in values {
                attributes.entry(attribute.clone()).or_default().push((value.clone(), *p));
            }
            Change::Add(Detection {
                classes: vec![(class.clone(), 1.0)],
                attributes: attributes.into_iter().collect(),
                xyz: place.xyz(),
                yaw: place.yaw,
                ..Detection::default()
            })
        }
        ObjectsVerb::Move { object, place } => {
            Change::Move { object: object.clone(), xyz: place.xyz(), yaw: place.yaw }
        }
        ObjectsVerb::Remove { object } => Change::Remove { object: object.clone() },
    };
    let number = tables.change(&sightings()?, change, args.timeout)?;
    let name = tables.latest.as_ref().and_then(|view| {
        let object = view.objects.iter().find(|it| it.known.number.0 == number);
        object.map(|object| object.known.name.clone())
    });
    if out.is_json() {
        out.json(&json!({ "number": number, "name": name }))?;
    } else {
        out.line(name.unwrap_or_else(|| format!("object {number} is off the table")))?;
    }
    Ok(Exit::Ok)
}

impl Tables {
    fn look(&mut self) {
        if let Some(view) = quiet(self.reader.latest()) {
            self.latest = Some(view);
        }
    }

    /// Sends a change under one key until it is answered. Returns the object's number.
    fn change(
        &mut self,
        sightings: &EncodedWriter<Sighting>,
        change: Change,
        patience: Duration,
    ) -> Result<u16, Failure> {
        let (source, frame) = ("hand".to_owned(), "base".to_owned());
        let sighting = Sighting { key: random_number(), source, frame, change };
        let (until, mut polling) = (Instant::now() + patience, Polling::default());
        let mut sent: Option<Instant> = None;
        while Instant::now() < until {
            if sent.is_none_or(|sent| sent.elapsed() >= RESEND_EVERY) {
                quiet(sightings.send(&sighting).map(Some));
                sent = Some(Instant::now());
            }
            self.look();
            let answers = self.latest.iter().flat_map(|view| &view.answers);
            if let Some(answer) = answers.into_iter().find(|it| it.key == sighting.key) {
                return match answer.refusal.as_str() {
                    "" => Ok(answer.object),
                    refusal => Err(Failure::new(Exit::NotReached, refusal.to_owned())),
                };
            }
            polling.pause();
        }
        Err(Failure::new(Exit::NotReached, "no answer from the policy; help: `whichone status`"))
    }
}

fn list(tables: &mut Tables, patience: Duration, out: &mut Output<'_>) -> Outcome {
    let (until, mut polling) = (Instant::now() + patience, Polling::default());
    tables.look();
    while Instant::now() < until && tables.latest.is_none() {
        polling.pause();
        tables.look();
    }
    let Some(view) = &tables.latest else {
        let what = "nothing from the policy; help: `whichone status`";
        return Err(Failure::new(Exit::NotReached, what));
    };
    if out.is_json() {
        out.json(&json_of(view))?;
        return Ok(Exit::Ok);
    }
    if view.objects.is_empty() {
        out.line("nothing on the table".to_owned())?;
    }
    for object in &view.objects {
        out.line(line(object))?;
    }
    if view.refused > 0 {
        out.line(format!("{} reports refused, the latest: {}", view.refused, view.refusal))?;
    }
    Ok(Exit::Ok)
}

fn line(object: &messages::TableObject) -> String {
    let [x, y, z, yaw] = object.place;
    let chances = |chances: &[(String, f64)]| -> Vec<String> {
        chances.iter().map(|(name, p)| format!("{name} {:.0} %", p * 100.0)).collect()
    };
    let mut all = chances(&object.known.classes);
    for (name, values) in &object.known.attributes {
        all.push(format!("{name}: {}", chances(values).join(", ")));
    }
    let how = match (object.known.taken, object.gone) {
        (true, _) => "  with a person",
        (_, true) => "  gone",
        _ => "",
    };
    let name = &object.known.name;
    format!("{name:<16}  {x:.3} {y:.3} {z:.3} m  {yaw:.2} rad  {}{how}", all.join("; "))
}

fn json_of(view: &TableView) -> Json {
    let now = clock::now();
    let map = |chances: &[(String, f64)]| -> serde_json::Map<String, Json> {
        chances.iter().map(|(name, p)| (name.clone(), json!(p))).collect()
    };
    let objects = view.objects.iter().map(|object| {
        let attributes: serde_json::Map<String, Json> = (object.known.attributes.iter())
            .map(|(name, values)| (name.clone(), json!(map(values))))
            .collect();
        json!({
            "number": object.known.number.0,
            "name": object.known.name,
            "classes": map(&object.known.classes),
            "attributes": attributes,
            "xyz": object.place[..3],
            "yaw": object.place[3],
            "sd": object.sd,
            "age_s": now.since(Time(object.seen_ns)).s(),
            "taken": object.known.taken,
            "gone": object.gone,
        })
    });
    json!({
        "version": view.version,
        "objects": objects.collect::<Vec<_>>(),
        "refused": view.refused,
        "refusal": view.refusal,
    })
}
