//! An installation is one file: `whichone` alone, in a folder of its own, from which it runs a whole group
//! with the configuration that is built in.

use std::path::{Path, PathBuf};
use std::process::Command;

use service::group::ENV_HOME;
use whichone_tests::{Ended, Group, program, run, wait_for};

/// `whichone` where cargo or a package would put it, and a user without any configuration.
struct Installed {
    folder: tempfile::TempDir,
    group: Group,
}

impl Installed {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let installed = Self { folder, group: Group::new() };
        std::fs::create_dir_all(installed.program().parent().unwrap()).unwrap();
        std::fs::create_dir(installed.empty()).unwrap();
        let built = program("whichone");
        // On another file system it is copied.
        std::fs::hard_link(&built, installed.program())
            .or_else(|_| std::fs::copy(&built, installed.program()).map(drop))
            .unwrap();
        installed
    }

    fn program(&self) -> PathBuf {
        self.folder.path().join("bin/whichone")
    }

    /// Home and working folder of the user.
    fn empty(&self) -> PathBuf {
        self.folder.path().join("home")
    }

    fn call(&self, words: &[&str]) -> Ended {
        let mut command = Command::new(self.program());
        command.args(words).current_dir(self.empty());
        command.env("HOME", self.empty()).env(ENV_HOME, self.group.paths().home());
        command.env("WHICHONE_GROUP", self.group.paths().name().as_str());
        for unset in ["WHICHONE_CONFIG", "XDG_CONFIG_HOME"] {
            command.env_remove(unset);
        }
        run(&mut command, "", 60.0)
    }

    fn must(&self, words: &[&str]) -> Ended {
        let ended = self.call(words);
        assert_eq!(ended.code, Some(0), "whichone {words:?}: {ended:?}\n{}", self.group.logs());
        ended
    }
}

#[test]
fn one_file_in_an_empty_folder_is_a_working_group() {
    let installed = Installed::new();
    installed.must(&["check"]);
    let up = ["up", "--detach", "--wait", "ready", "--timeout", "40", "--profile", "ci", "--json"];
    let up = installed.must(&up).json();
    assert!(up["config"].as_str().unwrap().contains("/built-in."), "{up}");
    let policy = installed.group.pid("policy").as_raw_nonzero();
    let comm = std::fs::read_to_string(format!("/proc/{policy}/comm")).unwrap();
    assert_eq!(comm, "whichone-policy\n", "lists of processes show the service");
    assert_is_identified(&installed);
    installed.must(&["say", "get me the bowl"]);
    let words = ["await", "pick", "--json", "--timeout", "50", "--answer-as", "white2"];
    let fetched = installed.must(&words).json();
    assert_eq!((&fetched["object"], &fetched["outcome"]), (&"white2".into(), &"delivered".into()));
    let before = installed.group.incarnation("policy");
    installed.must(&["restart", "policy"]);
    installed.group.wait_for_restart("policy", before);
    // A command that names the program of a service means the one inside, too.
    installed.must(&["swap", "grounding", "--", "whichone-grounding"]);
    wait_for("a dialogue after it", 20.0, || {
        (installed.call(&["say", "the clear bowl"]).code == Some(0)).then_some(())
    });
    installed.must(&["journal", "--verify"]);
    assert_eq!(
        std::fs::read_dir(installed.empty()).unwrap().count(),
        0,
        "nothing is put elsewhere"
    );
    installed.group.down();
}

/// Every place that states a build states the one that the program states: status, services, logs.
fn assert_is_identified(installed: &Installed) {
    let stated = installed.must(&["--version", "--json"]).json();
    let line = installed.must(&["--version"]).stdout;
    let status = installed.must(&["status", "--json"]).json();
    for key in ["version", "commit", "date", "features", "target"] {
        assert_eq!(status["build"][key], stated[key], "{key} in {status}");
    }
    let version = status["version"].as_str().unwrap();
    let commit = stated["commit"].as_str();
    assert!(commit.is_none_or(|commit| version.ends_with(commit)), "{version} in {stated}");
    let services = status["services"].as_array().unwrap();
    assert!(services.iter().all(|it| it["version"] == version), "{status}");
    let build = line.trim().strip_prefix("whichone ").unwrap();
    for name in ["supervisor", "policy", "arm"] {
        let log = installed.group.wait_for_log(name, "\n");
        let first = log.lines().next().unwrap();
        assert!(first.contains(&format!("whichone-{name} {build}")), "{first}, not {build}");
    }
}

#[test]
fn configuration_is_written_out_once_and_counts_from_then_on() {
    let installed = Installed::new();
    installed.must(&["init", "config"]);
    let written = installed.empty().join("config");
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let listed = Command::new("git").args(["ls-files", "config"]).current_dir(&top).output();
    // Without git every file counts; a scene of somebody's own need not be built in.
    let files = listed.ok().filter(|it| it.status.success() && !it.stdout.is_empty());
    let files = files.map_or_else(String::new, |it| String::from_utf8(it.stdout).unwrap());
    for file in files.lines() {
        let name = file.strip_prefix("config/").unwrap();
        let own = std::fs::read(written.join(name)).unwrap_or_default();
        let shipped = std::fs::read(top.join(file)).unwrap();
        assert!(own == shipped, "{name}: list it in services/whichone/src/shipped_files.rs");
    }
    let checked = installed.must(&["check"]);
    assert!(checked.stdout.contains("home/config is right"), "{checked:?}");
    installed.must(&["scene", "new", "mine"]);
    installed.must(&["check", "--set", "group.scene=mine"]);
    let again = installed.call(&["init", "config"]);
    assert_eq!(again.code, Some(64), "{again:?}");
    assert!(again.stderr.contains("nothing was written"), "{again:?}");
}

#[test]
fn new_scene_needs_a_configuration_of_ones_own() {
    let installed = Installed::new();
    let refused = installed.call(&["scene", "new", "mine"]);
    assert_eq!(refused.code, Some(78), "{refused:?}");
    assert!(refused.stderr.contains("whichone init config"), "{refused:?}");
}

#[test]
fn shells_are_offered_the_names_of_the_running_group() {
    let installed = Installed::new();
    let offers = |line: &[&str]| {
        let words: Vec<&str> = ["complete", "--", "whichone"].iter().chain(line).copied().collect();
        installed.must(&words).stdout
    };
    let folder = installed.group.paths().root();
    std::fs::create_dir(folder).unwrap();
    let name = installed.group.paths().name().as_str();
    assert_eq!(offers(&["status", "--group", ""]), format!("{name}\n"));
    assert_eq!(offers(&["await", "pick", "--answer-as", "whi"]), "white\nwhite2\nwhite3\n");
    // Bash itself, with the script that a package brings.
    let script = installed.must(&["completions", "bash"]).stdout;
    let ask = "COMP_WORDS=(whichone restart gro) COMP_CWORD=2; _whichone whichone gro restart; echo ${COMPREPLY[@]}";
    let mut bash = Command::new("bash");
    bash.arg("-s").current_dir(installed.empty());
    bash.env("PATH", format!("{}:/usr/bin:/bin", installed.folder.path().join("bin").display()));
    bash.env("HOME", installed.empty()).env(ENV_HOME, installed.group.paths().home());
    let ended = run(&mut bash, &format!("{script}\n{ask}\n"), 20.0);
    assert_eq!(ended.stdout, "grounding\n", "{ended:?}");
}
