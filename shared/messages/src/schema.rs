//! Schema of a message type: its fields' names, types and offsets, and a hash over them.
//!
//! iceoryx2 compares size, alignment and the type's name when a topic is opened, so a struct of the
//! same size with other fields would pass. The schema key closes that gap: it is an attribute of
//! every topic and each open requires it. Schemas are derived: those of structs by `wire_struct`,
//! those of postcard payloads from their `Deserialize` implementation.

use crate::definition::Definition;
use crate::layout::Layout;
#[doc(hidden)]
pub use serde_reflection;
use serde_reflection::{Error, Registry};
use std::borrow::Cow;

/// One field of a wire struct, or one type inside a postcard payload.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Name of the field.
    pub name: Cow<'static, str>,
    /// Type of the field: as written in a wire struct, as JSON of `serde-reflection` in a payload.
    pub ty: Cow<'static, str>,
    /// Bytes from the start of the struct.
    pub offset: usize,
    /// Size in bytes.
    pub size: usize,
    /// Codes of an enum; keys of structs nested by value.
    pub detail: String,
}

/// A message whose layout is part of the contract.
pub trait Schema {
    /// Name on the wire, equal in every language.
    const NAME: &'static str;

    /// Returns the fields in order; of a postcard payload, the types in it.
    fn fields() -> Vec<Field>;

    /// Returns the layout of the struct, `None` for a postcard payload.
    fn layout() -> Option<Layout>;

    /// Returns its description for programs that do not share this code.
    fn definition() -> Definition;

    /// Returns the key that both sides of a topic must agree on.
    fn key() -> SchemaKey {
        let mut hash = scene::StableHash::default();
        hash.bytes(Self::NAME.as_bytes());
        for Field { name, ty, offset, size, detail } in Self::fields() {
            hash.bytes(format!("{name}:{ty}@{offset}+{size} {detail};").as_bytes());
        }
        SchemaKey(hash.value())
    }
}

/// 64-bit structural hash of a message type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SchemaKey(pub u64);

impl std::fmt::Display for SchemaKey {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

/// Name of the field of a schema that could not be traced.
const UNTRACED: &str = "error";

/// Returns the fields of a payload's schema: every type in it.
#[doc(hidden)]
pub fn payload_fields(types: Result<Registry, Error>) -> Vec<Field> {
    let field = |name: String, ty: String| Field {
        name: name.into(),
        ty: ty.into(),
        offset: 0,
        size: 0,
        detail: String::new(),
    };
    match types {
        Ok(types) => types
            .into_iter()
            .map(|(name, format)| field(name, serde_json::json!(format).to_string()))
            .collect(),
        // Found by the golden file's test, not by users: both sides of a topic still agree.
        Err(error) => vec![field(UNTRACED.to_owned(), error.to_string())],
    }
}

/// Derives the schemas of payloads of variable size, for topics with messages of one's own, from
/// their `Deserialize` implementations. The enums inside are listed, innermost first:
///
/// ```
/// use messages::schema::Schema;
/// use serde::{Deserialize, Serialize};
///
/// #[derive(Debug, Serialize, Deserialize)]
/// enum Colour { Red, Blue }
///
/// #[derive(Debug, Serialize, Deserialize)]
/// struct Label { object: u16, colour: Colour }
///
/// messages::payloads! { Label [Colour] }
/// assert_eq!(Label::NAME, "Label");
/// ```
///
/// An enum that is not listed makes the schema that of an error: a field `error`.
#[macro_export]
macro_rules! payloads {
    ($($payload:ident [$($enum:ty),*])+) => {
        $(impl $crate::schema::Schema for $payload {
            const NAME: &'static str = stringify!($payload);

            fn fields() -> Vec<$crate::schema::Field> {
                $crate::schema::payload_fields($crate::schema::traced!($payload [$($enum),*]))
            }

            fn definition() -> $crate::definition::Definition {
                let types = $crate::schema::traced!($payload [$($enum),*]);
                // Types that cannot be traced fail the golden file's test.
                $crate::definition::Definition::Payload(types.unwrap_or_default())
            }

            fn layout() -> Option<$crate::layout::Layout> {
                None
            }
        })+
    };
}
pub use payloads;

/// Every type in a payload, or why it cannot be traced.
#[doc(hidden)]
#[macro_export]
macro_rules! traced {
    ($payload:ident [$($enum:ty),*]) => {{
        let types = || {
            let config = $crate::schema::serde_reflection::TracerConfig::default();
            let mut tracer = $crate::schema::serde_reflection::Tracer::new(config);
            $(tracer.trace_simple_type::<$enum>()?;)*
            tracer.trace_simple_type::<$payload>()?;
            tracer.registry()
        };
        types()
    }};
}
#[doc(hidden)]
pub use traced;

/// Declares a wire struct: `#[repr(C)]`, copyable, zeroed by default, sendable without a copy, and
/// with its schema and the check of its codes.
macro_rules! wire_struct {
    (
        $(#[$doc:meta])*
        $name:ident = $wire:literal {
            $($(#[$fdoc:meta])* $field:ident: $ty:ty,)+
        }
    ) => {
        $(#[$doc])*
        #[repr(C)]
        #[derive(
            Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize,
            iceoryx2::prelude::ZeroCopySend,
        )]
        #[type_name($wire)]
        pub struct $name {
            $($(#[$fdoc])* #[serde(with = "crate::wire_serde")] pub $field: $ty,)+
        }

        impl $crate::wire_serde::WireSerde for $name {
            fn zero() -> Self {
                Self::default()
            }

            fn is_zero(&self) -> bool {
                true $(&& $crate::wire_serde::WireSerde::is_zero(&self.$field))+
            }

            fn write<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serde::Serialize::serialize(self, serializer)
            }

            fn read<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                serde::Deserialize::deserialize(deserializer)
            }
        }

        impl $crate::schema::Schema for $name {
            const NAME: &'static str = $wire;

            fn fields() -> Vec<$crate::schema::Field> {
                vec![$($crate::schema::Field {
                    name: stringify!($field).into(),
                    ty: stringify!($ty).into(),
                    offset: std::mem::offset_of!(Self, $field),
                    size: std::mem::size_of::<$ty>(),
                    detail: <$ty as $crate::wire::WireField>::detail(),
                },)+]
            }

            fn layout() -> Option<$crate::layout::Layout> {
                Some($crate::layout::Layout::of::<Self>())
            }

            fn definition() -> $crate::definition::Definition {
                <Self as $crate::wire::WireField>::ros2().definition()
            }
        }

        // The sizes of the fields add up to the struct's size: without padding.
        const _: () = assert!(0 $(+ size_of::<$ty>())+ == size_of::<$name>());

        // SAFETY: fields are numbers, codes, arrays of these and other such structs; and see above.
        #[allow(unsafe_code)]
        unsafe impl $crate::layout::WireMessage for $name {}

        impl $crate::wire::WireField for $name {
            const CHECKED: bool = false $(|| <$ty as $crate::wire::WireField>::CHECKED)+;

            fn check(&self) -> Result<(), $crate::WireError> {
                $(<$ty as $crate::wire::WireField>::check(&self.$field)?;)+
                Ok(())
            }

            fn detail() -> String {
                <Self as $crate::schema::Schema>::key().to_string()
            }

            fn ros2() -> $crate::definition::FieldType {
                $crate::definition::FieldType::message(
                    $wire,
                    &[$((stringify!($field), <$ty as $crate::wire::WireField>::ros2()),)+],
                )
            }
        }
    };
}
pub(crate) use wire_struct;
