//! Another user has prepared the names that verbs of this user read and write: nothing of this user is read, changed
//! or run by that, and no verb waits.

use std::collections::BTreeMap;
use std::fs::{self, Permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;

use rustix::fs::{CWD, FileType, Mode, mknodat};
use service::group::{ENV_HOME, SHM};
use whichone_tests::isolated::{OTHER_USER, as_other_user};
use whichone_tests::{Ended, Group, program, run, wait_for};

/// Longest run of a verb, seconds.
const LONGEST_S: f64 = 120.0;
/// Process numbers for which names are prepared: the verb's own and those of its children.
const PIDS: u32 = 3_000;
/// Names that earlier versions made from their process number: the folder, and what they wrote in it.
const NAMED_BY_PID: [(&str, &str); 4] = [
    ("whichone-settings-", "settings.new"),
    ("whichone-doctor-recogniser-", "pocketsphinx.log"),
    ("whichone-doctor-voice-", "silence.wav"),
    ("whichone-conform-", "conform"),
];
const PRECIOUS: &str = "precious\n";

/// A folder of everybody, as `/tmp` is, and one of this user.
struct Place {
    top: tempfile::TempDir,
    before: BTreeMap<PathBuf, (u32, String)>,
}

impl Place {
    fn new() -> Self {
        let top = tempfile::Builder::new().prefix("wo").tempdir().unwrap();
        let mut place = Self { top, before: BTreeMap::new() };
        fs::set_permissions(place.top.path(), Permissions::from_mode(0o755)).unwrap();
        fs::create_dir(place.shared("")).unwrap();
        fs::set_permissions(place.shared(""), Permissions::from_mode(0o1777)).unwrap();
        fs::create_dir(place.own("")).unwrap();
        // Others may enter and look: what a link of theirs leads to is known.
        fs::set_permissions(place.own(""), Permissions::from_mode(0o755)).unwrap();
        for name in ["file", "study.csv", "picture.svg"] {
            fs::write(place.own(name), PRECIOUS).unwrap();
        }
        place.before = place.contents();
        place
    }

    fn shared(&self, name: &str) -> PathBuf {
        self.top.path().join("shared").join(name)
    }

    fn own(&self, name: &str) -> PathBuf {
        self.top.path().join("own").join(name)
    }

    /// Mode and content of everything that this user has.
    fn contents(&self) -> BTreeMap<PathBuf, (u32, String)> {
        let own = self.own("");
        let mode = |path: &Path| fs::symlink_metadata(path).unwrap().mode();
        let paths = fs::read_dir(&own).unwrap().map(|entry| entry.unwrap().path());
        let read = |path: &Path| fs::read_to_string(path).unwrap_or_default();
        let files = paths.map(|path| (path.clone(), (mode(&path), read(&path))));
        files.chain([(own.clone(), (mode(&own), String::new()))]).collect()
    }

    /// Checks that this user's files are as they were, and that nothing of this user is left in the shared folder.
    fn assert_untouched(&self, what: &str) {
        assert_eq!(self.contents(), self.before, "{what}");
        for entry in fs::read_dir(self.shared("")).unwrap() {
            let entry = entry.unwrap();
            // Sound servers and the like leave files, too.
            let is_ours = entry.file_name().to_string_lossy().contains("whichone");
            let owner = entry.metadata().unwrap().uid();
            assert!(!is_ours || owner == OTHER_USER, "{what}: {:?}", entry.path());
        }
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new("/bin/sh");
        // The number of this process is that of the verb.
        let script = "echo $$ > \"$HOME/pid.part\"; mv \"$HOME/pid.part\" \"$HOME/pid\"\n\
                      while [ ! -e \"$HOME/go\" ]; do sleep 0.01; done; exec \"$@\"";
        command.args(["-c", script, "sh"]).arg(program("whichone")).args(words);
        command.env("TMPDIR", self.shared("")).env_remove("XDG_RUNTIME_DIR");
        command.env("HOME", self.top.path()).env(ENV_HOME, self.top.path().join("groups"));
        command.current_dir(self.own("")).env("WHICHONE_CONFIG", config());
        command
    }

    /// Runs a verb, after `prepare` has got its process number as the other user.
    fn run_after(&self, words: &[&str], prepare: impl FnOnce(u32) + Send) -> Ended {
        let [pid, go] = ["pid", "go"].map(|name| self.top.path().join(name));
        let _ = (fs::remove_file(&pid), fs::remove_file(&go));
        thread::scope(|scope| {
            let ended = scope.spawn(|| run(&mut self.command(words), "", LONGEST_S));
            let pid = wait_for("the verb's process", 20.0, || fs::read_to_string(&pid).ok());
            as_other_user(|| prepare(pid.trim().parse().unwrap()));
            fs::write(&go, "").unwrap();
            ended.join().unwrap()
        })
    }

    /// Runs a verb on what has been prepared.
    fn run(&self, words: &[&str]) -> Ended {
        self.run_after(words, |_| ())
    }
}

fn config() -> &'static str {
    concat!(env!("CARGO_MANIFEST_DIR"), "/../config")
}

