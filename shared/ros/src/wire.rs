//! ROS 1 messages as bytes: little endian, lists and strings behind a length of four bytes.

/// Bytes that are not the expected message, or a message that has no counterpart here.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Unreadable(pub String);

impl From<messages::WireError> for Unreadable {
    fn from(error: messages::WireError) -> Self {
        Self(error.to_string())
    }
}

/// A type that ROS messages are made of.
pub trait Field: Sized {
    /// Name of the type in a message definition.
    fn ros_type() -> String;

    /// Reads a value from the front of `bytes`.
    ///
    /// # Errors
    /// Too few bytes, or text that is not UTF-8.
    fn read(bytes: &mut &[u8]) -> Result<Self, Unreadable>;

    /// Appends the value to `bytes`.
    fn write(&self, bytes: &mut Vec<u8>);

    /// Adds the definitions of the messages that this type contains, each once.
    fn nested(_definitions: &mut Vec<(&'static str, String)>) {}
}

/// A message type.
pub trait Message: Field {
    /// Name with package, e.g. `sensor_msgs/JointState`.
    const NAME: &'static str;
    /// Checksum of the definition; both ends of a connection compare it.
    const MD5: &'static str;

    /// Returns the definition as a `.msg` file has it.
    fn definition() -> String;

    /// Returns the definition with those of all nested messages, as recordings keep it.
    fn full_definition() -> String {
        let mut definitions = Vec::new();
        Self::nested(&mut definitions);
        let line = "=".repeat(80);
        let parts = definitions.into_iter().filter(|(name, _)| *name != Self::NAME);
        parts.fold(Self::definition(), |text, (name, definition)| {
            text + &format!("\n{line}\nMSG: {name}\n{definition}")
        })
    }

    /// Reads a message that fills `bytes`.
    ///
    /// # Errors
    /// As [`Field::read`]; bytes that are left over.
    fn from_bytes(mut bytes: &[u8]) -> Result<Self, Unreadable> {
        let message = Self::read(&mut bytes)?;
        match bytes.len() {
            0 => Ok(message),
            left => Err(Unreadable(format!("{left} bytes left over after {}", Self::NAME))),
        }
    }

    /// Returns the message as it is sent: behind its length.
    fn to_frame(&self) -> Vec<u8> {
        let mut bytes = vec![0; 4];
        self.write(&mut bytes);
        let length = (bytes.len() - 4) as u32;
        bytes[..4].copy_from_slice(&length.to_le_bytes());
        bytes
    }
}

fn take<'a>(bytes: &mut &'a [u8], count: usize) -> Result<&'a [u8], Unreadable> {
    let missing = || Unreadable(format!("expected {count} more bytes, found {}", bytes.len()));
    let (taken, rest) = bytes.split_at_checked(count).ok_or_else(missing)?;
    *bytes = rest;
    Ok(taken)
}

macro_rules! numbers {
    ($($type:ident = $name:literal),+) => {$(
        impl Field for $type {
            fn ros_type() -> String {
                $name.to_owned()
            }

            fn read(bytes: &mut &[u8]) -> Result<Self, Unreadable> {
                let mut own = [0; size_of::<Self>()];
                own.copy_from_slice(take(bytes, size_of::<Self>())?);
                Ok(Self::from_le_bytes(own))
            }

            fn write(&self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }
        }
    )+};
}
numbers!(
    u8 = "uint8",
    u32 = "uint32",
    i32 = "int32",
    i64 = "int64",
    f32 = "float32",
    f64 = "float64"
);

impl Field for bool {
    fn ros_type() -> String {
        "bool".to_owned()
    }

    fn read(bytes: &mut &[u8]) -> Result<Self, Unreadable> {
        u8::read(bytes).map(|byte| byte != 0)
    }

    fn write(&self, bytes: &mut Vec<u8>) {
        bytes.push((*self).into());
    }
}

impl Field for String {
    fn ros_type() -> String {
        "string".to_owned()
    }

    fn read(bytes: &mut &[u8]) -> Result<Self, Unreadable> {
        let length = u32::read(bytes)? as usize;
        let text = std::str::from_utf8(take(bytes, length)?);
        text.map(str::to_owned).map_err(|e| Unreadable(format!("text: {e}")))
    }

    fn write(&self, bytes: &mut Vec<u8>) {
        (self.len() as u32).write(bytes);
        bytes.extend(self.as_bytes());
    }
}

