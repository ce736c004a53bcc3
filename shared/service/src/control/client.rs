//! Client of the control socket.

use std::io::{self, BufRead, BufReader, ErrorKind, Write};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::time::Duration;

use thiserror::Error;

use super::{Refusal, Reply, Request};

/// Failure to get a reply.
#[derive(Debug, Error)]
pub enum CallError {
    /// The group of this name is not running.
    #[error("group {} is not running; help: start it with `whichone up{}`", .0, of(.0))]
    NoGroup(String),
    /// No answer within the timeout.
    #[error("the supervisor of group {} did not answer within {} s", .0, .1.as_secs_f64())]
    TimedOut(String, Duration),
    /// The supervisor ended before answering.
    #[error("the supervisor of group {0} ended before it answered")]
    Closed(String),
    /// An invalid answer, e.g. of a supervisor of another version, and the reason.
    #[error(
        "invalid answer of the supervisor of group {0}: {1}; help: use one version of all programs"
    )]
    Unintelligible(String, String),
    /// The supervisor rejects the request.
    #[error("{}", .0.message)]
    Refused(Refusal),
    /// Failure of the control socket.
    #[error("{}: {}", .0.display(), .1)]
    Io(PathBuf, io::Error),
}

impl CallError {
    /// An answer that is not one to the request, from the supervisor at control socket `path`.
    pub fn unintelligible(path: &Path, why: impl ToString) -> Self {
        Self::Unintelligible(group_of(path), why.to_string())
    }
}

fn of(group: &str) -> String {
    if group == crate::group::GroupName::DEFAULT {
        String::new()
    } else {
        format!(" --group {group}")
    }
}

/// Sends a request to the supervisor at control socket `path` and waits for the reply, at most
/// `timeout`.
///
/// For a request that itself waits, `timeout` should be longer than its `wait_ms`.
///
/// # Errors
/// No reply, or a refusal; see [`CallError`].
pub fn call(path: &Path, request: &Request, timeout: Duration) -> Result<Reply, CallError> {
    send(path, request, timeout)?.wait()
}

/// Sends a request to the supervisor at control socket `path`, whose reply is waited for later, at
/// most `timeout`.
///
/// # Errors
/// It cannot be sent; see [`CallError`].
pub fn send(path: &Path, request: &Request, timeout: Duration) -> Result<PendingReply, CallError> {
    let failed = |error: io::Error| explain(error, path, timeout);
    let mut stream = UnixStream::connect(path).map_err(failed)?;
    stream.set_read_timeout(Some(timeout)).map_err(failed)?;
    stream.set_write_timeout(Some(timeout)).map_err(failed)?;
    let mut line = serde_json::to_string(request).map_err(|e| failed(e.into()))?;
    line.push('\n');
    stream.write_all(line.as_bytes()).map_err(failed)?;
    Ok(PendingReply { stream, path: path.to_owned(), timeout })
}

/// The reply to a request that has been sent.
#[derive(Debug)]
pub struct PendingReply {
    stream: UnixStream,
    path: PathBuf,
    timeout: Duration,
}

impl PendingReply {
    /// Waits for the reply.
    ///
    /// # Errors
    /// No reply, or a refusal; see [`CallError`].
    pub fn wait(self) -> Result<Reply, CallError> {
        let Self { stream, path, timeout } = self;
        let mut answer = String::new();
        let read = BufReader::new(stream).read_line(&mut answer);
        read.map_err(|error| explain(error, &path, timeout))?;
        if !answer.ends_with('\n') {
            return Err(CallError::Closed(group_of(&path)));
        }
        match serde_json::from_str(&answer) {
            Ok(Reply::Refused(refusal)) => Err(CallError::Refused(refusal)),
            Ok(reply) => Ok(reply),
            Err(error) => Err(CallError::unintelligible(&path, error)),
        }
    }
}

fn explain(error: io::Error, path: &Path, timeout: Duration) -> CallError {
    let group = group_of(path);
    match error.kind() {
        ErrorKind::NotFound | ErrorKind::ConnectionRefused => CallError::NoGroup(group),
        ErrorKind::WouldBlock | ErrorKind::TimedOut => CallError::TimedOut(group, timeout),
        ErrorKind::ConnectionReset | ErrorKind::BrokenPipe => CallError::Closed(group),
        _ => CallError::Io(path.to_owned(), error),
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

    /// Returns the result of `call` if the supervisor answers with these bytes and closes.
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
    fn control_client_suggests_how_to_start_a_missing_group() {
        let (_home, path) = socket("lab");
        let error = call(&path, &Request::Ping, SHORT).unwrap_err().to_string();
        assert_eq!(
            error,
            "group lab is not running; help: start it with `whichone up --group lab`"
        );
        drop(UnixListener::bind(&path).unwrap());
        let error = call(&path, &Request::Ping, SHORT).unwrap_err();
        assert!(matches!(error, CallError::NoGroup(..)), "a stale socket: {error}");
        let (_home, path) = socket("whichone");
        let error = call(&path, &Request::Ping, SHORT).unwrap_err().to_string();
        assert_eq!(error, "group whichone is not running; help: start it with `whichone up`");
    }

    #[test]
    fn control_client_distinguishes_missing_answers() {
        assert!(matches!(answered_with(""), Err(CallError::Closed(..))));
        assert!(matches!(answered_with("{\"reply\":"), Err(CallError::Closed(..))));
        assert!(matches!(answered_with("?\n"), Err(CallError::Unintelligible(..))));
        let (_home, path) = socket("lab");
        let _silent = UnixListener::bind(&path).unwrap();
        let error = call(&path, &Request::Ping, SHORT).unwrap_err();
        assert!(matches!(error, CallError::TimedOut(..)), "{error}");
    }

    #[test]
    fn control_client_returns_the_reply() {
        let reply = answered_with("{\"reply\":\"done\",\"message\":\"so\"}\n").unwrap();
        assert_eq!(reply, Reply::Done { message: "so".into() });
    }
}