fn pids(first: u32) -> impl Iterator<Item = u32> {
    let most = fs::read_to_string("/proc/sys/kernel/pid_max").unwrap().trim().parse().unwrap();
    (first..first + PIDS).map(move |pid| if pid < most { pid } else { 300 + pid - most })
}

fn pipe(path: &Path) {
    mknodat(CWD, path, FileType::Fifo, Mode::from_raw_mode(0o666), 0).unwrap();
    // Whatever the umask.
    fs::set_permissions(path, Permissions::from_mode(0o666)).unwrap();
}

fn open_folder(path: &Path) {
    fs::create_dir(path).unwrap();
    fs::set_permissions(path, Permissions::from_mode(0o777)).unwrap();
}

/// Files in shared memory that are removed in the end: nobody else does.
struct Prepared(Vec<PathBuf>);

impl Drop for Prepared {
    fn drop(&mut self) {
        self.0.iter().for_each(|path| drop(fs::remove_file(path)));
    }
}

/// Prepares every name by process number, each as a link to `target`.
fn prepare_by_pid(place: &Place, first: u32, target: &Path, in_memory: &mut Prepared) {
    for pid in pids(first) {
        for (folder, file) in NAMED_BY_PID {
            let folder = place.shared(&format!("{folder}{pid}"));
            open_folder(&folder);
            symlink(target, folder.join(file)).unwrap();
        }
        let probe = Path::new(SHM).join(format!("whichone-doctor-{pid}"));
        if symlink(target, &probe).is_ok() {
            in_memory.0.push(probe);
        }
    }
}

#[test]
#[ignore = "needs root: acts as another user"]
fn names_by_process_number_lead_doctor_nowhere() {
    let place = Place::new();
    let mut in_memory = Prepared(Vec::new());
    let file = place.own("file");
    let prepare = |pid| prepare_by_pid(&place, pid, &file, &mut in_memory);
    let ended = place.run_after(&["doctor", "--json"], prepare);
    assert!(ended.stdout.contains("recogniser"), "{ended:?}");
    place.assert_untouched("doctor");
}

#[test]
#[ignore = "needs root: acts as another user"]
fn pipes_by_process_number_do_not_hold_doctor() {
    let place = Place::new();
    let mut in_memory = Prepared(Vec::new());
    let prepare = |pid| {
        let pipe_path = place.shared("pipe");
        pipe(&pipe_path);
        prepare_by_pid(&place, pid, &pipe_path, &mut in_memory);
    };
    let ended = place.run_after(&["doctor", "--json"], prepare);
    assert!(ended.stdout.contains("microphone"), "{ended:?}");
    place.assert_untouched("doctor");
}

#[test]
#[ignore = "needs root: acts as another user"]
fn links_by_process_number_lead_conform_nowhere() {
    let place = Place::new();
    let own = place.own("");
    let prepare = |pid| {
        for pid in pids(pid) {
            symlink(&own, place.shared(&format!("whichone-conform-{pid}"))).unwrap();
        }
    };
    let words = ["conform", "grounding", "--profile", "ci", "--", "whichone-grounding"];
    let ended = place.run_after(&words, prepare);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    place.assert_untouched("conform");
}

#[test]
#[ignore = "needs root: acts as another user"]
fn pipes_hold_no_verb_that_reads_a_file() {
    let place = Place::new();
    let [plain, sound, flights, config] =
        ["pipe", "pipe.wav", "flights", "config"].map(|name| place.shared(name));
    as_other_user(|| {
        for path in [&plain, &sound, &place.shared("pipe.toml"), &place.shared("pipe.urdf")] {
            pipe(path);
        }
        for (folder, file) in [(&flights, "x.flight"), (&config, "group.toml")] {
            open_folder(folder);
            pipe(&folder.join(file));
        }
    });
    let text = |path: &Path| path.display().to_string();
    let [plain, sound, flights, config] = [&plain, &sound, &flights, &config].map(|it| text(it));
    let [toml, urdf] = ["pipe.toml", "pipe.urdf"].map(|name| text(&place.shared(name)));
    let written = text(&place.own("written.mcap"));
    let verbs: [&[&str]; 16] = [
        &["listen", &sound],
        &["listen", "--live", &sound],
        &["replay", &plain],
        &["replay", &flights],
        &["export", "mcap", &plain, "--out", &written],
        &["export", "mcap", &flights, "--out", &written],
        &["export", "pomdp", &toml],
        &["belief", "--input", &plain],
        &["ground", "--scene", &toml],
        &["fk", "--tip", "x", "--robot", &urdf],
        &["scene", "check", &toml],
        &["scene", "show", &toml],
        &["scene", "place", &toml],
        &["console", "--view", &plain],
        &["check", "--config", &config],
        &["study", "--scene", &toml],
    ];
    for words in verbs {
        let ended = place.run(words);
        assert!(ended.code != Some(0), "{words:?}: {ended:?}");
        // A pipe among the flights of a folder is none of them.
        let why = if words.contains(&flights.as_str()) { &flights } else { "pipe" };
        assert!(ended.stderr.contains(why), "{words:?}: {ended:?}");
    }
    place.assert_untouched("pipes");
}

