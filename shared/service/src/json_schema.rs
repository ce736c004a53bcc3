//! Version of the JSON that the programs print with `--json`.
//!
//! Fields are added under the same number; one that changes its meaning or goes has a new number (docs/stability.md).

/// The number of this version.
pub const SCHEMA: u32 = 1;

/// Returns the text of a JSON object with the first key `schema`. Other values, as the lines of batch tools that take
/// the format of their input, are returned as they are.
pub fn with_schema(json: &str) -> String {
    match json.strip_prefix('{').map(str::trim_start) {
        Some("}") => format!("{{\"schema\":{SCHEMA}}}"),
        Some(rest) => format!("{{\"schema\":{SCHEMA},{rest}"),
        None => json.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_alone_get_a_schema() {
        assert_eq!(with_schema("{\"a\":{}}"), "{\"schema\":1,\"a\":{}}");
        assert_eq!(with_schema("{ }"), "{\"schema\":1}");
        assert_eq!(with_schema("[{}]"), "[{}]");
        assert_eq!(with_schema("\"{}\""), "\"{}\"");
    }
}
