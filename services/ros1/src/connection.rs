//! TCPROS: one connection per topic and subscriber, a header each way, then messages.

use std::collections::HashMap;
use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use rustix::net::sockopt;

use ros::wire::Message;

/// Largest header, bytes; that of a publisher contains the whole definition.
const HEADER_BYTES_MAX: u32 = 64 << 10;
/// Largest message, bytes. Those of the robot have some hundred, detections may carry point clouds.
const MESSAGE_BYTES_MAX: u32 = 64 << 20;
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
}

/// Fields of a header.
pub type Header = HashMap<String, String>;

impl Topic {
    /// Describes the topic `name` of messages `M`.
    pub fn of<M: Message>(name: &str) -> Self {
        let name = name.to_owned();
        Self { name, kind: M::NAME, md5: M::MD5, definition: M::full_definition() }
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
    read_frame(stream, HEADER_BYTES_MAX, &mut bytes)?;
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

/// Reads one message into `bytes`.
///
/// # Errors
/// The connection ends, or the message is larger than any of the bridge's.
pub fn read_message(stream: &mut impl Read, bytes: &mut Vec<u8>) -> io::Result<()> {
    read_frame(stream, MESSAGE_BYTES_MAX, bytes)
}

fn read_frame(stream: &mut impl Read, most: u32, bytes: &mut Vec<u8>) -> io::Result<()> {
    let mut length = [0; 4];
    stream.read_exact(&mut length)?;
    let length = u32::from_le_bytes(length);
    if length > most {
        let what = format!("expected at most {most} bytes, found {length}");
        return Err(io::Error::new(ErrorKind::InvalidData, what));
    }
    bytes.resize(length as usize, 0);
    stream.read_exact(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn topic() -> Topic {
        Topic { name: "/t".to_owned(), kind: "p/T", md5: "12", definition: "uint8 x\n".to_owned() }
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
        assert!(read_message(&mut huge.as_slice(), &mut Vec::new()).is_err());
    }
}
