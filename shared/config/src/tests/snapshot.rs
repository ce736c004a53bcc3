//! Snapshots: services read the settings that the supervisor wrote.

use std::fs;

use super::{Folder, shipped};
use crate::{SNAPSHOT_FILE, Settings, WORDS_FILE};

#[test]
fn words_of_the_scene_are_lines_after_its_key() {
    let settings = Settings::load(&shipped(), None, &[]).unwrap();
    let run = tempfile::tempdir().unwrap();
    settings.write_words(run.path()).unwrap();
    let text = fs::read_to_string(run.path().join(WORDS_FILE)).unwrap();
    let (key, words) = text.split_once('\n').unwrap();
    assert_eq!(u64::from_str_radix(key, 16), Ok(settings.scene.key()));
    assert_eq!(words.lines().collect::<Vec<_>>(), settings.scene.words());
}

#[test]
fn a_snapshot_reads_back_equal() {
    let overrides =
        [("arm.time_scale", "12.5"), ("group.scene", "markers"), ("dialogue.costs.from", "config")]
            .map(|(key, value)| (key.to_owned(), value.to_owned()));
    for profile in [None, Some("ci"), Some("lab"), Some("paper")] {
        let settings = Settings::load(&shipped(), profile, &overrides).unwrap();
        let run = tempfile::tempdir().unwrap();
        settings.write_snapshot(run.path()).unwrap();
        let read = Settings::load_snapshot(run.path()).unwrap();
        assert_eq!(read, settings);
        assert_eq!(read.group, settings.group);
        assert_eq!(read.dialogue, settings.dialogue);
        assert_eq!(read.speech, settings.speech);
        assert_eq!(read.arm, settings.arm);
        assert_eq!(read.scene, settings.scene);
        assert_eq!(read.scene_file(), settings.scene_file());
        let names: Vec<_> =
            fs::read_dir(run.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
        assert_eq!(names, [SNAPSHOT_FILE], "nothing else is left in the folder");
    }
}

#[test]
fn editing_the_files_changes_nothing_until_the_next_snapshot() {
    let folder = Folder::new(&[("arm.toml", "speed_ratio = 0.3")]);
    let run = tempfile::tempdir().unwrap();
    folder.load(None, &[]).unwrap().write_snapshot(run.path()).unwrap();
    folder.write("arm.toml", "speed_ratio = 0.9");
    folder.write("scenes/bowls.toml", "not a scene any more");
    let read = Settings::load_snapshot(run.path()).unwrap();
    assert_eq!((read.arm.motion.speed_ratio, read.scene.name()), (0.3, "one bowl"));
    assert!(folder.load(None, &[]).is_err());
}

#[test]
fn a_section_differs_exactly_when_its_values_do() {
    let folder = Folder::new(&[]);
    let before = folder.load(None, &[]).unwrap();
    folder.write("arm.toml", "# a remark\nspeed_ratio = 0.6\n");
    let same = folder.load(None, &[]).unwrap();
    let other = folder.load(None, &[("arm.speed_ratio", "0.5")]).unwrap();
    for (section, _) in crate::sections() {
        assert_eq!(before.section_text(section), same.section_text(section));
        let differs = before.section_text(section) != other.section_text(section);
        assert_eq!(differs, section == "arm", "{section}");
    }
    assert_eq!(before, same);
    assert_ne!(before, other);
}

#[test]
fn a_missing_or_damaged_snapshot_is_rejected() {
    let run = tempfile::tempdir().unwrap();
    let missing = Settings::load_snapshot(run.path()).unwrap_err().to_string();
    assert!(missing.contains("no such file"), "{missing}");

    let settings = Folder::new(&[]).load(None, &[]).unwrap();
    settings.write_snapshot(run.path()).unwrap();
    let path = run.path().join(SNAPSHOT_FILE);
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replace("speed_ratio = 0.6", "speed_ratio = 6.0")).unwrap();
    let damaged = Settings::load_snapshot(run.path()).unwrap_err().to_string();
    assert!(
        damaged.contains("arm.speed_ratio: expected a value from 0.05 to 1, found 6"),
        "{damaged}"
    );

    fs::write(&path, "[group]\n").unwrap();
    let bare = Settings::load_snapshot(run.path()).unwrap_err().to_string();
    assert!(bare.contains("the scene is missing"), "{bare}");
}

/// Values that a recording of an earlier version omits have that version's meaning.
#[test]
fn settings_of_an_earlier_version_keep_their_meaning() {
    let over = [("dialogue.epsilon".to_owned(), "0.02".to_owned())];
    let settings = Settings::load(&shipped(), None, &over).unwrap();
    let mut tree: toml::Table = settings.snapshot().parse().unwrap();
    let dialogue = tree["dialogue"].as_table_mut().unwrap();
    for key in ["misperception", "misperceptions", "open", "choice", "choice_questions"] {
        dialogue.remove(key).unwrap();
    }
    let read = Settings::from_snapshot("old", &tree.to_string(), ("", &[])).unwrap();
    let params = read.dialogue.params;
    assert_eq!((params.p_l, params.epsilon), (0.95, 0.02));
    for own in [params.open, params.choice] {
        assert_eq!(own.map(|own| (own.p_l, own.epsilon)), Some((0.95, 0.02)));
    }
    assert_eq!(read.dialogue.misperception_of("color"), 0.0);
    assert_eq!((read.dialogue.alpha_typed, settings.dialogue.alpha_typed), (Some(0.001), None));
    let set = [("dialogue.alpha_typed".to_owned(), "0.002".to_owned())];
    let both = Settings::from_snapshot("old", &settings.snapshot(), ("--set", &set)).unwrap();
    assert_eq!((both.dialogue.alpha_typed, both.dialogue.misperception), (Some(0.002), 0.004));
    assert!(!read.dialogue.actions.choice);
}
