//! Requests of the scene editor, with a supervisor that answers from a line.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::os::unix::net::UnixListener;
use std::path::Path;
use std::sync::{Arc, Mutex};

use language::word_findings;
use serde_json::{Value as Json, json};

use super::*;

/// A configuration of its own with the shipped files, and its desk.
struct Lab {
    folder: tempfile::TempDir,
    desk: Desk,
    asked: Arc<Mutex<Vec<String>>>,
}

fn lab(set: Option<Json>, locked: Option<&str>) -> Lab {
    let folder = tempfile::tempdir().unwrap();
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
    copy(&shipped, &folder.path().join("config"));
    let socket = folder.path().join("control.sock");
    let listener = UnixListener::bind(&socket).unwrap();
    let asked = Arc::new(Mutex::new(Vec::new()));
    let status = json!({
        "reply": "status", "name": "lab", "state": "ready", "supervisor_pid": 1, "version": "0",
        "uptime_s": 1.0, "epoch": 1, "scene": "bowls", "profile": null,
        "config": folder.path().join("config"), "set": set, "strays_killed": 0,
        "rss_kib": null, "cpu_s": null, "services": [],
    });
    let seen = Arc::clone(&asked);
    std::thread::spawn(move || {
        for stream in listener.incoming() {
            let stream = stream.unwrap();
            let mut line = String::new();
            BufReader::new(&stream).read_line(&mut line).unwrap();
            let request: Json = serde_json::from_str(&line).unwrap();
            let answer = match request["verb"].as_str().unwrap() {
                "status" => status.clone(),
                _ if request["scene"] == "tools" => {
                    json!({ "reply": "refused", "kind": "config", "message": "no", "details": ["why"] })
                }
                _ => json!({ "reply": "reloaded", "restarted": ["policy"] }),
            };
            seen.lock().unwrap().push(line);
            writeln!(&stream, "{answer}").unwrap();
        }
    });
    let desk = Desk::new(socket, "in force".into(), locked.map(str::to_owned), word_findings);
    Lab { folder, desk, asked }
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let to = to.join(path.file_name().unwrap());
        if path.is_dir() { copy(&path, &to) } else { fs::copy(&path, &to).map(drop).unwrap() }
    }
}

impl Lab {
    fn scene(&self, name: &str) -> String {
        let file = self.folder.path().join(format!("config/scenes/{name}.toml"));
        fs::read_to_string(file).unwrap()
    }
}

fn saving(opened: &Opened, known: Option<&str>, draft: bool) -> Saving {
    Saving {
        text: opened.text.clone(),
        document: opened.document.clone(),
        known: known.map(str::to_owned),
        draft,
    }
}

#[test]
fn scene_is_saved_with_its_comments_by_those_who_have_read_it() {
    let mut lab = lab(Some(json!([])), None);
    let listed = lab.desk.list().unwrap();
    assert!(listed.names.contains(&"bowls".to_owned()) && listed.in_force == "bowls");
    let before = lab.scene("bowls");
    let mut opened = lab.desk.open("bowls").unwrap();
    opened.document.objects[1].xyz = Some([0.64, 0.02, -0.13]);
    let known = opened.hash.clone().unwrap();
    let saved = lab.desk.save("bowls", &saving(&opened, Some(&known), false)).unwrap();
    let after = lab.scene("bowls");
    assert_eq!(saved.text, after);
    assert_eq!(after, before.replace("[0.64, 0.0, -0.13]", "[0.64, 0.02, -0.13]"));
    // It has changed since: by the request before.
    let stale = lab.desk.save("bowls", &saving(&opened, Some(&known), false)).unwrap_err();
    assert_eq!(stale.status, StatusCode::CONFLICT);
    assert!(stale.error.contains("has changed since it was read"), "{}", stale.error);
    let taken = lab.desk.save("bowls", &saving(&opened, None, false)).unwrap_err();
    assert!(taken.error.contains("already"), "{}", taken.error);
    for name in ["../bowls", "", "a/b", ".x"] {
        let refused = lab.desk.save(name, &saving(&opened, None, false)).unwrap_err();
        assert_eq!(refused.status, StatusCode::BAD_REQUEST, "{name}");
    }
    assert_eq!(lab.scene("bowls"), after);
    assert_eq!(lab.desk.open("nothing").unwrap_err().status, StatusCode::NOT_FOUND);
}

