//! The connection to the supervisor, on a thread of its own: answers may take a while.

use std::sync::Arc;
use std::time::Duration;

use crossbeam_channel::{Receiver, RecvTimeoutError};
use service::control::{Reply, Request, call};
use service::group::GroupPaths;
use service::worker_channel::DeviceSender;

use crate::hub::ViewerId;
use crate::hub::command::Command;
use crate::hub::outbound::Answer;
use crate::server::App;

/// Interval at which the supervisor is polled.
const ASK_EVERY: Duration = Duration::from_secs(1);
/// Timeout of its answer.
const PATIENCE: Duration = Duration::from_secs(2);

/// A restart that a viewer has requested.
pub(crate) type Restart = (ViewerId, u64, String);

/// Requests the group's status every second, and restarts as they come, until their senders are gone.
pub(crate) fn watch(
    paths: &GroupPaths,
    app: &Arc<App>,
    restarts: Receiver<Restart>,
    main_loop: DeviceSender<Command>,
) -> std::io::Result<()> {
    let (socket, hub) = (paths.control_socket(), Arc::downgrade(app));
    let ask = move || loop {
        let status = match call(&socket, &Request::Status, PATIENCE) {
            Ok(Reply::Status(status)) => Ok(status),
            Ok(other) => Err(format!("{other:?}")),
            Err(error) => Err(error.to_string()),
        };
        // A full inbox gets the next status a second later.
        let _ = main_loop.offer(Command::Group(status));
        match restarts.recv_timeout(ASK_EVERY) {
            Ok((viewer, id, service)) => {
                let restart = Request::Restart { service, original: false, wait_ms: 0 };
                let outcome = match call(&socket, &restart, PATIENCE) {
                    Ok(Reply::Done { message }) => Ok(Some(Answer::Supervisor { message })),
                    Ok(_) => Ok(None),
                    Err(error) => Err(error.to_string()),
                };
                let Some(app) = hub.upgrade() else { return };
                app.hub.answer(viewer, id, outcome);
            }
            Err(RecvTimeoutError::Timeout) if hub.strong_count() > 0 => {}
            Err(_) => return,
        }
    };
    std::thread::Builder::new().name("supervisor".into()).spawn(ask).map(drop)
}
