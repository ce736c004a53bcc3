//! XML-RPC as ROS 1 uses it: one call per connection, over HTTP.

use roxmltree::{Document, Node};
use std::fmt::Write as _;
use std::io::{self, ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::{Duration, Instant};

/// Largest call or answer, bytes.
const BYTES_MAX: usize = 256 << 10;
/// Deepest nesting of arrays.
const DEPTH_MAX: usize = 16;

/// A value. Types that the bridge has no use for are [`Value::Other`].
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `int`, `i4`.
    Int(i32),
    /// `boolean`.
    Bool(bool),
    /// `string`.
    Text(String),
    /// `array`.
    List(Vec<Value>),
    /// Any other.
    Other,
}

impl Value {
    /// Returns the text of a text.
    pub fn as_text(&self) -> Option<&str> {
        if let Self::Text(text) = self { Some(text) } else { None }
    }

    /// Returns the items of a list.
    pub fn as_list(&self) -> Option<&[Self]> {
        if let Self::List(items) = self { Some(items) } else { None }
    }

    /// Returns the texts of a list, others left out.
    pub fn texts(&self) -> Vec<String> {
        let items = self.as_list().unwrap_or_default();
        items.iter().filter_map(Self::as_text).map(str::to_owned).collect()
    }

    fn write(&self, text: &mut String) {
        // A string takes whatever is written.
        let _ = match self {
            Self::Int(number) => write!(text, "<value><int>{number}</int></value>"),
            Self::Bool(fact) => {
                write!(text, "<value><boolean>{}</boolean></value>", u8::from(*fact))
            }
            Self::Text(own) => {
                let own = own.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
                write!(text, "<value><string>{own}</string></value>")
            }
            Self::List(items) => {
                text.push_str("<value><array><data>");
                items.iter().for_each(|item| item.write(text));
                write!(text, "</data></array></value>")
            }
            Self::Other => write!(text, "<value></value>"),
        };
    }

