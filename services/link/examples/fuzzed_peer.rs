//! A peer with valid keys that sends nonsense, for the tests of the link (`scripts/link test`).
//!
//!     fuzzed_peer KEYS ROBOT SEED SECONDS
//!
//! With a person's keys it makes requests of the robot and streams sound to it; with a robot's
//! keys, the robot's own or another's, it publishes under the robot's name. It sends random bytes,
//! valid messages with changed bits, and valid messages with forbidden requests.

use std::io::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use link::identity::{Identity, Role};
use link::line::{Line, Packed};
use link::mirrored::TOPICS;
use link::motion::{Order, Request, Seen};
use link::names::{Call, Keys};
use link::say::{Said, Sent};
use link::session::{connect, request};
use messages::{RequestKey, Sound, StopId};
use roster::Name;
use zenoh::{Session, Wait};

/// Pause between two rounds.
const PAUSE: Duration = Duration::from_millis(5);
/// Timeout of an answer.
const PATIENCE: Duration = Duration::from_millis(500);

fn main() -> zenoh::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let mut next = || arguments.next().ok_or("expected KEYS ROBOT SEED SECONDS");
    let keys = PathBuf::from(next()?);
    let robot = Keys::of(&next()?.parse::<Name>()?);
    let mut dice = Dice(next()?.parse()?);
    let until = Instant::now() + Duration::from_secs_f64(next()?.parse()?);
    let identity = Identity::load(&keys).map_err(|failure| failure.to_string())?;
    let session = connect(&identity, &keys).map_err(|failure| failure.to_string())?;
    let is_robot = identity.role == Role::Robot;
    let token = session.liveliness().declare_token(robot.alive("00000000000000ff"));
    let _token = is_robot.then(|| token.wait()).transpose()?;
    let mut sent = 0_u64;
    while Instant::now() < until {
        match is_robot {
            true => publish(&session, &robot, &mut dice)?,
            false => ask(&session, &robot, &mut dice)?,
        }
        sent += 1;
        std::thread::sleep(PAUSE);
    }
    writeln!(std::io::stdout(), "{sent} rounds")?;
    Ok(())
}

/// One round of a person: every request, and sound.
fn ask(session: &Session, robot: &Keys, dice: &mut Dice) -> zenoh::Result<()> {
    for call in Call::ALL {
        let payload = match call {
            Call::Say => dice.words(),
            Call::Motion => dice.order(),
            Call::Line => dice.file_name(),
            Call::Presence | Call::Hello => dice.bytes(200),
        };
        request(session, robot, call, payload, PATIENCE, drop);
    }
    session.put(robot.audio(), dice.bytes(5_000)).wait()
}

/// One round of a robot: every state, joints, presence, and lines.
fn publish(session: &Session, robot: &Keys, dice: &mut Dice) -> zenoh::Result<()> {
    let states = TOPICS.into_iter().chain(["group", "motion", "no/such/topic"]);
    let keys = states.map(|name| robot.state(name)).chain([robot.joints(), robot.presence()]);
    for key in keys {
        session.put(key, dice.bytes(600)).wait()?;
    }
    session.put(robot.line(), dice.line()).wait()
}

/// A small generator, so that a failure is repeated by its seed.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: u64) -> u64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % sides
    }

    fn bytes(&mut self, most: u64) -> Vec<u8> {
        (0..self.roll(most)).map(|_| self.roll(256) as u8).collect()
    }

    fn key(&mut self) -> [u8; 16] {
        std::array::from_fn(|_| self.roll(256) as u8)
    }

    /// Changes, cuts or lengthens an encoded message.
    fn changed(&mut self, mut bytes: Vec<u8>) -> Vec<u8> {
        match self.roll(3) {
            0 => bytes.truncate(self.roll(bytes.len() as u64) as usize),
            1 => bytes.extend(self.bytes(50)),
            _ => {
                let place = self.roll(bytes.len() as u64) as usize;
                bytes[place] ^= 1 << self.roll(8);
            }
        }
        bytes
    }

    /// Words: those that can be read name a file of the robot, or are a sound file that is none.
    fn words(&mut self) -> Vec<u8> {
        let sound = match self.roll(20) {
            0 => Sent::Sound(Sound::Wav("/etc/passwd".into())),
            1 => Sent::File(self.bytes(2_000)),
            2 => Sent::Sound(Sound::Text(String::new())),
            _ => return self.bytes(300),
        };
        let said = Said {
            key: RequestKey(self.key()),
            onset_age_ns: Some(u64::MAX),
            end_age_ns: Some(0),
            seen_prompt: u64::MAX,
            from: "n".repeat(self.roll(100) as usize),
            sound,
        };
        let bytes = postcard::to_stdvec(&said).unwrap_or_default();
        if self.roll(2) == 0 { bytes } else { self.changed(bytes) }
    }

    /// Orders: stops, and releases of stops that were never given.
    fn order(&mut self) -> Vec<u8> {
        let time = |dice: &mut Self| dice.roll(1 << 31) << dice.roll(32);
        let order = match self.roll(3) {
            0 => Order::Stop,
            1 => {
                let (at_ns, in_force_ns, stop) = (time(self), time(self), StopId(time(self)));
                Order::Release(Seen { at_ns, in_force_ns, stopped: true, stop })
            }
            _ => return self.bytes(60),
        };
        let bytes = postcard::to_stdvec(&Request { key: self.key(), order }).unwrap_or_default();
        if self.roll(2) == 0 { bytes } else { self.changed(bytes) }
    }

    /// Lines: those that can be read have rates of no sound, or lead elsewhere.
    fn line(&mut self) -> Vec<u8> {
        let names = ["line-1-1.wav", "line-1-99999999999999999999.wav", "../settings.toml", ""];
        let file = names[self.roll(names.len() as u64) as usize].to_owned();
        let rate_hz = [0, 1, 16_000, u32::MAX][self.roll(4) as usize];
        let sound = match self.roll(3) {
            0 => Packed::File(self.bytes(2_000)),
            _ => Packed::Adpcm { rate_hz, codes: self.bytes(2_000) },
        };
        let bytes = Line { file, sound }.encode().unwrap_or_default();
        if self.roll(2) == 0 { bytes } else { self.changed(bytes) }
    }

    fn file_name(&mut self) -> Vec<u8> {
        let names =
            ["../settings.toml", "/etc/passwd", "line-../../x.wav", "line-1-1.wav", "line-.wav"];
        match self.roll(2) {
            0 => names[self.roll(names.len() as u64) as usize].into(),
            _ => self.bytes(40),
        }
    }
}
