//! Shared memory that is full, in a small one that nothing else on the machine sees.

use messages::{AppliedMark, Epoch, Injection, PolicyView, Receipt, Sound, topics};
use rustix::fs::{FallocateFlags, fallocate};
use rustix::process::Signal;
use service::Span;
use service::bus::{Bus, BusError, EncodedReader, EncodedWriter, Identity, Reader, SegmentError};
use service::client::{Client, deliver};
use service::group::{GroupName, GroupPaths, SHM};
use service::shm_cleanup::{self, Admin};
use std::cell::RefCell;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::Instant;
use vocabulary::{ActKind, Ended};
use whichone_tests::isolated::with_shared_memory;
use whichone_tests::{Group, wait_for};

/// Memory that somebody else takes; given back when dropped.
struct Ballast(PathBuf, File);

impl Ballast {
    /// Takes everything that is free.
    fn fill() -> Self {
        let path = Path::new(SHM).join("ballast");
        let ballast = Self(path.clone(), File::create(path).unwrap());
        ballast.grow();
        assert_eq!(free(), 0);
        ballast
    }

    /// Takes what has become free since.
    fn grow(&self) {
        let mut step = 1 << 24;
        while step >= 4096 {
            let end = self.1.metadata().unwrap().len();
            if fallocate(&self.1, FallocateFlags::empty(), end, step).is_err() {
                step /= 2;
            }
        }
    }
}

impl Drop for Ballast {
    fn drop(&mut self) {
        // A process that a test beside this one starts may hold the file open for a moment.
        self.1.set_len(0).unwrap();
        std::fs::remove_file(&self.0).unwrap();
    }
}

fn free() -> u64 {
    rustix::fs::statvfs(SHM).unwrap().f_bavail
}

/// A client with everything open that a dialogue needs.
struct Talker {
    injections: EncodedWriter<Injection>,
    receipts: Reader<Receipt>,
    views: EncodedReader<PolicyView>,
    view: RefCell<PolicyView>,
    _client: Client,
}

impl Talker {
    fn join(group: &Group) -> Self {
        let client = Client::join(group.paths()).unwrap();
        let bus = client.bus();
        Self {
            injections: bus.encoded_writer(&topics::INJECTION).unwrap(),
            receipts: bus.reader(&topics::RECEIPT).unwrap(),
            views: bus.encoded_reader(&topics::VIEW).unwrap(),
            view: RefCell::default(),
            _client: client,
        }
    }

    fn say(&self, words: &str) {
        let now = (service::clock::now(), service::Time(0));
        let words = Sound::Text(words.to_owned());
        deliver(&self.injections, &self.receipts, words, now, Span::from_s(10.0), || None).unwrap();
    }

    /// The robot's newest view.
    fn view(&self) -> PolicyView {
        if let Some(view) = self.views.latest().unwrap() {
            self.view.replace(view);
        }
        self.view.borrow().clone()
    }

    /// Asks for an object, repeats the request whenever the robot shows a question, also one that
    /// it repeats because the answer came before it, and waits until the interaction has ended.
    fn fetch(&self, words: &str) -> Ended {
        let number = |view: &PolicyView| view.last.as_ref().map_or(0, |ended| ended.interaction.0);
        let before = number(&self.view());
        self.say(words);
        let mut said = Instant::now();
        wait_for("the end of the interaction", 40.0, || {
            let view = self.view();
            if view.decision == ActKind::Ask && said.elapsed().as_secs_f64() > 0.5 {
                self.say(words);
                said = Instant::now();
            }
            view.last.filter(|ended| ended.interaction.0 > before)
        })
    }
}

