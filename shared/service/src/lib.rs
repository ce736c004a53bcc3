//! The shell: the only place that opens topics, reads clocks, takes signals and writes files for
//! the services. What every process of a group needs, also one from outside, is in `runtime`, whose modules
//! appear here, too.

pub mod audio;
mod commit;
pub mod console_link;
pub mod control;
pub mod exit;
pub mod flight;
pub mod inspection;
mod journal_clock;
pub mod journal_record;
pub mod journal_set;
pub mod kept_settings;
pub mod launch;
pub mod log_file;
pub mod log_tail;
pub mod logging;
pub mod printable;
mod reducer;
pub mod robot_topics;
pub mod service_loop;
pub mod status;
pub mod storage;
pub mod view;
pub mod wall_time;
pub mod worker_channel;

pub use journal::{replace_file, replace_file_synced};
pub use reducer::{Effects, Event, Never, Node, NodeError, SetAside};
pub use runtime::{Span, Time};
pub use runtime::{
    bus, client, clock, epoch, folders, group, lifecycle, notify, shm_cleanup, stop_socket,
    submission, wakes,
};
