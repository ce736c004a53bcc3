//! Everything that a recording or a live view shows: readers of every topic, and the picture.

use std::collections::BTreeMap;
use std::path::PathBuf;

use config::Settings;
use messages::Stamp;
use messages::topics::Topic;
use robot_model::Robot;
use service::Time;
use service::bus::{AnyMessage, AnyReader, Bus, BusError, PortError};

use crate::channels::{CDR_HEADER, ChannelId, group_topics};
use crate::clock::WallClock;
use crate::payload;
use crate::picture::{Painter, Shown};
use crate::settings::Recorder;

/// A message of a channel.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a> {
    /// The channel.
    pub channel: ChannelId,
    /// Number of the message among its writer's, or the picture channel's since its reader's start.
    pub sequence: u32,
    /// When it was sent, nanoseconds since 1970.
    pub at_ns: u64,
    /// The message in the encoding of the channel.
    pub data: &'a [u8],
}

/// The topics cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// A topic cannot be read.
    #[error(transparent)]
    Bus(#[from] BusError),
    /// The robot's description is invalid.
    #[error("{0}")]
    Robot(String),
    /// The settings of recordings are invalid.
    #[error(transparent)]
    Settings(diagnostics::Diagnostics),
}

/// A topic and the reader of its messages.
#[derive(Debug)]
struct Source {
    topic: &'static Topic,
    channel: ChannelId,
    reader: AnyReader,
    /// Messages that were sent before are left out.
    since: Time,
}

/// Readers of every topic of a group, and the painter of its picture.
#[derive(Debug)]
pub struct GroupReader {
    topics: Vec<Source>,
    painter: Painter,
    /// Number of the latest message of each channel of the picture.
    numbers: Numbers,
    /// The latest failure to read a topic, so that it is logged once.
    failure: Option<String>,
    /// Buffer of a message with its CDR header.
    buffer: Vec<u8>,
    /// Topics that are still to be opened, the next one last.
    unopened: Vec<(ChannelId, &'static Topic)>,
    since: Time,
}

impl GroupReader {
    /// Opens the channels of [`channels::shown`](crate::channels::shown). Messages before `since`
    /// are left out, except latest ones. The services' logs are in `log_folder`.
    ///
    /// # Errors
    /// A topic cannot be read, or the robot's description is invalid.
    pub fn open(
        bus: &Bus,
        settings: &Settings,
        log_folder: PathBuf,
        since: Time,
    ) -> Result<Self, OpenError> {
        let mut reader = Self::closed(settings, log_folder, since)?;
        while reader.open_next(bus)? {}
        Ok(reader)
    }

    /// As [`GroupReader::open`], with every topic still to be opened by [`GroupReader::open_next`]:
    /// each takes a while.
    ///
    /// # Errors
    /// The robot's description is invalid.
    pub fn closed(
        settings: &Settings,
        log_folder: PathBuf,
        since: Time,
    ) -> Result<Self, OpenError> {
        let files = settings.robot_files();
        let robot = Robot::read(&files.urdf, files.srdf.as_ref());
        let robot = robot.map_err(|found| OpenError::Robot(found.to_string()))?;
        let topics = group_topics().enumerate();
        let topics = topics.map(|(place, topic)| (ChannelId::of_topic(place), topic));
        let Recorder { sound, .. } = settings.part().map_err(OpenError::Settings)?;
        let is_shown = |channel: ChannelId| sound || !channel.is_sound();
        let mut unopened: Vec<_> = topics.filter(|(channel, _)| is_shown(*channel)).collect();
        unopened.reverse();
        let painter = Painter::new(settings, &robot, log_folder);
        let (topics, numbers, buffer) = (Vec::new(), Numbers::new(), Vec::new());
        Ok(Self { topics, painter, numbers, failure: None, buffer, unopened, since })
    }

