//! Looks on standard input: each line is read, placed in frame `base`, checked and reported.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;
use std::io::BufRead;

use command_line::Outcome;
use command_line::output::Output;
use config::Settings;
use messages::{Change, Detection, Look, Sighting};
use perception::Frame;
use ros::detector::{Detector, Label, Reported};
use serde::Deserialize;
use serde_json::{Value as Json, json};
use service::bus::EncodedWriter;
use service::client::random_number;
use service::clock;
use service::exit::{Exit, Failure};
use service::{Span, Time};

use crate::args::FeedArgs;
use crate::camera::Camera;
use crate::printed::{self, Pixels, Printed};

/// Kinds of problems that are reported, each once.
const REPORTED_MAX: usize = 64;
/// Variances of a box in pixels: its yaw is unknown.
const BOX_VARIANCES: [f64; 4] = [0.0, 0.0, 0.0, PI * PI];

/// One line of `feed`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FeedLine {
    #[serde(default = "script")]
    source: String,
    #[serde(default = "base")]
    frame: String,
    /// Time since the look was taken, seconds.
    #[serde(default)]
    age_s: f64,
    #[serde(default = "yes")]
    whole: bool,
    seen: Vec<FeedObject>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FeedObject {
    #[serde(default)]
    track: String,
    classes: BTreeMap<String, f64>,
    #[serde(default)]
    attributes: BTreeMap<String, BTreeMap<String, f64>>,
    xyz: [f64; 3],
    #[serde(default)]
    yaw: f64,
    /// Variances of x, y, z and yaw.
    #[serde(default)]
    variances: [f64; 4],
}

fn script() -> String {
    "script".to_owned()
}

fn base() -> String {
    "base".to_owned()
}

fn yes() -> bool {
    true
}

/// Reports each line of standard input; a wrong one is reported and skipped, and so are detections that the policy
/// would refuse.
pub(crate) fn feed(
    sightings: &EncodedWriter<Sighting>,
    args: &FeedArgs,
    settings: &Settings,
    out: &mut Output<'_>,
) -> Outcome {
    let feed = Feed::new(args, settings).map_err(|error| Failure::new(Exit::Usage, error))?;
    let send = |it: Sighting| sightings.send(&it).map_err(|error| error.to_string());
    send_lines(std::io::stdin().lock(), feed, send, out)
}

fn send_lines(
    lines: impl BufRead,
    mut feed: Feed<'_>,
    mut send: impl FnMut(Sighting) -> Result<(), String>,
    out: &mut Output<'_>,
) -> Outcome {
    let (mut is_right, mut reported) = (true, BTreeSet::new());
    for (n, line) in lines.split(b'\n').enumerate() {
        let line = line.map_err(|error| Failure::new(Exit::NotReached, error.to_string()))?;
        if line.trim_ascii().is_empty() {
            continue;
        }
        let mut problems = Vec::new();
        let line = std::str::from_utf8(&line).map_err(|error| error.to_string());
        let read = line.and_then(|line| feed.sighting(line, clock::now(), &mut problems));
        let sent = read.and_then(&mut send);
        is_right &= problems.is_empty() && sent.is_ok();
        // A person who walks past is in every look.
        problems.retain(|it| reported.len() < REPORTED_MAX && reported.insert(kind(it)));
        for error in problems.into_iter().chain(sent.err()) {
            out.json(&json!({ "line": n + 1, "error": error }))?;
        }
    }
    Ok(if is_right { Exit::Ok } else { Exit::NotReached })
}

/// A problem without its numbers, which differ from look to look; those of a label, in backticks, are its name.
fn kind(problem: &str) -> String {
    let parts = problem.split('`').enumerate();
    parts
        .flat_map(|(n, part)| part.chars().filter(move |c| n % 2 == 1 || !is_of_number(*c)))
        .collect()
}

fn is_of_number(c: char) -> bool {
    c.is_ascii_digit() || "-.".contains(c)
}

/// The reader of lines, with what they leave out.
#[derive(Clone, Debug)]
pub struct Feed<'a> {
    args: &'a FeedArgs,
    settings: &'a Settings,
    camera: Option<Camera>,
    frame: Frame,
    detector: Detector,
}

impl<'a> Feed<'a> {
    /// Reads the camera's file, if there is one.
    ///
    /// # Errors
    /// The frame is unknown, or the file cannot be read.
    pub fn new(args: &'a FeedArgs, settings: &'a Settings) -> Result<Self, String> {
        let frames = &settings.group.perception.tracker.frames;
        let base = Frame { name: "base".to_owned(), xyz: [0.0; 3], rpy: [0.0; 3] };
        let named = frames.iter().find(|frame| frame.name == args.frame).cloned();
        let frame = named.or_else(|| (args.frame == "base").then_some(base));
        let frame =
            frame.ok_or_else(|| perception::Refusal::Frame(args.frame.clone()).to_string())?;
        let camera = args.camera.as_ref().map(|path| {
            let name = path.display();
            let text = std::fs::read_to_string(path).map_err(|error| format!("{name}: {error}"))?;
            Camera::from_yaml(&text).map_err(|error| format!("{name}: {error}"))
        });
        let label = |(id, object): &(String, String)| Label {
            id: id.clone(),
            object: object.clone(),
            ..Label::default()
        };
        let labels: Vec<Label> = args.classes.iter().map(label).collect();
        let scene = Some(settings.scene.clone());
        let detector = Detector::new(&args.source, &labels, scene, frames);
        Ok(Self { args, settings, camera: camera.transpose()?, frame, detector })
    }

