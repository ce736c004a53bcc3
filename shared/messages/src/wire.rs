//! Enums as bytes in fixed layouts, and the check of bytes that another process wrote.

use crate::definition::FieldType;
use scene::{Intent, Reference, Relation, Response, Role};
use std::marker::PhantomData;

/// An invalid value on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("invalid {field} {value} on the wire")]
pub struct WireError {
    field: &'static str,
    value: u64,
}

impl WireError {
    /// An error for `value` in `field`.
    pub const fn new(field: &'static str, value: u32) -> Self {
        Self { field, value: value as u64 }
    }

    /// An error for a count in `field`.
    pub const fn count(field: &'static str, value: u64) -> Self {
        Self { field, value }
    }
}

/// An enum that travels as one byte.
pub trait WireCode: Copy + 'static {
    /// Name of the enum.
    const NAME: &'static str;
    /// Variants with their names and codes, all of them; the first is an unset field.
    const CODES: &'static [(Self, &'static str, u8)];

    /// Returns the code in a message.
    fn code(self) -> Code<Self> {
        self.into()
    }

    /// Returns the variant's byte.
    fn to_byte(self) -> u8;

    /// Returns the variant of a byte.
    ///
    /// # Errors
    /// A byte without a variant.
    fn from_byte(byte: u8) -> Result<Self, WireError> {
        let found = Self::CODES.iter().find(|(.., code)| *code == byte);
        found.map(|(variant, ..)| *variant).ok_or(WireError::new(Self::NAME, byte.into()))
    }
}

/// The byte of an enum inside a fixed-layout message. Readers reject messages with invalid codes
/// ([`WireField::check`]), so that services see valid ones only.
#[repr(transparent)]
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Code<E> {
    byte: u8,
    variant: PhantomData<fn() -> E>,
}

// SAFETY: one plain byte, the same in every process; the marker has no size.
#[allow(unsafe_code)]
unsafe impl<E: 'static> iceoryx2::prelude::ZeroCopySend for Code<E> {}

impl<E: WireCode> Code<E> {
    /// A code as another process may write it, valid or not.
    pub const fn from_raw(byte: u8) -> Self {
        Self { byte, variant: PhantomData }
    }

    /// Returns the byte.
    pub(crate) const fn raw(self) -> u8 {
        self.byte
    }

    /// Returns the variant. An invalid code, which no message from a reader has, counts as unset.
    pub fn get(self) -> E {
        E::from_byte(self.byte).unwrap_or(E::CODES[0].0)
    }
}

impl<E: WireCode> From<E> for Code<E> {
    fn from(variant: E) -> Self {
        Self::from_raw(variant.to_byte())
    }
}

impl<E: WireCode> PartialEq<E> for Code<E> {
    fn eq(&self, variant: &E) -> bool {
        self.byte == variant.to_byte()
    }
}

impl<E> Default for Code<E> {
    fn default() -> Self {
        Self { byte: 0, variant: PhantomData }
    }
}

impl<E: WireCode> std::fmt::Debug for Code<E> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match E::CODES.iter().find(|(.., code)| *code == self.byte) {
            Some((_, name, _)) => f.write_str(name),
            None => write!(f, "<invalid {} {}>", E::NAME, self.byte),
        }
    }
}

/// The type of a field in a fixed-layout message.
pub trait WireField {
    /// `true` if some of its bytes may be invalid.
    const CHECKED: bool = false;

    /// Checks the codes inside.
    ///
    /// # Errors
    /// An invalid code.
    fn check(&self) -> Result<(), WireError> {
        Ok(())
    }

    /// Returns the parts of a schema key other than the type's name: codes, and nested keys.
    fn detail() -> String {
        String::new()
    }

    /// Returns its type in a ROS 2 message definition.
    fn ros2() -> FieldType;
}

macro_rules! plain {
    ($($number:ty = $ros2:literal)+) => {
        $(impl WireField for $number {
            fn ros2() -> FieldType {
                FieldType::primitive($ros2)
            }
        })+
    };
}
plain! {
    u8 = "uint8" u16 = "uint16" u32 = "uint32" u64 = "uint64" i32 = "int32" f32 = "float32" f64 = "float64"
}

