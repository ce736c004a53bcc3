//! Messages of fixed layout as the bytes that travel.
//!
//! Shared memory knows no types: one port serves every topic, and its bytes become a message here.

use crate::schema::Schema;
use crate::wire::{WireError, WireField};
use iceoryx2::prelude::ZeroCopySend;
use std::fmt::Debug;
use std::mem::MaybeUninit;

/// A message of fixed layout.
///
/// # Safety
/// It is made of numbers and codes, so that any bytes of its size are a value of it until its codes
/// are checked, and has no padding, so that all of its bytes are written.
#[allow(unsafe_code)]
pub unsafe trait WireMessage:
    Schema + WireField + ZeroCopySend + Copy + PartialEq + Debug + 'static
{
}

/// Layout of a message, for those who know its topic only.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Name of its type on the wire.
    pub name: &'static str,
    /// Size, bytes.
    pub size: usize,
    /// Alignment, bytes.
    pub alignment: usize,
    check: fn(&[u8]) -> Result<(), WireError>,
}

impl Layout {
    /// The layout of a type.
    pub fn of<T: WireMessage>() -> Self {
        let (size, alignment) = (size_of::<T>(), align_of::<T>());
        Self { name: T::NAME, size, alignment, check: |bytes| checked::<T>(bytes).map(drop) }
    }

    /// Checks that the bytes are a message.
    ///
    /// # Errors
    /// Another size or alignment, or an invalid code.
    pub fn check(&self, bytes: &[u8]) -> Result<(), WireError> {
        (self.check)(bytes)
    }
}

/// A message of fixed layout, as bytes with the name of their type.
#[derive(Clone, Copy, Debug)]
pub struct FixedMessage<'a> {
    name: &'static str,
    bytes: &'a [u8],
}

impl<'a> FixedMessage<'a> {
    /// The bytes of a message.
    pub fn of<T: WireMessage>(message: &'a T) -> Self {
        Self { name: T::NAME, bytes: bytes(message) }
    }

    /// Bytes of a message of this layout.
    ///
    /// # Errors
    /// As [`Layout::check`].
    pub fn checked(layout: &Layout, bytes: &'a [u8]) -> Result<Self, WireError> {
        layout.check(bytes).map(|()| Self { name: layout.name, bytes })
    }

    /// Returns the message's bytes.
    pub fn bytes(&self) -> &'a [u8] {
        self.bytes
    }

    /// Returns the message if it is a `T`.
    pub fn get<T: WireMessage>(&self) -> Option<&'a T> {
        (self.name == T::NAME).then(|| view(self.bytes)).flatten()
    }
}

/// Returns the message that these bytes are.
///
/// # Errors
/// Another size or alignment, or an invalid code.
pub fn checked<T: WireMessage>(bytes: &[u8]) -> Result<&T, WireError> {
    let message = view::<T>(bytes);
    let message = message.ok_or(WireError::count("size", bytes.len() as u64))?;
    message.check().map(|()| message)
}

/// Returns these bytes as a message, if size and alignment are right; codes are unchecked.
fn view<T: WireMessage>(bytes: &[u8]) -> Option<&T> {
    let start = bytes.as_ptr().cast::<T>();
    // SAFETY: size and alignment are those of `T`, and any bytes are a `T` ([`WireMessage`]).
    #[allow(unsafe_code)]
    (bytes.len() == size_of::<T>() && start.is_aligned()).then(|| unsafe { &*start })
}

/// Returns memory as room for a message, unless its size or alignment is another one.
pub fn slot<T: WireMessage>(bytes: &mut [MaybeUninit<u8>]) -> Option<&mut MaybeUninit<T>> {
    let start = bytes.as_mut_ptr().cast::<MaybeUninit<T>>();
    // SAFETY: size and alignment are those of a `T`, and it may be uninitialised.
    #[allow(unsafe_code)]
    (bytes.len() == size_of::<T>() && start.is_aligned()).then(|| unsafe { &mut *start })
}

/// Returns the bytes of a message.
pub fn bytes<T: WireMessage>(message: &T) -> &[u8] {
    // SAFETY: a message of fixed layout has no padding (the test of the wire layout checks each),
    // so that every byte of it is initialised.
    #[allow(unsafe_code)]
    unsafe {
        std::slice::from_raw_parts(std::ptr::from_ref(message).cast(), size_of::<T>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AppliedMark, Receipt, ReceiptStatus};

    #[test]
    fn bytes_are_a_message_only_with_its_size_alignment_and_codes() {
        let receipt = Receipt { status: ReceiptStatus::Accepted.code(), ..Receipt::default() };
        let own = bytes(&receipt);
        assert_eq!(checked::<Receipt>(own), Ok(&receipt));
        let layout = Layout::of::<Receipt>();
        assert_eq!(layout.size, own.len());
        for (start, end) in [(0, own.len() - 1), (1, own.len()), (0, 0)] {
            assert!(layout.check(&own[start..end]).is_err(), "{start}..{end}");
        }
        let mut moved = vec![0; own.len() + layout.alignment];
        let aligned = moved.as_ptr().align_offset(layout.alignment);
        assert!(layout.check(&moved[aligned..][..own.len()]).is_ok());
        let misaligned = (aligned + 1) % layout.alignment;
        assert!(layout.check(&moved[misaligned..][..own.len()]).is_err());
        moved[aligned..][..own.len()].fill(u8::MAX);
        assert!(layout.check(&moved[aligned..][..own.len()]).is_err(), "no codes");
    }

    #[test]
    fn message_is_found_by_its_type_only() {
        let mark = AppliedMark { seq: 7 };
        let message = FixedMessage::of(&mark);
        assert_eq!(message.get::<AppliedMark>(), Some(&mark));
        assert_eq!(message.get::<Receipt>(), None);
        let bytes = message.bytes();
        assert!(FixedMessage::checked(&Layout::of::<Receipt>(), bytes).is_err());
        let again = FixedMessage::checked(&Layout::of::<AppliedMark>(), bytes).unwrap();
        assert_eq!(again.get(), Some(&mark));
    }
}