    /// Replaces the camera.
    #[must_use]
    pub fn with(self, camera: Option<Camera>) -> Self {
        Self { camera, ..self }
    }

    /// Reads a line that arrives at `now`. What cannot be used of it is added to `problems`.
    ///
    /// # Errors
    /// Why nothing of it can be used.
    pub fn sighting(
        &mut self,
        line: &str,
        now: Time,
        problems: &mut Vec<String>,
    ) -> Result<Sighting, String> {
        let json: Json = serde_json::from_str(line).map_err(|error| error.to_string())?;
        let mut sighting = match printed::read(&json) {
            Some(printed) => self.of_detector(printed?, now, problems)?,
            None => look(&json, now)?,
        };
        if let Change::Look(look) = &mut sighting.change {
            let frames = &self.settings.group.perception.tracker.frames;
            let checked =
                perception::in_base(frames, &sighting.frame, &look.seen, &self.settings.scene);
            let (_, refusals) = checked.map_err(|refusal| refusal.to_string())?;
            problems.extend(refusals.iter().map(ToString::to_string));
            look.whole &= look.seen.iter().all(Detection::is_sound);
            look.seen.retain(Detection::is_sound);
        }
        Ok(sighting)
    }

    fn of_detector(
        &mut self,
        printed: Vec<Printed>,
        now: Time,
        problems: &mut Vec<String>,
    ) -> Result<Sighting, String> {
        let at_ns = before(now, self.args.age.as_secs_f64());
        let (mut posed, mut seen, mut is_whole) = (Vec::new(), Vec::new(), true);
        for one in printed {
            match one {
                Printed::Posed(unnamed) if unnamed.hypotheses.is_empty() => {
                    problems
                        .push("a detection without a class; help: `results` with one".to_owned());
                    is_whole = false;
                }
                Printed::Posed(mut posed_one) => {
                    if posed_one.frame.is_empty() {
                        posed_one.frame.clone_from(&self.frame.name);
                    }
                    posed.push(self.known_tag(posed_one));
                }
                Printed::Pixels(pixels) => match self.placed(pixels) {
                    Ok(detection) => seen.push(detection),
                    // It may be an object of the table, which this look would miss.
                    Err(problem) => {
                        problems.push(problem);
                        is_whole = false;
                    }
                },
            }
        }
        let mut sighting = self.detector.look(random_number(), at_ns, &posed);
        problems.extend(self.detector.take_unused().iter().map(ToString::to_string));
        if let Change::Look(look) = &mut sighting.change {
            look.whole &= is_whole;
            look.seen.extend(seen);
        }
        Ok(sighting)
    }

    /// A tag may be named without its family.
    fn known_tag(&self, mut posed: Reported) -> Reported {
        for hypothesis in &mut posed.hypotheses {
            let number = hypothesis.id.rsplit(':').next().unwrap_or_default();
            if !self.detector.knows(&hypothesis.id) && self.detector.knows(number) {
                hypothesis.id = number.to_owned();
            }
        }
        posed
    }

    fn placed(&self, Pixels { labels, track, center, depth }: Pixels) -> Result<Detection, String> {
        let camera =
            self.camera.ok_or("a box in pixels; help: --camera FILE, the camera_info of ROS")?;
        let xyz = match (depth, self.args.height) {
            (Some(depth), _) if depth > 0.0 && depth.is_finite() => {
                camera.at_depth(&self.frame, center, depth)
            }
            // Depth cameras state 0 for what they cannot measure.
            (Some(depth), _) => return Err(format!("expected a `depth` above 0 m, found {depth}")),
            (None, Some(z)) => camera.at_height(&self.frame, center, z).ok_or_else(|| {
                format!(
                    "pixel {center:?} does not show the height {z} m; help: see --height, --frame"
                )
            })?,
            (None, None) => {
                return Err(
                    "a box without `depth`; help: add it, metres, or use --height Z".to_owned()
                );
            }
        };
        let label = |(id, score): (String, f64)| {
            let known = self.args.classes.iter().find(|(known, _)| *known == id);
            (known.map_or(id, |(_, label)| label.clone()), score)
        };
        let classes = labels.into_iter().map(label).collect();
        Ok(Detection { track, classes, xyz, variances: BOX_VARIANCES, ..Detection::default() })
    }
}

/// Time of a look of an age in seconds, nanoseconds; not 0, which stands for now.
fn before(now: Time, age_s: f64) -> u64 {
    (now - Span::from_s(age_s)).ns().max(1)
}

fn look(line: &Json, now: Time) -> Result<Sighting, String> {
    let line = FeedLine::deserialize(line).map_err(|error| error.to_string())?;
    let seen = line.seen.into_iter().map(|it| Detection {
        track: it.track,
        classes: it.classes.into_iter().collect(),
        attributes: (it.attributes.into_iter())
            .map(|(name, values)| (name, values.into_iter().collect()))
            .collect(),
        xyz: it.xyz,
        yaw: it.yaw,
        variances: it.variances,
    });
    let at_ns = before(now, line.age_s);
    let look = Look { at_ns, whole: line.whole, seen: seen.collect() };
    let (source, frame) = (line.source, line.frame);
    Ok(Sighting { key: random_number(), source, frame, change: Change::Look(look) })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests;
