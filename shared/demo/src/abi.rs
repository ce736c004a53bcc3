//! The functions that the page calls.
//!
//! A call has three steps: the page asks for room for its command ([`whichone_input`]), writes the command there as
//! UTF-8, and has it carried out ([`whichone_command`]). The answer lies where [`whichone_output`] says until the next
//! command. There is one desk for each instance of the module.

#![allow(unsafe_code, reason = "names of functions for the page, which no other crate defines")]

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::Desk;

/// Longest command, bytes.
const COMMAND_BYTES_MAX: usize = 64 * 1024;

#[derive(Default)]
struct Instance {
    desk: Option<Desk>,
    input: Vec<u8>,
    output: String,
}

static INSTANCE: Mutex<Instance> =
    Mutex::new(Instance { desk: None, input: Vec::new(), output: String::new() });

fn instance() -> MutexGuard<'static, Instance> {
    INSTANCE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes room for a command of that many bytes and returns its address; null if it is longer than 64 KiB.
#[unsafe(no_mangle)]
pub extern "C" fn whichone_input(bytes: usize) -> *mut u8 {
    if bytes > COMMAND_BYTES_MAX {
        return std::ptr::null_mut();
    }
    let mut instance = instance();
    instance.input.clear();
    instance.input.resize(bytes, 0);
    instance.input.as_mut_ptr()
}

/// Carries out the command that was written, and returns the length of its answer in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn whichone_command() -> usize {
    let mut instance = instance();
    let input = std::mem::take(&mut instance.input);
    let command = String::from_utf8_lossy(&input);
    instance.output = instance.desk.get_or_insert_default().command(&command);
    instance.output.len()
}

/// Returns the address of the latest answer.
#[unsafe(no_mangle)]
pub extern "C" fn whichone_output() -> *const u8 {
    instance().output.as_ptr()
}
