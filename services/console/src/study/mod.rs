//! Studies with people, run from the console.
//!
//! [`Study`] lives on the main thread: it is given the `do` verbs that begin with `study.`
//! ([`Study::verb`]), everything that happens in the picture ([`Study::event`]), and a moment in every
//! pass ([`Study::pass`]). What it shows is the section `study` ([`Study::section`]); what it serves
//! over HTTP are [`routes`] below `/study/`.

use std::sync::Arc;

use axum::Router;
use serde_json::Value as Json;
use settings::Settings;

use crate::hub::ViewerId;
use crate::hub::command::Verb;
use crate::picture::{Now, Picture, PictureEvent};
use crate::server::App;

/// The study, where there is one.
#[derive(Debug, Default)]
pub struct Study {}

impl Study {
    /// Reads the settings.
    pub fn new(_settings: &Settings) -> Self {
        Self {}
    }

    /// Whether pages may begin a study.
    pub fn is_offered(&self) -> bool {
        false
    }

    /// Does what a page asks for; its answer's fields.
    ///
    /// # Errors
    /// Why not, in a sentence with the cure.
    pub fn verb(
        &mut self,
        _viewer: ViewerId,
        verb: &str,
        _arguments: &Json,
        _picture: &Picture,
        _now: Now,
    ) -> Result<Json, String> {
        Err(format!("there is no study.{verb}"))
    }

    /// Something has happened.
    pub fn event(&mut self, _event: &PictureEvent, _picture: &Picture, _now: Now) {}

    /// Time has passed: what the study wants the dialogue to do, as a viewer would.
    pub fn pass(&mut self, _picture: &Picture, _now: Now) -> Vec<Verb> {
        Vec::new()
    }

    /// The section `study`; none while it is as it was.
    pub fn section(&mut self, _now: Now) -> Option<Json> {
        None
    }
}

/// What the study serves over HTTP.
pub fn routes() -> Router<Arc<App>> {
    Router::new()
}
