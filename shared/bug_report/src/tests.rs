//! Secrets in every syntax that holds some, words in journals, and archives that others read.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::Command;

use service::group::GroupPaths;

use crate::bundle::{Bundle, check_free};
use crate::collection::holds_words;
use crate::secret_names::without_secrets;
use crate::secrets::Scrubber;
use crate::words::without_words;

const SECRET: &str = "s3cr3t-Value_42";

/// Every way to write a secret, `@` for the secret.
const SHOWN: [&str; 25] = [
    "password = \"@\"",
    "password        = \"@\"",
    "api_key = '@'  # mine",
    "key = \"@\"",
    "token = \"\"\"@\"\"\"",
    "token = [\"@\", \"@\"]",
    "{\"password\":\"@\",\"a\":1}",
    "{\"access_token\": \"a\\\"@\"}",
    "{\"set\":[[\"dialogue.model.api_key\",\"@\"]]}",
    "{\"set\":[[\"dialogue.model.api_key\",\"\\\"@\\\"\"]]}",
    "command = [\"prog\", \"--api-key\", \"@\"]",
    "swap command=prog --token @ --fast",
    "prog --password=@",
    "prog --key @",
    "http://user:@@host/x",
    "url = \"https://@@example.org:8443/v1\"",
    "http://127.0.0.1:8377/?token=@&role=operator",
    "Authorization: Bearer @",
    "authorization=\"Bearer @\"",
    "sent Bearer @ to it",
    "Cookie: whichone=@",
    "secret: @",
    "client.Secret=@,",
    "-----BEGIN PRIVATE KEY-----\n@\n-----END PRIVATE KEY-----\nkept",
    "-----BEGIN EC PRIVATE KEY-----\n@\n",
];

#[test]
fn secrets_are_left_out_in_every_syntax() {
    for shown in SHOWN {
        let text =
            shown.replace('@', SECRET).replace(&format!("{SECRET}{SECRET}"), &format!("{SECRET}@"));
        assert!(text.contains(SECRET));
        let clean = without_secrets(&text, &mut Vec::new());
        assert!(!clean.contains(SECRET), "{shown}: {clean}");
        assert!(clean.contains("(left out)"), "{shown}: {clean}");
    }
    let kept = without_secrets(
        "-----BEGIN PRIVATE KEY-----\nx\n-----END PRIVATE KEY-----\nkept",
        &mut Vec::new(),
    );
    assert_eq!(kept, "-----BEGIN PRIVATE KEY-----(left out)-----END PRIVATE KEY-----\nkept");
}

#[test]
fn what_is_no_secret_is_kept() {
    for text in [
        "key_file = \"/etc/keys/model\"",
        "keys = \"/home/robot/keys\"",
        "{\"key\":\"dialogue.alpa\",\"what\":\"unknown key\"}",
        "console.access = \"token\"",
        "access = \"token\"  # the token of the group",
        "help: `whichone token list`",
        "http://127.0.0.1:8377/ is open",
        "ann@example.org",
        "the Bearer is here",
    ] {
        assert_eq!(without_secrets(text, &mut Vec::new()), text);
    }
}

fn group() -> (tempfile::TempDir, GroupPaths) {
    let home = tempfile::tempdir().unwrap();
    let paths = GroupPaths::in_home(home.path(), &"lab".parse().unwrap()).unwrap();
    fs::create_dir_all(paths.root()).unwrap();
    (home, paths)
}

#[test]
fn secrets_of_files_are_found_wherever_they_stand() {
    let (home, paths) = group();
    let private = |name: &str, text: &str| {
        let file = home.path().join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(&file, text).unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o600)).unwrap();
        file
    };
    private("lab/console.token", "a-token-of-the-page\n");
    let model = private("model.key", "sk-of-the-model\n");
    private("ring/robots/r1/identity.toml", "name = \"r1\"\npassword = \"of-the-link-42\"\n");
    let keys = home.path().join("ring");
    let mut scrubber = Scrubber::of(&paths);
    scrubber.learn(&format!("key_file = \"{}\"\nkeys = '{}'\n", model.display(), keys.display()));
    scrubber.learn("url = \"http://me:hunter2@model.example/v1\"");
    let text = "GET /?a-token-of-the-page sk-of-the-model of-the-link-42 hunter2";
    let clean = scrubber.clean(text);
    for secret in ["a-token-of-the-page", "sk-of-the-model", "of-the-link-42", "hunter2"] {
        assert!(!clean.contains(secret), "{clean}");
        assert!(scrubber.is_in(format!("\0\u{1}{secret}\0").as_bytes()), "{secret}");
    }
    assert!(!scrubber.is_in(b"nothing of this kind"));
}

