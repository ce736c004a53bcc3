//! A part or driver that ships is its crate and its line in a list: its section, its service and its restarts are known
//! to every program that has registered it.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::path::Path;

use config::{Check, Driver, Part, PartService, Registered, Section, Settings, schemas};
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

/// Settings of the driver of a crane.
#[derive(Debug, PartialEq)]
struct Crane {
    rope_m: f64,
}

impl Section for Crane {
    const KEY: &'static [&'static str] = &["arm", "crane"];

    fn read(f: &mut Fields<'_>) -> Self {
        Self { rope_m: f.number("rope_m", 0.0..=9.0) }
    }
}

static CRANE: Driver = Driver {
    name: "crane",
    in_real_time: true,
    needs: None,
    sections: &[Registered::of::<Crane>()],
};
static LIFT: Driver = Driver { name: "lift", needs: Some("hoist"), sections: &[], ..CRANE };

static REGISTERED: &[&Part] =
    &[&LAMP, &SHADE, &recorder::PART, &baxter::PART, &ros1::PART, &model_reader::PART];

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
    fs::write(folder.path().join("arm.toml"), "[crane]\nrope_m = 2.0\n").unwrap();
    let unknown = load(folder.path(), &[("lamp.brightness", "2"), ("lamp.warns", "true")]);
    let unknown = unknown.unwrap_err();
    assert!(
        unknown.contains("lamp: unknown key")
            && unknown.contains("shade: unknown key")
            && unknown.contains("crane: unknown key"),
        "{unknown}"
    );

    config::register(REGISTERED, drivers::known().chain([&CRANE, &LIFT]));

    let wrong = load(folder.path(), &[("lamp.brightness", "2"), ("lamp.glow", "1")]).unwrap_err();
    assert!(wrong.contains("lamp.brightness: expected a value from 0 to 1, found 2"), "{wrong}");
    assert!(wrong.contains("lamp.glow: unknown key"), "{wrong}");
    let alone = load(folder.path(), &[("lamp.warns", "true")]).unwrap_err();
    assert!(alone.contains("lamp.warns: is true, but the group has no lamp; help: add"), "{alone}");
    let stranger = load(folder.path(), &[("group.services.lmap.nice", "0")]).unwrap_err();
    assert!(stranger.contains("only services that ship have a default program"), "{stranger}");

    drivers_are_known(folder.path());

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
    assert_eq!(restarts(&[("arm.crane.rope_m", "3.0")]), [false, true, true]);
    assert_eq!(restarts(&[("dialogue.planner", "entropy")]), [true, false, true]);
    assert_eq!(restarts(&[("dialogue.alpha", "0.3")]), [false, false, true]);
    assert_eq!(restarts(&[("console.shade.drawn", "false")]), [false, false, true]);

    let schemas = schemas();
    let schema = |name: &str| &schemas.iter().find(|section| section.name == name).unwrap().schema;
    assert_eq!(schema("lamp")["properties"]["brightness"]["maximum"], 1.0);
    let arm = &schema("arm")["properties"];
    assert_eq!(
        arm["driver"]["enum"],
        serde_json::json!(["kinematic", "baxter", "feetech", "trajectory", "crane", "lift"])
    );
    assert_eq!(arm["crane"]["properties"]["rope_m"]["maximum"], 9.0);
    assert_eq!(schema("console")["properties"]["shade"]["properties"]["drawn"]["type"], "boolean");
}

/// Names, facts and sections of drivers; an arm with a program of its own may have others.
fn drivers_are_known(folder: &Path) {
    let settings = load(folder, &[("arm.driver", "crane")]).unwrap();
    assert_eq!(settings.arm.driver, "crane");
    assert_eq!(settings.part(), Ok(Crane { rope_m: 2.0 }));
    let refused = |set: &[(&str, &str)], expected: &str| {
        let found = load(folder, set).unwrap_err();
        assert!(found.contains(expected), "{found}");
    };
    refused(
        &[("arm.driver", "crane"), ("arm.time_scale", "9")],
        "arm.time_scale: is 9, but a robot moves in real time; help: write `time_scale = 1.0`",
    );
    refused(
        &[("arm.driver", "crne"), ("arm.crane.rope_m", "10")],
        "arm.driver: expected one of kinematic, baxter, feetech, trajectory, crane, lift, found `crne`; help: did you mean `crane`?",
    );
    refused(&[("arm.crane.rope_m", "10")], "rope_m: expected a value from 0 to 9, found 10");
    refused(
        &[("arm.driver", "lift")],
        "arm.driver: this build has no driver `lift`; help: `cargo install --path services/whichone \
         --features hoist` in a checkout",
    );
    let own = [("arm.driver", "mine"), ("arm.mine.port", "/dev/ttyUSB0")];
    refused(
        &own,
        "arm.driver: expected one of kinematic, baxter, feetech, trajectory, crane, lift, found `mine`",
    );
    refused(&own, "arm.mine: unknown key");
    let program = ("group.services.arm.command", "[\"my-arm\"]");
    let settings = load(folder, &[&own[..], &[program]].concat()).unwrap();
    assert_eq!(settings.arm.driver, "mine");
    refused(&[program, own[1]], "arm.mine: unknown key");
}
