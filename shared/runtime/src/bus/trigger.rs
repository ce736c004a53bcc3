//! What wakes a sleeping service: iceoryx2's datagram socket, and a counter of each process that wakes it often.
//!
//! A datagram has to be received, or its socket's short queue fills up and wake-ups are lost; a counter need not be
//! read. So a writer that goes on offers a counter (see [`super::counter`]), and later wake-ups add to it once it is taken.
//! A command such as `whichone say` wakes a service a few times and ends: an offer would cost more than it saves.

use super::counter::Offered;
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
use std::mem::MaybeUninit;
use std::os::fd::BorrowedFd;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::Duration;

type Bits = RelocatableCountingBitSet;
type Storage = Segment<State<Bits, ()>>;
type SocketHandle = UnixDatagramHandle<Bits, Storage>;
type SocketWaiter = UnixDatagramWaiter<Bits, Storage>;

/// Datagrams to a listener before the one that offers a counter: more than a command sends.
const DATAGRAMS: u8 = 8;

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
    /// Wake-ups before the offer.
    woken: AtomicU8,
    /// The counter once it has been offered; none where that was not possible.
    counter: OnceLock<Option<Offered>>,
}

impl Handle {
    /// Returns whether the listener has been woken with the counter, or with the offer of one.
    fn wakes_by_counter(&self) -> bool {
        match self.counter.get() {
            Some(counter) => counter.as_ref().is_some_and(Offered::wake),
            None if self.woken.fetch_add(1, Ordering::Relaxed) < DATAGRAMS => false,
            None => {
                let offer = || Offered::send(borrow(self.socket.file_descriptor())).ok();
                self.counter.get_or_init(offer).is_some()
            }
        }
    }
}

impl HandlerInterface<Bits, (), Storage> for Handle {
    fn open(name: &FileName, config: &Configuration, mgmt: &()) -> Result<Self, NotifierOpenError> {
        let socket = SocketHandle::open(name, config, mgmt)?;
        Ok(Self { socket, woken: AtomicU8::new(0), counter: OnceLock::new() })
    }

    fn notify(&self) -> Result<(), NotifierNotifyError> {
        if self.wakes_by_counter() { Ok(()) } else { self.socket.notify() }
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
            core::ptr::drop_in_place(&raw mut this.counter);
        }
    }
}

/// The listening end. Its socket is emptied by [`super::WakeListener`], which also takes the counters
/// that come with datagrams; here only the events are collected.
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
