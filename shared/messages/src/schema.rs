//! Identity of a message type: a hash over its name, its fields' names, types and offsets.
//!
//! iceoryx2 compares size, alignment and the type's name when a topic is opened, so a struct of the
//! same size with other fields would pass. The schema key closes that gap: it is an attribute of
//! every topic and each open requires it.

/// One field of a wire struct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub name: &'static str,
    /// Its type as written.
    pub ty: &'static str,
    /// Bytes from the start of the struct.
    pub offset: usize,
    /// Size in bytes.
    pub size: usize,
}

/// A message whose layout is part of the contract.
pub trait Schema {
    /// Name on the wire, equal in every language.
    const NAME: &'static str;

    /// The fields in order; for a payload that is encoded, one field naming its encoding.
    fn fields() -> Vec<Field>;

    /// Size of the struct in bytes, 0 for an encoded payload.
    fn size() -> usize;

    /// Its schemas nested by value, so that a change inside one of them shows.
    fn nested() -> Vec<SchemaKey> {
        Vec::new()
    }

    /// The key that both sides of a topic must agree on.
    fn key() -> SchemaKey {
        let mut hash = Fnv::default();
        hash.write(Self::NAME);
        for field in Self::fields() {
            hash.write(&format!("{}:{}@{}+{};", field.name, field.ty, field.offset, field.size));
        }
        Self::nested().iter().for_each(|key| hash.write(&key.to_string()));
        SchemaKey(hash.0)
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

/// FNV-1a, 64 bit: small, stable, and good enough to tell honest mistakes apart.
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    fn write(&mut self, text: &str) {
        for byte in text.bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

/// Declares a wire struct: `#[repr(C)]`, copyable, zeroed by default, sendable without a copy, and
/// with its schema.
macro_rules! wire_struct {
    (
        $(#[$doc:meta])*
        $name:ident = $wire:literal $(nests [$($nested:ty),+])? {
            $($(#[$fdoc:meta])* $field:ident: $ty:ty,)+
        }
    ) => {
        $(#[$doc])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, Default, PartialEq, iceoryx2::prelude::ZeroCopySend)]
        #[type_name($wire)]
        pub struct $name { $($(#[$fdoc])* pub $field: $ty,)+ }

        impl $crate::schema::Schema for $name {
            const NAME: &'static str = $wire;

            fn fields() -> Vec<$crate::schema::Field> {
                let zero = Self::default();
                vec![$($crate::schema::Field {
                    name: stringify!($field),
                    ty: stringify!($ty),
                    offset: std::mem::offset_of!(Self, $field),
                    size: std::mem::size_of_val(&zero.$field),
                },)+]
            }

            fn size() -> usize {
                std::mem::size_of::<Self>()
            }

            $(fn nested() -> Vec<$crate::schema::SchemaKey> {
                vec![$(<$nested as $crate::schema::Schema>::key(),)+]
            })?
        }
    };
}
pub(crate) use wire_struct;
