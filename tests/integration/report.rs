//! `whichone report`: secrets are planted wherever a group holds some, and words are said; none of them leaves.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use whichone_tests::Group;

const WORDS: &str = "get me the white bowl that Wilhelmina likes";
const MODEL_KEY: &str = "sk-planted-model-key-1";
const URL_PASSWORD: &str = "planted-url-password-2";
const LINK_PASSWORD: &str = "planted-link-password-3";
const LOGGED: &str = "planted-logged-token-4";
const IN_A_COMMENT: &str = "planted-comment-password-5";
const PRIVATE_KEY: &str = "cGxhbnRlZC1wcml2YXRlLWtleS02";
const PERSON: &str = "Wilhelmina";

/// A configuration of one's own with secrets in it, and in files that it names.
fn plant(folder: &Path) -> PathBuf {
    let config = folder.join("config");
    let shipped = concat!(env!("CARGO_MANIFEST_DIR"), "/../config");
    assert!(Command::new("cp").args(["-r", shipped]).arg(&config).status().unwrap().success());
    let private = |name: &str, text: &str| {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, text).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).unwrap();
        path.display().to_string()
    };
    let key = private("secret/model.key", &format!("{MODEL_KEY}\n"));
    private("ring/identity.toml", &format!("password = \"{LINK_PASSWORD}\"\n"));
    let pem = format!("-----BEGIN PRIVATE KEY-----\n{PRIVATE_KEY}\n-----END PRIVATE KEY-----\n");
    private("ring/key.pem", &pem);
    let add = |file: &str, text: &str| {
        let path = config.join(file);
        let before = fs::read_to_string(&path).unwrap();
        fs::write(&path, before + text).unwrap();
    };
    let ring = folder.join("ring").display().to_string();
    add("speech.toml", &format!("\n# password: {IN_A_COMMENT}\n# keys = \"{ring}\"\n"));
    let profile = format!(
        "[dialogue.model]\nurl = \"http://me:{URL_PASSWORD}@127.0.0.1:9/v1\"\nmodel = \"none\"\nkey_file = \"{key}\"\n"
    );
    fs::write(config.join("profiles/model.toml"), profile).unwrap();
    config
}

/// Every file of a folder, with its content.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let all = entries.map(|path| match path.is_dir() {
        true => files(&path),
        false => vec![(path.clone(), fs::read(&path).unwrap())],
    });
    all.flatten().collect()
}

fn holders<'a>(files: &'a [(PathBuf, Vec<u8>)], text: &str) -> Vec<&'a Path> {
    let has = |bytes: &[u8]| bytes.windows(text.len()).any(|window| window == text.as_bytes());
    files.iter().filter(|(_, bytes)| has(bytes)).map(|(path, _)| path.as_path()).collect()
}

#[test]
fn reports_hold_no_secret_and_words_on_request_only() {
    let folder = tempfile::tempdir().unwrap();
    let mut group = Group::with_config(plant(folder.path()));
    let key = folder.path().join("secret/model.key").display().to_string();
    group.start(&[
        "dialogue.model.model=none",
        &format!("dialogue.model.url=http://me:{URL_PASSWORD}@127.0.0.1:9/v1"),
        &format!("dialogue.model.key_file={key}"),
    ]);
    group.must(&["say", "--from", PERSON, WORDS]);
    let http = group.must(&["token", "add", "hall", "--json"]).json()["token"]
        .as_str()
        .unwrap()
        .to_owned();
    let page = fs::read_to_string(group.paths().root().join("console.token")).unwrap();
    let page = page.lines().next().unwrap().to_owned();
    let log = group.paths().log().join("planner.log");
    fs::write(log, format!("Authorization: Bearer {LOGGED}\nGET /?token={page}\nheard: {WORDS}\n"))
        .unwrap();

    let secrets =
        [MODEL_KEY, URL_PASSWORD, LINK_PASSWORD, LOGGED, IN_A_COMMENT, PRIVATE_KEY, &http, &page];
    let report = |name: &str, options: &[&str]| {
        let out = folder.path().join(name);
        let path = out.display().to_string();
        let words: Vec<&str> =
            ["report", "--json", "--out", &path].iter().chain(options).copied().collect();
        let listed = group.must(&words).json();
        (listed, out)
    };
    let (listed, archive) = report("r.tar.gz", &[]);
    let unpacked =
        Command::new("tar").arg("-xzf").arg(&archive).current_dir(folder.path()).status();
    assert!(unpacked.unwrap().success());
    let found = files(&folder.path().join("r"));
    let names: Vec<&str> =
        listed["files"].as_array().unwrap().iter().map(|it| it["name"].as_str().unwrap()).collect();
    for name in [
        "version.json",
        "status.json",
        "doctor.jsonl",
        "check.json",
        "machine.txt",
        "config/group.toml",
    ]
    .into_iter()
    .chain([
        "config/profiles/model.toml",
        "log/policy.log",
        "log/supervisor.log",
        "journal/speech.jsonl",
    ]) {
        assert!(names.contains(&name), "no {name} in {names:?}");
    }
    assert_eq!(found.len(), names.len() + 1, "the files, and their list");
    for secret in secrets.into_iter().chain([WORDS, PERSON]) {
        assert_eq!(holders(&found, secret), [] as [&Path; 0], "{secret}");
    }
    let left_out = listed["left_out"].to_string();
    assert!(left_out.contains("flight/speech-") && left_out.contains("--with-words"), "{left_out}");

    let (_, whole) = report("whole", &["--with-words"]);
    let found = files(&whole);
    for secret in secrets {
        assert_eq!(holders(&found, secret), [] as [&Path; 0], "{secret}");
    }
    assert!(holders(&found, WORDS).iter().any(|path| path.ends_with("journal/speech.jsonl")));
    let again = group.call(&["report", "--out", &whole.display().to_string()]);
    assert_eq!(again.code, Some(64), "{again:?}");
    group.down();
}
