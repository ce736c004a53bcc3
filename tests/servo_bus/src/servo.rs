//! One servo: registers, position loop, protections.

/// Value of a register when the servo leaves the works: address, size, value.
const FACTORY: [(usize, usize, u16); 29] = [
    (0, 1, 3),
    (1, 1, 10),
    (3, 2, 777),
    (7, 1, 250),
    (8, 1, 1),
    (11, 2, 4095),
    (13, 1, 70),
    (14, 1, 80),
    (15, 1, 40),
    (16, 2, 1000),
    (18, 1, 12),
    (19, 1, 44),
    (20, 1, 47),
    (21, 1, 32),
    (22, 1, 32),
    (24, 2, 16),
    (26, 1, 1),
    (27, 1, 1),
    (28, 2, 500),
    (34, 1, 20),
    (35, 1, 200),
    (36, 1, 80),
    (37, 1, 10),
    (38, 1, 200),
    (39, 1, 10),
    (55, 1, 1),
    (80, 1, 1),
    (84, 1, 254),
    (85, 1, 254),
];
/// Registers from here on are volatile.
const VOLATILE: usize = 40;
/// Fastest speed, steps/s.
const FASTEST: f64 = 3072.0;
/// Share of the torque for each step between goal and position.
const STIFFNESS: f64 = 0.01;
/// Gain of the position loop, 1/s.
const GAIN: f64 = 20.0;
const VOLTAGE: u8 = 1;
const HEAT: u8 = 4;
const OVERLOAD: u8 = 32;

/// A servo with its joint.
#[derive(Clone, Debug)]
pub struct Servo {
    stored: [u8; 256],
    registers: [u8; 256],
    /// Position of the encoder before the homing offset, steps.
    pub actual: f64,
    /// Steps/s.
    pub speed: f64,
    /// The joint is blocked beyond these positions, steps before the homing offset.
    pub blocked: (f64, f64),
    /// Supply, volts.
    pub volts: f64,
    /// Temperature, °C.
    pub celsius: f64,
    /// How fast the joint falls without torque, steps/s.
    pub sag: f64,
    /// It answers nothing, and holds what it was told last.
    pub dead: bool,
    load: f64,
    overloaded_s: f64,
    protects: bool,
}

impl Servo {
    /// A new servo with this id, in the middle of its turn.
    pub fn new(id: u8) -> Self {
        let mut stored = [0; 256];
        for (address, size, value) in FACTORY {
            stored[address..address + size].copy_from_slice(&value.to_le_bytes()[..size]);
        }
        stored[5] = id;
        let mut servo = Self {
            stored,
            registers: stored,
            actual: 2048.0,
            speed: 0.0,
            blocked: (f64::NEG_INFINITY, f64::INFINITY),
            volts: 7.4,
            celsius: 30.0,
            sag: 0.0,
            dead: false,
            load: 0.0,
            overloaded_s: 0.0,
            protects: false,
        };
        servo.power_on();
        servo
    }

    /// The state after the supply was interrupted: what was not saved is lost, and the torque is off.
    pub fn power_on(&mut self) {
        self.registers = self.stored;
        // The limit of torque is a copy of the stored one.
        self.registers.copy_within(16..18, 48);
        self.put_word(42, with_sign(self.shown(), 15));
        (self.overloaded_s, self.protects, self.load) = (0.0, false, 0.0);
    }

    /// Writes stored registers as a calibration program does, with the lock open.
    pub fn calibrate(&mut self, offset: i32, range: (u16, u16)) {
        let offset = with_sign(f64::from(offset), 11);
        for (address, value) in [(9, range.0), (11, range.1), (31, offset)] {
            self.stored[address..address + 2].copy_from_slice(&value.to_le_bytes());
            self.put_word(address, value);
        }
    }

    /// The id.
    pub fn id(&self) -> u8 {
        self.registers[5]
    }

    /// A register of one byte.
    pub fn byte(&self, address: usize) -> u8 {
        self.registers[address]
    }

    /// A register of two bytes.
    pub fn word(&self, address: usize) -> u16 {
        u16::from_le_bytes([self.registers[address], self.registers[address + 1]])
    }

    /// What survives a loss of power, as [`Self::word`].
    pub fn saved_word(&self, address: usize) -> u16 {
        u16::from_le_bytes([self.stored[address], self.stored[address + 1]])
    }

    /// Sets a register as if it had always been so.
    pub fn set_byte(&mut self, address: usize, value: u8) {
        self.registers[address] = value;
        self.stored[address] = value;
    }

    /// The position that it shows, steps.
    pub fn shown(&self) -> f64 {
        (self.actual - without_sign(self.word(31), 11)).rem_euclid(4096.0)
    }

    /// Puts the joint where the servo shows this position.
    pub fn stand_at(&mut self, shown: f64) {
        self.actual = shown + without_sign(self.word(31), 11);
        self.speed = 0.0;
        self.measure();
    }