impl<T: Field> Field for Vec<T> {
    fn ros_type() -> String {
        T::ros_type() + "[]"
    }

    fn read(bytes: &mut &[u8]) -> Result<Self, Unreadable> {
        let length = u32::read(bytes)?;
        // Nothing is reserved for a length that may be a lie: the bytes end first.
        (0..length).map(|_| T::read(bytes)).collect()
    }

    fn write(&self, bytes: &mut Vec<u8>) {
        (self.len() as u32).write(bytes);
        self.iter().for_each(|item| item.write(bytes));
    }

    fn nested(definitions: &mut Vec<(&'static str, String)>) {
        T::nested(definitions);
    }
}

/// A list of bytes that is skipped, e.g. a point cloud: nothing here reads it, and it is large.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Skipped;

impl Field for Skipped {
    fn ros_type() -> String {
        "uint8[]".to_owned()
    }

    fn read(bytes: &mut &[u8]) -> Result<Self, Unreadable> {
        let length = u32::read(bytes)? as usize;
        take(bytes, length).map(|_| Self)
    }

    fn write(&self, bytes: &mut Vec<u8>) {
        0_u32.write(bytes);
    }
}

/// A time of the robot's clock; all zero where it is not set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RosTime {
    /// Seconds.
    pub secs: u32,
    /// Nanoseconds within the second.
    pub nsecs: u32,
}

/// A signed span of time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RosDuration {
    /// Seconds, rounded down.
    pub secs: i32,
    /// Nanoseconds to be added.
    pub nsecs: i32,
}

impl RosTime {
    /// Returns nanoseconds since the beginning of the clock; `None` where it is not set.
    pub fn ns(self) -> Option<i64> {
        let ns = i64::from(self.secs) * 1_000_000_000 + i64::from(self.nsecs);
        (ns > 0).then_some(ns)
    }
}

impl RosDuration {
    /// Returns a duration of so many seconds.
    pub fn from_s(seconds: f64) -> Self {
        let secs = seconds.floor();
        Self { secs: secs as i32, nsecs: ((seconds - secs) * 1e9) as i32 }
    }
}

macro_rules! times {
    ($($type:ident = $name:literal),+) => {$(
        impl Field for $type {
            fn ros_type() -> String {
                $name.to_owned()
            }

            fn read(bytes: &mut &[u8]) -> Result<Self, Unreadable> {
                Ok(Self { secs: Field::read(bytes)?, nsecs: Field::read(bytes)? })
            }

            fn write(&self, bytes: &mut Vec<u8>) {
                self.secs.write(bytes);
                self.nsecs.write(bytes);
            }
        }
    )+};
}
times!(RosTime = "time", RosDuration = "duration");

/// Declares a message: its struct, reader, writer, checksum and definition. The constants, one
/// `type NAME=value` a line, are part of the definition and of its checksum.
#[macro_export]
macro_rules! message {
    (
        $(#[$about:meta])*
        $name:ident = $ros:literal $md5:literal $($constants:literal)? {
            $($field:ident: $type:ty),+ $(,)?
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Debug, Default, PartialEq)]
        #[allow(missing_docs, reason = "fields are those of the definition")]
        pub struct $name {
            $(pub $field: $type),+
        }

        impl $crate::wire::Field for $name {
            fn ros_type() -> String {
                $ros.to_owned()
            }

            fn read(bytes: &mut &[u8]) -> Result<Self, $crate::wire::Unreadable> {
                Ok(Self { $($field: $crate::wire::Field::read(bytes)?),+ })
            }

            fn write(&self, bytes: &mut Vec<u8>) {
                $(self.$field.write(bytes);)+
            }

            fn nested(definitions: &mut Vec<(&'static str, String)>) {
                if definitions.iter().any(|(known, _)| *known == $ros) {
                    return;
                }
                definitions.push(($ros, <Self as $crate::wire::Message>::definition()));
                $(<$type as $crate::wire::Field>::nested(definitions);)+
            }
        }

        impl $crate::wire::Message for $name {
            const NAME: &'static str = $ros;
            const MD5: &'static str = $md5;

            fn definition() -> String {
                let fields = [$(
                    format!("{} {}\n", <$type as $crate::wire::Field>::ros_type(), stringify!($field))
                ),+];
                let constants = concat!($($constants,)?);
                let constants = constants.lines().map(|line| line.trim_start().to_owned() + "\n");
                constants.chain(fields).collect()
            }
        }
    };
}
