//! Requests of the scene editor, carried out one after the other.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use axum::http::StatusCode;
use diagnostics::{Diagnostics, TextFile};
use scene_editing::{
    Configuration, Document, FileError, Findings, ObjectEntry, Problem, Reach, ReadBack,
    RobotSummary, SceneEdit, ScenesFolder, check, fingerprint, new_scene, schema_line,
};
use serde::{Deserialize, Serialize};
use service::control::{CallError, Reply, Request, call};

/// Timeout of the supervisor's answer.
const PATIENCE: Duration = Duration::from_secs(5);
/// Time of one answer about the reach: the page requests the rest.
const REACH: Duration = Duration::from_millis(700);
/// Most places of one request about the reach.
const PLACES_MAX: usize = 256;

/// Most objects, and values of all attributes, in the editor: checks of more take seconds.
const OBJECTS_MAX: usize = 1_024;
const VALUES_MAX: usize = 4_096;

/// A request that is not carried out.
#[derive(Debug, Serialize)]
pub(super) struct Refusal {
    #[serde(skip)]
    pub(super) status: StatusCode,
    error: String,
    /// Every problem, if a file is wrong.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    problems: Vec<Problem>,
    /// Further lines.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    details: Vec<String>,
}

impl Refusal {
    pub(super) fn new(status: StatusCode, error: impl Into<String>) -> Self {
        Self { status, error: error.into(), problems: Vec::new(), details: Vec::new() }
    }

    fn wrong(problems: Vec<Problem>) -> Self {
        let error = format!("the scene has {}", scene::count(problems.len(), "problem"));
        Self { problems, ..Self::new(StatusCode::UNPROCESSABLE_ENTITY, error) }
    }
}

impl From<Diagnostics> for Refusal {
    fn from(found: Diagnostics) -> Self {
        Self::wrong(found.iter().map(Problem::from).collect())
    }
}

impl From<FileError> for Refusal {
    fn from(error: FileError) -> Self {
        let status = match &error {
            FileError::Name(_) => StatusCode::BAD_REQUEST,
            FileError::Missing(..) => StatusCode::NOT_FOUND,
            FileError::Exists(_) | FileError::Changed(_) | FileError::Kind(_) => {
                StatusCode::CONFLICT
            }
            FileError::Io(..) => StatusCode::INTERNAL_SERVER_ERROR,
        };
        Self::new(status, error.to_string())
    }
}

/// The scenes of the configuration.
#[derive(Debug, Serialize)]
pub(super) struct Listed {
    folder: PathBuf,
    names: Vec<String>,
    /// The scene in force, as the configuration names it.
    in_force: String,
    /// Fingerprint of its text: that of a saved file if nothing has changed since.
    in_force_hash: String,
    /// Why scenes are not saved or put into force here.
    locked: Option<String>,
}

/// A scene for the editor.
#[derive(Debug, Serialize)]
pub(super) struct Opened {
    /// `None` for a new scene.
    name: Option<String>,
    text: String,
    /// `None` for a new scene.
    hash: Option<String>,
    document: Document,
    robot: RobotSummary,
}

/// A changed document with the text that it was read from.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Draft {
    text: String,
    document: Document,
}

/// A draft to be saved.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Saving {
    text: String,
    document: Document,
    /// The hash of the replaced file; `None` for a new one.
    known: Option<String>,
    /// True to save it although it has problems.
    #[serde(default)]
    draft: bool,
}

/// A saved scene.
#[derive(Debug, Serialize)]
pub(super) struct Saved {
    name: String,
    text: String,
    hash: String,
    document: Document,
    #[serde(flatten)]
    findings: Findings,
}

/// A question about the places where a lone object can be fetched.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Places {
    object: ObjectEntry,
    /// Centres of the object, metres: x and y.
    at: Vec<[f64; 2]>,
}

/// The limb for each of the first places, as far as the time was enough.
#[derive(Debug, Serialize)]
pub(super) struct Reached {
    limbs: Vec<Option<String>>,
    /// Why the first place without a limb has none.
    why: Option<String>,
}

