//! Names of the planners.

/// Calls a macro with the module and the name of each planner of `dialogue`, the default first. It
/// is the only list, and is here because configurations are checked without the planners.
#[macro_export]
macro_rules! planners {
    ($declare:ident) => {
        $declare! {
            lookahead "lookahead",
            optimal "optimal",
            information_seeking "information-seeking",
            entropy "entropy",
            sparse_sampling "sparse-sampling",
            no_attribute "no-attribute",
            always_ask "always-ask",
            never_ask "never-ask",
        }
    };
}

macro_rules! names {
    ($($module:ident $name:literal),+ $(,)?) => {
        /// Names of the planners, the default first.
        pub const PLANNERS: [&str; [$($name),+].len()] = [$($name),+];
    };
}

planners!(names);
