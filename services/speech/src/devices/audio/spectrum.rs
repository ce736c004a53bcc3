//! The discrete Fourier transform of a power of two of samples (Cooley and Tukey 1965).

use std::f32::consts::TAU;

/// Real and imaginary part.
pub(super) type Complex = (f32, f32);

/// Transforms of one length.
pub(super) struct Fourier {
    /// `e^(-2 pi i k / len)` for the first half of the `k`.
    turns: Vec<Complex>,
}

impl Fourier {
    /// For `len` samples, a power of two from 2 on.
    pub(super) fn new(len: usize) -> Self {
        let turn = |k: usize| {
            let (sin, cos) = (-TAU * k as f32 / len as f32).sin_cos();
            (cos, sin)
        };
        Self { turns: (0..len / 2).map(turn).collect() }
    }

    /// Samples to spectrum, in place and not normalised. What is longer or shorter than the
    /// transform stays as it is.
    pub(super) fn forward(&self, x: &mut [Complex]) {
        let len = 2 * self.turns.len();
        if x.len() != len {
            return;
        }
        let unused = usize::BITS - len.trailing_zeros();
        for i in 0..len {
            let j = i.reverse_bits() >> unused;
            if i < j {
                x.swap(i, j);
            }
        }
        let mut half = 1;
        while half < len {
            for start in (0..len).step_by(2 * half) {
                for k in 0..half {
                    let turn = self.turns[k * (len / 2 / half)];
                    let (a, b) = (x[start + k], x[start + k + half]);
                    let b = (b.0 * turn.0 - b.1 * turn.1, b.0 * turn.1 + b.1 * turn.0);
                    x[start + k] = (a.0 + b.0, a.1 + b.1);
                    x[start + k + half] = (a.0 - b.0, a.1 - b.1);
                }
            }
            half *= 2;
        }
    }

    /// Spectrum to samples, in place: undoes [`Fourier::forward`].
    pub(super) fn inverse(&self, x: &mut [Complex]) {
        let scale = 1.0 / x.len().max(1) as f32;
        x.iter_mut().for_each(|(_, im)| *im = -*im);
        self.forward(x);
        x.iter_mut().for_each(|(re, im)| (*re, *im) = (*re * scale, -*im * scale));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_is_one_line_and_comes_back() {
        let fourier = Fourier::new(16);
        let wave: Vec<Complex> =
            (0..16).map(|n| ((TAU * 3.0 * n as f32 / 16.0).cos(), 0.0)).collect();
        let mut x = wave.clone();
        fourier.forward(&mut x);
        for (k, (re, im)) in x.iter().enumerate() {
            let line = if k == 3 || k == 13 { 8.0 } else { 0.0 };
            assert!((re - line).abs() < 1e-4 && im.abs() < 1e-4, "{k}: {re} {im}");
        }
        fourier.inverse(&mut x);
        for (a, b) in x.iter().zip(&wave) {
            assert!((a.0 - b.0).abs() < 1e-5 && a.1.abs() < 1e-5);
        }
    }
}
