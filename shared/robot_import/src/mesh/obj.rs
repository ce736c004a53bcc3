//! Wavefront OBJ.

use nalgebra::Vector3;

/// Returns the vertices.
pub(super) fn vertices(text: &str) -> Vec<Vector3<f64>> {
    text.lines().filter_map(|line| line.trim_start().strip_prefix("v ")).filter_map(three).collect()
}

/// Returns the first three numbers of a line.
pub(super) fn three(line: &str) -> Option<Vector3<f64>> {
    let mut numbers = line.split_whitespace().map(str::parse::<f64>);
    let mut next = || numbers.next()?.ok();
    Some(Vector3::new(next()?, next()?, next()?))
}
