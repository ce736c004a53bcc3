//! ZeroMQ over its transport between processes, with postcard; its library is loaded where it is installed.
//!
//! Invariant: the declarations follow `zmq.h` of ZeroMQ 4; the shared object's name carries the ABI (`.so.5`).
#![allow(unsafe_code)]

use super::Link;
use super::peers::{Numbered, decoded, encoded};
use libloading::Library as SharedObject;
use std::ffi::{CString, c_char, c_int, c_void};
use std::sync::Arc;
use tempfile::TempDir;

/// `ZMQ_PAIR`: one peer at each end.
const PAIR: c_int = 0;

/// The functions used, and the shared object that keeps them mapped.
struct Library {
    ctx_new: unsafe extern "C" fn() -> *mut c_void,
    ctx_term: unsafe extern "C" fn(*mut c_void) -> c_int,
    socket: unsafe extern "C" fn(*mut c_void, c_int) -> *mut c_void,
    close: unsafe extern "C" fn(*mut c_void) -> c_int,
    bind: unsafe extern "C" fn(*mut c_void, *const c_char) -> c_int,
    connect: unsafe extern "C" fn(*mut c_void, *const c_char) -> c_int,
    send: unsafe extern "C" fn(*mut c_void, *const c_void, usize, c_int) -> c_int,
    recv: unsafe extern "C" fn(*mut c_void, *mut c_void, usize, c_int) -> c_int,
    /// Declared last: the functions above point into it.
    _object: SharedObject,
}

impl Library {
    fn open() -> Option<Self> {
        // SAFETY: the initialisers of ZeroMQ are plain C++ without demands on the caller; each type is that of the
        // function of that name, and the copied pointers stay valid because the object is kept beside them.
        unsafe {
            let object = SharedObject::new("libzmq.so.5").ok()?;
            Some(Self {
                ctx_new: *object.get("zmq_ctx_new").ok()?,
                ctx_term: *object.get("zmq_ctx_term").ok()?,
                socket: *object.get("zmq_socket").ok()?,
                close: *object.get("zmq_close").ok()?,
                bind: *object.get("zmq_bind").ok()?,
                connect: *object.get("zmq_connect").ok()?,
                send: *object.get("zmq_send").ok()?,
                recv: *object.get("zmq_recv").ok()?,
                _object: object,
            })
        }
    }
}

/// One end, with a context of its own, as a process has.
pub(super) struct ZeroMq<M> {
    library: Arc<Library>,
    context: *mut c_void,
    socket: *mut c_void,
    message: M,
    buffer: Vec<u8>,
    /// Connecting goes on in the background.
    _folder: Arc<TempDir>,
}

impl<M: Numbered + Clone> ZeroMq<M> {
    /// Both ends; none where ZeroMQ is not installed.
    pub(super) fn pair(
        message: M,
    ) -> Option<(impl FnOnce() -> Self + Send, impl FnOnce() -> Self + Send)> {
        let library = Arc::new(Library::open()?);
        let folder = Arc::new(tempfile::tempdir().expect("a temporary folder"));
        let endpoint = format!("ipc://{}", folder.path().join("socket").display());
        let endpoint = CString::new(endpoint).expect("a path without NUL");
        let open = |binds: bool| {
            let (library, message) = (Arc::clone(&library), message.clone());
            let (endpoint, folder) = (endpoint.clone(), Arc::clone(&folder));
            move || Self::open(library, message, (&endpoint, folder), binds)
        };
        Some((open(false), open(true)))
    }

    fn open(
        library: Arc<Library>,
        message: M,
        (endpoint, folder): (&CString, Arc<TempDir>),
        binds: bool,
    ) -> Self {
        // SAFETY: plain calls with pointers of the library; `endpoint` ends with NUL.
        let (context, socket, refused) = unsafe {
            let context = (library.ctx_new)();
            let socket = (library.socket)(context, PAIR);
            let open = if binds { library.bind } else { library.connect };
            (context, socket, open(socket, endpoint.as_ptr()))
        };
        assert_eq!(refused, 0, "a socket of ZeroMQ");
        Self { library, context, socket, message, buffer: vec![0; 1 << 18], _folder: folder }
    }
}

impl<M: Numbered> Link for ZeroMq<M> {
    fn send(&mut self, number: u64) {
        let bytes = encoded(&mut self.message, number);
        // SAFETY: the socket is open, and ZeroMQ copies the bytes.
        let sent =
            unsafe { (self.library.send)(self.socket, bytes.as_ptr().cast(), bytes.len(), 0) };
        assert_eq!(usize::try_from(sent), Ok(bytes.len()), "a message of ZeroMQ");
    }

    fn receive(&mut self) -> u64 {
        let buffer = &mut self.buffer;
        // SAFETY: the socket is open, and no more bytes are written than the buffer has.
        let length = unsafe {
            (self.library.recv)(self.socket, buffer.as_mut_ptr().cast(), buffer.len(), 0)
        };
        let length = usize::try_from(length).expect("a message of ZeroMQ");
        decoded::<M>(&self.buffer[..length])
    }
}

impl<M> Drop for ZeroMq<M> {
    fn drop(&mut self) {
        // SAFETY: both are open, and not used again. The end of the context waits for what was sent.
        unsafe {
            (self.library.close)(self.socket);
            (self.library.ctx_term)(self.context);
        }
    }
}
