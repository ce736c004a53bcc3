//! JSON Schemas of the configuration files (`config/schemas`), made by the readers of these files.
//! `UPDATE_EXPECT=1 cargo test -p parts schemas` rewrites them.

use std::collections::BTreeMap;
use std::io::Write;
use std::process::{Command, Stdio};

use config::SectionSchema;
use diagnostics::{Node, Report, Source, Table};
use expect_test::expect_file;
use serde_json::{Map, Value as Json, json};

use super::{Folder, sections, shipped};

mod descriptions;

const SCENES_MD: &str = include_str!("../../../../docs/scenes.md");

/// Every schema by the name of its file.
pub(super) fn schemas() -> BTreeMap<String, Json> {
    let mut all = BTreeMap::new();
    for SectionSchema { name, shipped, mut schema } in sections() {
        descriptions::of_file(shipped).put(&mut schema);
        all.insert(name.to_owned(), schema);
    }
    let sections = all.iter().map(|(name, schema)| (name.clone(), schema.clone()));
    let profile = json!({
        "description": "A profile: values over those of the other files of the configuration.",
        "type": "object", "properties": sections.collect::<Map<_, _>>(),
        "additionalProperties": false,
    });
    let mut scene = scene::Scene::schema();
    descriptions::of_scenes(SCENES_MD).put(&mut scene);
    all.insert("profile".to_owned(), profile);
    all.insert("scene".to_owned(), scene);
    all.into_iter()
        .map(|(name, schema)| {
            let mut whole = json!({ "$schema": "http://json-schema.org/draft-07/schema#" });
            whole["title"] = json!(format!("whichone: {name}"));
            whole.as_object_mut().unwrap().extend(schema.as_object().unwrap().clone());
            (name, whole)
        })
        .collect()
}

#[test]
fn schemas_are_those_of_the_readers() {
    for (name, schema) in schemas() {
        let path = shipped().join("schemas").join(format!("{name}.json"));
        expect_file![path].assert_eq(&format!("{schema:#}\n"));
    }
}

/// The editors' convention: a first line `#:schema PATH`, from the file's own folder.
#[test]
fn shipped_files_name_their_schema_in_the_first_line() {
    let mut files: Vec<(std::path::PathBuf, String)> = (sections().iter())
        .map(|SectionSchema { name, .. }| {
            (shipped().join(format!("{name}.toml")), format!("./schemas/{name}.json"))
        })
        .collect();
    for (folder, schema) in [("profiles", "profile"), ("scenes", "scene")] {
        for entry in std::fs::read_dir(shipped().join(folder)).unwrap() {
            files.push((entry.unwrap().path(), format!("../schemas/{schema}.json")));
        }
    }
    for (path, schema) in files {
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(text.lines().next().unwrap(), format!("#:schema {schema}"), "{path:?}");
        assert!(path.parent().unwrap().join(schema).is_file(), "{path:?}");
    }
}

#[test]
fn every_key_outside_of_lists_has_a_description() {
    fn check(schema: &Json, path: &str) {
        for (key, child) in schema["properties"].as_object().into_iter().flatten() {
            let path = format!("{path}.{key}");
            let described = child["description"].as_str();
            assert!(described.is_some_and(|text| text.len() > 5), "{path} has no description");
            check(child, &path);
        }
    }
    for (name, schema) in schemas() {
        match name.as_str() {
            "profile" => continue,
            _ => check(&schema, &name),
        }
    }
    let scene = &schemas()["scene"]["properties"];
    check(&scene["objects"]["items"], "objects");
    check(&scene["attributes"]["items"], "attributes");
}

/// Bounds and choices of the schemas are those that the reader enforces, also where it does so by a
/// check of another crate.
#[test]
fn schemas_have_the_bounds_that_are_enforced() {
    let mut checked = 0;
    for SectionSchema { name, schema, .. } in sections() {
        let file = format!("{name}.toml");
        leaves(&schema, &mut Vec::new(), &mut |path, schema| {
            let key = path.join(".");
            for (value, is_right) in samples(schema) {
                let text = format!("{key} = {value}");
                let folder = Folder::new(&[(&file, &text)]);
                let found = folder.load(None, &[]).err();
                let found = found.iter().flat_map(|found| found.iter()).find(|found| {
                    // Contradictions with other keys are no bounds.
                    let is_bound =
                        found.what.starts_with("expected") || found.what.contains(" is not a");
                    found.key == key && is_bound
                });
                assert_eq!(found.is_none(), is_right, "{file}: {text}: {found:?}");
                checked += 1;
            }
        });
    }
    assert!(checked > 300, "{checked}");
}

/// Visits every value that is neither a table nor a list.
fn leaves(schema: &Json, path: &mut Vec<String>, visit: &mut impl FnMut(&[String], &Json)) {
    for (key, child) in schema["properties"].as_object().into_iter().flatten() {
        path.push(key.clone());
        if child["type"] == "object" {
            leaves(child, path, visit)
        } else {
            visit(path, child)
        }
        path.pop();
    }
}

