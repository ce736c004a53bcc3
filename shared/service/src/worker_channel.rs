//! Blocking sources (a recogniser, a voice, a microphone) live on threads of their own and hand
//! what they have to the main loop through a bounded channel that wakes it.

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded};
use rustix::event::{EventfdFlags, eventfd};
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::sync::Arc;

/// Capacity of the channel; a faster source blocks.
const CHANNEL_LEN: usize = 256;

/// Sends messages to the main loop. Cheap to clone; usable from any thread.
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
    /// Sends `message`, blocking while the channel is full. Returns `false` once the loop has ended.
    pub fn send(&self, message: T) -> bool {
        let sent = self.sender.send(message).is_ok();
        // The counter only fails to grow when it is full, and then the loop is awake anyway.
        let _ = rustix::io::write(&self.wake, &1_u64.to_ne_bytes());
        sent
    }

    /// Sends `message` if the channel is not full.
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

/// The main loop's receiver.
#[derive(Debug)]
pub struct DeviceReceiver<T> {
    receiver: Receiver<T>,
    wake: Arc<OwnedFd>,
}

impl<T> DeviceReceiver<T> {
    /// Descriptor that is readable while messages are pending.
    pub fn fd(&self) -> BorrowedFd<'_> {
        self.wake.as_fd()
    }

    /// Resets the wake-up; to be called before receiving, so that no message is missed.
    pub fn clear(&self) {
        let _ = rustix::io::read(&self.wake, &mut [0_u8; 8]);
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
    let wake = Arc::new(eventfd(0, EventfdFlags::NONBLOCK | EventfdFlags::CLOEXEC)?);
    let (sender, receiver) = bounded(CHANNEL_LEN);
    Ok((DeviceSender { sender, wake: Arc::clone(&wake) }, DeviceReceiver { receiver, wake }))
}
