//! What the system offers: a futex, datagrams and streams.

use super::Link;
use serde::{Serialize, de::DeserializeOwned};
use std::io::{Read, Write};
use std::os::unix::net::{UnixDatagram, UnixStream};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread::Thread;

/// A message that postcard encodes.
pub(super) trait Numbered: Serialize + DeserializeOwned + Send {
    fn number(&mut self) -> &mut u64;
}

impl Numbered for [u64; 8] {
    fn number(&mut self) -> &mut u64 {
        &mut self[0]
    }
}

impl Numbered for (u64, Vec<u8>) {
    fn number(&mut self) -> &mut u64 {
        &mut self.0
    }
}

pub(super) fn encoded<M: Numbered>(message: &mut M, number: u64) -> Vec<u8> {
    *message.number() = number;
    postcard::to_stdvec(message).expect("room for a message")
}

pub(super) fn decoded<M: Numbered>(bytes: &[u8]) -> u64 {
    let mut message: M = postcard::from_bytes(bytes).expect("a message");
    *message.number()
}

pub(super) struct Datagrams<M> {
    socket: UnixDatagram,
    message: M,
    buffer: Vec<u8>,
}

impl<M: Numbered + Clone> Datagrams<M> {
    pub(super) fn pair(message: M) -> (impl FnOnce() -> Self + Send, impl FnOnce() -> Self + Send) {
        let (here, there) = UnixDatagram::pair().expect("a pair of sockets");
        let open = |socket, message| move || Self { socket, message, buffer: vec![0; 1 << 18] };
        (open(here, message.clone()), open(there, message))
    }
}

impl<M: Numbered> Link for Datagrams<M> {
    fn send(&mut self, number: u64) {
        let bytes = encoded(&mut self.message, number);
        self.socket.send(&bytes).expect("a socket with room");
    }

    fn receive(&mut self) -> u64 {
        let length = self.socket.recv(&mut self.buffer).expect("a datagram");
        decoded::<M>(&self.buffer[..length])
    }
}

/// A stream of messages, each after its length.
pub(super) struct Streams<M> {
    socket: UnixStream,
    message: M,
    buffer: Vec<u8>,
}

impl<M: Numbered + Clone> Streams<M> {
    pub(super) fn pair(message: M) -> (impl FnOnce() -> Self + Send, impl FnOnce() -> Self + Send) {
        let (here, there) = UnixStream::pair().expect("a pair of sockets");
        let open = |socket, message| move || Self { socket, message, buffer: vec![0; 1 << 18] };
        (open(here, message.clone()), open(there, message))
    }
}

impl<M: Numbered> Link for Streams<M> {
    fn send(&mut self, number: u64) {
        let bytes = encoded(&mut self.message, number);
        let length = (bytes.len() as u64).to_le_bytes();
        self.socket.write_all(&length).expect("a stream");
        self.socket.write_all(&bytes).expect("a stream");
    }

    fn receive(&mut self) -> u64 {
        let mut length = [0; 8];
        self.socket.read_exact(&mut length).expect("a length");
        let bytes = &mut self.buffer[..u64::from_le_bytes(length) as usize];
        self.socket.read_exact(bytes).expect("a message");
        decoded::<M>(bytes)
    }
}

/// A number for each side, and the threads that sleep until it comes.
#[derive(Default)]
struct Words {
    numbers: [AtomicU64; 2],
    threads: [OnceLock<Thread>; 2],
}

/// Threads that sleep on the standard library's futex.
pub(super) struct Parked {
    words: Arc<Words>,
    side: usize,
}

impl Parked {
    pub(super) fn pair() -> (impl FnOnce() -> Self + Send, impl FnOnce() -> Self + Send) {
        let words = Arc::new(Words::default());
        let open = |words: Arc<Words>, side: usize| {
            move || {
                words.threads[side].set(std::thread::current()).expect("one thread for each side");
                Self { words, side }
            }
        };
        (open(Arc::clone(&words), 0), open(words, 1))
    }
}

impl Link for Parked {
    fn send(&mut self, number: u64) {
        let other = 1 - self.side;
        self.words.numbers[other].store(number, Ordering::Release);
        self.words.threads[other].wait().unpark();
    }

    fn receive(&mut self) -> u64 {
        loop {
            match self.words.numbers[self.side].swap(0, Ordering::Acquire) {
                0 => std::thread::park(),
                number => return number,
            }
        }
    }
}