#[test]
fn problems_are_found_in_one_round_and_saved_on_request_only() {
    let mut lab = lab(Some(json!([])), None);
    let mut opened = lab.desk.open("bowls").unwrap();
    opened.document.objects[2].xyz = Some([1.9, 0.57, 0.135]);
    opened.document.objects[4].attributes.insert("color".into(), "gren".into());
    let draft = Draft { text: opened.text.clone(), document: opened.document.clone() };
    let found = lab.desk.check(&draft).unwrap();
    assert_eq!(found.problems.len(), 2, "{found:?}");
    let refused = lab.desk.save("mine", &saving(&opened, None, false)).unwrap_err();
    assert_eq!((refused.status, refused.problems.len()), (StatusCode::UNPROCESSABLE_ENTITY, 2));
    assert!(refused.problems[1].file.ends_with("/mine.toml"), "{refused:?}");
    lab.desk.save("mine", &saving(&opened, None, true)).unwrap();
    assert!(lab.scene("mine").contains("1.9"));
    // The scene in force stays one that a start accepts.
    let hash = opened.hash.clone();
    let in_force = lab.desk.save("bowls", &saving(&opened, hash.as_deref(), true)).unwrap_err();
    assert_eq!(in_force.status, StatusCode::UNPROCESSABLE_ENTITY);
}

#[test]
fn new_scene_begins_without_objects_and_with_every_comment() {
    let mut lab = lab(Some(json!([])), None);
    let opened = lab.desk.new_scene().unwrap();
    assert!(opened.document.objects.is_empty() && opened.hash.is_none());
    assert!(opened.text.starts_with("#:schema ../schemas/scene.json\n"), "{}", opened.text);
    assert!(opened.text.contains("# Objects. Lengths are metres"), "{}", opened.text);
    assert_eq!(opened.robot.limbs.len(), 2);
    let draft = Draft { text: opened.text, document: opened.document };
    let found = lab.desk.check(&draft).unwrap();
    assert!(found.problems.iter().any(|it| it.key == "objects"), "{found:?}");
}

#[test]
fn reach_is_asked_for_few_places_of_a_whole_object() {
    let mut lab = lab(Some(json!([])), None);
    let object = lab.desk.open("bowls").unwrap().document.objects.remove(1);
    let at = vec![[0.64, 0.0], [1.9, 0.0]];
    let places = Places { object: object.clone(), at: at.clone() };
    let reached = lab.desk.reach(&places).unwrap();
    assert!(reached.limbs[0].is_some(), "{reached:?}");
    let none = ObjectEntry { size: None, ..object.clone() };
    let refused = lab.desk.reach(&Places { object: none, at }).unwrap_err();
    assert_eq!(refused.status, StatusCode::BAD_REQUEST);
    assert!(lab.desk.reach(&Places { object, at: vec![[0.0; 2]; 257] }).is_err());
}

#[test]
fn scene_is_put_into_force_by_the_supervisor() {
    let mut lab = lab(Some(json!([])), None);
    assert_eq!(lab.desk.use_scene("markers").unwrap().restarted, ["policy"]);
    let asked = lab.asked.lock().unwrap().last().cloned().unwrap();
    let asked: Json = serde_json::from_str(&asked).unwrap();
    assert_eq!(asked, json!({ "verb": "use-scene", "scene": "markers", "wait_ms": 0 }));
    let refused = lab.desk.use_scene("tools").unwrap_err();
    assert_eq!(
        (refused.status, refused.details),
        (StatusCode::UNPROCESSABLE_ENTITY, vec!["why".into()])
    );
    assert_eq!(lab.desk.use_scene("..").unwrap_err().status, StatusCode::BAD_REQUEST);
}

#[test]
fn scenes_of_a_study_and_of_another_machine_are_left_alone() {
    let mut lab = lab(Some(json!([])), Some("a study is enabled"));
    let opened = lab.desk.open("bowls").unwrap();
    let refused = lab.desk.save("mine", &saving(&opened, None, false)).unwrap_err();
    assert_eq!(
        (refused.status, refused.error.as_str()),
        (StatusCode::FORBIDDEN, "a study is enabled")
    );
    assert_eq!(lab.desk.use_scene("bowls").unwrap_err().status, StatusCode::FORBIDDEN);
    let mut mirror = self::lab(None, None);
    assert!(mirror.desk.list().unwrap_err().error.contains("another machine"));
}

#[test]
fn draft_of_many_objects_is_refused_before_it_is_checked() {
    let mut lab = lab(Some(json!([])), None);
    let Opened { text, mut document, .. } = lab.desk.open("bowls").unwrap();
    let object = ObjectEntry { from: None, xyz: None, ..document.objects[0].clone() };
    let many = (0..20_000).map(|n| ObjectEntry { name: format!("o{n}"), ..object.clone() });
    document.objects = many.collect();
    let began = Instant::now();
    let refused = lab.desk.check(&Draft { text, document }).unwrap_err();
    assert_eq!(refused.status, StatusCode::UNPROCESSABLE_ENTITY);
    assert!(refused.error.contains("at most 1024 objects"), "{}", refused.error);
    assert!(began.elapsed() < Duration::from_secs(2), "{:?}", began.elapsed());
}
