//! A connection with a time limit.

use std::io::{self, BufReader, BufWriter, ErrorKind, Read, Write};
use std::net::{IpAddr, SocketAddr, TcpStream, ToSocketAddrs as _};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, mpsc};
use std::thread;
use std::time::{Duration, Instant};

use crate::client::ClientError;
use crate::frame::{Frame, FrameError};
use crate::{Address, Event};

/// Interval at which a waiting call looks whether it was cancelled.
const POLL: Duration = Duration::from_millis(20);

/// A stream whose reads and writes end at a time, or when they are cancelled.
struct Limited<'c> {
    stream: TcpStream,
    until: Instant,
    is_cancelled: &'c dyn Fn() -> bool,
}

impl Limited<'_> {
    fn wait<T>(&self, mut attempt: impl FnMut(&TcpStream) -> io::Result<T>) -> io::Result<T> {
        loop {
            if (self.is_cancelled)() || Instant::now() >= self.until {
                return Err(ErrorKind::TimedOut.into());
            }
            match attempt(&self.stream) {
                Err(error)
                    if matches!(
                        error.kind(),
                        ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
                    ) => {}
                other => return other,
            }
        }
    }
}

impl Read for Limited<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.wait(|mut stream| stream.read(into))
    }
}

impl Write for Limited<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.wait(|mut stream| stream.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A connection to a server, for one request.
pub(crate) struct Connection<'c> {
    reader: BufReader<Limited<'c>>,
    writer: BufWriter<Limited<'c>>,
    limit: Duration,
}

impl<'c> Connection<'c> {
    /// Connects within `connect`; everything else takes at most `limit` from then on.
    pub(crate) fn open(
        (address, lookup): (&Address, &Lookup),
        (connect, limit): (Duration, Duration),
        is_cancelled: &'c dyn Fn() -> bool,
    ) -> Result<Self, ClientError> {
        let until = Instant::now() + connect;
        let mut last = ClientError::Unreachable("its name has no address".to_owned());
        let found = resolve(address, lookup, until)?;
        for (found, remaining) in found.iter().zip((1..=found.len() as u32).rev()) {
            // One that does not answer leaves time for the others.
            let left = until.saturating_duration_since(Instant::now()) / remaining;
            if left.is_zero() {
                break;
            }
            match TcpStream::connect_timeout(found, left) {
                Ok(stream) => return Self::over(&stream, limit, is_cancelled),
                Err(error) => last = ClientError::Unreachable(error.kind().to_string()),
            }
        }
        Err(last)
    }

    fn over(
        stream: &TcpStream,
        limit: Duration,
        is_cancelled: &'c dyn Fn() -> bool,
    ) -> Result<Self, ClientError> {
        let until = Instant::now() + limit;
        let limited = || -> io::Result<Limited<'c>> {
            let stream = stream.try_clone()?;
            stream.set_read_timeout(Some(POLL))?;
            stream.set_write_timeout(Some(POLL))?;
            // A request ends with a small event, which must not wait for more.
            stream.set_nodelay(true)?;
            Ok(Limited { stream, until, is_cancelled })
        };
        let both = limited().and_then(|reader| Ok((reader, limited()?)));
        let (reader, writer) = both.map_err(|error| ClientError::Broken(error.to_string()))?;
        let (reader, writer) = (BufReader::new(reader), BufWriter::new(writer));
        Ok(Self { reader, writer, limit })
    }

    /// Sends events.
    pub(crate) fn send<'e>(
        &mut self,
        events: impl IntoIterator<Item = &'e Event>,
    ) -> Result<(), ClientError> {
        let sent =
            events.into_iter().try_for_each(|event| Frame::from(event).write(&mut self.writer));
        sent.and_then(|()| self.writer.flush()).map_err(|error| self.error(FrameError::Io(error)))
    }

    /// Returns the next event that is not a ping, which is answered.
    pub(crate) fn next(&mut self) -> Result<Event, ClientError> {
        loop {
            let frame = match Frame::read(&mut self.reader) {
                Ok(frame) => frame.ok_or(ClientError::Ended)?,
                Err(error) => return Err(self.error(error)),
            };
            match Event::try_from(frame).map_err(|error| ClientError::Broken(error.to_string()))? {
                Event::Ping(text) => self.send([&Event::Pong(text)])?,
                Event::Error(text) => {
                    return Err(ClientError::Refused(text.chars().take(200).collect()));
                }
                event => return Ok(event),
            }
        }
    }

    fn error(&self, error: FrameError) -> ClientError {
        let Limited { until, is_cancelled, .. } = self.reader.get_ref();
        match error {
            _ if is_cancelled() => ClientError::Cancelled,
            FrameError::Io(_) if Instant::now() >= *until => ClientError::Late(self.limit),
            FrameError::Cut => ClientError::Ended,
            FrameError::Io(error) if is_end(&error) => ClientError::Ended,
            other => ClientError::Broken(other.to_string()),
        }
    }
}

