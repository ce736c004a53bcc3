//! A part that ships is its crate and its line in a list: its section, its service and its restarts are known to
//! every program that has registered it.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::path::Path;

use config::{Check, Part, PartService, Registered, Section, Settings, schemas};
use diagnostics::Fields;

/// Colours of a lamp that shows the dialogue.
#[derive(Debug, PartialEq)]
struct Lamp {
    brightness: f64,
    warns: bool,
}

impl Section for Lamp {
    const KEY: &'static [&'static str] = &["lamp"];
    const FILE: Option<&'static str> =
        Some("# Brightness, 0 to 1.\nbrightness = 0.5\nwarns = false\n");

    fn read(f: &mut Fields<'_>) -> Self {
        Self { brightness: f.number("brightness", 0.0..=1.0), warns: f.flag("warns") }
    }

    fn check(&self, others: &mut Check<'_>) {
        if self.warns && !others.group.services.iter().any(|service| service.name == "lamp") {
            let help = "add `[group.services.lamp]`, or write `warns = false`";
            others.problem(&["lamp", "warns"], "is true, but the group has no lamp", help);
        }
    }
}

/// A table of the part in a section of the core.
struct Shade;

impl Section for Shade {
    const KEY: &'static [&'static str] = &["console", "shade"];

    fn read(f: &mut Fields<'_>) -> Self {
        f.flag("drawn");
        Self
    }
}

static LAMP: Part = Part {
    name: "lamp",
    service: Some(PartService { reads: &["lamp", "dialogue.planner"], is_client: false }),
    sections: &[Registered::of::<Lamp>()],
};
static SHADE: Part = Part { name: "shade", service: None, sections: &[Registered::of::<Shade>()] };

static REGISTERED: &[&Part] = &[&LAMP, &SHADE, &recorder::PART, &ros1::PART, &model_reader::PART];

fn load(folder: &Path, set: &[(&str, &str)]) -> Result<Settings, String> {
    let set: Vec<_> = set.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    Settings::load(folder, None, &set).map_err(|problems| problems.to_string())
}

/// One test, as parts are registered once for a process.
#[test]
fn a_new_part_is_known_once_it_is_registered() {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("scenes")).unwrap();
    fs::copy(shipped.join("scenes/bowls.toml"), folder.path().join("scenes/bowls.toml")).unwrap();
    fs::write(folder.path().join("console.toml"), "[shade]\ndrawn = true\n").unwrap();
    let unknown = load(folder.path(), &[("lamp.brightness", "2"), ("lamp.warns", "true")]);
    let unknown = unknown.unwrap_err();
    assert!(
        unknown.contains("lamp: unknown key") && unknown.contains("shade: unknown key"),
        "{unknown}"
    );

    config::register(REGISTERED);

    let wrong = load(folder.path(), &[("lamp.brightness", "2"), ("lamp.glow", "1")]).unwrap_err();
    assert!(wrong.contains("lamp.brightness: expected a value from 0 to 1, found 2"), "{wrong}");
    assert!(wrong.contains("lamp.glow: unknown key"), "{wrong}");
    let alone = load(folder.path(), &[("lamp.warns", "true")]).unwrap_err();
    assert!(alone.contains("lamp.warns: is true, but the group has no lamp; help: add"), "{alone}");
    let stranger = load(folder.path(), &[("group.services.lmap.nice", "0")]).unwrap_err();
    assert!(stranger.contains("only services that ship have a default program"), "{stranger}");

    // It has a program, so it needs no command.
    fs::write(folder.path().join("lamp.toml"), "brightness = 0.75\n").unwrap();
    let service = [("group.services.lamp.nice", "0"), ("lamp.warns", "true")];
    let settings = load(folder.path(), &service).unwrap();
    assert_eq!(settings.part(), Ok(Lamp { brightness: 0.75, warns: true }));
    let run = tempfile::tempdir().unwrap();
    settings.write_snapshot(run.path()).unwrap();
    let read = Settings::load_snapshot(run.path()).unwrap();
    assert_eq!(read.part::<Lamp>(), settings.part());

    let restarts = |set: &[(&str, &str)]| {
        let other = load(folder.path(), &[&service[..], set].concat()).unwrap();
        ["lamp", "arm", "console"].map(|name| other.read_by(name) != settings.read_by(name))
    };
    assert_eq!(restarts(&[("lamp.brightness", "0.1")]), [true, false, false]);
    assert_eq!(restarts(&[("dialogue.planner", "entropy")]), [true, false, true]);
    assert_eq!(restarts(&[("dialogue.alpha", "0.3")]), [false, false, true]);
    assert_eq!(restarts(&[("console.shade.drawn", "false")]), [false, false, true]);

    let schemas = schemas();
    let schema = |name: &str| &schemas.iter().find(|section| section.name == name).unwrap().schema;
    assert_eq!(schema("lamp")["properties"]["brightness"]["maximum"], 1.0);
    assert_eq!(schema("console")["properties"]["shade"]["properties"]["drawn"]["type"], "boolean");
}
