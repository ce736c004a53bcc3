//! TCPROS: one connection per topic and subscriber, a header each way, then messages.

use std::collections::HashMap;
use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use rustix::net::sockopt;

use ros::wire::Message;

/// Largest header, bytes; that of a publisher contains the whole definition.
const HEADER_BYTES_MAX: u32 = 64 << 10;
/// Largest message, bytes. Those of the robot have some thousand.
const MESSAGE_BYTES_MAX: u32 = 64 << 10;
/// Largest message of detections, which may carry point clouds.
pub const LARGE_BYTES_MAX: u32 = 16 << 20;
/// Room for large messages of all connections together, bytes.
const LARGE_ROOM: u32 = 64 << 20;
/// What of [`LARGE_ROOM`] is taken.
static LARGE_TAKEN: AtomicU32 = AtomicU32::new(0);
/// Time after which a silent peer that has lost its power or its cable is noticed.
const DEAD_AFTER: Duration = Duration::from_secs(5);

/// A topic as connections agree about it.
#[derive(Clone, Debug)]
pub struct Topic {
    /// Its name, e.g. `/robot/state`.
    pub name: String,
    /// Its type, e.g. `baxter_core_msgs/AssemblyState`.
    pub kind: &'static str,
    /// Checksum of the type.
    pub md5: &'static str,
    /// Full definition of the type.
    pub definition: String,
    /// Largest message, bytes.
    pub bytes_max: u32,
}

/// Fields of a header.
pub type Header = HashMap<String, String>;

impl Topic {
    /// Describes the topic `name` of messages `M`.
    pub fn of<M: Message>(name: &str) -> Self {
        let name = name.to_owned();
        let (definition, bytes_max) = (M::full_definition(), MESSAGE_BYTES_MAX);
        Self { name, kind: M::NAME, md5: M::MD5, definition, bytes_max }
    }

    /// Checks that the header of a peer means the same type.
    ///
    /// # Errors
    /// Another type, or what the peer complains about.
    pub fn check(&self, header: &Header) -> Result<(), String> {
        if let Some(error) = header.get("error") {
            return Err(error.clone());
        }
        // Tools that take any type say so.
        let fits =
            |key, own: &str| header.get(key).is_none_or(|value| value == own || value == "*");
        if fits("md5sum", self.md5) && fits("type", self.kind) {
            return Ok(());
        }
        let found = |key| header.get(key).map_or("none", String::as_str);
        Err(format!(
            "topic {}: expected {} with checksum {}, found {} with {}",
            self.name,
            self.kind,
            self.md5,
            found("type"),
            found("md5sum")
        ))
    }

    /// Returns the header's fields for this topic.
    pub fn fields<'a>(&'a self, node: &'a str) -> Vec<(&'static str, &'a str)> {
        vec![
            ("callerid", node),
            ("topic", &self.name),
            ("type", self.kind),
            ("md5sum", self.md5),
            ("message_definition", &self.definition),
        ]
    }
}

/// Sets what a connection needs to notice a dead peer, and to send messages at once.
///
/// # Errors
/// The operating system refuses an option.
pub fn tune(stream: &TcpStream) -> io::Result<()> {
    stream.set_nodelay(true)?;
    sockopt::set_socket_keepalive(stream, true)?;
    sockopt::set_tcp_keepidle(stream, Duration::from_secs(2))?;
    sockopt::set_tcp_keepintvl(stream, Duration::from_secs(1))?;
    sockopt::set_tcp_keepcnt(stream, 3)?;
    sockopt::set_tcp_user_timeout(stream, DEAD_AFTER.as_millis() as u32)?;
    Ok(())
}

/// A stream that is read until a time.
#[derive(Debug)]
pub struct Until<'a> {
    stream: &'a TcpStream,
    until: Instant,
}

impl<'a> Until<'a> {
    /// A stream that is read for so long.
    pub fn new(stream: &'a TcpStream, patience: Duration) -> Self {
        Self { stream, until: Instant::now() + patience }
    }
}

impl Read for Until<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let left = self.until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        self.stream.set_read_timeout(Some(left))?;
        self.stream.read(bytes)
    }
}

/// Writes a header.
///
/// # Errors
/// The connection fails.
pub fn write_header(stream: &mut impl Write, fields: &[(&str, &str)]) -> io::Result<()> {
    let mut bytes = vec![0; 4];
    for (key, value) in fields {
        bytes.extend(((key.len() + 1 + value.len()) as u32).to_le_bytes());
        bytes.extend([key.as_bytes(), b"=", value.as_bytes()].concat());
    }
    let length = (bytes.len() - 4) as u32;
    bytes[..4].copy_from_slice(&length.to_le_bytes());
    stream.write_all(&bytes)
}

/// Reads a header.
///
/// # Errors
/// The connection fails, or sends something else.
pub fn read_header(stream: &mut impl Read) -> io::Result<Header> {
    let invalid = || io::Error::new(ErrorKind::InvalidData, "expected a TCPROS header");
    let mut bytes = Vec::new();
    let length = read_length(stream, HEADER_BYTES_MAX)?;
    read_frame(stream, length, &mut bytes)?;
    let (mut rest, mut header) = (bytes.as_slice(), Header::new());
    while !rest.is_empty() {
        let (length, behind) = rest.split_first_chunk::<4>().ok_or_else(invalid)?;
        let length = u32::from_le_bytes(*length) as usize;
        let (field, behind) = behind.split_at_checked(length).ok_or_else(invalid)?;
        let (key, value) =
            std::str::from_utf8(field).ok().and_then(|f| f.split_once('=')).ok_or_else(invalid)?;
        header.insert(key.to_owned(), value.to_owned());
        rest = behind;
    }
    Ok(header)
}