/// Values at the edge of what a schema allows, as TOML, and whether it does.
fn samples(schema: &Json) -> Vec<(String, bool)> {
    let mut samples = Vec::new();
    let is_whole = schema["type"] == "integer";
    let written = |value: f64| if is_whole { format!("{value:.0}") } else { format!("{value:?}") };
    let step = |value: f64| if is_whole { 1.0 } else { (value.abs() * 0.01).max(1e-9) };
    for (bound, sign) in [("minimum", -1.0), ("maximum", 1.0)] {
        if let Some(value) = schema[bound].as_f64() {
            samples.push((written(value), true));
            samples.push((written(value + sign * step(value)), false));
        }
    }
    for (bound, sign) in [("exclusiveMinimum", -1.0), ("exclusiveMaximum", 1.0)] {
        if let Some(value) = schema[bound].as_f64() {
            samples.push((written(value), false));
            samples.push((written(value - sign * step(value)), true));
        }
    }
    if let Some(names) = schema["enum"].as_array() {
        samples.extend(names.iter().map(|name| (name.to_string(), true)));
        samples.push(("\"zzz\"".to_owned(), false));
    }
    samples
}

/// Every shipped file is accepted by its schema, and every wrong file of the tests is refused, except for
/// those listed in `inexpressible.txt`: what JSON Schema cannot say. By the reference implementation.
#[test]
#[ignore = "needs jsonschema for python3, named in WHICHONE_RECORDING_PYTHON"]
fn schemas_accept_shipped_files_and_refuse_wrong_ones() {
    let mut cases: Vec<(String, String, Json)> = Vec::new();
    for SectionSchema { name, shipped, .. } in sections() {
        cases.push((name.to_owned(), String::new(), instance(shipped).unwrap()));
    }
    for (folder, schema) in [("profiles", "profile"), ("scenes", "scene")] {
        for entry in std::fs::read_dir(shipped().join(folder)).unwrap() {
            let text = read(&entry.unwrap().path());
            cases.push((schema.to_owned(), String::new(), instance(&text).unwrap()));
        }
    }
    let shipped_count = cases.len();
    for (schema, wrong) in [
        (None, include_str!("invalid.txt")),
        (Some("scene"), include_str!("../../../scene/src/invalid.txt")),
    ] {
        for case in wrong.split("--- ").skip(1) {
            let (file, rest) = case.split_once('\n').unwrap();
            let text = rest.split_once("\n+++\n").unwrap().0;
            let schema = schema.unwrap_or_else(|| file.strip_suffix(".toml").unwrap());
            // What is no TOML is nothing for a schema.
            if let Some(instance) = instance(text) {
                cases.push((schema.to_owned(), text.to_owned(), instance));
            }
        }
    }
    let verdicts = verdicts(&cases);
    for ((schema, _, instance), verdict) in cases.iter().zip(&verdicts).take(shipped_count) {
        assert_eq!(verdict.as_str(), "", "{schema}: {instance}");
    }
    let mut accepted = String::new();
    let wrong = cases.iter().zip(&verdicts).skip(shipped_count);
    let refused = wrong.clone().filter(|(_, verdict)| !verdict.is_empty()).count();
    for ((schema, text, _), _) in wrong.filter(|(_, verdict)| verdict.is_empty()) {
        accepted += &format!("--- {schema}\n{text}\n");
    }
    expect_file!["inexpressible.txt"].assert_eq(&accepted);
    println!("{shipped_count} shipped files accepted, {refused} wrong ones refused");
    assert!(refused > 60, "{refused}");
}

fn read(path: &std::path::Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

/// The values of a TOML text; `None` if it is none.
fn instance(text: &str) -> Option<Json> {
    let mut report = Report::default();
    let table = Table::parse(text, &Source::new("", 0), &mut report)?;
    (report.count() == 0).then(|| serde_json::to_value(Node::Table(table)).unwrap())
}

/// The first error that jsonschema finds in each case; empty for none.
fn verdicts(cases: &[(String, String, Json)]) -> Vec<String> {
    const SCRIPT: &str = "
import json, sys, jsonschema
given = json.load(sys.stdin)
checks = {}
for name, schema in given['schemas'].items():
    jsonschema.Draft7Validator.check_schema(schema)
    checks[name] = jsonschema.Draft7Validator(schema)
errors = [next(checks[name].iter_errors(case), None) for name, case in given['cases']]
json.dump(['' if error is None else error.message for error in errors], sys.stdout)
";
    let python = std::env::var("WHICHONE_RECORDING_PYTHON").expect("WHICHONE_RECORDING_PYTHON");
    let given: Vec<Json> = cases.iter().map(|(name, _, case)| json!([name, case])).collect();
    let given = json!({ "schemas": schemas(), "cases": given }).to_string();
    let mut python = Command::new(python)
        .args(["-c", SCRIPT])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    python.stdin.take().unwrap().write_all(given.as_bytes()).unwrap();
    let ended = python.wait_with_output().unwrap();
    assert!(ended.status.success());
    serde_json::from_slice(&ended.stdout).unwrap()
}
