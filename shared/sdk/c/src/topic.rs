//! Topics as C names them.

use std::ffi::{CStr, c_char};

use messages::topics::{self, Topic};

/// The beginning of `whichone_topic_t`: all that is read of it here.
#[repr(C)]
#[derive(Debug)]
pub struct CTopic {
    name: *const c_char,
    _ty: *const c_char,
    schema: *const c_char,
}

/// Returns the topic that C means.
///
/// # Errors
/// There is none of this name, or the header is of another version than this library.
///
/// # Safety
/// `topic` is null or a `whichone_topic_t` of the header.
pub(crate) unsafe fn find(topic: *const CTopic) -> Result<&'static Topic, String> {
    // SAFETY: as the caller promises.
    let topic = unsafe { topic.as_ref() }.ok_or("expected a topic, found NULL")?;
    let text = |part: *const c_char| {
        // SAFETY: the header's texts end with a zero.
        let part = (!part.is_null()).then(|| unsafe { CStr::from_ptr(part) });
        part.and_then(|part| part.to_str().ok()).unwrap_or_default()
    };
    let (name, schema) = (text(topic.name), text(topic.schema));
    let mut all = topics::ALL.iter().chain(&topics::robot::ALL);
    let found = all.find(|topic| topic.name == name).ok_or(format!("no topic {name:?}"))?;
    let ours = (found.schema)().to_string();
    if schema != ours {
        let help = "help: compile the program with the whichone.h of the library";
        return Err(format!("topic {name}: expected schema {ours}, found {schema}; {help}"));
    }
    Ok(found)
}
