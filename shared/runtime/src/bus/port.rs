//! Ports that do not know the type of their messages, as in iceoryx2's bindings for other
//! languages: the type's name, size and alignment are data. So there is one code for all types.
//!
//! All of iceoryx2's interface that is meant for its bindings is used here and nowhere else.

use super::Ipc;
use iceoryx2::port::publisher::Publisher;
use iceoryx2::port::subscriber::Subscriber;
use iceoryx2::port::{LoanError, ReceiveError, SendError};
use iceoryx2::sample::Sample;
use iceoryx2::sample_mut_uninit::SampleMutUninit;
use iceoryx2::service::builder::publish_subscribe::Builder;
use iceoryx2::service::marker::{CustomHeaderMarker, CustomPayloadMarker};
use iceoryx2::service::port_factory::publish_subscribe::PortFactory;
use iceoryx2::service::static_config::message_type_details::{TypeDetail, TypeVariant};
use messages::Stamp;
use messages::layout::Layout;
use std::mem::MaybeUninit;
use std::ptr;
use std::slice;

/// Creates the ports of a topic.
pub(super) type TopicPorts = PortFactory<Ipc, [CustomPayloadMarker], CustomHeaderMarker>;
/// Sends the messages of a topic.
pub(super) type SendPort = Publisher<Ipc, [CustomPayloadMarker], CustomHeaderMarker>;
/// Receives the messages of a topic.
pub(super) type ReceivePort = Subscriber<Ipc, [CustomPayloadMarker], CustomHeaderMarker>;

/// Sets the type of a topic's messages: a fixed layout, or bytes of any number, behind a [`Stamp`].
///
/// # Errors
/// The type's name is too long.
pub(super) fn with_layout(
    builder: Builder<[CustomPayloadMarker], CustomHeaderMarker, Ipc>,
    layout: Option<Layout>,
) -> Result<Builder<[CustomPayloadMarker], CustomHeaderMarker, Ipc>, String> {
    let payload = layout.map_or_else(
        || Ok(TypeDetail::new::<u8>(TypeVariant::Dynamic)),
        |Layout { name, size, alignment, .. }| {
            let variant = TypeVariant::FixedSize;
            TypeDetail::__internal_new_from_parts(variant, name, size, alignment)
        },
    );
    let payload = payload.map_err(|error| format!("{error:?}"))?;
    let stamp = TypeDetail::new::<Stamp>(TypeVariant::FixedSize);
    // SAFETY: header and payload are only converted to these types and those in `layout`.
    #[allow(unsafe_code)]
    Ok(unsafe {
        builder
            .__internal_set_payload_type_details(&payload)
            .__internal_set_user_header_type_details(&stamp)
    })
}

/// A message borrowed from shared memory.
#[derive(Debug)]
pub(super) struct Received(Sample<Ipc, [CustomPayloadMarker], CustomHeaderMarker>);

impl Received {
    /// Takes the next message of a port.
    pub(super) fn take(port: &ReceivePort) -> Result<Option<Self>, ReceiveError> {
        port.receive().map(|sample| sample.map(Self))
    }

    pub(super) fn stamp(&self) -> &Stamp {
        // SAFETY: the topic's header is a stamp, with its size and alignment, which the type hides.
        #[allow(unsafe_code)]
        unsafe {
            &*ptr::from_ref(self.0.user_header()).cast()
        }
    }

    pub(super) fn bytes(&self) -> &[u8] {
        let payload = self.0.payload();
        // SAFETY: a marker is one byte, and all of a payload is written before it is sent.
        #[allow(unsafe_code)]
        unsafe {
            slice::from_raw_parts(payload.as_ptr().cast(), payload.len())
        }
    }
}

/// Memory of a message that is to be sent.
pub(super) struct Loan(
    SampleMutUninit<Ipc, [MaybeUninit<CustomPayloadMarker>], CustomHeaderMarker>,
);

impl Loan {
    /// Takes memory: one slot of a fixed layout, or a number of bytes.
    pub(super) fn take(port: &SendPort, slots: usize) -> Result<Self, LoanError> {
        // SAFETY: more than one slot is only taken of bytes, and the memory's size is its length.
        #[allow(unsafe_code)]
        unsafe {
            port.loan_custom_payload(slots).map(Self)
        }
    }

    pub(super) fn stamp(&mut self, stamp: Stamp) {
        let header = ptr::from_mut(self.0.user_header_mut()).cast::<Stamp>();
        // SAFETY: the topic's header has a stamp's size and alignment, which the type hides.
        #[allow(unsafe_code)]
        unsafe {
            header.write(stamp);
        }
    }

    pub(super) fn memory(&mut self) -> &mut [MaybeUninit<u8>] {
        let payload = self.0.payload_mut();
        // SAFETY: a marker is one byte, here an uninitialised one.
        #[allow(unsafe_code)]
        unsafe {
            slice::from_raw_parts_mut(payload.as_mut_ptr().cast(), payload.len())
        }
    }

    /// Sends the message.
    ///
    /// # Safety
    /// Its stamp and all of its memory have been written.
    #[allow(unsafe_code)]
    pub(super) unsafe fn send(self) -> Result<usize, SendError> {
        // SAFETY: as the caller promises.
        unsafe { self.0.assume_init() }.send()
    }
}