/// A scene that is put into force.
#[derive(Debug, Serialize)]
pub(super) struct Used {
    restarted: Vec<String>,
}

/// Resources of the requests.
#[derive(Debug)]
pub struct Desk {
    /// The supervisor's.
    socket: PathBuf,
    in_force_hash: String,
    locked: Option<String>,
    read_back: ReadBack,
    reach: Option<Reach>,
}

impl Desk {
    /// Makes the desk of a group: its control socket, the scene in force, the reason for any lock, and the reader of
    /// its scenes' words.
    pub fn new(
        socket: PathBuf,
        in_force: String,
        locked: Option<String>,
        read_back: ReadBack,
    ) -> Self {
        Self { socket, in_force_hash: fingerprint(&in_force), locked, read_back, reach: None }
    }

    pub(super) fn list(&mut self) -> Result<Listed, Refusal> {
        let (configuration, in_force) = self.configuration()?;
        let folder = ScenesFolder::of(&configuration.folder);
        Ok(Listed {
            names: folder.names()?,
            folder: folder.path().to_owned(),
            in_force,
            in_force_hash: self.in_force_hash.clone(),
            locked: self.locked.clone(),
        })
    }

    pub(super) fn open(&mut self, name: &str) -> Result<Opened, Refusal> {
        let (configuration, _) = self.configuration()?;
        let TextFile { label, text } = ScenesFolder::of(&configuration.folder).read(name)?;
        let document = SceneEdit::parse(&label, &text)?.document()?;
        let robot = self.reach_in(&configuration, true)?.robot();
        let hash = Some(fingerprint(&text));
        Ok(Opened { name: Some(name.to_owned()), text, hash, document, robot })
    }

    /// A new scene: two attributes to begin with, and no object.
    pub(super) fn new_scene(&mut self) -> Result<Opened, Refusal> {
        let (configuration, _) = self.configuration()?;
        let folder = ScenesFolder::of(&configuration.folder);
        let path = folder.path().join("new.toml");
        let text = new_scene("new", &schema_line(&path, &configuration.folder));
        let mut edit = SceneEdit::parse("new.toml", &text)?;
        let mut document = edit.document()?;
        document.objects.clear();
        edit.apply(&document)?;
        let robot = self.reach_in(&configuration, true)?.robot();
        Ok(Opened { name: None, text: edit.text(), hash: None, document, robot })
    }

    pub(super) fn check(&mut self, draft: &Draft) -> Result<Findings, Refusal> {
        let (configuration, _) = self.configuration()?;
        let Draft { text, document } = draft;
        let text = applied("scene.toml", text, document)?;
        Ok(check(&configuration, TextFile::new("scene.toml", text), self.read_back))
    }

    pub(super) fn save(&mut self, name: &str, saving: &Saving) -> Result<Saved, Refusal> {
        self.must_be_unlocked()?;
        let (configuration, in_force) = self.configuration()?;
        let folder = ScenesFolder::of(&configuration.folder);
        let label = folder.file(name)?.display().to_string();
        let text = applied(&label, &saving.text, &saving.document)?;
        let findings =
            check(&configuration, TextFile::new(label.clone(), text.clone()), self.read_back);
        let must_be_right = !saving.draft || name == in_force;
        if must_be_right && !findings.problems.is_empty() {
            return Err(Refusal::wrong(findings.problems));
        }
        folder.write(name, &text, saving.known.as_deref())?;
        tracing::info!(name, "scene saved");
        let document = SceneEdit::parse(&label, &text)?.document()?;
        let hash = fingerprint(&text);
        Ok(Saved { name: name.to_owned(), text, hash, document, findings })
    }