#[test]
#[ignore = "needs root: acts as another user"]
fn links_lead_no_output_elsewhere() {
    let place = Place::new();
    let text = |path: PathBuf| path.display().to_string();
    as_other_user(|| {
        for (link, target) in [
            ("folder", ""),
            ("picture.svg", "picture.svg"),
            ("problem", "file"),
            ("new.toml", "new.toml"),
            ("new.mcap", "new.mcap"),
        ] {
            symlink(place.own(target), place.shared(link)).unwrap();
        }
        open_folder(&place.shared("open"));
        symlink(place.own("new.toml"), place.shared("open/group.toml")).unwrap();
        symlink(place.own("study.csv"), place.shared("open/study.csv")).unwrap();
        symlink(place.own("file"), place.shared("open/whichone.1")).unwrap();
    });
    let shared = |name: &str| text(place.shared(name));
    let verbs: [(&[&str], &str); 9] = [
        (&["arm", "plot"], "picture.svg"),
        (&["export", "pomdp", "bowls"], "problem"),
        (&["study", "--interactions", "2", "--scene", "bowls"], "folder"),
        (&["study", "--interactions", "2", "--scene", "bowls"], "open"),
        (&["init"], "folder"),
        (&["init"], "open"),
        (&["scene", "new"], "new.toml"),
        (&["scene", "new"], "folder/other.toml"),
        (&["man"], "folder"),
    ];
    for (words, name) in verbs {
        let path = shared(name);
        let option = match words {
            ["export", ..] => Some("--output"),
            ["study", ..] | ["arm", ..] => Some("--out"),
            _ => None,
        };
        let words: Vec<&str> = words.iter().copied().chain(option).chain([path.as_str()]).collect();
        let ended = place.run(&words);
        assert!(ended.code != Some(0), "{words:?}: {ended:?}");
        let known =
            ["link of user", "exist", "already"].iter().any(|why| ended.stderr.contains(why));
        assert!(known, "{words:?}: {ended:?}");
        place.assert_untouched(&format!("{words:?}"));
        // The same is done where nothing was prepared.
        let clean = text(place.top.path().join(format!("clean-{}", name.replace('/', "-"))));
        let words: Vec<&str> =
            words[..words.len() - 1].iter().copied().chain([clean.as_str()]).collect();
        let ended = place.run(&words);
        assert_eq!(ended.code, Some(0), "{words:?}: {ended:?}");
    }
}

#[test]
#[ignore = "needs root: acts as another user"]
fn copy_of_an_open_recording_is_made_in_the_groups_own_folder() {
    let group = Group::up(&["group.recorder.free_min_mib=0"]);
    let place = Place::new();
    let name = wait_for("a recording", 20.0, || {
        let listed = group.must(&["record", "list", "--json"]).stdout;
        let first: serde_json::Value = serde_json::from_str(listed.lines().last()?).ok()?;
        (first["state"] == "being_written").then(|| first["name"].as_str().map(str::to_owned))?
    });
    as_other_user(|| {
        symlink(place.own("file"), place.shared(&format!("{name}.mcap"))).unwrap();
    });
    for _ in 0..2 {
        let mut open = group.command(&["record", "open", "--json"]);
        let opened = run(open.env("TMPDIR", place.shared("")), "", LONGEST_S);
        assert_eq!(opened.code, Some(0), "{opened:?}");
        let file = PathBuf::from(opened.json()["file"].as_str().unwrap());
        assert!(file.starts_with(group.paths().root()) && file.is_file(), "{opened:?}");
        assert_eq!(fs::read_dir(file.parent().unwrap()).unwrap().count(), 1, "one copy is kept");
    }
    place.assert_untouched("record open");
    group.down();
}
