//! Checked reading of bytes that another process wrote.

use scene::{AttributeId, Intent, ObjectId, Question, Response, ValueId};

/// A value on the wire that has no meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} {value} on the wire has no meaning")]
pub struct WireError {
    what: &'static str,
    value: u32,
}

impl WireError {
    /// The field `what` holds `value`.
    pub const fn new(what: &'static str, value: u32) -> Self {
        Self { what, value }
    }
}

/// Declares an enum that travels as one byte, with a checked way back.
macro_rules! wire_enum {
    ($(#[$doc:meta])* $name:ident { $($(#[$vdoc:meta])* $variant:ident = $code:literal,)+ }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum $name { $($(#[$vdoc])* $variant,)+ }

        impl $name {
            /// The byte on the wire.
            pub const fn code(self) -> u8 {
                match self { $(Self::$variant => $code,)+ }
            }

            /// The meaning of a byte.
            ///
            /// # Errors
            /// A byte that no writer of this build sends.
            pub const fn from_code(code: u8) -> Result<Self, $crate::WireError> {
                match code {
                    $($code => Ok(Self::$variant),)+
                    _ => Err($crate::WireError::new(stringify!($name), code as u32)),
                }
            }
        }
    };
}
pub(crate) use wire_enum;

/// An enum of the dialogue that travels as one byte.
pub trait WireCode: Sized {
    /// Returns the byte on the wire.
    fn code(self) -> u8;

    /// Returns the meaning of a byte.
    ///
    /// # Errors
    /// A byte that no writer of this build sends.
    fn from_code(code: u8) -> Result<Self, WireError>;
}

/// Implements [`WireCode`] from a table of all variants.
macro_rules! wire_code {
    ($name:ident { $($variant:ident = $code:literal,)+ }) => {
        impl $crate::wire::WireCode for $name {
            fn code(self) -> u8 {
                match self { $(Self::$variant => $code,)+ }
            }

            fn from_code(code: u8) -> Result<Self, $crate::WireError> {
                match code {
                    $($code => Ok(Self::$variant),)+
                    _ => Err($crate::WireError::new(stringify!($name), code.into())),
                }
            }
        }
    };
}
pub(crate) use wire_code;

/// The byte of a response.
pub(crate) fn response_code(response: Response) -> u8 {
    match response {
        Response::None => 0,
        Response::Yes => 1,
        Response::No => 2,
    }
}

/// The response of a byte.
pub(crate) fn response_from(code: u8) -> Result<Response, WireError> {
    match code {
        0 => Ok(Response::None),
        1 => Ok(Response::Yes),
        2 => Ok(Response::No),
        _ => Err(WireError::new("response", code.into())),
    }
}

const INTENTS: [Intent; 7] = [
    Intent::Inform,
    Intent::None,
    Intent::Stop,
    Intent::Cancel,
    Intent::Repeat,
    Intent::StartOver,
    Intent::AskBack,
];

/// The byte of an intent: its place in [`INTENTS`].
pub(crate) fn intent_code(intent: Intent) -> u8 {
    INTENTS.iter().position(|&i| i == intent).unwrap_or(0) as u8
}

/// The intent of a byte.
pub(crate) fn intent_from(code: u8) -> Result<Intent, WireError> {
    INTENTS.get(usize::from(code)).copied().ok_or(WireError::new("intent", code.into()))
}

/// A question as four numbers: kind, object, attribute, value; unused ones are 0.
pub(crate) fn question_codes(question: Question) -> (u16, u16, u16, u16) {
    match question {
        Question::None => (0, 0, 0, 0),
        Question::Point(i) => (1, i.0, 0, 0),
        Question::Attribute(k, v) => (2, 0, k.0, v.0),
        Question::Which(k) => (3, 0, k.0, 0),
    }
}

/// The question of four numbers. Whether the scene has it is for the reader to check.
pub(crate) fn question_from(codes: (u16, u16, u16, u16)) -> Result<Question, WireError> {
    let (kind, object, attribute, value) = codes;
    match kind {
        0 => Ok(Question::None),
        1 => Ok(Question::Point(ObjectId(object))),
        2 => Ok(Question::Attribute(AttributeId(attribute), ValueId(value))),
        3 => Ok(Question::Which(AttributeId(attribute))),
        _ => Err(WireError::new("question kind", kind.into())),
    }
}