#[test]
fn names_of_files_are_read_out_of_a_status() {
    let (home, paths) = group();
    let file = home.path().join("model.key");
    fs::write(&file, "sk-of-the-model\n").unwrap();
    let mut scrubber = Scrubber::of(&paths);
    let config = home.path().join("arm.toml");
    fs::write(&config, "# ordinary words\n").unwrap();
    let of_another = serde_json::json!({ "key": "arm.limb", "from": config }).to_string();
    scrubber.learn(&of_another);
    assert!(!scrubber.is_in(b"# ordinary words"), "a file that merely stands behind a key");
    let set = format!("\"{}\"", file.display());
    scrubber.learn(&serde_json::json!({ "set": [["dialogue.model.key_file", set]] }).to_string());
    assert!(scrubber.is_in(b"sk-of-the-model"));
}

#[test]
fn journals_keep_their_structure_and_no_words() {
    let golden = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden");
    for (service, said) in
        [("speech", "get me the white bowl"), ("policy", "Here is the clear bowl.")]
    {
        let lines = fs::read_to_string(format!("{golden}/journal_{service}.jsonl")).unwrap();
        assert!(lines.contains(said), "{service}");
        let (clean, words) = without_words(&lines);
        assert!(!clean.contains(said), "{service}");
        assert!(words.contains(said), "{service}: {words:?}");
        assert_eq!(clean.lines().count(), lines.lines().count());
        let first: serde_json::Value = serde_json::from_str(clean.lines().next().unwrap()).unwrap();
        assert_eq!((&first["seq"], &first["record"]["service"]), (&1.into(), &service.into()));
    }
    let (clean, words) = without_words("{\"from\":\"Ann\",\"text\":\"no\"}\nno JSON\n");
    assert!(
        !clean.contains("Ann") && !clean.contains("\"no\"") && !clean.contains("no JSON"),
        "{clean}"
    );
    assert_eq!(words.into_iter().collect::<Vec<_>>(), ["Ann"]);
}

#[test]
fn what_was_said_is_found_in_logs_and_names_in_words_are_not() {
    let mut scrubber = Scrubber::default();
    scrubber.learn_words(["the red mug".to_owned(), "Ann".to_owned()]);
    let clean = scrubber.clean("Ann said \"the red mug\"; Annotation of the red mugs");
    assert_eq!(clean, "(left out) said \"(left out)\"; Annotation of the red mugs");
}

#[test]
fn archive_is_read_by_tar_and_replaces_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let archive = folder.path().join("report.tar.gz");
    let mut bundle = Bundle::default();
    let deep = format!("config/{}/x.toml", "d".repeat(100));
    bundle.add("version.json", "{}\n");
    bundle.add(deep.as_str(), vec![b'x'; 1000]);
    bundle.leave_out("flight", "too loud");
    check_free(&archive).unwrap();
    bundle.write(&archive).unwrap();
    let listed =
        Command::new("tar").arg("-xvzf").arg(&archive).current_dir(folder.path()).output().unwrap();
    assert!(listed.status.success(), "{listed:?}");
    assert_eq!(fs::read(folder.path().join("report").join(&deep)).unwrap().len(), 1000);
    let contents = fs::read_to_string(folder.path().join("report/CONTENTS.txt")).unwrap();
    assert!(
        contents.contains("1000  config/d") && contents.contains("flight: too loud"),
        "{contents}"
    );
    let refused = check_free(&archive).unwrap_err();
    assert!(refused.message.contains("--out"), "{refused}");
    let as_folder = folder.path().join("report-folder");
    bundle.write(&as_folder).unwrap();
    assert_eq!(fs::read_to_string(as_folder.join("version.json")).unwrap(), "{}\n");
}

#[test]
fn lines_of_logs_with_what_people_said_are_told_from_others() {
    for line in [
        r#"INFO speech::asr_worker::worker: speech rejected: not meant for the robot text="see you at the bank" score=0.2"#,
        r#"{"level":"INFO","fields":{"message":"speech rejected","text":"see you at the bank","score":0.2}}"#,
        "WARN console: not in the audit: say the pills are in the drawer",
    ] {
        assert!(holds_words(line), "{line}");
    }
    for line in [
        "INFO supervisor: started service=arm",
        "INFO speech: questions are shown as text reason=none",
    ] {
        assert!(!holds_words(line), "{line}");
    }
}