/// The memory of a connection for its messages. What it has beyond that of a usual message is a part of
/// [`LARGE_ROOM`] until the connection ends.
#[derive(Debug, Default)]
pub struct MessageBuffer {
    bytes: Vec<u8>,
    taken: u32,
}

impl MessageBuffer {
    /// Reads one message of at most `most` bytes.
    ///
    /// # Errors
    /// The connection ends, the message is larger, or large messages of other connections have all the room.
    pub fn read(&mut self, stream: &mut impl Read, most: u32) -> io::Result<&[u8]> {
        let length = read_length(stream, most)?;
        self.take_room(length)?;
        read_frame(stream, length, &mut self.bytes)?;
        Ok(&self.bytes)
    }

    fn take_room(&mut self, length: u32) -> io::Result<()> {
        if length <= MESSAGE_BYTES_MAX.max(self.taken) {
            return Ok(());
        }
        let more = length - self.taken;
        let taken = LARGE_TAKEN.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |taken| {
            taken.checked_add(more).filter(|taken| *taken <= LARGE_ROOM)
        });
        taken.map_err(|_| io::Error::other("too many large messages at a time"))?;
        self.taken = length;
        Ok(())
    }
}

impl Drop for MessageBuffer {
    fn drop(&mut self) {
        LARGE_TAKEN.fetch_sub(self.taken, Ordering::Relaxed);
    }
}

fn read_length(stream: &mut impl Read, most: u32) -> io::Result<u32> {
    let mut length = [0; 4];
    stream.read_exact(&mut length)?;
    let length = u32::from_le_bytes(length);
    if length > most {
        let what = format!("expected at most {most} bytes, found {length}");
        return Err(io::Error::new(ErrorKind::InvalidData, what));
    }
    Ok(length)
}

/// Reads so many bytes. Memory is taken as they arrive: a length alone is a claim.
fn read_frame(stream: &mut impl Read, length: u32, bytes: &mut Vec<u8>) -> io::Result<()> {
    bytes.clear();
    let read = stream.take(length.into()).read_to_end(bytes)?;
    if read < length as usize { Err(ErrorKind::UnexpectedEof.into()) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn topic() -> Topic {
        let (name, definition) = ("/t".to_owned(), "uint8 x\n".to_owned());
        Topic { name, kind: "p/T", md5: "12", definition, bytes_max: 9 }
    }

    #[test]
    fn headers_round_trip_and_name_the_type() {
        let mut bytes = Vec::new();
        write_header(&mut bytes, &topic().fields("/me")).unwrap();
        let header = read_header(&mut bytes.as_slice()).unwrap();
        assert_eq!(header["message_definition"], "uint8 x\n");
        assert_eq!(topic().check(&header), Ok(()));
        let with = |key: &str, value: &str| {
            let mut header = header.clone();
            header.insert(key.to_owned(), value.to_owned());
            topic().check(&header)
        };
        assert_eq!(with("md5sum", "*"), Ok(()));
        assert!(with("md5sum", "13").unwrap_err().contains("found p/T with 13"));
        assert!(with("type", "p/Other").is_err());
        assert_eq!(with("error", "no"), Err("no".to_owned()));
    }

    #[test]
    fn frames_that_lie_are_rejected() {
        for bytes in
            [&[255, 255, 255, 255][..], &[5, 0, 0, 0, 9, 0, 0, 0, b'a'], &[4, 0, 0, 0, 0, 0, 0, 0]]
        {
            assert!(read_header(&mut &bytes[..]).is_err(), "{bytes:?}");
        }
        let huge = (MESSAGE_BYTES_MAX + 1).to_le_bytes();
        let mut buffer = MessageBuffer::default();
        assert!(buffer.read(&mut huge.as_slice(), MESSAGE_BYTES_MAX).is_err());
    }

    #[test]
    fn memory_is_taken_for_what_arrives_and_bounded_over_all_connections() {
        let frame =
            |claimed: u32, sent: usize| [claimed.to_le_bytes().to_vec(), vec![7; sent]].concat();
        let mut claim = MessageBuffer::default();
        let short = frame(LARGE_BYTES_MAX, 1_000);
        assert!(claim.read(&mut short.as_slice(), LARGE_BYTES_MAX).is_err());
        assert!(claim.bytes.capacity() < 1 << 16, "{}", claim.bytes.capacity());
        drop(claim);
        let claims = || {
            let mut buffer = MessageBuffer::default();
            let is_room = buffer.take_room(LARGE_BYTES_MAX).is_ok();
            is_room.then_some(buffer)
        };
        let large: Vec<MessageBuffer> = std::iter::repeat_with(claims).map_while(|it| it).collect();
        assert_eq!(large.len(), (LARGE_ROOM / LARGE_BYTES_MAX) as usize);
        // The robot's messages need none of it.
        let mut usual = MessageBuffer::default();
        for length in [3, 60_000, 5] {
            let read = usual.read(&mut frame(length, length as usize).as_slice(), 1 << 16).unwrap();
            assert_eq!(read, vec![7; length as usize]);
        }
        drop(large);
        assert!(claims().is_some());
    }

    #[test]
    fn header_that_comes_byte_by_byte_ends_in_time() {
        let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        let mut peer = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        let (stream, _) = listener.accept().unwrap();
        let slow = std::thread::spawn(move || {
            while peer.write_all(&[1]).is_ok() {
                std::thread::sleep(Duration::from_millis(20));
            }
        });
        let began = Instant::now();
        let mut until = Until::new(&stream, Duration::from_millis(200));
        assert!(read_header(&mut until).is_err() && began.elapsed() < Duration::from_secs(2));
        drop(stream);
        slow.join().unwrap();
    }
}
