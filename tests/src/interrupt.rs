//! Interrupted programs that run groups.

use crate::Group;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

/// From now on Ctrl-C and SIGTERM end this process after its groups, which would run on without it.
///
/// # Panics
/// If the system lets no signal be handled.
pub fn end_with_groups() {
    let mut signals = Signals::new([SIGINT, SIGTERM]).expect("handlers of signals");
    std::thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            // A panic that the end of a group causes must not end this process before the other groups.
            std::panic::set_hook(Box::new(|_| {
                loop {
                    std::thread::park();
                }
            }));
            Group::end_all();
            std::process::exit(128 + signal);
        }
    });
}