    fn read(value: Node<'_, '_>, depth: usize) -> Option<Self> {
        let Some(typed) = value.first_element_child() else {
            return Some(Self::Text(value.text().unwrap_or_default().to_owned()));
        };
        let text = typed.text().unwrap_or_default();
        Some(match typed.tag_name().name() {
            "int" | "i4" => Self::Int(text.trim().parse().ok()?),
            "boolean" => Self::Bool(text.trim() == "1"),
            "string" => Self::Text(text.to_owned()),
            "array" if depth < DEPTH_MAX => {
                let data = typed.first_element_child()?;
                let items = data.children().filter(Node::is_element);
                Self::List(items.map(|item| Self::read(item, depth + 1)).collect::<Option<_>>()?)
            }
            "array" => return None,
            _ => Self::Other,
        })
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

/// A call without an answer of use.
#[derive(Debug, thiserror::Error)]
pub enum CallError {
    /// The other side cannot be reached.
    #[error("{0}: {1}")]
    Connection(String, io::Error),
    /// The other side refuses, or answers in another way.
    #[error("{0}: {1}")]
    Answer(String, String),
}

/// Calls a method of the ROS node or master at `uri`, and returns the third part of its answer
/// `[code, text, value]`.
///
/// # Errors
/// The node cannot be reached within `patience`, or its code is not that of success.
pub fn call(
    uri: &str,
    method: &str,
    parameters: &[Value],
    patience: Duration,
) -> Result<Value, CallError> {
    let unreachable = |error| CallError::Connection(uri.to_owned(), error);
    let body = exchange(uri, &request(method, parameters), patience).map_err(unreachable)?;
    let refused = |what: &str| CallError::Answer(uri.to_owned(), format!("{method}: {what}"));
    let parts = answer(&body).ok_or_else(|| refused("expected [code, text, value]"))?;
    match parts.as_slice() {
        [Value::Int(1), _, value] => Ok(value.clone()),
        [_, text, ..] => Err(refused(text.as_text().unwrap_or("refused"))),
        _ => Err(refused("expected [code, text, value]")),
    }
}

fn request(method: &str, parameters: &[Value]) -> String {
    let mut text =
        format!("<?xml version=\"1.0\"?><methodCall><methodName>{method}</methodName><params>");
    for parameter in parameters {
        text.push_str("<param>");
        parameter.write(&mut text);
        text.push_str("</param>");
    }
    text + "</params></methodCall>"
}

/// Host and port of a URI.
pub fn authority(uri: &str) -> &str {
    let rest = uri.split_once("://").map_or(uri, |(_, rest)| rest);
    rest.split('/').next().unwrap_or(rest)
}

fn exchange(uri: &str, body: &str, patience: Duration) -> io::Result<String> {
    let authority = authority(uri);
    let mut stream = connect(authority, patience)?;
    let head = format!(
        "POST /RPC2 HTTP/1.1\r\nHost: {authority}\r\nContent-Type: text/xml\r\nConnection: close\r\n\
         Content-Length: {}\r\n\r\n",
        body.len()
    );
    stream.write_all((head + body).as_bytes())?;
    let (head, body) = read_http(&mut stream, patience)?;
    let status = head.split(' ').nth(1).unwrap_or_default();
    if status == "200" { Ok(body) } else { Err(io::Error::other(format!("HTTP status {status}"))) }
}

/// Connects to `host:port`, whatever of its addresses answers.
///
/// # Errors
/// The name is unknown, or none answers within `patience`.
pub fn connect(authority: &str, patience: Duration) -> io::Result<TcpStream> {
    let mut last = io::Error::new(ErrorKind::NotFound, "no address");
    for address in authority.to_socket_addrs()? {
        match TcpStream::connect_timeout(&address, patience) {
            Ok(stream) => {
                stream.set_read_timeout(Some(patience))?;
                stream.set_write_timeout(Some(patience))?;
                stream.set_nodelay(true)?;
                return Ok(stream);
            }
            Err(error) => last = error,
        }
    }
    Err(last)
}

/// Reads one HTTP message: its head, and a body of the stated length, or up to the end of the stream.
fn read_http(stream: &mut impl Read, patience: Duration) -> io::Result<(String, String)> {
    let invalid = |what| io::Error::new(ErrorKind::InvalidData, what);
    let until = Instant::now() + patience;
    let (mut bytes, mut chunk) = (Vec::new(), [0; 4096]);
    // Beginning and length of the body, once known.
    let mut body: Option<(usize, Option<usize>)> = None;
    loop {
        if body.is_none()
            && let Some(end) = bytes.windows(4).position(|at| at == b"\r\n\r\n")
        {
            body = Some((end + 4, content_length(&bytes[..end])));
        }
        if let Some((begin, Some(length))) = body
            && bytes.len() >= begin.saturating_add(length)
        {
            bytes.truncate(begin + length);
            break;
        }
        if bytes.len() > BYTES_MAX {
            return Err(invalid("the message is too long"));
        }
        if Instant::now() >= until {
            return Err(ErrorKind::TimedOut.into());
        }
        match stream.read(&mut chunk)? {
            0 if matches!(body, Some((_, None))) => break,
            0 => return Err(ErrorKind::UnexpectedEof.into()),
            count => bytes.extend(&chunk[..count]),
        }
    }
    let (begin, _) = body.unwrap_or_default();
    let mut head = String::from_utf8(bytes).map_err(|_| invalid("no text"))?;
    let body = head.split_off(begin);
    Ok((head, body))
}

fn content_length(head: &[u8]) -> Option<usize> {
    let head = std::str::from_utf8(head).ok()?;
    let mut fields = head.lines().filter_map(|line| line.split_once(':'));
    let (_, value) = fields.find(|(name, _)| name.eq_ignore_ascii_case("content-length"))?;
    value.trim().parse().ok()
}

/// Returns the parts of an answer `[code, text, value]`, if it is one.
pub fn answer(body: &str) -> Option<Vec<Value>> {
    let document = Document::parse(body).ok()?;
    let params = document.root_element().first_element_child()?;
    let value = params.first_element_child()?.first_element_child()?;
    let read = Value::read(value, 0)?;
    params.has_tag_name("params").then_some(())?;
    if let Value::List(parts) = read { Some(parts) } else { None }
}

/// Answers one call that comes over `stream` with what `handle` returns for its method and parameters.
///
/// # Errors
/// The call does not come within `patience`, or is none.
pub fn serve(
    stream: &mut TcpStream,
    patience: Duration,
    handle: impl FnOnce(&str, &[Value]) -> (i32, String, Value),
) -> io::Result<()> {
    stream.set_read_timeout(Some(patience))?;
    stream.set_write_timeout(Some(patience))?;
    let (_, body) = read_http(stream, patience)?;
    let invalid = || io::Error::new(ErrorKind::InvalidData, "expected a method call");
    let (method, parameters) = method_call(&body).ok_or_else(invalid)?;
    let (code, text, value) = handle(&method, &parameters);
    let mut body = String::from("<?xml version=\"1.0\"?><methodResponse><params><param>");
    Value::List(vec![Value::Int(code), Value::Text(text), value]).write(&mut body);
    body.push_str("</param></params></methodResponse>");
    let head = format!(
        "HTTP/1.1 200 OK\r\nContent-Type: text/xml\r\nConnection: close\r\nContent-Length: {}\r\n\r\n",
        body.len()
    );
    stream.write_all((head + &body).as_bytes())
}

/// Returns method and parameters of a call, if it is one.
pub fn method_call(body: &str) -> Option<(String, Vec<Value>)> {
    let document = Document::parse(body).ok()?;
    let call = document.root_element();
    let child = |name| call.children().find(|node: &Node<'_, '_>| node.has_tag_name(name));
    let method = child("methodName")?.text()?.trim().to_owned();
    let params = child("params").map(|params| params.children().filter(Node::is_element));
    let read = |param: Node<'_, '_>| Value::read(param.first_element_child()?, 0);
    Some((method, params.into_iter().flatten().map(read).collect::<Option<_>>()?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;

    const SOON: Duration = Duration::from_secs(5);

    #[test]
    fn call_and_answer_round_trip() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let uri = format!("http://{}/", listener.local_addr().unwrap());
        let sent = vec![
            Value::from("/a&b <c>"),
            Value::List(vec![Value::Int(-3), Value::Bool(true), Value::List(Vec::new())]),
        ];
        let expected = sent.clone();
        let server = std::thread::spawn(move || {
            for code in [1, 0] {
                let (mut stream, _) = listener.accept().unwrap();
                serve(&mut stream, SOON, |method, parameters| {
                    assert_eq!((method, parameters), ("requestTopic", expected.as_slice()));
                    (code, "no such topic".to_owned(), parameters[1].clone())
                })
                .unwrap();
            }
        });
        assert_eq!(call(&uri, "requestTopic", &sent, SOON).unwrap(), sent[1]);
        let refused = call(&uri, "requestTopic", &sent, SOON).unwrap_err();
        assert!(refused.to_string().ends_with("requestTopic: no such topic"), "{refused}");
        server.join().unwrap();
        assert!(matches!(call(&uri, "getPid", &[], SOON), Err(CallError::Connection(..))));
    }

    #[test]
    fn values_of_other_programs_are_read() {
        let text = "<?xml version='1.0'?>\n<methodResponse>\n<params>\n<param>\n<value><array><data>\n\
                    <value><i4>1</i4></value>\n<value>plain</value>\n<value><double>1.5</double></value>\n\
                    </data></array></value>\n</param>\n</params>\n</methodResponse>\n";
        let expected = vec![Value::Int(1), Value::from("plain"), Value::Other];
        assert_eq!(answer(text), Some(expected));
        let fault = "<methodResponse><fault><value><int>1</int></value></fault></methodResponse>";
        assert_eq!(answer(fault), None);
        let deep = "<value><array><data>".repeat(100) + &"</data></array></value>".repeat(100);
        let deep = format!(
            "<methodCall><methodName>x</methodName><params><param>{deep}</param></params></methodCall>"
        );
        assert_eq!(method_call(&deep), None);
    }

    #[test]
    fn http_messages_end_with_their_length_or_stream() {
        let read = |text: &str| read_http(&mut text.as_bytes(), SOON).map(|(_, body)| body);
        assert_eq!(read("HTTP/1.1 200 OK\r\ncontent-length: 2\r\n\r\nabc").unwrap(), "ab");
        assert_eq!(read("HTTP/1.0 200 OK\r\n\r\nabc").unwrap(), "abc");
        assert!(read("HTTP/1.1 200 OK\r\nContent-Length: 4\r\n\r\nabc").is_err());
        assert!(read("HTTP/1.1 200 OK").is_err());
        assert!(read(&"x".repeat(BYTES_MAX + 5000)).is_err());
    }

    #[test]
    fn authority_is_what_a_uri_connects_to() {
        assert_eq!(authority("http://robot.local:11311/"), "robot.local:11311");
        assert_eq!(authority("http://[::1]:80/RPC2"), "[::1]:80");
    }
}
