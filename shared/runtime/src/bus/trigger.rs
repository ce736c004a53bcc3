//! What wakes a sleeping service: iceoryx2's datagram socket, and a pipe from each process that has
//! woken it before.
//!
//! A datagram has to be received, or its socket's short queue fills up and wake-ups are lost; a byte
//! in a pipe wakes an edge-triggered sleeper without being read. So the first wake-up carries the
//! reading end of a pipe, and later ones are bytes in it. A listener that does not know about pipes
//! (iceoryx2's own, in programs of other languages) closes the end with the datagram, as does its
//! death: writing fails then, and the socket is used as before.

use super::segment::Segment;
use core::ptr::NonNull;
use iceoryx2::prelude::{FileName, Path};
use iceoryx2_bb_elementary_traits::testing::abandonable::Abandonable;
use iceoryx2_bb_lock_free::mpmc::counting_bit_set::RelocatableCountingBitSet;
use iceoryx2_bb_posix::file_descriptor::{FileDescriptor, FileDescriptorBased};
use iceoryx2_bb_posix::file_descriptor_set::SynchronousMultiplexing;
use iceoryx2_cal::event::common::EventImpl;
use iceoryx2_cal::event::trigger::unix_datagram_socket::{UnixDatagramHandle, UnixDatagramWaiter};
use iceoryx2_cal::event::trigger::{Configuration, HandlerInterface, State, WaiterInterface};
use iceoryx2_cal::event::{
    ListenerCreateError, ListenerWaitError, NotifierNotifyError, NotifierOpenError,
};
use iceoryx2_cal::named_concept::{NamedConceptPathHintRemoveError, NamedConceptRemoveError};
use rustix::net::{SendAncillaryBuffer, SendAncillaryMessage, SendFlags, sendmsg};
use rustix::pipe::{PipeFlags, pipe_with};
use std::io::IoSlice;
use std::mem::MaybeUninit;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::sync::OnceLock;
use std::time::Duration;

type Bits = RelocatableCountingBitSet;
type Storage = Segment<State<Bits, ()>>;
type SocketHandle = UnixDatagramHandle<Bits, Storage>;
type SocketWaiter = UnixDatagramWaiter<Bits, Storage>;

/// The event of a group: names and layout in shared memory are those of iceoryx2's datagram trigger.
pub(super) type Trigger = EventImpl<Bits, (), Storage, Handle, Waiter>;

/// Borrows the descriptor of one of iceoryx2's ports.
pub(super) fn borrow(descriptor: &FileDescriptor) -> BorrowedFd<'_> {
    // SAFETY: the descriptor is open as long as its owner, which the result borrows; nobody closes
    // it through the result.
    #[allow(unsafe_code)]
    unsafe {
        BorrowedFd::borrow_raw(descriptor.native_handle())
    }
}

/// The notifying end, for one listener.
#[derive(Debug)]
pub(crate) struct Handle {
    socket: SocketHandle,
    /// The pipe to the listener once it has been offered; none where that was not possible.
    pipe: OnceLock<Option<OwnedFd>>,
}

impl Handle {
    /// Wakes the listener with a datagram that carries a pipe's reading end.
    fn offer_pipe(&self) -> Option<OwnedFd> {
        let (reading, writing) = pipe_with(PipeFlags::CLOEXEC | PipeFlags::NONBLOCK).ok()?;
        let mut space = [MaybeUninit::uninit(); rustix::cmsg_space!(ScmRights(1))];
        let mut control = SendAncillaryBuffer::new(&mut space);
        let carried = [reading.as_fd()];
        control.push(SendAncillaryMessage::ScmRights(&carried));
        let flags = SendFlags::DONTWAIT | SendFlags::NOSIGNAL;
        let socket = borrow(self.socket.file_descriptor());
        sendmsg(socket, &[IoSlice::new(&[0])], &mut control, flags).ok()?;
        Some(writing)
    }
}

impl HandlerInterface<Bits, (), Storage> for Handle {
    fn open(name: &FileName, config: &Configuration, mgmt: &()) -> Result<Self, NotifierOpenError> {
        let socket = SocketHandle::open(name, config, mgmt)?;
        Ok(Self { socket, pipe: OnceLock::new() })
    }

    fn notify(&self) -> Result<(), NotifierNotifyError> {
        let is_woken = match self.pipe.get() {
            Some(pipe) => pipe.as_ref().is_some_and(|fd| rustix::io::write(fd, &[0]).is_ok()),
            None => self.pipe.get_or_init(|| self.offer_pipe()).is_some(),
        };
        if is_woken { Ok(()) } else { self.socket.notify() }
    }
}

impl FileDescriptorBased for Handle {
    fn file_descriptor(&self) -> &FileDescriptor {
        self.socket.file_descriptor()
    }
}

impl SynchronousMultiplexing for Handle {}

impl Abandonable for Handle {
    #[allow(unsafe_code)]
    unsafe fn abandon_in_place(mut this: NonNull<Self>) {
        // SAFETY: as the caller promises, `this` is valid and not used again.
        unsafe {
            let this = this.as_mut();
            SocketHandle::abandon_in_place(NonNull::from_mut(&mut this.socket));
            core::ptr::drop_in_place(&raw mut this.pipe);
        }
    }
}

/// The listening end. Its socket is emptied by [`super::WakeListener`], which also takes over the
/// pipes that come with datagrams; here only the events are collected.
#[derive(Debug)]
pub(crate) struct Waiter(SocketWaiter);

impl WaiterInterface<Bits, (), Storage> for Waiter {
    const IS_FILE_DESCRIPTOR_BASED: bool = true;

    #[allow(unsafe_code)]
    unsafe fn remove(
        name: &FileName,
        config: &Configuration,
    ) -> Result<bool, NamedConceptRemoveError> {
        // SAFETY: as the caller promises.
        unsafe { SocketWaiter::remove(name, config) }
    }

    fn remove_path_hint(value: &Path) -> Result<(), NamedConceptPathHintRemoveError> {
        SocketWaiter::remove_path_hint(value)
    }

    fn create(
        name: &FileName,
        config: &Configuration,
        mgmt: &mut MaybeUninit<()>,
    ) -> Result<Self, ListenerCreateError> {
        SocketWaiter::create(name, config, mgmt).map(Self)
    }

    fn try_wait(&self) -> Result<(), ListenerWaitError> {
        Ok(())
    }

    fn timed_wait(&self, timeout: Duration) -> Result<(), ListenerWaitError> {
        self.0.timed_wait(timeout)
    }

    fn blocking_wait(&self) -> Result<(), ListenerWaitError> {
        self.0.blocking_wait()
    }

    fn empty_buffer(&self) -> Result<(), ListenerWaitError> {
        Ok(())
    }
}

impl FileDescriptorBased for Waiter {
    fn file_descriptor(&self) -> &FileDescriptor {
        self.0.file_descriptor()
    }
}

impl SynchronousMultiplexing for Waiter {}

impl Abandonable for Waiter {
    #[allow(unsafe_code)]
    unsafe fn abandon_in_place(mut this: NonNull<Self>) {
        // SAFETY: as the caller promises, `this` is valid and not used again.
        unsafe { SocketWaiter::abandon_in_place(NonNull::from_mut(&mut this.as_mut().0)) }
    }
}
