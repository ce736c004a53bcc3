//! Every kind of mistake: told with its file, its key and the cure, and all of them at once.

use super::{Folder, ONE_BOWL};

/// Loads a folder with one such file and expects exactly these complaints.
#[track_caller]
fn check(name: &str, text: &str, expected: &[&str]) {
    assert_eq!(Folder::new(&[(name, text)]).complaints(None, &[]), expected, "{name}: {text}");
}

#[test]
fn a_key_that_nobody_knows() {
    check(
        "arm.toml",
        "sped_ratio = 0.5",
        &["arm.toml: sped_ratio: unknown key (did you mean `speed_ratio`?)"],
    );
    check(
        "group.toml",
        "[log]\ncolour = 'red'",
        &[
            "group.toml: log.colour: unknown key (remove it; the keys here are level, file_bytes_max, files_kept)",
        ],
    );
    check(
        "group.toml",
        "[services.arm]\nwatchdog = 2",
        &["group.toml: services.arm.watchdog: unknown key (did you mean `watchdog_s`?)"],
    );
}

#[test]
fn a_value_of_another_type() {
    check(
        "arm.toml",
        "speed_ratio = 'fast'",
        &[
            "arm.toml: speed_ratio: expected a finite number, found a text (write digits, e.g. `1.5`)",
        ],
    );
    check(
        "arm.toml",
        "restock = 1",
        &[
            "arm.toml: restock: expected true or false, found a whole number (write `true` or `false`)",
        ],
    );
    check(
        "group.toml",
        "restart.exits_max = 2.5",
        &[
            "group.toml: restart.exits_max: expected a whole number, found a number (write digits alone, e.g. `5`)",
        ],
    );
    check(
        "arm.toml",
        "hand_over_xyz = [1.0, 2.0]",
        &["arm.toml: hand_over_xyz: expected three finite numbers (write `[x, y, z]`)"],
    );
    check(
        "speech.toml",
        "player = 'aplay'",
        &[
            "speech.toml: player: expected a list of texts, found a text (write `[\"one\", \"two\"]`)",
        ],
    );
    check(
        "speech.toml",
        "voice = 'command'",
        &[
            "speech.toml: voice: `command` needs a voice_command (write `voice_command = [\"program\", \"{text}\", \"{wav}\"]`)",
        ],
    );
    check(
        "speech.toml",
        "voice_command = ['say', '{text}']\nvoice_dir = 'sounds'",
        &[
            "speech.toml: voice_command: lacks {wav} (write `voice_command = [\"program\", \"{text}\", \"{wav}\"]`)",
            "speech.toml: voice_dir: is not an absolute path (write it from `/` on)",
        ],
    );
    check(
        "speech.toml",
        "voice = 'flite'",
        &[
            "speech.toml: voice: flite has no voice `en-us` (set voice_name to one that `flite -lv` lists, e.g. `slt`)",
        ],
    );
    check("speech.toml", "voice_name = ' '", &["speech.toml: voice_name: is empty (write a text)"]);
    check(
        "group.toml",
        "restart = 5",
        &[
            "group.toml: restart: expected a table, found a whole number (write a table `[restart]`)",
        ],
    );
    check(
        "arm.toml",
        "[limb]\nname = 'left'",
        &["arm.toml: limb: expected a text, found a table (write `limb = …`)"],
    );
    check(
        "group.toml",
        "services.camera = 'camera'",
        &[
            "group.toml: services.camera: expected a table, found a text (write a table `[services.camera]`)",
        ],
    );
}

#[test]
fn a_number_out_of_range() {
    check(
        "arm.toml",
        "speed_ratio = 1.5",
        &["arm.toml: speed_ratio: 1.5 is out of range (use a number from 0.05 to 1)"],
    );
    check(
        "arm.toml",
        "time_scale = nan",
        &[
            "arm.toml: time_scale: expected a finite number, found a number (write digits, e.g. `1.5`)",
        ],
    );
    check(
        "group.toml",
        "services.arm.nice = 20",
        &["group.toml: services.arm.nice: 20 is out of range (use a number from -20 to 19)"],
    );
    check(
        "group.toml",
        "log.files_kept = -1",
        &["group.toml: log.files_kept: -1 is out of range (use a number from 0 to 1000)"],
    );
    check(
        "dialogue.toml",
        "[prior]\nobjects = 'histroy'\nsmoothing = 0\nabsent = 1",
        &[
            "dialogue.toml: prior.objects: `histroy` is not one of uniform, history (did you mean `history`?)",
            "dialogue.toml: prior.smoothing: 0 is out of range (use a number from 0.01 to 1000000)",
            "dialogue.toml: prior.absent: 1 is out of range (use a number from 0 to 0.9)",
        ],
    );
    check(
        "dialogue.toml",
        "[gesture]\np_g = 0\nstd_theta_rad = 2.0\nstray = 1\nperson_xyz = [0, 50, 0]",
        &[
            "dialogue.toml: gesture.p_g: 0 is not a probability (use a number above 0 and below 1, e.g. 0.1)",
            "dialogue.toml: gesture.std_theta_rad: 2 is not a spread of pointing (use radians above 0 and at most 1, e.g. 0.15)",
            "dialogue.toml: gesture.stray: 1 is not a share of stray gestures (use a number above 0 and below 1, e.g. 0.05)",
            "dialogue.toml: gesture.person_xyz: [0.0, 50.0, 0.0] is out of range (use metres from -20 to 20)",
        ],
    );
    check(
        "dialogue.toml",
        "epsilon = 0.0\np_l = 1",
        &[
            "dialogue.toml: p_l: 1 is not a probability (use a number above 0 and below 1, e.g. 0.95)",
            "dialogue.toml: epsilon: 0 is not an error rate (use a number above 0 and below 0.5, e.g. 0.01)",
        ],
    );
    check(
        "dialogue.toml",
        "costs.wrong = -1",
        &["dialogue.toml: costs.wrong: -1 is not a positive amount (use a finite number above 0)"],
    );
}