impl<T: WireField, const N: usize> WireField for [T; N] {
    const CHECKED: bool = T::CHECKED;

    fn check(&self) -> Result<(), WireError> {
        if T::CHECKED { self.iter().try_for_each(T::check) } else { Ok(()) }
    }

    fn detail() -> String {
        T::detail()
    }

    fn ros2() -> FieldType {
        T::ros2().array(N)
    }
}

impl<E: WireCode> WireField for Code<E> {
    const CHECKED: bool = true;

    fn check(&self) -> Result<(), WireError> {
        E::from_byte(self.byte).map(drop)
    }

    fn detail() -> String {
        E::CODES.iter().map(|(_, name, byte)| format!("{byte}={name} ")).collect()
    }

    fn ros2() -> FieldType {
        let constants = E::CODES.iter().map(|(_, name, byte)| (*name, *byte)).collect();
        FieldType { constants, ..FieldType::primitive("uint8") }
    }
}

/// Gives an enum of another module its codes.
macro_rules! wire_codes {
    ($name:ident { $($variant:ident = $code:literal,)+ }) => {
        impl $crate::wire::WireCode for $name {
            const NAME: &'static str = stringify!($name);
            const CODES: &'static [(Self, &'static str, u8)] =
                &[$((Self::$variant, stringify!($variant), $code)),+];

            fn to_byte(self) -> u8 {
                match self { $(Self::$variant => $code,)+ }
            }
        }
    };
}
pub(crate) use wire_codes;

/// Declares an enum together with its codes.
macro_rules! wire_enum {
    ($(#[$doc:meta])* $name:ident { $($(#[$vdoc:meta])* $variant:ident = $code:literal,)+ }) => {
        $(#[$doc])*
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash,
            serde::Serialize, serde::Deserialize,
        )]
        #[serde(rename_all = "snake_case")]
        pub enum $name { $($(#[$vdoc])* $variant,)+ }

        $crate::wire::wire_codes! { $name { $($variant = $code,)+ } }

        impl $name {
            /// Returns the code in a message.
            pub const fn code(self) -> $crate::wire::Code<Self> {
                $crate::wire::Code::from_raw(match self { $(Self::$variant => $code,)+ })
            }
        }
    };
}
pub(crate) use wire_enum;

wire_codes! { Role { Quality = 0, Kind = 1, Place = 2, Part = 3, } }
wire_codes! { Response { None = 0, Yes = 1, No = 2, CannotTell = 3, DoesNotMatter = 4, } }
wire_codes! {
    Intent {
        Inform = 0,
        None = 1,
        Stop = 2,
        Cancel = 3,
        Repeat = 4,
        StartOver = 5,
        AskBack = 6,
        AskCount = 7,
        AskWhich = 8,
        AskWhere = 9,
        AskWhy = 10,
        AskStatus = 11,
        AskHelp = 12,
        Greet = 13,
        Thank = 14,
        PutBack = 15,
        Leave = 16,
        AskWhether = 17,
        Chore = 18,
        StopAndCancel = 19,
        GoOn = 20,
    }
}

impl WireCode for Reference {
    const NAME: &'static str = "Reference";
    const CODES: &'static [(Self, &'static str, u8)] = &[
        (Self::None, "None", 0),
        (Self::Other, "Other", 1),
        (Self::Same, "Same", 2),
        (Self::Smaller, "Smaller", 3),
        (Self::Larger, "Larger", 4),
        (Self::Smallest, "Smallest", 5),
        (Self::Largest, "Largest", 6),
        (Self::Any, "Any", 7),
        // Which one is in a field of its own.
        (Self::Relation(Relation::Beside), "Relation", 8),
    ];

    fn to_byte(self) -> u8 {
        match self {
            Self::None => 0,
            Self::Other => 1,
            Self::Same => 2,
            Self::Smaller => 3,
            Self::Larger => 4,
            Self::Smallest => 5,
            Self::Largest => 6,
            Self::Any => 7,
            Self::Relation(_) => 8,
        }
    }
}
