//! A message as its reader gets it.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::ops::Deref;

/// A message borrowed from shared memory, or an owned one: a test or a simulation has no shared
/// memory and carries messages itself.
#[derive(Clone)]
pub enum MessageRef<'a, T> {
    /// Borrowed from shared memory while being handled. A reader copies the parts that it keeps.
    Lent(&'a T),
    /// Owned, on the heap.
    Owned(Box<T>),
}

impl<T> Deref for MessageRef<'_, T> {
    type Target = T;

    fn deref(&self) -> &T {
        match self {
            Self::Lent(message) => message,
            Self::Owned(message) => message,
        }
    }
}

impl<'a, T> From<&'a T> for MessageRef<'a, T> {
    fn from(message: &'a T) -> Self {
        Self::Lent(message)
    }
}

impl<T> From<Box<T>> for MessageRef<'_, T> {
    fn from(message: Box<T>) -> Self {
        Self::Owned(message)
    }
}

impl<T> From<T> for MessageRef<'_, T> {
    fn from(message: T) -> Self {
        Self::Owned(Box::new(message))
    }
}

impl<T: PartialEq> PartialEq for MessageRef<'_, T> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<T: fmt::Debug> fmt::Debug for MessageRef<'_, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}

impl<T: Serialize> Serialize for MessageRef<'_, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (**self).serialize(serializer)
    }
}

/// A deserialised message is owned.
impl<'de, T: Deserialize<'de>> Deserialize<'de> for MessageRef<'_, T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::deserialize(deserializer).map(|message| Self::Owned(Box::new(message)))
    }
}