    /// The torque is on.
    pub fn holds(&self) -> bool {
        self.registers[40] == 1
    }

    /// The error byte of its answers.
    pub fn errors(&self) -> u8 {
        self.registers[65]
    }

    pub(crate) fn read(&self, address: usize, count: usize) -> Vec<u8> {
        (address..address + count).map(|at| self.registers.get(at).copied().unwrap_or(0)).collect()
    }

    pub(crate) fn write(&mut self, address: usize, data: &[u8]) {
        let goal = self.word(42);
        for (at, value) in (address..).zip(data) {
            if at < 5 || (56..71).contains(&at) || at > 255 {
                continue;
            }
            self.registers[at] = *value;
            if at < VOLATILE && self.registers[55] == 0 {
                self.stored[at] = *value;
            }
        }
        // Another goal, or switching it on, ends the protection.
        let switched = (address..address + data.len()).contains(&40) && self.holds();
        if self.protects && (self.word(42) != goal || switched) {
            (self.protects, self.overloaded_s) = (false, 0.0);
            self.registers[65] &= !OVERLOAD;
        }
    }

    /// Moves on by a few milliseconds.
    pub(crate) fn step(&mut self, dt: f64) {
        let limit = f64::from(self.word(48)) / 1000.0;
        let limit =
            if self.protects { limit.min(f64::from(self.registers[34]) / 100.0) } else { limit };
        self.load = 0.0;
        if self.holds() {
            self.follow(limit, dt)
        } else {
            self.fall(dt)
        }
        self.protect(dt);
        self.measure();
    }

    fn follow(&mut self, limit: f64, dt: f64) {
        let (least, most) = (f64::from(self.word(9)), f64::from(self.word(11)));
        let goal = without_sign(self.word(42), 15);
        let goal = if least == 0.0 && most == 0.0 { goal } else { goal.clamp(least, most) };
        let gap = goal - self.shown();
        let top = match self.word(46) {
            0 => FASTEST,
            limit => f64::from(limit).min(FASTEST),
        };
        let acceleration =
            100.0 * f64::from(if self.registers[41] == 0 { 254 } else { self.registers[41] });
        let braking = (2.0 * acceleration * gap.abs()).sqrt();
        let wanted = (gap * GAIN).clamp(-top, top).clamp(-braking, braking);
        self.speed += (wanted - self.speed).clamp(-acceleration * dt, acceleration * dt);
        let next = self.actual + self.speed * dt;
        let reached = next.clamp(self.blocked.0, self.blocked.1);
        if reached == next {
            self.load = (0.3 * self.speed / FASTEST).clamp(-limit, limit);
        } else {
            (self.load, self.speed) = ((gap * STIFFNESS).clamp(-limit, limit), 0.0);
        }
        self.actual = reached;
    }

    fn fall(&mut self, dt: f64) {
        self.speed = self.sag;
        self.actual = (self.actual + self.sag * dt).clamp(self.blocked.0, self.blocked.1);
    }

    fn protect(&mut self, dt: f64) {
        let percent = |register: u8| f64::from(register);
        if 100.0 * self.load.abs() > percent(self.registers[36]) && !self.protects {
            self.overloaded_s += dt;
            if 100.0 * self.overloaded_s >= percent(self.registers[35]) {
                self.protects = true;
                self.registers[65] |= OVERLOAD;
            }
        } else if !self.protects {
            self.overloaded_s = 0.0;
        }
        let supply = percent(self.registers[15])..=percent(self.registers[14]);
        let conditions = [
            (HEAT, self.celsius > percent(self.registers[13])),
            (VOLTAGE, !supply.contains(&(10.0 * self.volts))),
        ];
        for (bit, is_so) in conditions {
            self.registers[65] =
                if is_so { self.registers[65] | bit } else { self.registers[65] & !bit };
            if is_so && self.registers[19] & bit != 0 {
                self.registers[40] = 0;
            }
        }
    }

    fn measure(&mut self) {
        self.put_word(56, with_sign(self.shown(), 15));
        self.put_word(58, with_sign(self.speed, 15));
        self.put_word(60, with_sign(1000.0 * self.load, 10));
        self.registers[62] = (10.0 * self.volts) as u8;
        self.registers[63] = self.celsius as u8;
        self.registers[66] = u8::from(self.speed.abs() > 5.0);
    }

    fn put_word(&mut self, address: usize, value: u16) {
        self.registers[address..address + 2].copy_from_slice(&value.to_le_bytes());
    }
}

/// A number with its sign in a bit of its own.
fn with_sign(value: f64, bit: u32) -> u16 {
    let magnitude = (value.abs().round() as u16).min((1 << bit) - 1);
    if value < 0.0 { magnitude | 1 << bit } else { magnitude }
}

fn without_sign(raw: u16, bit: u32) -> f64 {
    let magnitude = f64::from(raw & ((1 << bit) - 1));
    if raw >> bit & 1 == 1 { -magnitude } else { magnitude }
}
