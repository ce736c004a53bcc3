//! `scene show`: the objects with their words and places, and which arm fetches what.

use command_line::Outcome;
use command_line::output::{Output, note, table};
use config::Settings;
use language::word_findings;
use preflight::{ArmSetup, Arrangement};
use scene::{ObjectId, Scene, Value};
use scene_editing::misunderstood;
use serde_json::{Value as Json, json};
use service::exit::{Exit, Failure};

use super::{examine, read};
use crate::args::SceneShowArgs;

/// Which arm fetches an object, or why none does; none without a place.
type Reach = Option<Result<String, String>>;

/// Prints the scene.
pub(super) fn show(args: &SceneShowArgs, out: &mut Output<'_>) -> Outcome {
    let file = args.scene.as_ref().map(|scene| read(scene, &args.config)).transpose()?;
    let settings = examine(&args.config, file.map(|(_, file)| file))?;
    let (scene, reach) = (&settings.scene, reach(&settings)?);
    if out.is_json() {
        out.json(&to_json(&settings, &reach))?;
        return Ok(Exit::Ok);
    }
    let objects = scene::count(scene.objects().len(), scene.noun());
    out.line(format_args!("{}: {objects} ({})", scene.name(), settings.scene_file().label))?;
    let rows: Vec<Vec<String>> =
        (0..scene.objects().len()).map(|n| row(scene, n, &reach[n])).collect();
    for line in table(&["OBJECT", "IN WORDS", "X Y Z, m", "SIZE, mm", "ARM"], &rows) {
        out.line(format_args!("  {line}"))?;
    }
    for attribute in scene.attributes() {
        out.line(also(&attribute.name, &attribute.synonyms))?;
        let rows: Vec<Vec<String>> = attribute.values.iter().map(value_row).collect();
        for line in table(&["VALUE", "ROLE", "SPOKEN", "OTHER WORDS"], &rows) {
            out.line(format_args!("  {line}"))?;
        }
    }
    for (object, reach) in scene.objects().iter().zip(&reach) {
        if let Some(Err(why)) = reach {
            note(format_args!(
                "`{}` cannot be fetched: {why}; help: whichone scene check",
                object.name
            ));
        }
    }
    let (problems, warnings) = misunderstood(scene, settings.scene_file(), word_findings);
    problems.iter().for_each(|problem| note(format_args!("{problem}")));
    warnings.iter().for_each(|text| note(format_args!("warning: {text}")));
    Ok(Exit::Ok)
}

/// Which arm fetches each object.
fn reach(settings: &Settings) -> Result<Vec<Reach>, Failure> {
    let setup = ArmSetup::new(settings)?;
    let placed: Vec<ObjectId> = settings.scene.placed().collect();
    let pose = |i: &ObjectId| settings.scene.object(*i).placement.as_ref().map(preflight::pose);
    let arrangement = Arrangement::new(&setup, placed.iter().filter_map(pose).collect());
    let mut reach: Vec<Reach> = vec![None; settings.scene.objects().len()];
    for (i, object) in placed.iter().enumerate() {
        let limb = arrangement.limb(i);
        let limb = limb.map(|limb| setup.robot.arm(limb).name.clone());
        reach[object.index()] = Some(limb.map_err(|error| error.to_string()));
    }
    Ok(reach)
}

fn row(scene: &Scene, n: usize, reach: &Reach) -> Vec<String> {
    let object = &scene.objects()[n];
    let (place, size) = match &object.placement {
        None => ("-".to_owned(), "-".to_owned()),
        Some(placement) => {
            let [x, y, z] = placement.xyz;
            let [length, width, height] = placement.size.map(|m| m * 1e3);
            (format!("{x:.3} {y:.3} {z:.3}"), format!("{length:.0}×{width:.0}×{height:.0}"))
        }
    };
    let arm = match reach {
        None => "-",
        Some(Ok(limb)) => limb,
        Some(Err(_)) => "none",
    };
    vec![object.name.clone(), scene.describe(n.into()), place, size, arm.to_owned()]
}

fn value_row(value: &Value) -> Vec<String> {
    let role = json!(value.role()).as_str().unwrap_or_default().to_owned();
    vec![value.name.clone(), role, value.spoken.clone(), value.synonyms.join(", ")]
}

fn also(name: &str, synonyms: &[String]) -> String {
    if synonyms.is_empty() { name.to_owned() } else { format!("{name} ({})", synonyms.join(", ")) }
}

fn to_json(settings: &Settings, reach: &[Reach]) -> Json {
    let scene = &settings.scene;
    let mut json = scene.to_json();
    let objects = json["objects"].as_array_mut().into_iter().flatten();
    for ((n, object), reach) in objects.enumerate().zip(reach) {
        object["words"] = json!(scene.describe(n.into()));
        object["arm"] = json!(reach.as_ref().and_then(|reach| reach.as_ref().ok()));
        object["problem"] = json!(reach.as_ref().and_then(|reach| reach.as_ref().err()));
    }
    let value = |value: &Value| {
        json!({ "name": value.name, "role": value.role(), "spoken": value.spoken,
                "synonyms": value.synonyms })
    };
    let attributes = scene.attributes().iter().map(|attribute| {
        let values: Vec<Json> = attribute.values.iter().map(value).collect();
        json!({ "name": attribute.name, "synonyms": attribute.synonyms, "values": values })
    });
    json!({
        "name": scene.name(), "noun": scene.noun(), "file": settings.scene_file().label,
        "objects": json["objects"], "attributes": attributes.collect::<Vec<_>>(),
        "warnings": misunderstood(scene, settings.scene_file(), word_findings).1,
    })
}
