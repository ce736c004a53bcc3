//! Precedence of layers, and the resulting values.

use std::path::Path;
use std::time::Duration;

use super::{Folder, ONE_BOWL, shipped};
use crate::{Restart, Settings, Voice};
use messages::Service;

#[test]
fn config_of_a_nearly_empty_folder_equals_the_shipped_values() {
    let folder = Folder::new(&[]);
    let bare = folder.load(None, &[]).unwrap();
    let full = Settings::load(&shipped(), None, &[]).unwrap();
    for (section, _) in crate::sections() {
        assert_eq!(bare.section_text(section), full.section_text(section));
    }
    let origins = bare.origins();
    assert!(origins.iter().all(|origin| origin.from == "built-in defaults"));
    assert!(origins.iter().any(|origin| origin.key == "arm.limb" && origin.value == "\"auto\""));
}

/// The other defaults are those of docs/configuration.md, which `parts` makes of the shipped files.
#[test]
fn defaults_are_those_of_the_vocabulary() {
    let Settings { group, dialogue, .. } = Folder::new(&[]).load(None, &[]).unwrap();
    let names: Vec<_> = group.services.iter().map(|service| service.name.as_str()).collect();
    assert_eq!(names, Service::BUILT_IN.map(Service::name));
    assert!(group.services.iter().all(|service| service.after.is_empty()), "they start together");
    assert_eq!(group.services[1].stop_deadline, Duration::from_secs(5));
    assert_eq!(group.services[3].stop_deadline, Duration::from_secs(15), "the arm's");
    let reliability = |p_l, epsilon| Some(vocabulary::Reliability { p_l, epsilon });
    let (open, choice) = (reliability(0.85, 0.03), reliability(0.93, 0.015));
    assert_eq!(
        dialogue.params,
        vocabulary::Params { open, choice, ..vocabulary::Params::default() }
    );
    assert_eq!(dialogue.costs, vocabulary::Costs::default());
}

#[test]
fn later_layers_win_value_by_value() {
    let folder = Folder::new(&[
        ("arm.toml", "speed_ratio = 0.3\ntime_scale = 2\njoint_rate_hz = 50"),
        ("profiles/fast.toml", "[arm]\ntime_scale = 10\njoint_rate_hz = 20"),
    ]);
    let arm = folder.load(Some("fast"), &[("arm.joint_rate_hz", "10")]).unwrap().arm;
    assert_eq!((arm.motion.speed_ratio, arm.time_scale, arm.joint_rate_hz), (0.3, 10.0, 10.0));
    assert_eq!(arm.motion.hover_m, 0.15);

    let settings = folder.load(Some("fast"), &[("arm.joint_rate_hz", "10")]).unwrap();
    let from = |key: &str| {
        let origin = settings.origins().into_iter().find(|origin| origin.key == key).unwrap();
        origin.from.replace(&format!("{}/", folder.path().display()), "")
    };
    assert_eq!(from("arm.speed_ratio"), "arm.toml");
    assert_eq!(from("arm.time_scale"), "profiles/fast.toml");
    assert_eq!(from("arm.joint_rate_hz"), "--set");
    assert_eq!(from("arm.hover_m"), "built-in defaults");
}

#[test]
fn overrides_need_no_quotes_in_a_shell() {
    let folder = Folder::new(&[]);
    let overrides = [
        ("speech.voice", "print"),
        ("arm.limb", "\"left\""),
        ("arm.restock", "false"),
        ("arm.hand_over_xyz", "[0.75, 0.4, 0.15]"),
        ("dialogue.costs.wrong", "80"),
        ("group.services.arm.watchdog_s", "0"),
    ];
    let settings = folder.load(None, &overrides).unwrap();
    assert_eq!(settings.speech.voice, Voice::Print);
    assert_eq!((settings.arm.limb.as_deref(), settings.arm.restock), (Some("left"), false));
    assert_eq!(settings.arm.motion.hand_over_xyz_m, [0.75, 0.4, 0.15]);
    assert_eq!(settings.dialogue.costs.wrong, 80.0);
    assert_eq!(settings.group.services[3].watchdog, None);
}