#[test]
fn nobody_points_from_where_an_object_stands() {
    let inside = "[gesture]\nenabled = true\nperson_xyz = [0.7, 0.2, -0.125]";
    let complaints = Folder::new(&[("dialogue.toml", inside)]).complaints(None, &[]);
    assert_eq!(
        complaints,
        [
            "dialogue.toml: gesture.person_xyz: the person stands where `red_one` does (use a place from which people see the objects, e.g. [1.6, 0.0, 0.45])"
        ]
    );
    let off = inside.replace("true", "false");
    assert!(Folder::new(&[("dialogue.toml", &off)]).load(None, &[]).is_ok());
}

#[test]
fn a_choice_that_does_not_exist() {
    check(
        "arm.toml",
        "limb = 'lefft'",
        &["arm.toml: limb: `lefft` is not one of auto, left, right (did you mean `left`?)"],
    );
    check(
        "speech.toml",
        "voice = 'opera'",
        &[
            "speech.toml: voice: `opera` is not one of auto, espeak-ng, flite, command, print (use one of these)",
        ],
    );
    check(
        "speech.toml",
        "[microphone]\nmode = 'handsfree'\necho_pause_ms = -1",
        &[
            "speech.toml: microphone.mode: `handsfree` is not one of off, hands-free, push-to-talk (did you mean `hands-free`?)",
            "speech.toml: microphone.echo_pause_ms: -1 is out of range (use a number from 0 to 5000)",
        ],
    );
    let planner = Folder::new(&[("dialogue.toml", "planner = 'lookahed'")]).complaints(None, &[]);
    assert_eq!(planner.len(), 1);
    assert!(planner[0].starts_with("dialogue.toml: planner: `lookahed` is not one of "));
    assert!(planner[0].ends_with("(did you mean `lookahead`?)"), "{planner:?}");
    check(
        "group.toml",
        "log.level = 'info,policy=loud'",
        &[
            "group.toml: log.level: `policy=loud` is no log level (use one of off, error, warn, info, debug, trace, or NAME=LEVEL,…)",
        ],
    );
}

#[test]
fn values_that_contradict_each_other() {
    check(
        "speech.toml",
        "recogniser = 'command'",
        &[
            "speech.toml: recogniser: `command` needs a recogniser_command (write `recogniser_command = [\"program\", \"argument\"]`)",
        ],
    );
    check(
        "speech.toml",
        "recogniser = 'whisper'",
        &[
            "speech.toml: recogniser: `whisper` needs a whisper_model (write `whisper_model = \"/path/to/ggml-model.bin\"`)",
        ],
    );
    check(
        "speech.toml",
        "recogniser = 'whisper'\nwhisper_model = 'ggml-model.bin'",
        &["speech.toml: whisper_model: is not an absolute path (write it from `/` on)"],
    );
    check(
        "group.toml",
        "restart.backoff_max_ms = 50",
        &[
            "group.toml: restart.backoff_max_ms: the first pause is longer than the longest (raise backoff_max_ms or lower backoff_first_ms)",
        ],
    );
    check(
        "group.toml",
        "restart.backoff_first_ms = 9000",
        &[
            "group.toml: restart.backoff_first_ms: the first pause is longer than the longest (raise backoff_max_ms or lower backoff_first_ms)",
        ],
    );
    check(
        "speech.toml",
        "model_dir = 'model'",
        &["speech.toml: model_dir: is not an absolute path (write it from `/` on)"],
    );
}

