//! Noise whose power falls by 3 dB an octave, as that of most rooms does.

use std::f64::consts::TAU;

/// So many samples of pink noise of power 1, the same for the same seed. Every frequency gets a
/// random amplitude and phase, divided by the root of the frequency.
pub(super) fn pink(len: usize, seed: u64) -> Vec<f64> {
    let size = len.next_power_of_two();
    let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
    let mut spectrum = vec![(0.0, 0.0); size];
    for k in 1..size / 2 {
        let amplitude = 1.0 / (k as f64).sqrt();
        let (re, im) = random.normals();
        spectrum[k] = (re * amplitude, im * amplitude);
        spectrum[size - k] = (re * amplitude, -im * amplitude);
    }
    fourier(&mut spectrum);
    let noise: Vec<f64> = spectrum.into_iter().take(len).map(|(re, _)| re).collect();
    let power = noise.iter().map(|x| x * x).sum::<f64>() / len as f64;
    noise.into_iter().map(|x| x / power.sqrt()).collect()
}

/// The discrete Fourier transform of a power of two of complex numbers, not normalised.
fn fourier(x: &mut [(f64, f64)]) {
    let n = x.len();
    if n < 2 {
        return;
    }
    let bits = n.trailing_zeros();
    for i in 0..n {
        let j = i.reverse_bits() >> (usize::BITS - bits);
        if i < j {
            x.swap(i, j);
        }
    }
    let mut half = 1;
    while half < n {
        for start in (0..n).step_by(2 * half) {
            for k in 0..half {
                let (sin, cos) = (-TAU * k as f64 / (2 * half) as f64).sin_cos();
                let (a, b) = (x[start + k], x[start + k + half]);
                let t = (b.0 * cos - b.1 * sin, b.0 * sin + b.1 * cos);
                x[start + k] = (a.0 + t.0, a.1 + t.1);
                x[start + k + half] = (a.0 - t.0, a.1 - t.1);
            }
        }
        half *= 2;
    }
}

/// A small generator (xorshift).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Two normal numbers (Box and Muller).
    fn normals(&mut self) -> (f64, f64) {
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        let (sin, cos) = (TAU * self.unit()).sin_cos();
        (radius * cos, radius * sin)
    }
}
