//! The operator's side of the control socket.

use std::io::{self, BufRead, BufReader, ErrorKind, Write};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::time::Duration;

use thiserror::Error;

use super::{Reply, Request};

/// Why a request got no reply.
#[derive(Debug, Error)]
pub enum CallError {
    /// Nobody listens: the group does not run.
    #[error("no group {group} is running; start it with `whichone up{}`", of(.group))]
    NoGroup {
        /// The group's name.
        group: String,
    },
    /// The supervisor did not answer in time.
    #[error("the supervisor of group {group} did not answer within {} s", .timeout.as_secs_f64())]
    TimedOut {
        /// The group's name.
        group: String,
        /// How long it was waited for.
        timeout: Duration,
    },
    /// The connection broke: the supervisor ended meanwhile.
    #[error("the supervisor of group {group} ended before it answered")]
    Closed {
        /// The group's name.
        group: String,
    },
    /// The answer is not one, as of a supervisor of another version.
    #[error(
        "the supervisor of group {group} answered what this program does not understand: {why}"
    )]
    Unintelligible {
        /// The group's name.
        group: String,
        /// Where the understanding ended.
        why: String,
    },
    /// The socket cannot be used.
    #[error("{}: {error}", .path.display())]
    Io {
        /// The control socket.
        path: PathBuf,
        /// What the operating system says.
        error: io::Error,
    },
}

fn of(group: &str) -> String {
    if group == crate::group::GroupName::DEFAULT {
        String::new()
    } else {
        format!(" --group {group}")
    }
}

/// Asks the supervisor at control socket `path` and waits for its reply, at most for `timeout`.
///
/// For a request that itself waits, `timeout` should be longer than its `wait_ms`.
///
/// # Errors
/// No reply; see [`CallError`]. A request that is answered with
/// [`Reply::Refused`] is a reply.
pub fn call(path: &Path, request: &Request, timeout: Duration) -> Result<Reply, CallError> {
    let failed = |error: io::Error| explain(error, path, timeout);
    let mut stream = UnixStream::connect(path).map_err(failed)?;
    stream.set_read_timeout(Some(timeout)).map_err(failed)?;
    stream.set_write_timeout(Some(timeout)).map_err(failed)?;
    let mut line = serde_json::to_string(request).map_err(|e| failed(e.into()))?;
    line.push('\n');
    stream.write_all(line.as_bytes()).map_err(failed)?;
    let mut answer = String::new();
    BufReader::new(stream).read_line(&mut answer).map_err(failed)?;
    if !answer.ends_with('\n') {
        return Err(CallError::Closed { group: group_of(path) });
    }
    serde_json::from_str(&answer).map_err(|error| CallError::Unintelligible {
        group: group_of(path),
        why: error.to_string(),
    })
}

fn explain(error: io::Error, path: &Path, timeout: Duration) -> CallError {
    let group = group_of(path);
    match error.kind() {
        ErrorKind::NotFound | ErrorKind::ConnectionRefused => CallError::NoGroup { group },
        ErrorKind::WouldBlock | ErrorKind::TimedOut => CallError::TimedOut { group, timeout },
        ErrorKind::ConnectionReset | ErrorKind::BrokenPipe => CallError::Closed { group },
        _ => CallError::Io { path: path.to_owned(), error },
    }
}

/// The control socket lies in the run folder of the folder that is named after the group.
fn group_of(path: &Path) -> String {
    let folder = path.parent().and_then(Path::parent).and_then(Path::file_name);
    folder.map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use std::os::unix::net::UnixListener;
    use std::thread;

    use super::*;

    const SHORT: Duration = Duration::from_millis(100);

    fn socket(group: &str) -> (tempfile::TempDir, PathBuf) {
        let home = tempfile::tempdir().unwrap();
        let run = home.path().join(group).join("run");
        std::fs::create_dir_all(&run).unwrap();
        (home, run.join("control.sock"))
    }

    /// What `call` says when the supervisor answers with these bytes and closes.
    fn answered_with(answer: &'static str) -> Result<Reply, CallError> {
        let (_home, path) = socket("lab");
        let listener = UnixListener::bind(&path).unwrap();
        let server = thread::spawn(move || {
            let (stream, _) = listener.accept().unwrap();
            let mut line = String::new();
            BufReader::new(&stream).read_line(&mut line).unwrap();
            (&stream).write_all(answer.as_bytes()).unwrap();
        });
        let reply = call(&path, &Request::Ping, Duration::from_secs(5));
        server.join().unwrap();
        reply
    }

    #[test]
    fn without_a_group_it_says_how_to_start_one() {
        let (_home, path) = socket("lab");
        let told = call(&path, &Request::Ping, SHORT).unwrap_err().to_string();
        assert_eq!(told, "no group lab is running; start it with `whichone up --group lab`");
        drop(UnixListener::bind(&path).unwrap());
        let told = call(&path, &Request::Ping, SHORT).unwrap_err();
        assert!(matches!(told, CallError::NoGroup { .. }), "a socket that was left behind: {told}");
        let (_home, path) = socket("whichone");
        let told = call(&path, &Request::Ping, SHORT).unwrap_err().to_string();
        assert_eq!(told, "no group whichone is running; start it with `whichone up`");
    }

    #[test]
    fn every_way_not_to_answer_is_told() {
        assert!(matches!(answered_with(""), Err(CallError::Closed { .. })));
        assert!(matches!(answered_with("{\"reply\":"), Err(CallError::Closed { .. })));
        assert!(matches!(answered_with("?\n"), Err(CallError::Unintelligible { .. })));
        let (_home, path) = socket("lab");
        let _silent = UnixListener::bind(&path).unwrap();
        let told = call(&path, &Request::Ping, SHORT).unwrap_err();
        assert!(matches!(told, CallError::TimedOut { .. }), "{told}");
    }

    #[test]
    fn an_answer_is_handed_on() {
        let reply = answered_with("{\"reply\":\"done\",\"message\":\"so\"}\n").unwrap();
        assert_eq!(reply, Reply::Done { message: "so".into() });
    }
}
