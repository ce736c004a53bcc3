//! The robot in its local network: the service `_whichone._tcp.local.` of DNS-SD (RFC 6763) over multicast DNS
//! (RFC 6762).
//!
//! Programs find the console's interface by it, without an address (docs/http.md). What is announced is known to
//! everyone in that network, and anyone there can announce the same: it proves nothing.

mod records;
mod responder;

use std::fmt;
use std::io;
use std::net::SocketAddr;

use mdns_sd::ServiceInfo;
use serde::Serialize;

use crate::records::Records;
use crate::responder::Shared;

/// Type of the service.
pub const SERVICE: &str = "_whichone._tcp.local.";

/// Identity of a robot, as `/api/v1/info` states it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Identity {
    /// Version of the interface.
    pub api: u64,
    /// Letters, digits, `-` and `_`; no other robot has it, and a restart keeps it.
    pub id: String,
    /// Name of the group.
    pub name: String,
    /// Version of the program.
    pub version: &'static str,
}

/// Why a robot is not announced.
#[derive(Debug, thiserror::Error)]
pub enum Unannounced {
    /// No other machine reaches the listener.
    #[error(
        "the console listens at {}; help: set console.listen = \"0.0.0.0:{}\", or console.discovery = false",
        .0.ip(), .0.port()
    )]
    Loopback(SocketAddr),
    /// The records are not those of a service.
    #[error(transparent)]
    Records(#[from] mdns_sd::Error),
    /// The responder's thread has not started.
    #[error(transparent)]
    Thread(#[from] io::Error),
}

/// A robot that is announced, until this is dropped.
///
/// It follows the addresses of the machine. If another robot has the name, a number is appended. A responder that does
/// not start, or fails, is started again.
pub struct Announcement(Shared);

impl fmt::Debug for Announcement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Announcement").finish_non_exhaustive()
    }
}

impl Announcement {
    /// Announces a robot whose interface is at `path` of a plain HTTP server that listens at this address, in the
    /// networks that reach it.
    ///
    /// # Errors
    /// No other machine reaches the address, the records are invalid, or a thread does not start.
    pub fn begin(robot: &Identity, listening: SocketAddr, path: &str) -> Result<Self, Unannounced> {
        let networks = records::networks(listening.ip());
        let networks = networks.ok_or(Unannounced::Loopback(listening))?;
        let service: ServiceInfo = records::service(robot, listening.port(), path, &networks)?;
        Ok(Self(Shared::start(Records { service, networks })?))
    }
}

impl Drop for Announcement {
    fn drop(&mut self) {
        self.0.end();
    }
}

#[cfg(test)]
mod tests;
