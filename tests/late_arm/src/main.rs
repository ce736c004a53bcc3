//! The program of an arm with a driver of its own, `late`, which neither the arm nor the configuration knows: the
//! example of a driver outside of the project.
//!
//! ```text
//! whichone up --set 'group.services.arm.command=["late_arm"]' --set arm.driver=late --set arm.late.delay_s=0.08
//! ```

use std::collections::VecDeque;
use std::process::ExitCode;

use arm::KinematicArm;
use arm_driver::{ArmDriver, Command, Configured, Driver, Drivers, Fault, Measured};
use config::{Registered, Section};
use diagnostics::Fields;
use service::{Span, Time};

fn main() -> ExitCode {
    arm::run::<Own>()
}

/// The drivers of this program.
struct Own;

impl Drivers for Own {
    const LIST: &'static [&'static Driver] = &[&LATE];
}

static LATE: Driver = Driver {
    about: &config::Driver {
        name: "late",
        in_real_time: true,
        needs: None,
        sections: &[Registered::of::<Settings>()],
    },
    configure: |settings, _| {
        let Settings { delay } = settings.part()?;
        Ok(Configured::new(move |start| Box::new(LateArm::new(KinematicArm::at(start), delay))))
    },
    connect: None,
    examine: None,
};

/// `[late]` of `arm.toml`.
struct Settings {
    /// Time from a command to its motion.
    delay: Span,
}

impl Section for Settings {
    const KEY: &'static [&'static str] = &["arm", "late"];

    fn read(f: &mut Fields<'_>) -> Self {
        Self { delay: Span::from_s(f.number("delay_s", 0.0..=0.5)) }
    }
}

/// A robot that moves as commanded, a while later.
struct LateArm {
    robot: KinematicArm,
    delay: Span,
    now: Time,
    /// Commands under way: when they arrive, and the seconds that each takes.
    under_way: VecDeque<(Time, Command, f64)>,
}

impl LateArm {
    fn new(robot: KinematicArm, delay: Span) -> Self {
        Self { robot, delay, now: Time(0), under_way: VecDeque::new() }
    }
}

impl ArmDriver for LateArm {
    fn measured(&self) -> Measured {
        self.robot.measured()
    }

    fn command(&mut self, command: &Command, seconds: f64) {
        // The end of a motion is commanded until the robot has arrived.
        if seconds > 0.0 {
            self.under_way.push_back((self.now + self.delay, *command, seconds));
        }
    }

    fn begin_pass(&mut self, now: Time, _: [bool; 2]) {
        self.now = now;
        let due = self.under_way.iter().take_while(|it| it.0 <= now).count();
        for (_, command, seconds) in self.under_way.drain(..due) {
            self.robot.command(&command, seconds);
        }
    }

    fn has_arrived(&mut self, _: &Command, _: f64) -> Result<bool, Fault> {
        Ok(self.is_still())
    }

    fn is_still(&self) -> bool {
        self.under_way.is_empty()
    }

    fn hold_here(&mut self) {
        self.under_way.clear();
    }

    fn beat(&self) -> Option<Span> {
        Some(Span::from_ms(10))
    }
}
