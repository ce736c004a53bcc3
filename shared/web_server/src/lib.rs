//! Common parts of the web servers of console and gateway: connections that are bounded in number and time,
//! where a request comes from, sessions of browsers, logins, files that are followed, an audit, and headers that forbid foreign scripts. Their limits, and who
//! is let in, are the servers' own.

pub mod audit;
pub mod connections;
pub mod followed;
pub mod login;
pub mod request;
pub mod security;
pub mod sessions;
