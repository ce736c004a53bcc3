//! `[simulated]` of `arm.toml`: the simulated Baxter.

use crate::camera::CameraSettings;
use config::{Check, Section};
use diagnostics::Fields;
use service::Span;

/// The simulated Baxter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simulated {
    /// Time constant with which a joint follows its command, seconds.
    pub lag_s: f64,
    /// Standard deviation of measured joint positions, radians.
    pub noise_rad: f64,
    /// Share of joint states that are lost.
    pub loss: f64,
    /// Seed of its random numbers.
    pub seed: u64,
    /// The motors are enabled at start.
    pub enabled: bool,
    /// A camera that reports the objects on its table, where they come from perception.
    pub camera: Option<CameraSettings>,
}

impl Section for Simulated {
    const KEY: &'static [&'static str] = &["arm", "simulated"];

    fn read(f: &mut Fields<'_>) -> Self {
        let seed = f.whole("seed", 0..=u64::from(u32::MAX));
        Self {
            lag_s: f.number("lag_s", 0.002..=1.0),
            noise_rad: f.number("noise_rad", 0.0..=0.01),
            loss: f.number("loss", 0.0..=0.9),
            seed,
            enabled: f.flag("enabled"),
            camera: f.table("camera", |f| camera(f, seed)),
        }
    }

    /// Reports a camera whose reports would have no effect.
    fn check(&self, others: &mut Check<'_>) {
        let driver = &others.arm.driver;
        let (what, help) = match self.camera {
            None => return,
            Some(_) if driver != "baxter" => (
                format!("is true, but the driver is {driver}"),
                "start with `--profile camera`, or write driver = \"baxter\"",
            ),
            Some(_) if !others.group.perception.enabled => (
                "is true, but the objects are those of the scene file".to_owned(),
                "start with `--profile camera`, or write group.perception.enabled = true",
            ),
            Some(_) => return,
        };
        others.problem(&["arm", "simulated", "camera", "enabled"], &what, help);
    }
}

fn camera(f: &mut Fields<'_>, seed: u64) -> Option<CameraSettings> {
    let is_enabled = f.flag("enabled");
    let camera = CameraSettings {
        rate_hz: f.number("rate_hz", 0.5..=30.0),
        noise_m: f.number("noise_m", 0.0..=0.05),
        misses: f.number("misses", 0.0..=0.9),
        delay: Span::from_s(f.number("delay_s", 0.0..=1.0)),
        sure: (f.number("sure_min", 0.0..=1.0), f.number("sure_max", 0.0..=1.0)),
        hidden_m: f.number("hidden_m", 0.0..=1.0),
        seed,
    };
    let (least, most) = camera.sure;
    if least > most && !f.is_wrong("sure_min") && !f.is_wrong("sure_max") {
        let what = format!("is {least}, more than sure_max");
        f.problem("sure_min", &what, "raise sure_max or lower sure_min");
    }
    is_enabled.then_some(camera)
}