    pub(super) fn reach(&mut self, places: &Places) -> Result<Reached, Refusal> {
        let bad = |what: &str| Refusal::new(StatusCode::BAD_REQUEST, what);
        if !(1..=PLACES_MAX).contains(&places.at.len()) {
            let found = places.at.len();
            return Err(bad(&format!("at: expected 1 to {PLACES_MAX} places, found {found}")));
        }
        let (configuration, _) = self.configuration()?;
        let reach = self.reach_in(&configuration, false)?;
        let found = reach.limbs(&places.object, &places.at, Instant::now() + REACH);
        let what =
            "object: expected xyz within 5 m, size and grasp_width above 0 m and at most 2 m";
        let found = found.ok_or_else(|| bad(what))?;
        let why = found.iter().find_map(|limb| limb.as_ref().err().cloned());
        Ok(Reached { limbs: found.into_iter().map(Result::ok).collect(), why })
    }

    /// Puts a saved scene into force.
    pub(super) fn use_scene(&mut self, name: &str) -> Result<Used, Refusal> {
        self.must_be_unlocked()?;
        let (configuration, _) = self.configuration()?;
        ScenesFolder::of(&configuration.folder).read(name)?;
        // The console is restarted by it, too: the answer must come first.
        let request = Request::UseScene { scene: name.to_owned(), wait_ms: 0 };
        match call(&self.socket, &request, PATIENCE) {
            Ok(Reply::Reloaded { restarted }) => Ok(Used { restarted }),
            Ok(other) => Err(unreachable(&format!("unexpected answer {other:?}"))),
            Err(CallError::Refused(refusal)) => Err(Refusal {
                details: refusal.details,
                ..Refusal::new(StatusCode::UNPROCESSABLE_ENTITY, refusal.message)
            }),
            Err(error) => Err(unreachable(&error.to_string())),
        }
    }

    fn must_be_unlocked(&self) -> Result<(), Refusal> {
        let locked = self.locked.as_ref();
        locked.map_or(Ok(()), |why| Err(Refusal::new(StatusCode::FORBIDDEN, why)))
    }

    /// The configuration in force, and the scene that it names.
    fn configuration(&self) -> Result<(Configuration, String), Refusal> {
        let status = match call(&self.socket, &Request::Status, PATIENCE) {
            Ok(Reply::Status(status)) => status,
            Ok(other) => return Err(unreachable(&format!("unexpected answer {other:?}"))),
            Err(error) => return Err(unreachable(&error.to_string())),
        };
        let Some(set) = status.set else {
            let what = "the scene is that of another machine; help: open the console of the robot";
            return Err(Refusal::new(StatusCode::FORBIDDEN, what));
        };
        let folder = std::path::absolute(&status.config).unwrap_or(status.config);
        Ok((Configuration { folder, profile: status.profile, set }, status.scene))
    }

    /// The arm of a configuration, read again if it is another one or `is_fresh`.
    fn reach_in(
        &mut self,
        configuration: &Configuration,
        is_fresh: bool,
    ) -> Result<&Reach, Refusal> {
        let kept = self.reach.take().filter(|reach| !is_fresh && reach.is_of(configuration));
        let reach = match kept {
            Some(reach) => reach,
            None => Reach::new(configuration)?,
        };
        Ok(self.reach.insert(reach))
    }
}

/// The text of a document.
fn applied(label: &str, text: &str, document: &Document) -> Result<String, Refusal> {
    let values = document.attributes.iter().map(|attribute| attribute.values.len()).sum();
    for (what, found, most) in
        [("objects", document.objects.len(), OBJECTS_MAX), ("values", values, VALUES_MAX)]
    {
        if found > most {
            let help = "help: edit the file, and use `whichone scene check`";
            let what =
                format!("expected at most {most} {what} in the editor, found {found}; {help}");
            return Err(Refusal::new(StatusCode::UNPROCESSABLE_ENTITY, what));
        }
    }
    let mut edit = SceneEdit::parse(label, text)?;
    edit.apply(document)?;
    Ok(edit.text())
}

fn unreachable(why: &str) -> Refusal {
    Refusal::new(StatusCode::SERVICE_UNAVAILABLE, format!("the supervisor: {why}"))
}

#[cfg(test)]
mod tests;