    /// Opens the next topic; returns whether there was one.
    ///
    /// # Errors
    /// The topic cannot be read; it is tried again with the next call.
    pub fn open_next(&mut self, bus: &Bus) -> Result<bool, OpenError> {
        let Some((channel, topic)) = self.unopened.last().copied() else { return Ok(false) };
        let reader = bus.any_reader(topic)?;
        // Of a state the latest message counts, however old it is.
        let since = if topic.history > 1 { self.since } else { Time(0) };
        self.topics.push(Source { topic, channel, reader, since });
        self.unopened.pop();
        Ok(true)
    }

    /// Shows everything that is known to one who begins to look at `now`.
    pub fn begin(&mut self, now: Time, clock: WallClock, show: &mut dyn FnMut(Sample<'_>)) {
        let Self { painter, numbers, .. } = self;
        painter.begin(now, clock, &mut |shown| picture(&shown, numbers, show));
    }

    /// Takes the new messages of all topics. Returns whether a buffer was more than an eighth full:
    /// then the next look should come soon.
    pub fn look(&mut self, now: Time, clock: WallClock, show: &mut dyn FnMut(Sample<'_>)) -> bool {
        let Self { topics, painter, numbers, buffer, .. } = self;
        let (mut failure, mut is_filling) = (None, false);
        for Source { topic, channel, reader, since } in topics.iter() {
            let mut pending = 0;
            let taken = reader.drain(&mut |stamp, message| {
                pending += 1;
                let sent = sent(stamp, now);
                if sent < *since {
                    return;
                }
                let (channel, sequence) = (*channel, stamp.sequence);
                let at_ns = clock.wall_ns(sent);
                let mut show_data = |data: &[u8]| show(Sample { channel, sequence, at_ns, data });
                match message {
                    AnyMessage::Fixed(message) => {
                        buffer.clear();
                        buffer.extend(CDR_HEADER);
                        buffer.extend(message.bytes());
                        show_data(buffer);
                    }
                    AnyMessage::Encoded(bytes) => match payload::to_json(topic, bytes) {
                        Ok(json) => show_data(&json),
                        // Those whom it is for reject it, and say so.
                        Err(error) => tracing::debug!(%error, "not shown"),
                    },
                }
                let mut show_picture = |shown| picture(&shown, numbers, show);
                painter.on_message(topic, (sent, clock), message, &mut show_picture);
            });
            is_filling |= 8 * pending > topic.buffer_max();
            failure = failure.or(taken.err());
        }
        painter.show_scene(now, clock, &mut |shown| picture(&shown, numbers, show));
        self.judge(failure);
        is_filling
    }

    /// Shows the lines that were added to the services' logs.
    pub fn show_logs(&mut self, now: Time, clock: WallClock, show: &mut dyn FnMut(Sample<'_>)) {
        let Self { painter, numbers, .. } = self;
        painter.show_logs(now, clock, &mut |shown| picture(&shown, numbers, show));
    }

    /// Drops the new messages of all topics.
    pub fn skip(&mut self) {
        let drop_all = |source: &Source| source.reader.drain(&mut |_, _| {}).err();
        let failure = self.topics.iter().filter_map(drop_all).next();
        self.judge(failure);
    }

    /// A topic that cannot be read is tried again with the next look.
    fn judge(&mut self, failure: Option<PortError>) {
        let failure = failure.map(|error| error.to_string());
        if let Some(error) = failure.as_ref().filter(|_| self.failure.is_none()) {
            tracing::warn!(error, "a topic cannot be read; trying again");
        }
        self.failure = failure;
    }
}

/// Number of the latest message by channel.
type Numbers = BTreeMap<ChannelId, u32>;

fn picture(
    (picture, at_ns, data): &Shown,
    numbers: &mut Numbers,
    show: &mut dyn FnMut(Sample<'_>),
) {
    let channel = (*picture).into();
    let sequence = numbers.entry(channel).or_default();
    *sequence = sequence.wrapping_add(1);
    show(Sample { channel, sequence: *sequence, at_ns: *at_ns, data });
}

/// When a message was sent, unless its sender gives an impossible time.
fn sent(stamp: &Stamp, now: Time) -> Time {
    match Time(stamp.sent_ns) {
        Time(0) => now,
        sent if sent > now => now,
        sent => sent,
    }
}
