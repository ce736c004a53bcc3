//! Shortages for tests and measurements: a full disk, full shared memory, no free descriptor. They
//! are made on small file systems of their own, which needs root.

use crate::{Group, wait_for};
use messages::{JointStates, topics};
use rustix::process::{Pid, Resource, Rlimit, getrlimit, prlimit};
use service::bus::Reader;
use service::client::Client;
use service::{Time, clock};
use std::fs;
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Barrier};
use std::thread::JoinHandle;

/// Environment variable of a test that runs in mounts of its own.
const PRIVATE: &str = "WHICHONE_PRIVATE_MOUNTS";
/// Size of a group's disk, MiB.
const DISK_MIB: u32 = 24;
/// Size of its shared memory, MiB.
const SHARED_MIB: u32 = 128;
/// Writers of [`BusyDisk`], and the size of the file of each, MiB.
const FOREIGN_WRITERS: usize = 2;
const FOREIGN_MIB: u32 = 256;
/// A joint that is slower stands still, rad/s.
const STILL_RAD_S: f64 = 1e-9;

/// A file system that can be filled.
#[derive(Debug)]
pub struct SmallDisk {
    folder: PathBuf,
    is_mounted_here: bool,
}

impl SmallDisk {
    /// Mounts one of `mib` MiB on `folder`.
    ///
    /// # Panics
    /// Without the permission to mount.
    pub fn mount(folder: &Path, mib: u32) -> Self {
        let size = format!("size={mib}m");
        let words = ["-t", "tmpfs", "-o", &size, "tmpfs"];
        let mounted = Command::new("mount").args(words).arg(folder).status();
        assert!(mounted.is_ok_and(|status| status.success()), "mount: this needs root");
        Self { folder: folder.to_owned(), is_mounted_here: true }
    }

    /// The small shared memory of [`in_private_mounts`].
    ///
    /// # Panics
    /// If called outside.
    pub fn shared_memory() -> Self {
        assert!(has_private_mounts(), "the machine's shared memory is not to be filled");
        Self { folder: "/dev/shm".into(), is_mounted_here: false }
    }

    fn ballast(&self) -> PathBuf {
        self.folder.join("ballast")
    }

    /// Takes all space that is left.
    ///
    /// # Panics
    /// If no file can be made.
    pub fn fill(&self) {
        let mut file = fs::File::create(self.ballast()).expect("a file on the small disk");
        for size in [1 << 20, 4096] {
            while file.write_all(&vec![1; size]).is_ok() {}
        }
    }

    /// Gives the space back.
    pub fn free(&self) {
        // It may never have been filled.
        let _ = fs::remove_file(self.ballast());
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        self.free();
        if self.is_mounted_here {
            let _ = Command::new("umount").arg("--lazy").arg(&self.folder).status();
            let _ = fs::remove_dir(&self.folder);
        }
    }
}

/// A group whose folder lies on a small disk.
#[derive(Debug)]
pub struct SmallGroup {
    /// The group; it is stopped before the disk is taken away.
    pub group: Group,
    /// The disk.
    pub disk: SmallDisk,
}

impl SmallGroup {
    /// Starts it with these overrides.
    ///
    /// # Panics
    /// Without root, or if the group does not become ready.
    pub fn up(settings: &[&str]) -> Self {
        let mut group = Group::new();
        let disk = SmallDisk::mount(group.paths().home(), DISK_MIB);
        let ended = group.start(settings);
        assert_eq!(ended.code, Some(0), "{ended:?}\n{}", group.logs());
        Self { group, disk }
    }
}

/// Returns whether this process runs in mounts of its own.
pub fn has_private_mounts() -> bool {
    std::env::var_os(PRIVATE).is_some()
}

/// Runs `body` in a process of its own whose shared memory is small and its own: runs the test of that
/// name once more.
///
/// # Panics
/// Without root, or if the test fails there.
pub fn in_private_mounts(test: &str, body: impl FnOnce()) {
    if has_private_mounts() {
        return body();
    }
    let script = format!(
        "mount -t tmpfs -o size={SHARED_MIB}m tmpfs /dev/shm && exec \"$0\" --exact {test} \
         --include-ignored --nocapture"
    );
    let own = std::env::current_exe().expect("the test's own path");
    let output = Command::new("unshare")
        .args(["--mount", "--propagation", "private", "sh", "-c", &script])
        .arg(own)
        .env(PRIVATE, "1")
        .output()
        .expect("unshare");
    // Not among the results of this process, which whoever counts tests would take for another test.
    let printed = [output.stdout, output.stderr].concat();
    assert!(
        output.status.success(),
        "{test} failed in mounts of its own:\n{}",
        String::from_utf8_lossy(&printed)
    );
}

/// Another process's load on a disk: writes large files and syncs them, until dropped.
#[derive(Debug)]
pub struct BusyDisk {
    over: Arc<AtomicBool>,
    writers: Vec<JoinHandle<()>>,
}

impl BusyDisk {
    /// Begins to write beside the group's folder. Returns once the disk has work.
    ///
    /// # Panics
    /// If no file can be made there.
    pub fn beside(group: &Group) -> Self {
        let home = group.paths().home();
        let folder = home.parent().expect("a folder of temporary folders").to_owned();
        let over = Arc::new(AtomicBool::new(false));
        let begun = Arc::new(Barrier::new(FOREIGN_WRITERS + 1));
        let start = |_| {
            let (over, begun) = (Arc::clone(&over), Arc::clone(&begun));
            let file = tempfile::tempfile_in(&folder).expect("a file on the group's disk");
            std::thread::spawn(move || keep_writing(file, &over, &begun))
        };
        let writers = (0..FOREIGN_WRITERS).map(start).collect();
        begun.wait();
        Self { over, writers }
    }
}