#[test]
fn services_can_be_added_and_keep_their_order() {
    let folder = Folder::new(&[(
        "group.toml",
        "[services.zoom]\ncommand = ['zoom', '-x']\nafter = ['arm', 'camera']\n\
         [services.camera]\ncommand = ['camera']\nrestart = 'never'\nnice = -3\n\
         [services.grounding]\ncommand = ['python3', 'grounding.py']\n",
    )]);
    let settings = folder.load(None, &[]).unwrap();
    settings.write_snapshot(folder.path()).unwrap();
    let read = Settings::load_snapshot(folder.path()).unwrap();
    assert_eq!(read.group, settings.group);
    let services = settings.group.services;
    let names: Vec<_> = services.iter().map(|service| service.name.as_str()).collect();
    let built_in = Service::BUILT_IN.map(Service::name);
    assert_eq!(names, [&built_in[..], &["zoom", "camera"]].concat());
    let [zoom, camera] = &services[built_in.len()..] else { panic!("{names:?}") };
    assert_eq!(services[1].command, Some(vec!["python3".into(), "grounding.py".into()]));
    assert_eq!(zoom.after, ["arm", "camera"]);
    assert_eq!(zoom.watchdog, Some(Duration::from_secs(3)));
    assert_eq!((camera.restart, camera.nice), (Restart::Never, -3));
}

#[test]
fn a_layer_can_remove_an_optional_value() {
    let folder = Folder::new(&[
        ("speech.toml", "player = ['aplay']\nmodel_dir = '/opt/model'"),
        ("profiles/plain.toml", "[speech]\nplayer = []\nmodel_dir = ''"),
    ]);
    let speech = folder.load(None, &[]).unwrap().speech;
    assert_eq!(speech.player, Some(vec!["aplay".to_owned()]));
    assert_eq!(speech.model_dir.as_deref(), Some(Path::new("/opt/model")));
    let speech = folder.load(Some("plain"), &[]).unwrap().speech;
    assert_eq!((speech.player, speech.model_dir), (None, None));
}

#[test]
fn a_scene_may_be_a_path() {
    let folder = Folder::new(&[("mine/lab.toml", &ONE_BOWL.replace("one bowl", "mine"))]);
    let scene = folder.load(None, &[("group.scene", "mine/lab.toml")]).unwrap().scene;
    assert_eq!(scene.name(), "mine");
    let absolute = folder.path().join("mine/lab.toml").display().to_string();
    assert_eq!(folder.load(None, &[("group.scene", &absolute)]).unwrap().scene, scene);
}

/// The key of earlier versions becomes the rate that replaces it, with a warning, unless that rate
/// is stated too or as high by default.
#[test]
fn former_keys_are_replaced_with_a_warning() {
    let read = |text: &str| {
        let folder = Folder::new(&[("dialogue.toml", text)]);
        let settings = folder.load(None, &[]).unwrap();
        let warnings: Vec<String> = settings.warnings().iter().map(ToString::to_string).collect();
        let warnings = warnings.join("\n").replace(&format!("{}/", folder.path().display()), "");
        assert_eq!(settings.dialogue.alpha_typed, None);
        (settings.dialogue.misperception, warnings)
    };
    const REPLACED: &str = "alpha_typed: replaced by dialogue.misperception; help:";
    let (rate, warning) = read("alpha_typed = 0.25");
    let help = "write `misperception = 0.2`, which is taken";
    assert_eq!((rate, warning), (0.2, format!("dialogue.toml:1:1: {REPLACED} {help}")));
    let removed = format!("dialogue.toml:1:1: {REPLACED} remove it");
    assert_eq!(read("alpha_typed = 0.001"), (0.004, removed.clone()));
    assert_eq!(read("alpha_typed = 0.25\nmisperception = 0.01"), (0.01, removed));
    assert_eq!(read("alpha = 0.2"), (0.004, String::new()));
    let wrong = Folder::new(&[("dialogue.toml", "alpha_typed = 0")]).complaints(None, &[]);
    assert!(wrong[0].contains("alpha_typed: expected a value from 0.000001 to 100"), "{wrong:?}");
}
