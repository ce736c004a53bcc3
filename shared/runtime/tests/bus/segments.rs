//! The segments behind the topics: reserved, private, and never waited for without end.

use messages::topics;
use messages::{AppliedMark, Epoch, Incarnation, PolicyView, Service};
use runtime::bus::{Bus, BusError, Identity, SegmentError};
use runtime::group::GroupPaths;
use runtime::shm_cleanup;
use std::fs::{self, File};
use std::os::unix::fs::MetadataExt;
use std::path::PathBuf;
use std::sync::mpsc;
use std::time::Duration;

use super::Shm;

/// Timeout for an open that must fail by itself.
const OPEN_MAX: Duration = Duration::from_secs(5);

impl Shm {
    /// Files whose names contain `part`.
    fn files(&self, part: &str) -> Vec<PathBuf> {
        let all = shm_cleanup::leftovers(&self.paths).into_iter();
        all.filter(|path| path.is_file() && path.to_string_lossy().contains(part)).collect()
    }

    /// Runs `open` in a thread of its own, so that the test ends even if it hangs.
    fn refused(
        &self,
        open: impl FnOnce(&GroupPaths) -> Result<(), BusError> + Send + 'static,
    ) -> BusError {
        let (done, result) = mpsc::channel();
        let paths = self.paths.clone();
        std::thread::spawn(move || done.send(open(&paths)));
        result.recv_timeout(OPEN_MAX).expect("an end in time").unwrap_err()
    }
}

fn join(paths: &GroupPaths) -> Result<Bus, BusError> {
    Bus::open(paths, "test", Identity { epoch: Epoch(1), incarnation: Incarnation(1) })
}

fn read_marks(paths: &GroupPaths) -> Result<(), BusError> {
    join(paths)?.reader::<AppliedMark>(&topics::MARK).map(drop)
}

#[test]
fn segments_are_private_and_their_pages_are_reserved() {
    let shm = Shm::new();
    let bus = join(&shm.paths).unwrap();
    let _listener = bus.wake_listener(Service::Speech).unwrap();
    let _marks = bus.writer::<AppliedMark>(&topics::MARK).unwrap();
    let _views = bus.encoded_writer::<PolicyView>(&topics::VIEW).unwrap();
    let other = join(&shm.paths).unwrap();
    let _read = other.reader::<AppliedMark>(&topics::MARK).unwrap();
    for kind in ["global_mgmt", ".dynamic", ".data", ".connection", ".event"] {
        assert!(!shm.files(kind).is_empty(), "no {kind}");
    }
    for path in shm.files("") {
        let file = path.metadata().unwrap();
        assert_eq!(file.mode() & 0o777, 0o600, "{}", path.display());
        assert!(file.blocks() * 512 >= file.len(), "{}: has holes", path.display());
    }
}

#[test]
fn truncated_segments_are_an_error_and_no_hang() {
    let shm = Shm::new();
    let bus = join(&shm.paths).unwrap();
    // It is mapped here, and could not even be dropped.
    std::mem::forget(bus.writer::<AppliedMark>(&topics::MARK).unwrap());
    std::mem::forget(bus);
    for kind in [".dynamic", "global_mgmt"] {
        for path in shm.files(kind) {
            File::create(path).unwrap();
        }
        let error = shm.refused(read_marks);
        let BusError::Segment { cause: SegmentError::Incomplete { file }, .. } = &error else {
            panic!("{error}")
        };
        assert!(file.ends_with(kind) && error.to_string().contains("help:"), "{error}");
    }
}

#[test]
#[ignore = "needs root: gives a file to another user"]
fn second_user_owns_a_segment_and_it_is_refused() {
    let shm = Shm::new();
    let _bus = join(&shm.paths).unwrap();
    for path in shm.files("global_mgmt") {
        std::os::unix::fs::chown(path, Some(65534), Some(65534)).unwrap();
    }
    let error = shm.refused(|paths| join(paths).map(drop)).to_string();
    assert!(error.contains("belongs to user 65534; help:"), "{error}");
    shm.files("").into_iter().for_each(|path| drop(fs::remove_file(path)));
}

#[test]
fn leftovers_of_every_former_start_are_found() {
    let shm = Shm::new();
    let first = join(&shm.paths).unwrap();
    shm_cleanup::create_place(&shm.paths).unwrap();
    let second = join(&shm.paths).unwrap();
    assert_eq!(shm.files("global_mgmt").len(), 2);
    std::mem::forget((first, second));
    shm_cleanup::remove_leftovers(&shm.paths);
    assert_eq!(shm_cleanup::leftovers(&shm.paths), Vec::<PathBuf>::new());
}
