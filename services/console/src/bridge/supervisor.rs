//! The connection to the supervisor, on a thread of its own: answers may take a while.

use std::sync::Arc;
use std::time::Duration;

use crossbeam_channel::{Receiver, RecvTimeoutError};
use service::control::{Reply, Request, call, watch_supervisor};
use service::group::GroupPaths;
use service::worker_channel::DeviceSender;

use crate::hub::ViewerId;
use crate::hub::command::Command;
use crate::hub::outbound::Answer;
use crate::server::App;

/// Interval at which the supervisor is polled.
const ASK_EVERY: Duration = Duration::from_secs(1);
/// Timeout of the answer to a restart.
const PATIENCE: Duration = Duration::from_secs(2);

/// A restart that a viewer has requested.
pub(crate) type Restart = (ViewerId, u64, String);

/// Requests the group's status every second, and restarts on demand, until the senders are gone.
pub(crate) fn watch(
    paths: &GroupPaths,
    app: &Arc<App>,
    restarts: Receiver<Restart>,
    main_loop: DeviceSender<Command>,
) -> std::io::Result<()> {
    let (socket, hub) = (paths.control_socket(), Arc::downgrade(app));
    // A full inbox gets the next status a second later.
    let take = move |status| drop(main_loop.offer(Command::Group(status)));
    let pause = move || match restarts.recv_timeout(ASK_EVERY) {
        Ok((viewer, id, service)) => {
            let restart = Request::Restart { service, original: false, wait_ms: 0 };
            let outcome = match call(&socket, &restart, PATIENCE) {
                Ok(Reply::Done { message }) => Ok(Some(Answer::Supervisor { message })),
                Ok(_) => Ok(None),
                Err(error) => Err(error.to_string()),
            };
            let app = hub.upgrade();
            if let Some(app) = &app {
                app.hub.answer(viewer, id, outcome);
            }
            app.is_some()
        }
        Err(RecvTimeoutError::Timeout) => hub.strong_count() > 0,
        Err(RecvTimeoutError::Disconnected) => false,
    };
    watch_supervisor(paths, take, pause)
}
