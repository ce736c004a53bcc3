//! Invalid configurations: every kind of error is reported with file, line, key and help, and all
//! of them at once. Single files are in the tests of `parts`, which knows every section.

use expect_test::expect;

use super::{Folder, ONE_BOWL};

#[test]
fn a_person_may_stand_anywhere_if_gestures_are_off() {
    let inside = "[gesture]\nenabled = false\nperson_xyz = [0.7, 0.2, -0.125]";
    assert!(Folder::new(&[("dialogue.toml", inside)]).load(None, &[]).is_ok());
}

#[test]
fn unknown_profiles_scenes_and_robots_get_a_suggestion() {
    let folder = Folder::new(&[
        ("profiles/lab.toml", ""),
        ("profiles/ci.toml", "[amr]"),
        ("robots/sawyer.urdf", "<robot/>"),
    ]);
    let overrides = [("group.scene", "bowl"), ("arm.robot", "sawer")];
    expect![[r#"
        profiles: no profile `lap`; help: did you mean `lab`?
        --set: group.scene: no scene `bowl`: there is no scenes/bowl.toml; help: did you mean `bowls`?
        --set: arm.robot: no robot `sawer`: there is no robots/sawer.urdf; help: did you mean `sawyer`?"#]].assert_eq(&folder.complaints(Some("lap"), &overrides).join("\n"));
    expect!["profiles/ci.toml:1:2: amr: unknown key; help: did you mean `arm`?"]
        .assert_eq(&folder.complaints(Some("ci"), &[]).join("\n"));
}

#[test]
fn invalid_overrides_are_reported() {
    let folder = Folder::new(&[]);
    let overrides =
        [("limb", "left"), ("arm..limb", "left"), ("arms.limb", "left"), ("arm.speed_ratio", "9")];
    expect![[r#"
        --set: limb: not a key with its section; help: write SECTION.KEY=VALUE, e.g. arm.speed_ratio=0.4
        --set: arm..limb: not a key with its section; help: write SECTION.KEY=VALUE, e.g. arm.speed_ratio=0.4
        --set: arm.speed_ratio: expected a value from 0.05 to 1, found 9
        --set: arms: unknown key; help: did you mean `arm`?"#]].assert_eq(&folder.complaints(None, &overrides).join("\n"));
}

#[test]
fn servers_of_speech_need_an_address() {
    let text =
        "voice = 'wyoming'\nrecogniser = 'wyoming'\n[wyoming]\nvoice = 'piper:1'\nspeaker = '3'";
    let folder = Folder::new(&[("speech.toml", text)]);
    expect![[r#"
        speech.toml:4:1: wyoming.voice: expected tcp://HOST:PORT, found `piper:1`; help: write the server's address, e.g. `tcp://127.0.0.1:10300`
        speech.toml:5:1: wyoming.speaker: a speaker belongs to a voice; help: set voice_name as well
        speech.toml:2:1: recogniser: `wyoming` needs a server; help: set `recogniser` in [wyoming]"#]].assert_eq(&folder.complaints(None, &[]).join("\n"));
}

#[test]
fn a_missing_folder_is_reported() {
    let missing = Folder::new(&[]).path().join("cofnig");
    let error = crate::Settings::load(&missing, None, &[]).unwrap_err().to_string();
    assert!(error.contains("cofnig: not a folder"), "{error}");
}

#[test]
fn errors_of_all_layers_are_reported_at_once() {
    let bowls = format!("{ONE_BOWL}colour_blind = true\n");
    let folder = Folder::new(&[
        ("group.toml", "scnee = 'bowls'\n[log]\nlevel = 'inof'"),
        ("dialogue.toml", "alpha = 0\nmode = 'far'\n[turns]\nrepeats_max = -1"),
        ("speech.toml", "voice_words_per_minute = 9000"),
        ("arm.toml", "limb = 2\nhover_m = 'high'"),
        ("profiles/odd.toml", "[speech]\nvoise = 'print'"),
        ("scenes/bowls.toml", &bowls),
    ]);
    let complaints = folder.complaints(Some("odd"), &[("arm.restock", "maybe")]);
    expect![[r#"
        group.toml:3:1: log.level: `inof` is not a log level; help: use one of off, error, warn, info, debug, trace, or NAME=LEVEL,…
        group.toml:1:1: scnee: unknown key; help: did you mean `scene`?
        dialogue.toml:1:1: alpha: 0 is not a smoothing weight; help: use a number above 0, e.g. 0.2
        dialogue.toml:2:1: mode: expected one of remote, present, found `far`
        dialogue.toml:4:1: turns.repeats_max: expected a value from 0 to 100, found -1
        speech.toml:1:1: voice_words_per_minute: expected a value from 80 to 450, found 9000
        profiles/odd.toml:2:1: speech.voise: unknown key; help: did you mean `voice`?
        arm.toml:1:1: limb: expected a string, found an integer; help: write it in double quotes
        arm.toml:2:1: hover_m: expected a finite number, found a string; help: write digits, e.g. `1.5`
        --set: arm.restock: expected a boolean, found a string; help: write `true` or `false`
        scenes/bowls.toml:15:1: objects[0].colour_blind: unknown key; help: remove it; the keys here are name, attributes, xyz, yaw, size, grasp_width, mass_kg, wall_deg, form, xyz, yaw, size, grasp_width, mass_kg, wall_deg, form"#]].assert_eq(&complaints.join("\n"));
}

#[test]
fn huge_files_and_those_that_are_none_are_rejected_unread() {
    let folder = Folder::new(&[("arm.toml", ""), ("console.toml", ""), ("huge.toml", "")]);
    // As much as no memory holds, without taking any space on the disk.
    for name in ["arm.toml", "scenes/bowls.toml"] {
        let file = std::fs::File::options().write(true).open(folder.path().join(name)).unwrap();
        file.set_len(1 << 40).unwrap();
    }
    // Opening it would wait for a writer.
    let pipe = folder.path().join("console.toml");
    std::fs::remove_file(&pipe).unwrap();
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let large = "cannot read the file: expected at most 16 MiB, found 1048576 MiB (1099511627776 bytes); help: fix or remove it";
    let none = "cannot read the file: expected a regular file, found a pipe, socket or device; help: fix or remove it";
    assert_eq!(
        folder.complaints(None, &[]),
        [
            format!("arm.toml: {large}"),
            format!("console.toml: {none}"),
            format!("scenes/bowls.toml: {large}")
        ]
    );
}