fn is_end(error: &io::Error) -> bool {
    use ErrorKind::{BrokenPipe, ConnectionAborted, ConnectionReset, UnexpectedEof};
    matches!(error.kind(), BrokenPipe | ConnectionAborted | ConnectionReset | UnexpectedEof)
}

/// A client's look-ups of its server's name, at most one at a time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lookup(Arc<AtomicBool>);

/// They make no difference between clients.
impl PartialEq for Lookup {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A look-up in flight.
struct InFlight(Lookup);

impl Lookup {
    fn begin(&self) -> Option<InFlight> {
        (!self.0.swap(true, Ordering::SeqCst)).then(|| InFlight(self.clone()))
    }
}

impl Drop for InFlight {
    fn drop(&mut self) {
        self.0.0.store(false, Ordering::SeqCst);
    }
}

/// Returns the addresses of a host. A name is looked up on a thread of its own, because the system
/// may take its time, which nothing can shorten.
fn resolve(
    address: &Address,
    lookup: &Lookup,
    until: Instant,
) -> Result<Vec<SocketAddr>, ClientError> {
    let Address { host, port } = address.clone();
    if let Ok(number) = host.parse::<IpAddr>() {
        return Ok(vec![(number, port).into()]);
    }
    let Some(in_flight) = lookup.begin() else {
        return Err(ClientError::Unreachable("its name is still being looked up".to_owned()));
    };
    let (found, wait) = mpsc::channel();
    let look_up = move || {
        let addresses = (host.as_str(), port).to_socket_addrs().map(Iterator::collect);
        drop(in_flight);
        // The caller may have given up.
        let _ = found.send(addresses);
    };
    let started = thread::Builder::new().spawn(look_up);
    started.map_err(|error| ClientError::Unreachable(error.to_string()))?;
    match wait.recv_timeout(until.saturating_duration_since(Instant::now())) {
        Ok(Ok(addresses)) => Ok(addresses),
        Ok(Err(error)) => Err(ClientError::Unreachable(error.to_string())),
        Err(_) => Err(ClientError::Unreachable("its name cannot be looked up in time".to_owned())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn name_is_looked_up_once_at_a_time() {
        let until = Instant::now() + Duration::from_secs(20);
        let local = Address { host: "localhost".to_owned(), port: 1 };
        let number = Address { host: "127.0.0.1".to_owned(), port: 1 };
        let lookup = Lookup::default();
        let in_flight = lookup.begin();
        let refused = resolve(&local, &lookup, until).unwrap_err().to_string();
        assert!(refused.contains("still being looked up"), "{refused}");
        assert!(resolve(&number, &lookup, until).is_ok());
        drop(in_flight);
        for _ in 0..2 {
            assert!(resolve(&local, &lookup, until).is_ok());
        }
    }
}
