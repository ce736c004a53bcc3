//! `people`: what was learned about people.

use std::time::Duration;

use clap::{Args, Subcommand};
use command_line::args::seconds;
use vocabulary::PersonId;

use super::talk::person;

/// Arguments of `people`.
#[derive(Debug, Args)]
pub struct PeopleArgs {
    /// What to do; `list` by default.
    #[command(subcommand)]
    pub what: Option<PeopleVerb>,
}

/// What `people` does.
#[derive(Debug, Subcommand)]
pub enum PeopleVerb {
    /// List the people by name, with their deliveries and errors.
    List,
    /// Print all that was learned, as JSON: about everybody, or about one person.
    Export {
        /// The person's name.
        #[arg(value_name = "NAME", value_parser = person)]
        person: Option<PersonId>,
    },
    /// Forget what was learned about a person; the group must be running.
    ///
    /// The policy's journal continues in a new file without it, and its older files are removed.
    Forget {
        /// The person's name.
        #[arg(value_name = "NAME", value_parser = person)]
        person: PersonId,
        /// Timeout for the confirmation, seconds.
        #[arg(long, value_name = "S", default_value = "10", value_parser = seconds)]
        timeout: Duration,
    },
}
