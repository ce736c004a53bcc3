//! The machine's own limits in the same run: the floor under the group's figures; and what it reports of
//! a process.

use crate::report::Report;
use std::io::Write;
use std::os::unix::net::UnixDatagram;
use std::process::{Command, Stdio};
use std::time::Instant;

pub(crate) const SPAWN: &str = "spawn and end of /bin/true";
pub(crate) const SYNC: &str = "fdatasync of a 256-byte record";
pub(crate) const WAKE: &str = "wake-up of a sleeping thread (Unix datagram, one way)";

pub(crate) fn measure(report: &mut Report) {
    report.add(SPAWN, "ms", &spawn(), "floor of any start");
    report.add(SYNC, "ms", &sync(), "floor of any durable step");
    report.add(WAKE, "ms", &wake(), "floor of any hop between sleeping processes");
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

fn spawn() -> Vec<f64> {
    let once = || {
        let started = Instant::now();
        let ended = Command::new("/bin/true").stdin(Stdio::null()).status();
        ended.is_ok_and(|status| status.success()).then(|| milliseconds(started))
    };
    (0..50).filter_map(|_| once()).collect()
}

fn sync() -> Vec<f64> {
    let mut file = tempfile::tempfile().expect("a temporary file");
    let once = |_| {
        let started = Instant::now();
        file.write_all(&[7; 256]).expect("room for a record");
        file.sync_data().expect("a disk that syncs");
        milliseconds(started)
    };
    (0..200).map(once).collect()
}

fn wake() -> Vec<f64> {
    let (here, there) = UnixDatagram::pair().expect("a pair of sockets");
    let echo = std::thread::spawn(move || {
        let mut byte = [0];
        while there.recv(&mut byte).is_ok_and(|_| byte[0] != 0) && there.send(&byte).is_ok() {}
    });
    let mut byte = [1];
    let mut once = || {
        std::thread::sleep(std::time::Duration::from_millis(1));
        let started = Instant::now();
        here.send(&byte).and_then(|_| here.recv(&mut byte)).expect("an echo");
        milliseconds(started) / 2.0
    };
    let samples = (0..300).map(|_| once()).collect();
    here.send(&[0]).expect("a last word");
    echo.join().expect("an echo that ends");
    samples
}

/// Resident memory of a process, MiB.
pub(crate) fn resident_mib(pid: i32) -> Option<f64> {
    let text = std::fs::read_to_string(format!("/proc/{pid}/status")).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.split_whitespace().next()?.parse::<f64>().ok()? / 1024.0)
}
