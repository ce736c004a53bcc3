//! Arguments that another program understands.

use std::ffi::OsString;

use clap::Args;

/// Arguments of `whichone link`, `whichone fleet` and `whichone gateway`.
#[derive(Debug, Args)]
pub struct LinkArgs {
    /// Arguments of the program whichone-link or whichone-gateway.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "ARGUMENT")]
    pub arguments: Vec<OsString>,
}
