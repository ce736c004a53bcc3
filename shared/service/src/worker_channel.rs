//! Blocking sources (a recogniser, a voice, a microphone) live on threads of their own and hand
//! their results to the main loop through a bounded channel that wakes it.

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded};
use rustix::event::{EventfdFlags, eventfd};
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Capacity of the channel; a faster source blocks.
const CHANNEL_LEN: usize = 256;

/// Wakes the main loop.
#[derive(Debug)]
struct Wake {
    counter: OwnedFd,
    /// Whether the counter may be above 0: else there is nothing to read.
    is_raised: AtomicBool,
}

impl Wake {
    fn raise(&self) {
        // The counter only fails to grow when it is full, and then the loop is awake anyway.
        let _ = rustix::io::write(&self.counter, &1_u64.to_ne_bytes());
        // Afterwards: every reader of this finds the counter raised.
        self.is_raised.store(true, Ordering::Release);
    }

    fn clear(&self) {
        if self.is_raised.swap(false, Ordering::AcqRel) {
            let _ = rustix::io::read(&self.counter, &mut [0_u8; 8]);
        }
    }
}

/// Sends messages to the main loop. Cheap to clone; usable from any thread.
#[derive(Debug)]
pub struct DeviceSender<T> {
    sender: Sender<T>,
    wake: Arc<Wake>,
}

impl<T> Clone for DeviceSender<T> {
    fn clone(&self) -> Self {
        Self { sender: self.sender.clone(), wake: Arc::clone(&self.wake) }
    }
}

impl<T> DeviceSender<T> {
    /// Sends `message`, blocking while the channel is full. Returns `false` after the loop's end.
    pub fn send(&self, message: T) -> bool {
        let sent = self.sender.send(message).is_ok();
        self.wake.raise();
        sent
    }

    /// Sends `message` if the channel is not full.
    ///
    /// # Errors
    /// The message, if the channel is full. Once the loop has ended, it never is.
    pub fn offer(&self, message: T) -> Result<(), T> {
        match self.sender.try_send(message) {
            Err(TrySendError::Full(message)) => Err(message),
            Ok(()) | Err(TrySendError::Disconnected(_)) => {
                self.wake.raise();
                Ok(())
            }
        }
    }
}

/// The main loop's receiver.
#[derive(Debug)]
pub struct DeviceReceiver<T> {
    receiver: Receiver<T>,
    wake: Arc<Wake>,
}

impl<T> DeviceReceiver<T> {
    /// Descriptor that is readable while messages are pending.
    pub fn fd(&self) -> BorrowedFd<'_> {
        self.wake.counter.as_fd()
    }

    /// Resets the wake-up; to be called before receiving, so that no message is missed.
    pub fn clear(&self) {
        self.wake.clear();
    }

    /// Returns the next pending message.
    pub fn take(&self) -> Option<T> {
        self.receiver.try_recv().ok()
    }
}

/// Creates a channel from device threads to the main loop.
///
/// # Errors
/// The operating system has no descriptor left.
pub fn channel<T>() -> std::io::Result<(DeviceSender<T>, DeviceReceiver<T>)> {
    let counter = eventfd(0, EventfdFlags::NONBLOCK | EventfdFlags::CLOEXEC)?;
    let wake = Arc::new(Wake { counter, is_raised: AtomicBool::new(false) });
    let (sender, receiver) = bounded(CHANNEL_LEN);
    Ok((DeviceSender { sender, wake: Arc::clone(&wake) }, DeviceReceiver { receiver, wake }))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;
    use rustix::event::{PollFd, PollFlags, poll};

    fn is_readable(receiver: &DeviceReceiver<u32>) -> bool {
        let now = rustix::time::Timespec { tv_sec: 0, tv_nsec: 0 };
        let fd = receiver.fd();
        poll(&mut [PollFd::from_borrowed_fd(fd, PollFlags::IN)], Some(&now)).unwrap() > 0
    }

    #[test]
    fn channel_is_readable_from_a_message_until_it_is_cleared() {
        let (sender, receiver) = channel().unwrap();
        for message in 0..3 {
            receiver.clear();
            assert!(!is_readable(&receiver));
            assert!(sender.send(message));
            sender.offer(message).unwrap();
            assert!(is_readable(&receiver));
            receiver.clear();
            assert!(!is_readable(&receiver));
            assert_eq!(
                [receiver.take(), receiver.take(), receiver.take()],
                [Some(message), Some(message), None]
            );
        }
    }
}
