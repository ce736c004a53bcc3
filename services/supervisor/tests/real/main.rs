//! The supervisor with real processes: each fault has a fixture, each protection a test.

mod end;
mod faults;
mod harness;
mod launch;
mod operator;
mod orphans;
mod start;
mod swap;
