//! Random durations.

use dialogue::Rng;

/// Uniform between two numbers.
pub fn between(rng: &mut Rng, (low, high): (f64, f64)) -> f64 {
    low + (high - low) * rng.uniform()
}

/// Log-normal with that median and standard deviation of the logarithm (Box and Muller 1958).
pub fn log_normal(rng: &mut Rng, median: f64, log_sd: f64) -> f64 {
    // In (0, 1], so that the logarithm is finite.
    let radius = (-2.0 * (1.0 - rng.uniform()).ln()).sqrt();
    let normal = radius * (std::f64::consts::TAU * rng.uniform()).cos();
    median * (log_sd * normal).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn log_normal_numbers_have_their_moments() {
        let seed = 11;
        let mut rng = Rng::new(seed);
        let logs: Vec<f64> = (0..20_000).map(|_| log_normal(&mut rng, 0.9, 0.55).ln()).collect();
        let mean = logs.iter().sum::<f64>() / 20_000.0;
        let variance = logs.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 20_000.0;
        assert!((mean - 0.9_f64.ln()).abs() < 0.02, "seed {seed}: {mean}");
        assert!((variance.sqrt() - 0.55).abs() < 0.02, "seed {seed}: {variance}");
    }
}
