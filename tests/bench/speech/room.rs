//! A synthesised room: direct sound, early reflections and an exponentially decaying tail.

use super::noise::samples;
use ::speech_engines::audio::RATE_HZ;
use realfft::RealFftPlanner;
use vocabulary::Rng;

/// Time in which the tail falls by 60 dB, seconds: a furnished kitchen.
const REVERBERATION_S: f64 = 0.4;
/// Distance at which direct and reverberant sound are equally strong, metres: of an omnidirectional
/// source in 80 cubic metres with that reverberation.
const CRITICAL_M: f64 = 0.8;
/// Distance at which a voice has its level.
const NEAR_M: f64 = 0.5;
/// Early reflections and their latest arrival, seconds; share of the reverberant power in them.
const REFLECTIONS: usize = 8;
const EARLY_S: f64 = 0.03;
const EARLY: f64 = 0.4;

/// Returns a voice (of any level) as it arrives from a distance; at [`NEAR_M`] the level stays.
pub(super) fn heard(voice: &[f64], distance_m: f64, seed: u64) -> Vec<f64> {
    convolved(voice, &impulse_response(distance_m, seed))
}

fn impulse_response(distance_m: f64, seed: u64) -> Vec<f64> {
    let mut rng = Rng::new(seed);
    let mut tail = vec![0.0; samples(REVERBERATION_S)];
    let early = samples(EARLY_S);
    for (n, sample) in tail.iter_mut().enumerate().skip(early) {
        let fallen_db = 60.0 * n as f64 / f64::from(RATE_HZ) / REVERBERATION_S;
        *sample = (2.0 * rng.uniform() - 1.0) * 10_f64.powf(-fallen_db / 20.0);
    }
    scale_to(&mut tail[early..], 1.0 - EARLY);
    for _ in 0..REFLECTIONS {
        let at = samples(0.002 + (EARLY_S - 0.002) * rng.uniform());
        tail[at.min(early - 1)] += 1.0 + rng.uniform();
    }
    scale_to(&mut tail[..early], EARLY);
    // Powers relative to the reverberation, which is the same everywhere in the room.
    let direct = |metres: f64| (CRITICAL_M / metres).powi(2);
    tail[0] += direct(distance_m).sqrt();
    let near = (direct(NEAR_M) + 1.0).sqrt();
    tail.into_iter().map(|sample| sample / near).collect()
}

/// Scales samples to an energy.
fn scale_to(samples: &mut [f64], energy: f64) {
    let gain = (energy / samples.iter().map(|s| s * s).sum::<f64>()).sqrt();
    samples.iter_mut().for_each(|s| *s *= gain);
}

fn convolved(a: &[f64], b: &[f64]) -> Vec<f64> {
    let len = a.len() + b.len();
    let size = len.next_power_of_two();
    let mut planner = RealFftPlanner::new();
    let (forward, inverse) = (planner.plan_fft_forward(size), planner.plan_fft_inverse(size));
    let spectrum = |samples: &[f64]| {
        let (mut input, mut output) = (forward.make_input_vec(), forward.make_output_vec());
        input[..samples.len()].copy_from_slice(samples);
        forward.process(&mut input, &mut output).expect("vectors of the transform's own lengths");
        output
    };
    let mut product: Vec<_> = spectrum(a).iter().zip(spectrum(b)).map(|(a, b)| a * b).collect();
    let mut sum = inverse.make_output_vec();
    inverse.process(&mut product, &mut sum).expect("vectors of the transform's own lengths");
    sum.truncate(len);
    sum.into_iter().map(|sample| sample / size as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn room_keeps_the_level_nearby_and_the_reverberation_far_away() {
        let energy = |samples: &[f64]| samples.iter().map(|s| s * s).sum::<f64>();
        let [near, far] = [NEAR_M, 3.0].map(|metres| impulse_response(metres, 7));
        assert!((energy(&near) - 1.0).abs() < 0.1, "{}", energy(&near));
        let direct_share = |response: &[f64]| energy(&response[..1]) / energy(response);
        assert!(direct_share(&near) > 0.6 && direct_share(&far) < 0.1);
        assert!((energy(&far[1..]) / energy(&near[1..]) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn room_delays_the_tail_only() {
        let echoed = convolved(&[0.0, 1.0], &[1.0, 0.0, 0.5]);
        for (found, expected) in echoed.iter().zip([0.0, 1.0, 0.0, 0.5]) {
            assert!((found - expected).abs() < 1e-12, "{echoed:?}");
        }
    }
}
