//! A topic that the bridge publishes.

use crate::connection::{self, Topic, Until};
use crate::guarded;
use crate::slots::Slot;
use ros::wire::Message;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::net::sockopt;
use service::{Span, Time, clock};
use std::io::Write;
use std::net::TcpStream;
use std::sync::{Arc, Condvar, Mutex};
use std::time::Duration;

/// Age beyond which a message is dropped: commands of a process that has died in the meantime, or that
/// waited in a stopped bridge. Half the time after which the robot itself drops out of a command.
const AGE_MAX: Span = Span::from_ms(100);
/// Subscribers of one topic at a time.
const SUBSCRIBERS_MAX: usize = 16;
/// Smallest buffer that the system gives: a slow subscriber misses messages, and gets no queue of old ones.
const SEND_BUFFER_BYTES: usize = 4096;
/// Patience with a subscriber's header.
const HEADER_PATIENCE: Duration = Duration::from_secs(5);
/// Interval at which a silent connection is looked at.
const LOOK_EVERY: Duration = Duration::from_secs(1);

/// A topic that the bridge publishes, with a connection and a thread for each subscriber.
#[derive(Debug)]
pub struct Publication {
    /// The topic.
    pub topic: Topic,
    subscribers: Mutex<Vec<Arc<Outbox>>>,
}

/// The newest message for one subscriber.
#[derive(Debug, Default)]
struct Outbox {
    waiting: Mutex<Option<(Arc<[u8]>, Time)>>,
    changed: Condvar,
}

impl Publication {
    /// Returns the topic `name` of messages `M`.
    pub fn new<M: Message>(name: &str) -> Self {
        Self { topic: Topic::of::<M>(name), subscribers: Mutex::default() }
    }

    /// Sends a message that was `made` then to every subscriber that has taken the one before; the
    /// others get the newest one once they have.
    pub fn publish(&self, message: &impl Message, made: Time) {
        let subscribers = guarded(&self.subscribers);
        if subscribers.is_empty() {
            return;
        }
        let frame: Arc<[u8]> = message.to_frame().into();
        for outbox in subscribers.iter() {
            *guarded(&outbox.waiting) = Some((Arc::clone(&frame), made));
            outbox.changed.notify_one();
        }
    }

    /// Returns the number of subscribers.
    pub fn subscribers(&self) -> usize {
        guarded(&self.subscribers).len()
    }

    /// Sends messages over `stream` until the subscriber is gone.
    pub fn serve(&self, mut stream: TcpStream, node: &str) {
        let outbox = Arc::new(Outbox::default());
        {
            let mut subscribers = guarded(&self.subscribers);
            if subscribers.len() == SUBSCRIBERS_MAX {
                return tracing::warn!(topic = self.topic.name, node, "too many subscribers");
            }
            subscribers.push(Arc::clone(&outbox));
        }
        tracing::info!(topic = self.topic.name, node, "subscriber connected");
        // Those of the header ended with it; a dead peer is found by the socket's own options.
        let _ = stream.set_write_timeout(None);
        let _ = sockopt::set_socket_send_buffer_size(&stream, SEND_BUFFER_BYTES);
        while outbox.send_next(&mut stream) {}
        guarded(&self.subscribers).retain(|other| !Arc::ptr_eq(other, &outbox));
        tracing::info!(topic = self.topic.name, node, "subscriber gone");
    }
}

impl Outbox {
    /// Waits for a message and sends it. Returns false once the subscriber is gone.
    fn send_next(&self, stream: &mut TcpStream) -> bool {
        let waiting = guarded(&self.waiting);
        let waited = self.changed.wait_timeout_while(waiting, LOOK_EVERY, |it| it.is_none());
        let Some((frame, made)) = waited.ok().and_then(|(mut waiting, _)| waiting.take()) else {
            return !is_closed(stream);
        };
        if clock::now().since(made) > AGE_MAX {
            tracing::debug!("a message is too old to be sent");
            return true;
        }
        stream.write_all(&frame).is_ok()
    }
}

/// Returns whether the peer has closed the connection.
fn is_closed(stream: &TcpStream) -> bool {
    let closed = PollFlags::RDHUP | PollFlags::HUP | PollFlags::ERR;
    let mut fds = [PollFd::new(stream, PollFlags::RDHUP)];
    let now = Timespec { tv_sec: 0, tv_nsec: 0 };
    poll(&mut fds, Some(&now)).is_ok() && fds[0].revents().intersects(closed)
}

/// Answers a subscriber's header, for which it has the `slot`, and sends it messages until it is gone.
///
/// # Errors
/// The connection fails, or the subscriber wants something else.
pub(crate) fn accept(
    mut stream: TcpStream,
    own: &str,
    publications: &[Arc<Publication>],
    slot: Slot,
) -> std::io::Result<()> {
    connection::tune(&stream)?;
    let header = connection::read_header(&mut Until::new(&stream, HEADER_PATIENCE))?;
    let wanted = header.get("topic").map_or("", String::as_str);
    let found = publications.iter().find(|publication| publication.topic.name == wanted);
    let checked = found.ok_or_else(|| format!("topic {wanted} is not published by {own}"));
    let checked = checked.and_then(|found| found.topic.check(&header).map(|()| found));
    let publication = match checked {
        Ok(publication) => publication,
        Err(error) => {
            let node = header.get("callerid").map_or("", String::as_str);
            tracing::warn!(node, error, "a subscriber is refused");
            return connection::write_header(&mut stream, &[("error", &error)]);
        }
    };
    let mut fields = publication.topic.fields(own);
    fields.push(("latching", "0"));
    connection::write_header(&mut stream, &fields)?;
    // From here on it counts among the topic's subscribers.
    drop(slot);
    publication.serve(stream, header.get("callerid").map_or("?", String::as_str));
    Ok(())
}