#[test]
fn services_that_cannot_be() {
    check(
        "group.toml",
        "[services.camera]",
        &[
            "group.toml: services.camera.command: missing: only built-in services know their program (write `command = [\"program\", \"argument\"]`)",
        ],
    );
    check(
        "group.toml",
        "[services.Camera_1]\ncommand = ['camera']",
        &[
            "group.toml: services.Camera_1: is no name for a service (use 1 to 19 of a-z, 0-9 and -, beginning with a letter or digit)",
        ],
    );
    check(
        "group.toml",
        "[services.arm]\nafter = ['polcy']",
        &["group.toml: services.arm.after: there is no service `polcy` (did you mean `policy`?)"],
    );
    check(
        "group.toml",
        "[services.arm]\nafter = ['speech']",
        &[
            "group.toml: services.arm.after: these services wait for each other: arm after speech after policy after arm (remove one of them from an `after`)",
        ],
    );
    check(
        "group.toml",
        "[services.grounding]\nafter = ['grounding']",
        &[
            "group.toml: services.grounding.after: these services wait for each other: grounding after grounding (remove one of them from an `after`)",
        ],
    );
}

#[test]
fn texts_that_are_not_toml() {
    let complaints = Folder::new(&[("arm.toml", "limb = \nspeed_ratio = 0.5\nrestock = tru\n")])
        .complaints(None, &[]);
    assert_eq!(complaints.len(), 2, "{complaints:?}");
    assert!(complaints[0].starts_with("arm.toml: line 1, column "), "{complaints:?}");
    assert!(complaints[1].starts_with("arm.toml: line 3, column "), "{complaints:?}");
}

#[test]
fn a_number_that_toml_cannot_hold() {
    let text = "files_kept = 1\n[deep]\nlog = 99999999999999999999";
    let complaints = Folder::new(&[("arm.toml", text)]).complaints(None, &[]);
    assert!(complaints[0].starts_with("arm.toml: deep.log: "), "{complaints:?}");
}

#[test]
fn profiles_and_scenes_that_do_not_exist() {
    let folder = Folder::new(&[("profiles/lab.toml", ""), ("profiles/ci.toml", "[amr]")]);
    let known = folder.complaints(Some("lap"), &[("group.scene", "bowl")]);
    assert_eq!(known[0], "profiles: there is no profile `lap` (did you mean `lab`?)");
    assert!(known[1].starts_with("--set: group.scene: there is no scene `bowl` ("), "{known:?}");
    assert!(known[1].ends_with("(did you mean `bowls`?)"), "{known:?}");
    assert_eq!(
        folder.complaints(Some("ci"), &[]),
        ["profiles/ci.toml: amr: unknown key (did you mean `arm`?)"]
    );
}

#[test]
fn overrides_that_mean_nothing() {
    let folder = Folder::new(&[]);
    let overrides =
        [("limb", "left"), ("arm..limb", "left"), ("arms.limb", "left"), ("arm.speed_ratio", "9")];
    assert_eq!(
        folder.complaints(None, &overrides),
        [
            "--set: limb: is not a key with its section (write SECTION.KEY=VALUE, e.g. arm.speed_ratio=0.4)",
            "--set: arm..limb: is not a key with its section (write SECTION.KEY=VALUE, e.g. arm.speed_ratio=0.4)",
            "--set: arm.speed_ratio: 9 is out of range (use a number from 0.05 to 1)",
            "--set: arms: unknown key (did you mean `arm`?)",
        ]
    );
}

#[test]
fn a_folder_that_is_none() {
    let folder = Folder::new(&[]);
    let problems = crate::Settings::load(&folder.path().join("cofnig"), None, &[]).unwrap_err();
    assert_eq!(problems.iter().count(), 1);
    assert!(problems.to_string().contains("cofnig: is not a folder"));
}

#[test]
fn everything_wrong_is_told_at_once() {
    let bowls = format!("{ONE_BOWL}colour_blind = true\n");
    let folder = Folder::new(&[
        ("group.toml", "scnee = 'bowls'\n[log]\nlevel = 'inof'"),
        ("dialogue.toml", "alpha = 0\nmode = 'far'\n[turns]\nrepeats_max = -1"),
        ("speech.toml", "voice_words_per_minute = 9000"),
        ("arm.toml", "limb = 'both'\nhover_m = 'high'"),
        ("profiles/odd.toml", "[speech]\nvoise = 'print'"),
        ("scenes/bowls.toml", &bowls),
    ]);
    let complaints = folder.complaints(Some("odd"), &[("arm.restock", "maybe")]);
    let places = [
        "group.toml: log.level",
        "group.toml: scnee",
        "dialogue.toml: alpha",
        "dialogue.toml: mode",
        "dialogue.toml: turns.repeats_max",
        "speech.toml: voice_words_per_minute",
        "profiles/odd.toml: speech.voise",
        "arm.toml: limb",
        "arm.toml: hover_m",
        "--set: arm.restock",
        "scenes/bowls.toml: objects[0].colour_blind",
    ];
    let found: Vec<String> = complaints
        .iter()
        .map(|line| line.split(": ").take(2).collect::<Vec<_>>().join(": "))
        .collect();
    assert_eq!(found, places, "{}", complaints.join("\n"));
}
