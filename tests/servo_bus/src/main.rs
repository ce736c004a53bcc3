//! Serves a simulated bus behind a pseudo-terminal.
//!
//! ```text
//! servo_bus [--servos N] [--seed N] [--faults lost=0.02,late=0.02] [--calibration FILE]
//! ```
//!
//! It prints the path of the terminal, and obeys lines of its input: `block ID` (the joint meets an obstacle where it
//! is), `free ID`, `jaw ID STEPS` (an object stops it on the way down), `heat ID CELSIUS`, `volts ID VOLTS`, `dead ID`,
//! `alive ID`, `dip` (the supply of all is interrupted), `byte ID ADDRESS VALUE`, `faults KIND CHANCE`, `state` (prints
//! JSON). It ends with its input.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program for tests, whose answers are printed"
)]

use std::error::Error;
use std::io::{self, BufRead, Write};
use std::process::ExitCode;
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::thread;

use serde_json::{Value, json};
use servo_bus::{Bus, Faults, Servo, Terminal};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("servo_bus: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let mut bus = configured(std::env::args().skip(1))?;
    let terminal = Terminal::open()?;
    println!("{}", terminal.path());
    io::stdout().flush()?;
    let lines = lines();
    loop {
        terminal.serve(&mut bus)?;
        match lines.try_recv() {
            Ok(line) => {
                let done =
                    obey(&mut bus, &line).ok_or_else(|| format!("not understood: {line}"))?;
                if let Some(answer) = done {
                    println!("{answer}");
                    io::stdout().flush()?;
                }
            }
            Err(TryRecvError::Empty) => {}
            Err(TryRecvError::Disconnected) => return Ok(()),
        }
    }
}

/// The lines of the input, from a thread.
fn lines() -> Receiver<String> {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        let mut lines = io::stdin().lock().lines().map_while(Result::ok);
        lines.try_for_each(|line| sender.send(line))
    });
    receiver
}

fn configured(mut arguments: impl Iterator<Item = String>) -> Result<Bus, Box<dyn Error>> {
    let (mut servos, mut seed, mut chances, mut calibration) = (6, 1, String::new(), None);
    while let Some(option) = arguments.next() {
        let value = arguments.next().ok_or_else(|| format!("expected a value of {option}"))?;
        match option.as_str() {
            "--servos" => servos = value.parse()?,
            "--seed" => seed = value.parse()?,
            "--faults" => chances = value,
            "--calibration" => calibration = Some(value),
            _ => return Err(format!("unknown option {option}").into()),
        }
    }
    let mut bus = Bus::new(servos);
    bus.faults = Faults::each(0.0, seed);
    for one in chances.split(',').filter(|one| !one.is_empty()) {
        let (kind, chance) = one.split_once('=').ok_or("expected KIND=CHANCE")?;
        bus.faults.set(kind, chance.parse()?).ok_or_else(|| format!("unknown fault {kind}"))?;
    }
    if let Some(file) = calibration {
        calibrate(&mut bus, &serde_json::from_str(&std::fs::read_to_string(file)?)?)
            .ok_or("no calibration")?;
    }
    Ok(bus)
}

/// Gives the servos a calibration of lerobot, and puts each into the middle of its range.
fn calibrate(bus: &mut Bus, calibration: &Value) -> Option<()> {
    for of in calibration.as_object()?.values() {
        let number = |key: &str| of[key].as_i64();
        let range =
            (u16::try_from(number("range_min")?).ok()?, u16::try_from(number("range_max")?).ok()?);
        let servo = bus.servo(u8::try_from(number("id")?).ok()?)?;
        servo.calibrate(i32::try_from(number("homing_offset")?).ok()?, range);
        servo.stand_at(0.5 * (f64::from(range.0) + f64::from(range.1)));
    }
    Some(())
}

/// Obeys a line; `None` if it is not understood.
fn obey(bus: &mut Bus, line: &str) -> Option<Option<Value>> {
    let mut words = line.split_whitespace();
    match words.next()? {
        "dip" => bus.servos.iter_mut().for_each(Servo::power_on),
        "state" => return Some(Some(state(bus))),
        "faults" => bus.faults.set(words.next()?, words.next()?.parse().ok()?)?,
        order => {
            let servo = bus.servo(words.next()?.parse().ok()?)?;
            let number = words.next().map_or(Some(0.0), |word| word.parse::<f64>().ok())?;
            match order {
                "block" => servo.blocked = (servo.actual, servo.actual),
                "jaw" => servo.blocked.0 = servo.actual - servo.shown() + number,
                "free" => servo.blocked = (f64::NEG_INFINITY, f64::INFINITY),
                "heat" => servo.celsius = number,
                "volts" => servo.volts = number,
                "dead" => servo.dead = true,
                "alive" => servo.dead = false,
                "byte" => servo.set_byte(number as usize, words.next()?.parse().ok()?),
                _ => return None,
            }
        }
    }
    Some(None)
}

fn state(bus: &Bus) -> Value {
    let servos = bus.servos.iter().map(|servo| {
        json!({ "id": servo.id(), "position": servo.shown(), "speed": servo.speed, "goal": servo.word(42),
                "torque": servo.byte(40), "torque_limit": servo.word(48), "errors": servo.errors(),
                "range": [servo.saved_word(9), servo.saved_word(11)], "lock": servo.byte(55) })
    });
    json!({ "now_s": bus.now_s(), "moved_s": bus.moved_s, "requests": bus.requests,
            "servos": servos.collect::<Vec<_>>(), "faults": bus.faults.made })
}
