//! Readers and writers of topics as bytes.

use std::mem::MaybeUninit;

use messages::layout::{self, WireMessage};
use messages::schema::Schema;
use messages::topics::Topic;
use messages::{
    Activity, AppliedMark, ArmStatus, AudioChunk, Forget, Hearing, Injection, JointStates,
    Observation, Partial, PolicyView, Presented, Receipt, RobotAct, Sighting, TableView,
    TrajectoryView, Utterance, WorldView, robot,
};
use serde::Serialize;
use serde::de::DeserializeOwned;
use service::bus::{Bus, EncodedReader, EncodedWriter, Reader, Writer};

use crate::topic::{CTopic, find};
use crate::{complain, group::Group, or_complain};

/// Reads a topic; `whichone_reader_t`.
#[derive(Debug)]
pub struct CReader(Box<dyn ReadBytes>, &'static str);

/// Writes a topic; `whichone_writer_t`.
#[derive(Debug)]
pub struct CWriter(Box<dyn WriteBytes>, &'static str);

/// Readers, whatever they read.
trait ReadBytes: std::fmt::Debug {
    /// Copies the next message to the beginning of `out`, and returns its bytes.
    fn take(&self, out: &mut [u8]) -> Result<Option<usize>, String>;
}

/// Writers, whatever they write.
trait WriteBytes: std::fmt::Debug {
    /// Sends the message in these bytes.
    fn send(&self, bytes: &[u8]) -> Result<(), String>;
}

fn too_small(room: usize, bytes: usize) -> String {
    format!("expected room for {bytes} bytes, found {room}; the message is lost")
}

/// Copies a message to the beginning of `out`.
fn copy(bytes: &[u8], out: &mut [u8]) -> Result<usize, String> {
    let room = out.len();
    let out = out.get_mut(..bytes.len()).ok_or_else(|| too_small(room, bytes.len()))?;
    out.copy_from_slice(bytes);
    Ok(bytes.len())
}

impl<T: WireMessage> ReadBytes for Reader<T> {
    fn take(&self, out: &mut [u8]) -> Result<Option<usize>, String> {
        let copied = self.take(|message| copy(layout::bytes(message), out));
        copied.map_err(|error| error.to_string())?.transpose()
    }
}

impl<T: WireMessage> WriteBytes for Writer<T> {
    fn send(&self, bytes: &[u8]) -> Result<(), String> {
        if bytes.len() != size_of::<T>() {
            return Err(format!("expected {} bytes, found {}", size_of::<T>(), bytes.len()));
        }
        let mut message = MaybeUninit::<T>::uninit();
        // SAFETY: as many bytes as the message has, which may all be anything: its fields are numbers, arrays of
        // numbers, and codes, which are checked below.
        let message = unsafe {
            std::ptr::copy_nonoverlapping(bytes.as_ptr(), message.as_mut_ptr().cast(), bytes.len());
            message.assume_init()
        };
        message.check().map_err(|error| error.to_string())?;
        self.send(&message).map_err(|error| error.to_string())
    }
}

impl<T: Schema + DeserializeOwned + std::fmt::Debug> ReadBytes for EncodedReader<T> {
    fn take(&self, out: &mut [u8]) -> Result<Option<usize>, String> {
        // Bytes that are no message are rejected before C sees them.
        let copied =
            self.take_with(|bytes| postcard::from_bytes::<T>(bytes).map(|_| copy(bytes, out)));
        copied.map_err(|error| error.to_string())?.transpose()
    }
}

impl<T: Schema + Serialize + DeserializeOwned + std::fmt::Debug> WriteBytes for EncodedWriter<T> {
    fn send(&self, bytes: &[u8]) -> Result<(), String> {
        let message: T = postcard::from_bytes(bytes)
            .map_err(|error| format!("expected a {} in postcard, found {error}", T::NAME))?;
        self.send(&message).map_err(|error| error.to_string())
    }
}

/// Opens a port of the payload's type, which is found by its name.
macro_rules! open {
    ($bus:ident, $topic:ident, $fixed:ident, $encoded:ident) => {
        open!(@ $bus, $topic, $fixed [
            Receipt Utterance Presented Activity Hearing Partial AudioChunk Observation AppliedMark Forget RobotAct
            ArmStatus JointStates
        ] robot [
            JointState AssemblyState JointCommand JointTrajectoryPoint SpeedRatio EndpointState EndEffectorCommand
            EndEffectorState EndEffectorProperties Drill
        ] $encoded [Injection PolicyView WorldView TrajectoryView Sighting TableView])
    };
    (@ $bus:ident, $topic:ident, $fixed:ident [$($message:ident)+] robot [$($of_robot:ident)+]
        $encoded:ident [$($payload:ident)+]) => {
        match $topic.payload {
            $(name if name == $message::NAME => {
                $bus.$fixed::<$message>($topic).map(|it| Box::new(it) as Box<_>)
            })+
            $(name if name == robot::$of_robot::NAME => {
                $bus.$fixed::<robot::$of_robot>($topic).map(|it| Box::new(it) as Box<_>)
            })+
            $(name if name == $payload::NAME => {
                $bus.$encoded::<$payload>($topic).map(|it| Box::new(it) as Box<_>)
            })+
            name => return Err(format!("topic {}: no program in C has {name} yet", $topic.name)),
        }
    };
}

fn reader(bus: &Bus, topic: &'static Topic) -> Result<CReader, String> {
    let port: Result<Box<dyn ReadBytes>, _> = open!(bus, topic, reader, encoded_reader);
    Ok(CReader(port.map_err(|error| error.to_string())?, topic.name))
}

fn writer(bus: &Bus, topic: &'static Topic) -> Result<CWriter, String> {
    let port: Result<Box<dyn WriteBytes>, _> = open!(bus, topic, writer, encoded_writer);
    Ok(CWriter(port.map_err(|error| error.to_string())?, topic.name))
}

/// Opens a topic for reading; null after saying why not.
///
/// # Safety
/// `group` is null or was returned by a function that joins one; `topic` is null or one of the header's.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_open_reader(
    group: *const Group,
    topic: *const CTopic,
) -> *mut CReader {
    // SAFETY: as the caller promises.
    let (group, topic) = unsafe { (group.as_ref(), find(topic)) };
    let opened = group.and_then(|group| or_complain(topic.and_then(|it| reader(group.bus(), it))));
    opened.map_or(std::ptr::null_mut(), |port| Box::into_raw(Box::new(port)))
}

/// Opens a topic for writing; null after saying why not.
///
/// # Safety
/// As [`whichone_open_reader`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_open_writer(
    group: *const Group,
    topic: *const CTopic,
) -> *mut CWriter {
    // SAFETY: as the caller promises.
    let (group, topic) = unsafe { (group.as_ref(), find(topic)) };
    let opened = group.and_then(|group| or_complain(topic.and_then(|it| writer(group.bus(), it))));
    opened.map_or(std::ptr::null_mut(), |port| Box::into_raw(Box::new(port)))
}

