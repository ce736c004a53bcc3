//! Which services restart when a value changes.

use std::collections::BTreeSet;

use config::{SectionSchema, Settings};
use messages::Service;

use super::{Folder, sections};

/// Those that a group can do without.
const OTHERS: [&str; 4] = ["ros2", "trajectory", "link", "baxter"];

/// Names of the services that ship.
fn services() -> Vec<&'static str> {
    Service::BUILT_IN.map(Service::name).into_iter().chain(OTHERS).collect()
}

/// The services that a reload restarts between two configurations.
fn restarted(before: &Settings, after: &Settings) -> Vec<&'static str> {
    let differs = |name: &&str| before.read_by(name) != after.read_by(name);
    services().into_iter().filter(differs).collect()
}

#[test]
fn values_restart_the_services_that_read_them() {
    let before = Folder::new(&[]).load(None, &[]).unwrap();
    for (key, value, expected) in [
        (
            "speech.voice_words_per_minute",
            "200",
            &["speech", "console", "recorder", "link", "baxter"][..],
        ),
        ("arm.speed_ratio", "0.5", &["arm", "console", "recorder", "ros2", "link", "baxter"]),
        ("arm.baxter.stale_s", "0.2", &["arm", "console", "recorder", "ros2", "link", "baxter"]),
        ("arm.simulated.loss", "0.1", &["arm", "console", "recorder", "ros2", "link", "baxter"]),
        ("arm.ros1.master", "lab", &["arm", "console", "recorder", "ros2", "link", "baxter"]),
        ("console.viewers_max", "9", &["console", "recorder", "link"]),
        ("ros2.domain_id", "7", &["recorder", "ros2", "trajectory", "link"]),
        (
            "arm.trajectory.stale_s",
            "0.2",
            &["arm", "console", "recorder", "ros2", "trajectory", "link", "baxter"],
        ),
        ("link.keys", "/keys", &["recorder", "link"]),
        ("group.recorder.sound", "true", &["console", "recorder", "link"]),
        ("group.recorder.mib_max", "64", &["recorder", "link"]),
        ("group.restart.exits_max", "9", &["recorder", "link"]),
    ] {
        let after = Folder::new(&[]).load(None, &[(key, value)]).unwrap();
        assert_eq!(restarted(&before, &after), expected, "{key}");
    }
    let perceived = Folder::new(&[]).load(None, &[("group.perception.enabled", "true")]).unwrap();
    assert_eq!(restarted(&before, &perceived), services(), "where objects come from");
}

/// A section that no service but the recorder and the link reads would be one that a reload leaves without effect.
#[test]
fn every_section_has_a_reader() {
    let before = Folder::new(&[]).load(None, &[]).unwrap();
    let changes = [
        ("dialogue", "alpha", "0.3"),
        ("speech", "voice_words_per_minute", "200"),
        ("arm", "speed_ratio", "0.5"),
        ("console", "viewers_max", "9"),
        ("study", "interactions", "7"),
        ("ros2", "domain_id", "7"),
    ];
    let changed: BTreeSet<&str> = changes.iter().map(|(section, ..)| *section).collect();
    // The group's is the supervisor's, and the link is among those that read everything.
    let other = ["group", "link"];
    for SectionSchema { name, .. } in sections() {
        assert!(changed.contains(name) || other.contains(&name), "{name} is not tested");
    }
    for (section, key, value) in changes {
        let after = Folder::new(&[]).load(None, &[(&format!("{section}.{key}"), value)]).unwrap();
        let mut readers = restarted(&before, &after);
        readers.retain(|name| !["recorder", "link"].contains(name));
        assert!(!readers.is_empty(), "{section}");
    }
}
