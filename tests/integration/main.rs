//! The real supervisor and processes, driven through the command line. Every test has a group of its
//! own, so that tests run in parallel.

#![allow(clippy::unwrap_used, reason = "a test without a value fails")]

mod absence;
mod batch;
mod camera;
mod config;
mod conform;
mod console;
mod console_access;
mod console_study;
mod console_voice;
mod dashboard;
mod dialogues;
mod documents;
mod export;
mod fair_share;
mod forged;
mod full_log;
mod full_memory;
mod gateway;
mod hearing;
mod installed;
mod interrupted;
mod isolation;
mod journal_format;
mod journal_loss;
mod journals;
mod link;
mod live;
mod metrics;
mod model;
mod own_voice;
mod perception;
mod physics;
mod planners;
mod pointing;
mod put_back;
mod python;
mod recording;
mod recovery;
mod reload;
mod replay;
mod robot;
mod ros1;
mod ros2;
mod sdk;
mod sdk_bindings;
mod second_user;
mod shortage;
mod speech;
mod spoken;
mod supervision;
mod swap;
mod unusual_users;
mod user_model;