/// Closes a reader.
///
/// # Safety
/// It is null, or was opened and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_close_reader(reader: *mut CReader) {
    if !reader.is_null() {
        // SAFETY: as the caller promises.
        drop(unsafe { Box::from_raw(reader) });
    }
}

/// Closes a writer.
///
/// # Safety
/// It is null, or was opened and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_close_writer(writer: *mut CWriter) {
    if !writer.is_null() {
        // SAFETY: as the caller promises.
        drop(unsafe { Box::from_raw(writer) });
    }
}

/// Copies the next message to `message`. Returns its bytes, 0 if there is none, -1 after saying why.
///
/// # Safety
/// `reader` is null or open, and `message` has room for `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_take(
    reader: *const CReader,
    message: *mut u8,
    size: usize,
) -> isize {
    // SAFETY: as the caller promises.
    let Some(CReader(port, name)) = (unsafe { reader.as_ref() }) else { return -1 };
    if message.is_null() {
        return -1;
    }
    // SAFETY: as the caller promises; what it holds is overwritten, never read.
    let out = unsafe { std::slice::from_raw_parts_mut(message, size) };
    match port.take(out) {
        Ok(bytes) => bytes.map_or(0, |bytes| bytes as isize),
        Err(error) => {
            complain(&format_args!("topic {name}: {error}"));
            -1
        }
    }
}

/// Sends a copy of a message and wakes the topic's readers. Returns false after saying why it was not sent.
///
/// # Safety
/// `writer` is null or open, and `message` has `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_send(
    writer: *const CWriter,
    message: *const u8,
    size: usize,
) -> bool {
    // SAFETY: as the caller promises.
    let Some(CWriter(port, name)) = (unsafe { writer.as_ref() }) else { return false };
    if message.is_null() {
        return false;
    }
    // SAFETY: as the caller promises.
    let bytes = unsafe { std::slice::from_raw_parts(message, size) };
    or_complain(port.send(bytes).map_err(|error| format!("topic {name}: not sent: {error}")))
        .is_some()
}
