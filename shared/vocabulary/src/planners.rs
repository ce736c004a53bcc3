//! Names of the planners.

/// Names of the planners of `dialogue`, the default first: what a configuration may name. The registry of `dialogue`
/// holds the same names in the same order, or it does not compile, or a test of it fails.
pub const PLANNERS: [&str; 8] = [
    "lookahead",
    "optimal",
    "information-seeking",
    "entropy",
    "sparse-sampling",
    "no-attribute",
    "always-ask",
    "never-ask",
];
