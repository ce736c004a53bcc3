//! Blocking sources (a recogniser, a voice, a microphone) live on threads of their own and hand
//! what they have to the main loop through a bounded channel that wakes it.

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded};
use rustix::event::{EventfdFlags, eventfd};
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::sync::Arc;

/// Messages that wait for the main loop at a time; a source that is faster waits.
const CHANNEL_LEN: usize = 256;

/// Hands messages to the main loop. Cheap to clone; usable from any thread.
#[derive(Debug)]
pub struct DeviceSender<T> {
    sender: Sender<T>,
    wake: Arc<OwnedFd>,
}

impl<T> Clone for DeviceSender<T> {
    fn clone(&self) -> Self {
        Self { sender: self.sender.clone(), wake: Arc::clone(&self.wake) }
    }
}

impl<T> DeviceSender<T> {
    /// Hands over `message`, waiting while the channel is full. `false` once the loop has ended.
    pub fn send(&self, message: T) -> bool {
        let sent = self.sender.send(message).is_ok();
        // The counter only fails to grow when it is full, and then the loop is awake anyway.
        let _ = rustix::io::write(&self.wake, &1_u64.to_ne_bytes());
        sent
    }

    /// Hands over `message` if there is room.
    ///
    /// # Errors
    /// The message, where the channel is full. Once the loop has ended, nothing is ever full.
    pub fn offer(&self, message: T) -> Result<(), T> {
        match self.sender.try_send(message) {
            Err(TrySendError::Full(message)) => Err(message),
            Ok(()) | Err(TrySendError::Disconnected(_)) => {
                // As above.
                let _ = rustix::io::write(&self.wake, &1_u64.to_ne_bytes());
                Ok(())
            }
        }
    }
}

/// The main loop's end.
#[derive(Debug)]
pub struct DeviceReceiver<T> {
    receiver: Receiver<T>,
    wake: Arc<OwnedFd>,
}

impl<T> DeviceReceiver<T> {
    /// Readable while something waits.
    pub fn fd(&self) -> BorrowedFd<'_> {
        self.wake.as_fd()
    }

    /// Resets the wake-up; call before taking, so that nothing is slept over.
    pub fn clear(&self) {
        let _ = rustix::io::read(&self.wake, &mut [0_u8; 8]);
    }

    /// The next message that waits.
    pub fn take(&self) -> Option<T> {
        self.receiver.try_recv().ok()
    }
}

/// A channel from device threads to the main loop.
///
/// # Errors
/// The operating system has no descriptor left.
pub fn channel<T>() -> std::io::Result<(DeviceSender<T>, DeviceReceiver<T>)> {
    let wake = Arc::new(eventfd(0, EventfdFlags::NONBLOCK | EventfdFlags::CLOEXEC)?);
    let (sender, receiver) = bounded(CHANNEL_LEN);
    Ok((DeviceSender { sender, wake: Arc::clone(&wake) }, DeviceReceiver { receiver, wake }))
}
