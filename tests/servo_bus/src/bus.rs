//! The bus: requests in, answers out, at their times.

use std::collections::VecDeque;

use crate::faults::Faults;
use crate::servo::Servo;

/// Longest step of the servos, seconds.
const STEP_S: f64 = 0.002;
/// Time of a byte at 1,000,000 baud, seconds.
const BYTE_S: f64 = 10e-6;
/// Speed from which a servo moves, steps/s: 0.05 rad/s.
const MOVES: f64 = 33.0;
const EVERYONE: u8 = 0xfe;
const BAUDS: [u32; 5] = [1_000_000, 500_000, 250_000, 128_000, 115_200];

/// Servos on one line.
#[derive(Clone, Debug)]
pub struct Bus {
    /// The servos.
    pub servos: Vec<Servo>,
    /// Faults of answers.
    pub faults: Faults,
    /// Rate at which the program sends.
    pub baud: u32,
    /// Positions of the servos when they were read last, by their places.
    pub sampled: Vec<u16>,
    /// When a servo last moved, seconds.
    pub moved_s: f64,
    /// Requests that were understood.
    pub requests: u64,
    answers: VecDeque<(f64, Vec<u8>)>,
    heard: Vec<u8>,
    now_s: f64,
}

impl Bus {
    /// New servos with the ids 1 to `count`.
    pub fn new(count: u8) -> Self {
        Self {
            servos: (1..=count).map(Servo::new).collect(),
            faults: Faults::none(),
            baud: BAUDS[0],
            sampled: vec![0; usize::from(count)],
            moved_s: 0.0,
            requests: 0,
            answers: VecDeque::new(),
            heard: Vec::new(),
            now_s: 0.0,
        }
    }

    /// The time, seconds.
    pub fn now_s(&self) -> f64 {
        self.now_s
    }

    /// Lets the servos move until this time.
    pub fn advance_to(&mut self, now_s: f64) {
        while self.now_s < now_s {
            let dt = STEP_S.min(now_s - self.now_s).max(1e-9);
            self.servos.iter_mut().for_each(|servo| servo.step(dt));
            self.now_s += dt;
            if self.servos.iter().any(|servo| servo.speed.abs() > MOVES) {
                self.moved_s = self.now_s;
            }
        }
    }

    /// Takes bytes of the program.
    pub fn take(&mut self, bytes: &[u8]) {
        self.heard.extend_from_slice(bytes);
        while let Some(at) = self.heard.windows(2).position(|two| two == [0xff, 0xff]) {
            self.heard.drain(..at);
            let Some(length) = self.heard.get(3).map(|length| usize::from(*length) + 4) else {
                return;
            };
            if self.heard.len() < length {
                return;
            }
            let packet: Vec<u8> = self.heard.drain(..length).collect();
            if length >= 6 && sum(&packet[2..length - 1]) == packet[length - 1] {
                self.requests += 1;
                self.obey(packet[2], packet[4], &packet[5..length - 1]);
            }
        }
    }

    /// Hands over the bytes that have arrived by now.
    pub fn give(&mut self) -> Vec<u8> {
        let mut bytes = Vec::new();
        while self.answers.front().is_some_and(|(at, _)| *at <= self.now_s) {
            bytes.extend(self.answers.pop_front().map(|(_, answer)| answer).unwrap_or_default());
        }
        bytes
    }

    /// Time of the next bytes, seconds.
    pub fn next_s(&self) -> Option<f64> {
        self.answers.front().map(|(at, _)| *at)
    }

    /// The servo with this id.
    pub fn servo(&mut self, id: u8) -> Option<&mut Servo> {
        self.servos.iter_mut().find(|servo| servo.id() == id)
    }

    fn hears(&self, servo: &Servo) -> bool {
        !servo.dead && BAUDS.get(usize::from(servo.byte(6))) == Some(&self.baud)
    }

    fn obey(&mut self, id: u8, instruction: u8, parameters: &[u8]) {
        let places: Vec<usize> = (0..self.servos.len())
            .filter(|place| self.hears(&self.servos[*place]))
            .filter(|place| id == EVERYONE || self.servos[*place].id() == id)
            .collect();
        let places: Vec<usize> = places.into_iter().filter(|_| self.faults.hears()).collect();
        match (instruction, parameters) {
            (1, []) => self.answer(&places, |_| Vec::new()),
            (2, [address, count]) if id != EVERYONE => {
                self.answer(&places, |servo| servo.read((*address).into(), (*count).into()));
            }
            (3, [address, data @ ..]) => {
                places.iter().for_each(|place| self.servos[*place].write((*address).into(), data));
                let answering: Vec<usize> =
                    places.into_iter().filter(|place| self.servos[*place].byte(8) != 0).collect();
                if id != EVERYONE {
                    self.answer(&answering, |_| Vec::new());
                }
            }
            (0x82, [address, count, ids @ ..]) => {
                let place =
                    |id: &u8| places.iter().copied().find(|place| self.servos[*place].id() == *id);
                let asked: Vec<usize> = ids.iter().filter_map(place).collect();
                let shows_position = (*address..address.saturating_add(*count)).contains(&56);
                for place in asked.iter().filter(|_| shows_position) {
                    self.sampled[*place] = self.servos[*place].word(56);
                }
                self.answer(&asked, |servo| servo.read((*address).into(), (*count).into()));
            }
            (0x83, [address, count, values @ ..]) => {
                for value in values.chunks_exact(usize::from(*count) + 1) {
                    let place = places.iter().find(|place| self.servos[**place].id() == value[0]);
                    place.iter().for_each(|place| {
                        self.servos[**place].write((*address).into(), &value[1..])
                    });
                }
            }
            _ => {}
        }
    }

    /// Sends the answers of these servos, one after the other.
    fn answer(&mut self, places: &[usize], data: impl Fn(&Servo) -> Vec<u8>) {
        let mut at = self.now_s;
        for place in places {
            let servo = &self.servos[*place];
            let data = data(servo);
            let mut packet =
                vec![0xff, 0xff, servo.id(), data.len() as u8 + 2, servo.errors() & 0x7f];
            packet.extend(data);
            packet.push(sum(&packet[2..]));
            let (late_s, bytes) = self.faults.pass(packet);
            at += BYTE_S * bytes.len() as f64 + 2e-6 * f64::from(servo.byte(7));
            if !bytes.is_empty() {
                self.answers.push_back((at + late_s, bytes));
            }
        }
        self.answers.make_contiguous().sort_by(|a, b| a.0.total_cmp(&b.0));
    }
}

fn sum(body: &[u8]) -> u8 {
    !body.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte))
}
