//! Arguments that another program understands.

use std::ffi::OsString;

use clap::Args;

/// Arguments of the verbs that hand over to a program of their own, such as `whichone link`.
#[derive(Debug, Args)]
pub struct OtherProgramArgs {
    /// Arguments of that program.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "ARGUMENT")]
    pub arguments: Vec<OsString>,
}