/// Overwrites a file again and again, each time with a sync.
fn keep_writing(mut file: fs::File, over: &AtomicBool, begun: &Barrier) {
    let block = vec![0xa5; 1 << 20];
    for round in 0.. {
        for _ in 0..FOREIGN_MIB {
            if over.load(Ordering::Relaxed) {
                return;
            }
            file.write_all(&block).expect("space on the group's disk");
        }
        if round == 0 {
            begun.wait();
        }
        file.sync_all().and_then(|()| file.rewind()).expect("a disk that syncs");
    }
}

impl Drop for BusyDisk {
    fn drop(&mut self) {
        self.over.store(true, Ordering::Relaxed);
        self.writers.drain(..).for_each(|writer| drop(writer.join()));
    }
}

/// Leaves a process without a free descriptor, until dropped.
#[derive(Debug)]
pub struct NoDescriptors {
    process: Pid,
    before: Rlimit,
}

impl NoDescriptors {
    /// Lowers the limit of `process` to the descriptors that it has open.
    ///
    /// # Panics
    /// If that is not permitted.
    pub fn of(process: Pid) -> Self {
        let folder = format!("/proc/{}/fd", process.as_raw_nonzero());
        let open = fs::read_dir(folder)
            .expect("a process of ours")
            .filter_map(|entry| entry.ok()?.file_name().to_str()?.parse::<u64>().ok());
        // Every number below the limit is taken, or cannot be: the lowest free one is the limit.
        let mut numbers: Vec<u64> = open.collect();
        numbers.sort_unstable();
        let free = numbers.iter().enumerate().find(|(i, number)| **number != *i as u64);
        let limit = free.map_or(numbers.len() as u64, |(i, _)| i as u64);
        let maximum = getrlimit(Resource::Nofile).maximum;
        let lowered = Rlimit { current: Some(limit), maximum };
        let before = prlimit(Some(process), Resource::Nofile, lowered).expect("a process of ours");
        Self { process, before }
    }
}

impl Drop for NoDescriptors {
    fn drop(&mut self) {
        // The process may have ended.
        let _ = prlimit(Some(self.process), Resource::Nofile, self.before);
    }
}

/// Watches the joints that a busy arm reports a hundred times a second.
#[derive(Debug)]
pub struct JointWatch {
    joints: Reader<JointStates>,
    _client: Client,
}

impl JointWatch {
    /// Opens it; needs shared memory, and so comes before a shortage.
    ///
    /// # Panics
    /// If the group cannot be joined.
    pub fn open(group: &Group) -> Self {
        let client = Client::join(group.paths()).expect("a running group");
        let joints = client.bus().reader(&topics::JOINTS).expect("joint states");
        Self { joints, _client: client }
    }

    /// Waits until a joint moves.
    ///
    /// # Panics
    /// If none does in time.
    pub fn wait_moving(&self) {
        wait_for("a moving joint", 30.0, || {
            let latest = self.joints.latest().expect("a topic that can be read")?;
            moves(&latest).then_some(())
        });
    }

    /// Returns whether a joint moves.
    ///
    /// # Panics
    /// If the topic breaks.
    pub fn is_moving(&self) -> bool {
        self.joints.latest().expect("a topic that can be read").is_some_and(|latest| moves(&latest))
    }

    /// Stops the arm with `whichone stop-motion` and returns the milliseconds until the last joint state in
    /// which something moves; none if the arm stood already, as between two steps.
    ///
    /// # Panics
    /// If the stop is not confirmed, or a joint moves afterwards.
    pub fn stop(&self, group: &Group) -> Option<f64> {
        self.stop_by(|| drop(group.must(&["stop-motion", "--json"])))
    }

    /// As [`JointWatch::stop`], by an order that returns once it is confirmed.
    ///
    /// # Panics
    /// If the order does, or a joint moves afterwards.
    pub fn stop_by(&self, order: impl FnOnce() + Send) -> Option<f64> {
        let given = clock::now();
        let mut last_moving = given;
        let mut seen = |joints: &JointStates| {
            if moves(joints) {
                last_moving = last_moving.max(Time(joints.at_ns));
            }
        };
        std::thread::scope(|scope| {
            let stop = scope.spawn(order);
            while !stop.is_finished() {
                self.joints.drain(&mut seen).expect("a topic that can be read");
                std::thread::sleep(std::time::Duration::from_millis(2));
            }
            stop.join().expect("a confirmed stop");
        });
        let confirmed = clock::now();
        wait_for("joint states after the stop", 10.0, || {
            let mut after = None;
            let drained = self.joints.drain(|joints| {
                assert!(Time(joints.at_ns) < confirmed || !moves(joints), "it moves again");
                seen(joints);
                after = (Time(joints.at_ns) > confirmed).then_some(()).or(after);
            });
            drained.expect("a topic that can be read");
            after
        });
        (last_moving > given).then(|| last_moving.since(given).s() * 1e3)
    }
}

fn moves(joints: &JointStates) -> bool {
    joints.velocity.iter().any(|velocity| velocity.abs() > STILL_RAD_S)
}
