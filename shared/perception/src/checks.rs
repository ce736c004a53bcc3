//! Checks of reports: numbers, frames, places within reach, and names of the scene file.

use scene::Scene;

use crate::{Detection, Frame, Refusal, labels};

/// Detections in one look that are used.
const SEEN_MAX: usize = 256;
/// Distance from the robot's base beyond which no arm reaches, metres.
const REACH_MAX_M: f64 = 4.0;

/// Converts the detections of a report to frame `base` and to names of the scene file. Returns also
/// why others cannot be used.
///
/// # Errors
/// Why none can be used.
pub fn in_base(
    frames: &[Frame],
    frame: &str,
    seen: &[Detection],
    file: &Scene,
) -> Result<(Vec<Detection>, Vec<Refusal>), Refusal> {
    let known = frame_named(frames, frame)?;
    let (mut used, mut refusals) = (Vec::new(), Vec::new());
    for detection in seen.iter().take(SEEN_MAX) {
        match placed(known, detection).and_then(|it| labels::read(it, file)) {
            Ok(detection) => used.push(detection),
            Err(refusal) => refusals.push(refusal),
        }
    }
    Ok((used, refusals))
}

/// The frame of that name; `None` for `base`.
pub(crate) fn frame_named<'a>(of: &'a [Frame], name: &str) -> Result<Option<&'a Frame>, Refusal> {
    let known = of.iter().find(|known| known.name == name);
    let is_known = name == "base" || known.is_some();
    is_known.then_some(known).ok_or_else(|| Refusal::Frame(name.to_owned()))
}

/// Converts one detection to frame `base`, but for its labels.
pub(crate) fn placed(frame: Option<&Frame>, one: &Detection) -> Result<Detection, Refusal> {
    let mut placed = Some(one).filter(|it| it.is_sound()).cloned().ok_or(Refusal::Number)?;
    if let Some(frame) = frame {
        (placed.xyz, placed.yaw) = frame.to_base(placed.xyz, placed.yaw);
    }
    check_reach(placed.xyz).map(|()| placed)
}

/// Checks that an arm may reach a place in frame `base`.
fn check_reach(xyz: [f64; 3]) -> Result<(), Refusal> {
    let far = xyz.iter().map(|x| x * x).sum::<f64>().sqrt();
    if far <= REACH_MAX_M {
        return Ok(());
    }
    // The unit in which the object would be on a table in front of the robot.
    let units = [("millimetres", 1_000.0), ("centimetres", 100.0)];
    let on_table = |(_, per_metre): &(&str, f64)| (0.1..REACH_MAX_M).contains(&(far / per_metre));
    let unit = units.into_iter().find(on_table).map(|(unit, _)| unit);
    Err(Refusal::Far(xyz.map(|x| x.to_string()).join(" "), unit.unwrap_or("another frame")))
}

/// Checks that the scene file has the attributes and values. Others, from cameras, do not count.
pub(crate) fn check_values(detection: &Detection, file: &Scene) -> Result<(), Refusal> {
    for (name, values) in &detection.attributes {
        let Some(k) = file.attribute_named(name) else {
            let known = listed(file.attributes().iter().map(|attribute| attribute.name.as_str()));
            return Err(Refusal::NoAttribute(name.clone(), known));
        };
        if let Some((value, _)) = values.iter().find(|(v, _)| file.value_named(k, v).is_none()) {
            let known = file.attributes()[k.index()].values.iter().map(|value| value.name.as_str());
            return Err(Refusal::NoValue(name.clone(), value.clone(), listed(known)));
        }
    }
    Ok(())
}

fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.collect::<Vec<_>>().join(", ")
}
