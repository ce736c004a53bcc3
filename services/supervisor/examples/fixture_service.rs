//! A service for tests: well-behaved, or with one fault that its first argument names.
//!
//! Notes what happens to it in the file `events` of the group's folder, one line each.

#![expect(clippy::unwrap_used, reason = "a fixture fails loudly")]

use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::os::unix::net::UnixDatagram;
use std::path::PathBuf;
use std::process::{Command, ExitCode};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

const PASS: Duration = Duration::from_millis(10);

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        [] | ["ready"] => serve(|_| None, Ending::Prompt),
        ["never-ready"] => wait_for_the_end(),
        ["exits", code] => ExitCode::from(code.parse::<u8>().unwrap()),
        ["short-of", what] => {
            notify(&format!("X_SHORTAGE={what}"));
            serve(|since| (since > PASS * 5).then_some(1), Ending::Prompt)
        }
        ["ignores-term"] => serve(|_| None, Ending::Never),
        ["ends-slowly", ms] => {
            serve(|_| None, Ending::After(Duration::from_millis(ms.parse().unwrap())))
        }
        ["hangs"] => serve(
            |since| {
                if since > Duration::from_millis(100) {
                    wait_for_the_end();
                }
                None
            },
            Ending::Prompt,
        ),
        ["leaves", "child"] => leave(&["sleep", "1000"]),
        ["leaves", "daemon"] => leave(&["setsid", "sleep", "1000"]),
        ["floods"] => serve(
            |_| {
                let _ = std::io::stderr().write_all(&[b'x'; 1 << 16]);
                None
            },
            Ending::Prompt,
        ),
        _ => ExitCode::from(64),
    }
}

/// Behaviour of the service on a shutdown request.
enum Ending {
    Prompt,
    After(Duration),
    Never,
}

/// Becomes ready and beats; `each_pass` may end it with a code.
fn serve(mut each_pass: impl FnMut(Duration) -> Option<u8>, ending: Ending) -> ExitCode {
    let requested = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT] {
        signal_hook::flag::register(signal, Arc::clone(&requested)).unwrap();
    }
    let orphaned = watch_lifeline();
    let since = Instant::now();
    note("ready");
    notify("READY=1\nX_VERSION=fixture\nSTATUS=all well");
    let mut stop_requested_at = None;
    loop {
        thread::sleep(PASS);
        notify("WATCHDOG=1\nX_INPUT_AGE_MS=7");
        if let Some(code) = each_pass(since.elapsed()) {
            return ExitCode::from(code);
        }
        let is_orphan = orphaned.load(Ordering::Relaxed);
        if !is_orphan && !requested.load(Ordering::Relaxed) {
            continue;
        }
        let stop_requested_at = *stop_requested_at.get_or_insert_with(Instant::now);
        match ending {
            Ending::Never if !is_orphan => continue,
            Ending::After(time) if stop_requested_at.elapsed() < time => continue,
            Ending::Prompt | Ending::After(_) | Ending::Never => {
                note(if is_orphan { "orphaned" } else { "ended" });
                return ExitCode::SUCCESS;
            }
        }
    }
}

/// Puts a process into the background and then serves as if nothing had happened.
fn leave(command: &[&str]) -> ExitCode {
    let script = format!("{} >/dev/null 2>&1 & echo $!", command.join(" "));
    let output = Command::new("sh").args(["-c", &script]).output().unwrap();
    note(&format!("left {}", String::from_utf8_lossy(&output.stdout).trim()));
    serve(|_| None, Ending::Prompt)
}

fn wait_for_the_end() -> ! {
    loop {
        thread::sleep(Duration::from_secs(1000));
    }
}

/// Becomes true when the supervisor is gone.
fn watch_lifeline() -> Arc<AtomicBool> {
    let orphaned = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&orphaned);
    let fd = std::env::var("WHICHONE_LIFELINE_FD").unwrap();
    let mut lifeline = File::open(format!("/proc/self/fd/{fd}")).unwrap();
    thread::spawn(move || {
        let _ = lifeline.read(&mut [0]);
        flag.store(true, Ordering::Relaxed);
    });
    orphaned
}

fn notify(state: &str) {
    let socket = UnixDatagram::unbound().unwrap();
    socket.set_nonblocking(true).unwrap();
    let _ = socket.send_to(state.as_bytes(), std::env::var("NOTIFY_SOCKET").unwrap());
}

fn note(what: &str) {
    let var = |key| std::env::var(key).unwrap();
    let folder = PathBuf::from(var("WHICHONE_HOME")).join(var("WHICHONE_GROUP"));
    let file = OpenOptions::new().append(true).create(true).open(folder.join("events"));
    let line = format!("{} {} {what}\n", var("WHICHONE_SERVICE"), var("WHICHONE_INCARNATION"));
    file.unwrap().write_all(line.as_bytes()).unwrap();
}
