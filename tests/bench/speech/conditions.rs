//! Circumstances in which sentences are heard: noise, room, distance, manner of speaking.

use super::noise::{self, bursts, pink, samples};
use super::room;
use vocabulary::Rng;
use whichone_tests::spoken::babble;

/// What is heard beside the voice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Noise {
    /// Steady and pink.
    Steady,
    /// Six other speakers.
    Babble,
    /// Knocks and clatter at the voice's level, over steady noise.
    Sudden,
    /// Steady, until noise of 10 dB begins during the speech.
    Beginning,
}

/// One set of circumstances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Condition {
    pub(super) name: &'static str,
    /// Level of a voice nearby above the noise.
    pub(super) snr_db: f64,
    pub(super) noise: Noise,
    /// Distance in the room; `None` without reverberation.
    pub(super) distance_m: Option<f64>,
    /// Factors of the pace and of all frequencies of the voice.
    pub(super) pace: f64,
    pub(super) pitch: f64,
}

impl Condition {
    /// Steady noise without a room.
    pub(super) const fn steady(name: &'static str, snr_db: f64) -> Self {
        Self { name, snr_db, noise: Noise::Steady, distance_m: None, pace: 1.0, pitch: 1.0 }
    }

    const fn noise(name: &'static str, noise: Noise, snr_db: f64) -> Self {
        Self { noise, ..Self::steady(name, snr_db) }
    }
}

/// Levels of steady noise.
pub(super) const QUIET: Condition = Condition::steady("25 dB", 25.0);
pub(super) const NOISY: Condition = Condition::steady("10 dB", 10.0);
pub(super) const BETWEEN: [Condition; 2] =
    [Condition::steady("20 dB", 20.0), Condition::steady("15 dB", 15.0)];

/// Circumstances other than steady noise.
pub(super) const OTHER: [Condition; 8] = [
    Condition::noise("babble, 15 dB", Noise::Babble, 15.0),
    Condition::noise("babble, 10 dB", Noise::Babble, 10.0),
    Condition::noise("knocks and clatter, 25 dB", Noise::Sudden, 25.0),
    Condition::noise("noise of 10 dB begins during the speech", Noise::Beginning, 25.0),
    Condition { distance_m: Some(0.5), ..Condition::steady("room, 0.5 m, 25 dB", 25.0) },
    Condition { distance_m: Some(3.0), ..Condition::steady("room, 3 m", 25.0) },
    Condition { pace: 1.3, ..Condition::steady("spoken 1.3 times as fast, 25 dB", 25.0) },
    Condition { pitch: 1.15, ..Condition::steady("voice 1.15 times as high, 25 dB", 25.0) },
];

/// What is heard before and behind the voice, seconds; talk is known after some seconds only.
const LEAD_S: f64 = 0.5;
const BABBLE_LEAD_S: f64 = 5.0;
const TAIL_S: f64 = 0.8;
/// Level of noise that begins.
const BEGINNING_DB: f64 = 10.0;

impl Condition {
    /// Returns how much is heard before the voice, seconds.
    pub(super) fn lead_s(&self) -> f64 {
        if self.noise == Noise::Babble { BABBLE_LEAD_S } else { LEAD_S }
    }

    /// Returns the voice with everything around it.
    pub(super) fn heard(&self, spoken: &[i16], others: &[Vec<i16>], seed: u64) -> Vec<i16> {
        let spoken: Vec<f64> = spoken.iter().map(|&s| f64::from(s)).collect();
        let level = noise::rms(&spoken);
        let (lead, tail) = (samples(self.lead_s()), samples(TAIL_S));
        let len = lead + spoken.len() + tail;
        let voice = match self.distance_m {
            Some(metres) => room::heard(&spoken, metres, seed),
            None => spoken.clone(),
        };
        let below = |db: f64| level / 10_f64.powf(db / 20.0);
        let steady = match self.noise {
            Noise::Babble => babble(len, others, seed),
            _ => pink(len, seed),
        };
        let mut sum: Vec<f64> = steady.iter().map(|s| s * below(self.snr_db)).collect();
        sum[lead..].iter_mut().zip(voice).for_each(|(sum, voice)| *sum += voice);
        // A second draw, independent of the first.
        let second = seed ^ 0x5EED;
        match self.noise {
            Noise::Sudden => add(&mut sum, &bursts(len, second), level),
            Noise::Beginning => {
                let share = 0.2 + 0.4 * Rng::new(second).uniform();
                let from = lead + (share * spoken.len() as f64) as usize;
                add(&mut sum[from..], &pink(len - from, second), below(BEGINNING_DB));
            }
            Noise::Steady | Noise::Babble => {}
        }
        // The cast saturates: what exceeds full scale is clipped.
        sum.into_iter().map(|s| s as i16).collect()
    }
}

fn add(sum: &mut [f64], noise: &[f64], level: f64) {
    sum.iter_mut().zip(noise).for_each(|(sum, s)| *sum += level * s);
}
