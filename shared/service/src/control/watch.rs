//! A thread that asks the supervisor for the group's status again and again.

use std::io;
use std::time::Duration;

use super::{Reply, Request, call};
use crate::group::GroupPaths;
use crate::status::GroupStatus;

/// Timeout of one answer.
const PATIENCE: Duration = Duration::from_secs(2);

/// Status of the group, or why there is none.
pub type Watched = Result<Box<GroupStatus>, String>;

/// Requests the group's status on its own thread, as answers take time. `take` gets each one and
/// must not wait; `pause` waits until the next one is wanted, and returns false to end the thread.
///
/// # Errors
/// The operating system has no thread left.
pub fn watch_supervisor(
    paths: &GroupPaths,
    mut take: impl FnMut(Watched) + Send + 'static,
    mut pause: impl FnMut() -> bool + Send + 'static,
) -> io::Result<()> {
    let socket = paths.control_socket();
    let watch = move || {
        loop {
            take(match call(&socket, &Request::Status, PATIENCE) {
                Ok(Reply::Status(status)) => Ok(status),
                Ok(other) => Err(format!("expected a status, found {other:?}")),
                Err(error) => Err(error.to_string()),
            });
            if !pause() {
                return;
            }
        }
    };
    std::thread::Builder::new().name("supervisor".into()).spawn(watch).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::group::GroupName;

    #[test]
    fn watcher_reports_a_missing_group_until_it_is_stopped() {
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("lab").unwrap()).unwrap();
        let (sender, statuses) = std::sync::mpsc::channel();
        let mut left = 2;
        let take = move |status: Watched| drop(sender.send(status));
        let pause = move || {
            left -= 1;
            left > 0
        };
        watch_supervisor(&paths, take, pause).unwrap();
        let all: Vec<Watched> = statuses.iter().collect();
        assert_eq!(all.len(), 2);
        let is_missing = |status: &Watched| {
            status.as_ref().is_err_and(|why| why.contains("group lab is not running"))
        };
        assert!(all.iter().all(is_missing), "{all:?}");
    }
}
