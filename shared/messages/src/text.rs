//! Text of bounded length inside a fixed layout.

use crate::WireError;
use crate::definition::FieldType;
use iceoryx2::prelude::ZeroCopySend;

/// UTF-8 text of at most `N` bytes.
#[repr(C)]
#[derive(Clone, Copy, ZeroCopySend)]
#[type_name("FixedText")]
pub struct FixedText<const N: usize> {
    len: u32,
    bytes: [u8; N],
}

/// The text does not fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the text has {bytes} bytes, {max} at most are allowed")]
pub struct TextTooLong {
    /// Length of the text.
    pub bytes: usize,
    /// The bound.
    pub max: usize,
}

impl<const N: usize> FixedText<N> {
    /// Stores the text unchanged.
    ///
    /// # Errors
    /// Longer than `N` bytes.
    pub fn new(text: &str) -> Result<Self, TextTooLong> {
        if text.len() > N {
            return Err(TextTooLong { bytes: text.len(), max: N });
        }
        Ok(Self::truncated(text))
    }

    /// The longest prefix that fits, cut between characters. For display to people, never as a
    /// basis of decisions.
    pub fn truncated(text: &str) -> Self {
        let end = (0..=N.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0);
        let mut bytes = [0; N];
        bytes[..end].copy_from_slice(&text.as_bytes()[..end]);
        Self { len: end as u32, bytes }
    }

    /// The length as the writer stated it.
    pub(crate) fn raw_len(&self) -> u32 {
        self.len
    }

    /// The bytes up to the length; all of them if that is invalid.
    pub(crate) fn used(&self) -> &[u8] {
        self.bytes.get(..self.len as usize).unwrap_or(&self.bytes)
    }

    /// A text as another process may write it, valid or not.
    ///
    /// # Errors
    /// More than `N` bytes.
    pub fn from_raw(len: u32, used: &[u8]) -> Result<Self, TextTooLong> {
        let mut bytes = [0; N];
        let slots = bytes.get_mut(..used.len());
        slots.ok_or(TextTooLong { bytes: used.len(), max: N })?.copy_from_slice(used);
        Ok(Self { len, bytes })
    }

    /// The text.
    ///
    /// # Errors
    /// A length beyond the bound, or bytes that are not UTF-8.
    pub fn as_str(&self) -> Result<&str, WireError> {
        let bytes =
            self.bytes.get(..self.len as usize).ok_or(WireError::new("text length", self.len))?;
        std::str::from_utf8(bytes).map_err(|e| WireError::new("text byte", e.valid_up_to() as u32))
    }
}

impl<const N: usize> crate::wire::WireField for FixedText<N> {
    fn ros2() -> FieldType {
        let bytes = FieldType::primitive("uint8").array(N);
        let fields = [("len", FieldType::primitive("uint32")), ("bytes", bytes)];
        FieldType::message(&format!("Text{N}"), &fields)
    }
}

impl<const N: usize> Default for FixedText<N> {
    fn default() -> Self {
        Self { len: 0, bytes: [0; N] }
    }
}

impl<const N: usize> PartialEq for FixedText<N> {
    fn eq(&self, other: &Self) -> bool {
        self.as_str().ok() == other.as_str().ok()
    }
}

impl<const N: usize> std::fmt::Debug for FixedText<N> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.as_str() {
            Ok(text) => text.fmt(f),
            Err(error) => write!(f, "<{error}>"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fixed_text_rejects_oversized_text() {
        assert_eq!(FixedText::<4>::new("abcd").unwrap().as_str(), Ok("abcd"));
        assert_eq!(FixedText::<4>::new("abcde").unwrap_err(), TextTooLong { bytes: 5, max: 4 });
    }

    #[test]
    fn fixed_text_truncates_between_characters() {
        assert_eq!(FixedText::<4>::truncated("aßßß").as_str(), Ok("aß"));
        assert_eq!(FixedText::<1>::truncated("ß").as_str(), Ok(""));
    }

    #[test]
    fn fixed_text_rejects_an_invalid_length() {
        let mut text = FixedText::<4>::truncated("ab");
        text.len = 9;
        assert!(text.as_str().is_err());
    }
}