#[test]
#[ignore = "needs root: mounts a small /dev/shm"]
fn full_memory_is_an_error_of_the_creator_and_of_nobody_else() {
    let home = tempfile::tempdir().unwrap();
    let paths = GroupPaths::in_home(home.path(), &GroupName::new("full").unwrap()).unwrap();
    with_shared_memory(32, || {
        let group = Admin::open(&paths, Epoch(1)).unwrap();
        let join =
            || Bus::open(&paths, "test", Identity { epoch: Epoch(1), ..Identity::default() });
        let (one, two) = (join().unwrap(), join().unwrap());
        let marks = one.writer::<AppliedMark>(&topics::MARK).unwrap();
        let views = one.encoded_writer::<PolicyView>(&topics::VIEW).unwrap();
        let read_marks = two.reader::<AppliedMark>(&topics::MARK).unwrap();
        let read_views = two.encoded_reader::<PolicyView>(&topics::VIEW).unwrap();
        let view = |objects| PolicyView { belief: vec![0.5; objects], ..PolicyView::default() };

        let ballast = Ballast::fill();
        let error = two.encoded_writer::<Injection>(&topics::INJECTION).unwrap_err();
        assert!(error.to_string().contains("KiB needed, 0 KiB free in /dev/shm; help:"), "{error}");
        assert!(matches!(error, BusError::Segment { cause: SegmentError::Room { .. }, .. }));
        assert!(two.reader::<AppliedMark>(&topics::MARK).is_err());
        // Each page that these touch was reserved, however often they go round.
        for seq in 0..200 {
            marks.send(&AppliedMark { seq }).unwrap();
            assert_eq!(read_marks.latest().unwrap(), Some(AppliedMark { seq }));
            views.send(&view(100 + seq as usize)).unwrap();
            assert!(read_views.latest().unwrap().is_some());
        }
        // What would have to grow is not shown, and its writer goes on.
        views.send(&view(10_000)).unwrap();
        assert_eq!(read_views.latest().unwrap(), None);
        views.send(&view(3)).unwrap();
        assert_eq!(read_views.latest().unwrap(), Some(view(3)));

        drop(ballast);
        views.send(&view(10_000)).unwrap();
        assert_eq!(read_views.latest().unwrap(), Some(view(10_000)));
        two.encoded_writer::<Injection>(&topics::INJECTION).unwrap();
        drop((marks, views, read_marks, read_views, one, two, group));
        shm_cleanup::remove_leftovers(&paths);
    });
}

#[test]
#[ignore = "needs root: mounts a small /dev/shm"]
fn group_that_does_not_fit_is_refused_with_the_figure() {
    with_shared_memory(4, || {
        let mut group = Group::new();
        let ended = group.start(&["group.shared_memory.free_min_mib=1"]);
        assert_ne!(ended.code, Some(0));
        let all = format!("{ended:?}\n{}", group.logs());
        assert!(all.contains("shared memory is full") && all.contains("KiB needed"), "{all}");
        group.call(&["down"]);
    });
}

#[test]
#[ignore = "needs root: mounts a small /dev/shm"]
fn group_goes_on_in_full_memory_and_recovers_by_itself() {
    with_shared_memory(64, || {
        let group = Group::up(&[]);
        let talker = Talker::join(&group);
        let services = ["speech", "grounding", "policy", "arm", "console"];
        let before = services.map(|service| group.incarnation(service));

        let ballast = Ballast::fill();
        for _ in 0..2 {
            let ended = talker.fetch("the clear bowl");
            assert_eq!(ended.name.as_deref(), Some("clear"), "{ended:?}\n{}", group.logs());
        }
        assert_eq!(services.map(|service| group.incarnation(service)), before, "{}", group.logs());
        // Some memory may have become free since.
        ballast.grow();
        let ended = group.call(&["say", "the clear bowl"]);
        assert_eq!(ended.code, Some(74), "{ended:?}");
        assert!(ended.stderr.contains("shared memory is full"), "{ended:?}");

        // A service that is killed takes the room that it had.
        let of_policy = group.incarnation("policy");
        group.signal("policy", Signal::KILL);
        group.wait_for_restart("policy", of_policy);
        assert_eq!(talker.fetch("the clear bowl").name.as_deref(), Some("clear"));

        // If somebody else takes that room, it starts once there is some. Some of it may become free only after the
        // ballast has grown: then the service starts, and the ballast grows again.
        let squeeze = || {
            let before = group.incarnation("grounding");
            group.must(&["hold", "grounding"]);
            ballast.grow();
            group.call(&["release", "grounding"]);
            before
        };
        let mut of_grounding = squeeze();
        wait_for("a start that fails for want of memory", 20.0, || {
            let grounding = group.service("grounding");
            if grounding["actual"] == "ready" {
                of_grounding = squeeze();
            }
            grounding.to_string().contains("shared memory is full").then_some(())
        });
        assert_eq!(group.service("speech")["actual"], "ready");

        drop(ballast);
        let freed = Instant::now();
        group.wait_for_restart("grounding", of_grounding);
        eprintln!(
            "ready {:.1} s after shared memory was free again",
            freed.elapsed().as_secs_f64()
        );
        assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
        group.verify_journals();
        group.down();
    });
}
