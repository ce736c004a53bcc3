//! Every way to lose a journal between two starts, and the reaction to it.

use messages::{Epoch, Incarnation};

use super::*;
use crate::group::GroupName;

/// A group that has been started: its set exists.
struct Lab {
    _home: tempfile::TempDir,
    paths: GroupPaths,
}

impl Lab {
    fn new() -> Self {
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("lab").unwrap()).unwrap();
        fs::create_dir_all(paths.journal()).unwrap();
        JournalSet::new(7).save(&paths).unwrap();
        Self { _home: home, paths }
    }

    fn open(&self, service: &str) -> Result<Opened<u32>, Failure> {
        let environment = Environment {
            paths: self.paths.clone(),
            epoch: Epoch(7),
            incarnation: Incarnation(1),
            arguments: Vec::new(),
        };
        open(&environment, service, "number/1", &[])
    }

    /// A start in which the service records `number`.
    fn run(&self, service: &str, number: u32) -> Vec<u32> {
        let (mut journal, recovered, _) = self.open(service).unwrap();
        journal.append(&number).unwrap();
        journal.sync().unwrap();
        recovered.records
    }

    fn file(&self, service: &str) -> PathBuf {
        self.paths.journal_file(service)
    }

    fn problems(&self) -> Vec<String> {
        let set = JournalSet::load(&self.paths).unwrap().unwrap();
        set.check(&self.paths).iter().map(ToString::to_string).collect()
    }

    /// Asserts that the journal is refused with help at a service's start and at the supervisor's.
    #[track_caller]
    fn assert_lost(&self, service: &str, why: &str) {
        let failure = self.open(service).map(drop).unwrap_err();
        assert_eq!(failure.exit, Exit::Storage, "{failure}");
        assert_eq!(self.problems(), [failure.to_string()]);
        assert!(failure.to_string().contains(why), "{failure}");
        let help = format!("help: `whichone journal set-aside {service}`");
        assert!(failure.to_string().contains(&help), "{failure}");
    }
}

#[test]
fn journal_is_made_once_and_then_continued() {
    let lab = Lab::new();
    assert!(lab.problems().is_empty());
    assert_eq!(lab.run("policy", 1), Vec::<u32>::new());
    assert_eq!(lab.run("policy", 2), [1]);
    assert_eq!(lab.run("policy", 3), [1, 2]);
    assert!(lab.problems().is_empty());
}

#[test]
fn journal_that_is_lost_in_any_way_is_refused_by_name() {
    let lab = Lab::new();
    lab.run("arm", 1);
    lab.run("policy", 1);
    let whole = fs::read(lab.file("policy")).unwrap();
    fs::remove_file(lab.file("policy")).unwrap();
    lab.assert_lost("policy", "the file is missing");
    fs::write(lab.file("policy"), "").unwrap();
    lab.assert_lost("policy", "the file is empty");
    fs::write(lab.file("policy"), "{}").unwrap();
    lab.assert_lost("policy", "not a journal");
    let mut flipped = whole.clone();
    *flipped.last_mut().unwrap() ^= 1;
    fs::write(lab.file("policy"), flipped).unwrap();
    lab.assert_lost("policy", "damaged at byte");
    fs::write(lab.file("policy"), whole).unwrap();
    assert_eq!(lab.run("policy", 2), [1]);
}

/// A kill between making the file and saying so leaves a journal without records.
#[test]
fn journal_made_by_a_killed_service_is_taken_over() {
    let lab = Lab::new();
    let empty = JournalSet::load(&lab.paths).unwrap().unwrap();
    drop(lab.open("speech").unwrap());
    empty.save(&lab.paths).unwrap();
    assert!(lab.problems().is_empty());
    assert_eq!(lab.run("speech", 1), Vec::<u32>::new());
    assert_eq!(lab.run("speech", 2), [1]);
}

#[test]
fn journal_of_another_epoch_is_refused() {
    let lab = Lab::new();
    lab.run("policy", 1);
    JournalSet::new(8).save(&lab.paths).unwrap();
    assert_eq!(lab.open("policy").map(drop).unwrap_err().exit, Exit::Config);
    let problems = lab.problems();
    assert!(problems[0].contains("expected epoch 8, found a journal of epoch 7"), "{problems:?}");
}

#[test]
fn journal_set_aside_is_kept_and_its_numbers_are_over() {
    let lab = Lab::new();
    lab.run("policy", 1);
    lab.run("arm", 5);
    fs::write(safe_files::suffixed(&lab.file("policy"), 1), "older").unwrap();
    let folder = set_aside(&lab.paths, &[Service::Policy]).unwrap().unwrap();
    assert_eq!(fs::read_to_string(folder.join("policy.journal.1")).unwrap(), "older");
    assert!(folder.join("policy.journal").is_file() && !lab.file("policy").exists());
    assert!(lab.problems().is_empty());

    let over = NUMBERS_SKIPPED;
    let (journal, recovered, event) = lab.open("policy").unwrap();
    assert_eq!((recovered.records, event), (vec![], Some(SetAside { over, is_own: true })));
    drop(journal);
    let (journal, recovered, event) = lab.open("arm").unwrap();
    assert_eq!((recovered.records, event), (vec![5], Some(SetAside { over, is_own: false })));
    drop(journal);
    // Killed before its first record it is still the successor; after it no more.
    assert!(lab.open("policy").unwrap().2.unwrap().is_own);
    lab.run("policy", 2);
    assert!(!lab.open("policy").unwrap().2.unwrap().is_own);

    // The old file is not taken for the new one.
    fs::copy(folder.join("policy.journal"), lab.file("policy")).unwrap();
    lab.assert_lost("policy", "expected generation 2, found 1");
    let other = set_aside(&lab.paths, &[Service::Policy, Service::Speech]).unwrap().unwrap();
    assert_ne!(other, folder, "what is kept is never replaced");
    assert_eq!(lab.open("policy").unwrap().2.unwrap().over, 2 * over);
}

#[test]
fn journal_is_not_set_aside_under_a_running_group() {
    let lab = Lab::new();
    for path in [lab.paths.supervisor_lock(), lab.paths.alive_lock()] {
        let lock = safe_files::open_lock(&path).unwrap();
        flock(&lock, FlockOperation::LockShared).unwrap();
        let failure = set_aside(&lab.paths, &[Service::Arm]).unwrap_err();
        assert!(failure.to_string().contains("`whichone down` first"), "{failure}");
    }
    set_aside(&lab.paths, &[Service::Arm]).unwrap();
}
