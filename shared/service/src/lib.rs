//! The shell: the only place that opens topics, reads clocks, takes signals and writes files for
//! the services. iceoryx2 is reached through this crate alone.

pub mod audio;
pub mod bus;
pub mod client;
pub mod clock;
mod commit;
pub mod console_link;
pub mod control;
pub mod exit;
pub mod flight;
pub mod folders;
pub mod group;
pub mod inspection;
mod journal_clock;
pub mod journal_record;
pub mod journal_set;
pub mod kept_settings;
pub mod launch;
pub mod lifecycle;
pub mod log_file;
pub mod log_tail;
pub mod logging;
pub mod notify;
pub mod printable;
mod reducer;
pub mod robot_topics;
pub mod service_loop;
pub mod shm_cleanup;
pub mod status;
pub mod stop_socket;
pub mod storage;
pub mod submission;
mod sync_time;
pub mod view;
pub mod wall_time;
pub mod worker_channel;

pub use dialogue::time::{Span, Time};
pub use journal::{replace_file, replace_file_synced};
pub use reducer::{Effects, Event, Never, Node, NodeError, SetAside};
