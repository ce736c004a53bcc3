use std::io::Write;

use super::*;

fn group() -> (tempfile::TempDir, GroupPaths) {
    let home = tempfile::tempdir().unwrap();
    let paths = GroupPaths::in_home(home.path(), &"lab".parse().unwrap()).unwrap();
    fs::create_dir_all(paths.log()).unwrap();
    (home, paths)
}

fn append(paths: &GroupPaths, service: &str, text: &str) {
    let path = paths.log_file(service);
    let mut file = fs::OpenOptions::new().append(true).create(true).open(path).unwrap();
    file.write_all(text.as_bytes()).unwrap();
}

fn printed(paths: &GroupPaths, service: Option<&str>, tail: usize) -> Vec<String> {
    let args = LogsArgs { service: service.map(str::to_owned), follow: false, tail };
    let mut bytes = Vec::new();
    logs(paths, &args, &mut Output::to(&mut bytes, false)).unwrap();
    String::from_utf8(bytes).unwrap().lines().map(str::to_owned).collect()
}

#[test]
fn lines_of_all_services_come_in_order_of_time() {
    let (_home, paths) = group();
    append(&paths, "arm", "2026-01-01T00:00:01.5Z  INFO one\n  and more\n");
    append(&paths, "arm", "2026-01-01T00:00:03.0Z  INFO three\n");
    append(&paths, "policy", "{\"timestamp\":\"2026-01-01T00:00:02.0Z\",\"level\":\"INFO\"}\n");
    let lines = printed(&paths, None, 100);
    let order: Vec<&str> = lines.iter().map(|line| line.split(' ').next().unwrap()).collect();
    assert_eq!(order, ["arm", "arm", "policy", "arm"], "{lines:?}");
    assert!(lines[1].ends_with("  and more"));
    assert_eq!(printed(&paths, None, 1).len(), 1);
    assert_eq!(printed(&paths, Some("arm"), 1), ["2026-01-01T00:00:03.0Z  INFO three"]);
}

#[test]
fn logs_of_an_unknown_service_list_the_known_ones() {
    let (_home, paths) = group();
    append(&paths, "arm", "line\n");
    let args = LogsArgs { service: Some("leg".into()), follow: false, tail: 1 };
    let error = logs(&paths, &args, &mut Output::to(Vec::new(), false)).unwrap_err();
    assert!(error.to_string().ends_with("existing logs: arm"), "{error}");
}

#[test]
fn log_lines_are_sanitised_for_the_terminal() {
    let (_home, paths) = group();
    append(&paths, "arm", "\x1b[2Jgone\r\n");
    assert_eq!(printed(&paths, Some("arm"), 5), ["\\u{1b}[2Jgone"]);
}

#[test]
fn log_is_followed_through_partial_lines_and_rotation() {
    let (_home, paths) = group();
    append(&paths, "arm", "one\ntwo\nthr");
    let mut file = LogFile::new("arm", paths.log_file("arm"));
    assert_eq!(file.last_lines(1).unwrap(), ["two"]);
    assert_eq!(file.new_lines().unwrap(), [""; 0]);
    append(&paths, "arm", "ee\nfour\n");
    assert_eq!(file.new_lines().unwrap(), ["three", "four"]);
    fs::rename(paths.log_file("arm"), paths.log_file("old")).unwrap();
    assert_eq!(file.new_lines().unwrap(), [""; 0]);
    append(&paths, "arm", "a longer line than all before together\n");
    assert_eq!(file.new_lines().unwrap(), ["a longer line than all before together"]);
    fs::write(paths.log_file("arm"), "emptied\n").unwrap();
    assert_eq!(file.new_lines().unwrap(), ["emptied"]);
}

#[test]
fn lines_of_both_forms_have_level_target_and_fields() {
    let text = "2025-11-25T10:08:19.250000Z  WARN policy::shell: a topic fails n=3";
    let json = r#"{"timestamp":"2025-11-25T10:08:19.250000Z","level":"WARN","fields":{"message":"a topic fails","n":3},"target":"policy::shell"}"#;
    let (text, json) = (parts(text).unwrap(), parts(json).unwrap());
    for parts in [&text, &json] {
        assert_eq!(parts.timestamp, "2025-11-25T10:08:19.250000Z");
        assert_eq!((parts.level.as_str(), parts.target.as_str()), ("WARN", "policy::shell"));
    }
    assert_eq!(text.fields["message"], "a topic fails n=3");
    assert_eq!((&json.fields["message"], &json.fields["n"]), (&"a topic fails".into(), &3.into()));
    let panic = "thread 'main' panicked at src/main.rs:1:1:";
    assert_eq!(parts(panic), None);
}
