//! STL, binary and ASCII.

use nalgebra::Vector3;

/// Bytes before the triangles, and of each triangle.
const HEAD: usize = 84;
const TRIANGLE: usize = 50;

/// Returns the corners of the triangles.
///
/// # Errors
/// The file is cut short.
pub(super) fn vertices(bytes: &[u8]) -> Result<Vec<Vector3<f64>>, String> {
    // Binary files may begin with the word "solid" as well: their length tells.
    let count = bytes
        .get(80..HEAD)
        .map(|count| u32::from_le_bytes([count[0], count[1], count[2], count[3]]));
    let length = count.map(|count| HEAD + count as usize * TRIANGLE);
    if length.is_some_and(|length| bytes.len() >= length && bytes.len() - length < TRIANGLE) {
        return Ok(binary(&bytes[HEAD..]));
    }
    let text = String::from_utf8_lossy(bytes);
    if text.trim_start().starts_with("solid") {
        return Ok(ascii(&text));
    }
    let expected = length.unwrap_or(HEAD);
    Err(format!("expected {expected} bytes of a binary STL, found {}", bytes.len()))
}

fn binary(triangles: &[u8]) -> Vec<Vector3<f64>> {
    let number =
        |bytes: &[u8]| f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
    let corners = triangles.chunks_exact(TRIANGLE).flat_map(|triangle| {
        // The normal comes first.
        triangle[12..48]
            .chunks_exact(12)
            .map(|at| Vector3::new(number(&at[..4]), number(&at[4..8]), number(&at[8..])))
    });
    corners.collect()
}

fn ascii(text: &str) -> Vec<Vector3<f64>> {
    let lines = text.lines().filter_map(|line| line.trim_start().strip_prefix("vertex"));
    lines.filter_map(super::obj::three).collect()
}
