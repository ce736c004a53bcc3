//! Addresses of servers.

use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

/// A server's address, `tcp://HOST:PORT`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Address {
    /// Name or number of the host; IPv6 without brackets.
    pub host: String,
    /// Port, not 0.
    pub port: u16,
}

/// Error of an address.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected tcp://HOST:PORT, found `{0}`")]
pub struct AddressError(String);

const SCHEME: &str = "tcp://";

impl FromStr for Address {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<Self, AddressError> {
        let parsed = || {
            let (host, port) = text.strip_prefix(SCHEME)?.rsplit_once(':')?;
            let port: u16 = port.parse().ok().filter(|port| *port != 0)?;
            let host = match host.strip_prefix('[') {
                Some(inner) => inner.strip_suffix(']')?,
                None if host.contains(':') => return None,
                None => host,
            };
            let is_odd = |c: char| c.is_whitespace() || matches!(c, '/' | '@' | '[' | ']');
            (!host.is_empty() && !host.contains(is_odd))
                .then(|| Self { host: host.to_owned(), port })
        };
        parsed().ok_or_else(|| AddressError(text.to_owned()))
    }
}

impl Display for Address {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { host, port } = self;
        if host.contains(':') {
            write!(f, "{SCHEME}[{host}]:{port}")
        } else {
            write!(f, "{SCHEME}{host}:{port}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn address_is_read_as_it_is_written() {
        for text in ["tcp://127.0.0.1:10300", "tcp://whisper.local:1", "tcp://[::1]:65535"] {
            assert_eq!(text.parse::<Address>().unwrap().to_string(), text);
        }
        for text in [
            "",
            "127.0.0.1:10300",
            "tcp://host",
            "tcp://:10300",
            "tcp://host:0",
            "tcp://host:70000",
            "tcp://::1:10300",
            "tcp://[::1:10300",
            "tcp://a b:10300",
            "tcp://user@host:10300",
            "http://host:10300",
            "tcp://host:10300/",
        ] {
            let error = text.parse::<Address>().unwrap_err().to_string();
            assert!(error.ends_with(&format!("found `{text}`")), "{error}");
        }
    }
}
