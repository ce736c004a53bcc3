//! What detectors print, as objects in an image or in a frame: one reader for each form.
//!
//! | printed by | recognised by |
//! |---|---|
//! | Ultralytics, `results[0].to_json()` | a list with `box` of `x1` … `y2` |
//! | COCO results | a list with `bbox` and `category_id` |
//! | Transformers, zero-shot pipeline (OWL-ViT, GroundingDINO) | a list with `box` of `xmin` … `ymax` |
//! | Transformers, `post_process_…` (OWL-ViT, GroundingDINO) | `boxes` with `scores` and `labels` |
//! | `vision_msgs`, `Detection2DArray` or `Detection3DArray` as JSON | `detections` |
//! | `pupil_apriltags` and `dt_apriltags` | a list with `tag_id` and `pose_t` |

use ros::detector::{Hypothesis, Pose, Reported};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value as Json;

/// An object that a detector printed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Printed {
    /// In an image.
    Pixels(Pixels),
    /// With a pose.
    Posed(Reported),
}

/// An object in an image.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Pixels {
    /// Labels or ids with scores.
    pub(crate) labels: Vec<(String, f64)>,
    /// The detector's own identifier of the object; empty if it has none.
    pub(crate) track: String,
    /// Centre of its box, pixels.
    pub(crate) center: [f64; 2],
    /// Distance along the optical axis, metres, if a program has added it as `depth`.
    pub(crate) depth: Option<f64>,
}

/// Reads a line; `None` if no detector prints that.
///
/// # Errors
/// A key is missing or of another type, or boxes are not in pixels.
pub(crate) fn read(line: &Json) -> Option<Result<Vec<Printed>, String>> {
    form(line).map(|printed| printed.and_then(in_pixels))
}

/// Refuses boxes that are fractions of the image.
fn in_pixels(printed: Vec<Printed>) -> Result<Vec<Printed>, String> {
    let mut centers = printed.iter().filter_map(|one| match one {
        Printed::Pixels(pixels) => Some(pixels.center),
        Printed::Posed(_) => None,
    });
    let is_fraction = |[x, y]: [f64; 2]| x <= 1.0 && y <= 1.0;
    if centers.next().is_some_and(is_fraction) && centers.all(is_fraction) {
        return Err("boxes: pixels expected, found fractions; help: multiply by the image's size"
            .to_owned());
    }
    Ok(printed)
}

fn form(line: &Json) -> Option<Result<Vec<Printed>, String>> {
    let first = line.as_array().map(|list| list.first().unwrap_or(&Json::Null));
    let has = |of: &Json, key: &str| of.get(key).is_some();
    match first {
        Some(Json::Null) if line.as_array().is_some_and(Vec::is_empty) => Some(Ok(Vec::new())),
        Some(first) if has(first, "tag_id") => Some(each(line, tag)),
        Some(first) if has(first, "category_id") => Some(each(line, coco)),
        Some(first) if first["box"].get("xmin").is_some() => Some(each(line, zero_shot)),
        Some(first) if has(first, "box") => Some(each(line, ultralytics)),
        Some(_) => None,
        None if has(line, "boxes") => Some(post_processed(line)),
        None if has(line, "detections") => Some(vision_msgs(line)),
        None => None,
    }
}

fn parse<T: DeserializeOwned>(json: &Json) -> Result<T, String> {
    T::deserialize(json).map_err(|error| error.to_string())
}

fn each<T: DeserializeOwned>(list: &Json, of: fn(T) -> Printed) -> Result<Vec<Printed>, String> {
    Ok(parse::<Vec<T>>(list)?.into_iter().map(of).collect())
}

/// A text, or a number as one.
fn text(json: &Json) -> String {
    json.as_str().map_or_else(|| json.to_string(), str::to_owned)
}

#[derive(Deserialize)]
struct Ultralytics {
    name: String,
    confidence: f64,
    #[serde(rename = "box")]
    corners: Corners,
    track_id: Option<u64>,
    depth: Option<f64>,
}

#[derive(Deserialize)]
struct Corners {
    #[serde(alias = "xmin")]
    x1: f64,
    #[serde(alias = "ymin")]
    y1: f64,
    #[serde(alias = "xmax")]
    x2: f64,
    #[serde(alias = "ymax")]
    y2: f64,
}

impl Corners {
    fn center(&self) -> [f64; 2] {
        [(self.x1 + self.x2) / 2.0, (self.y1 + self.y2) / 2.0]
    }
}

fn ultralytics(it: Ultralytics) -> Printed {
    Printed::Pixels(Pixels {
        labels: vec![(it.name, it.confidence)],
        track: it.track_id.map_or_else(String::new, |id| id.to_string()),
        center: it.corners.center(),
        depth: it.depth,
    })
}

#[derive(Deserialize)]
struct Coco {
    category_id: Json,
    bbox: [f64; 4],
    score: f64,
    depth: Option<f64>,
}

fn coco(it: Coco) -> Printed {
    let [x, y, width, height] = it.bbox;
    let center = [x + width / 2.0, y + height / 2.0];
    let labels = vec![(text(&it.category_id), it.score)];
    Printed::Pixels(Pixels { labels, center, depth: it.depth, ..Pixels::default() })
}

#[derive(Deserialize)]
struct ZeroShot {
    label: String,
    score: f64,
    #[serde(rename = "box")]
    corners: Corners,
    depth: Option<f64>,
}

fn zero_shot(it: ZeroShot) -> Printed {
    let (labels, center) = (vec![(it.label, it.score)], it.corners.center());
    Printed::Pixels(Pixels { labels, center, depth: it.depth, ..Pixels::default() })
}

#[derive(Deserialize)]
struct PostProcessed {
    boxes: Vec<[f64; 4]>,
    scores: Vec<f64>,
    labels: Vec<Json>,
    text_labels: Option<Vec<Json>>,
    depths: Option<Vec<f64>>,
}

fn post_processed(line: &Json) -> Result<Vec<Printed>, String> {
    let PostProcessed { boxes, scores, labels, text_labels, depths } = parse(line)?;
    let labels = text_labels.unwrap_or(labels);
    let counts =
        [boxes.len(), scores.len(), labels.len(), depths.as_ref().map_or(boxes.len(), Vec::len)];
    if counts != [boxes.len(); 4] {
        return Err(format!("boxes, scores, labels and depths of different lengths: {counts:?}"));
    }
    let one = |(n, [x1, y1, x2, y2]): (usize, [f64; 4])| {
        Printed::Pixels(Pixels {
            labels: vec![(text(&labels[n]), scores[n])],
            center: Corners { x1, y1, x2, y2 }.center(),
            depth: depths.as_ref().map(|depths| depths[n]),
            ..Pixels::default()
        })
    };
    Ok(boxes.into_iter().enumerate().map(one).collect())
}

#[derive(Deserialize)]
struct DetectionArray {
    header: Header,
    detections: Vec<Detection>,
}

#[derive(Default, Deserialize)]
struct Header {
    #[serde(default)]
    frame_id: String,
}

#[derive(Deserialize)]
struct Detection {
    #[serde(default)]
    header: Header,
    results: Vec<ResultWithPose>,
    bbox: BoundingBox,
    #[serde(default)]
    id: String,
    depth: Option<f64>,
}

#[derive(Deserialize)]
struct ResultWithPose {
    hypothesis: ClassScore,
    #[serde(default)]
    pose: PoseWithCovariance,
}

#[derive(Deserialize)]
struct ClassScore {
    class_id: String,
    score: f64,
}

#[derive(Default, Deserialize)]
struct PoseWithCovariance {
    #[serde(default)]
    pose: ros::geometry::Pose,
    #[serde(default)]
    covariance: Vec<f64>,
}

/// A box of two dimensions has `size_x`, and its centre is in pixels.
#[derive(Deserialize)]
struct BoundingBox {
    center: Json,
    size_x: Option<f64>,
}

#[derive(Deserialize)]
struct Center2 {
    position: Point2,
}

#[derive(Deserialize)]
struct Point2 {
    x: f64,
    y: f64,
}

fn vision_msgs(line: &Json) -> Result<Vec<Printed>, String> {
    let array: DetectionArray = parse(line)?;
    let one = |it: Detection| -> Result<Printed, String> {
        if it.bbox.size_x.is_some() {
            let Point2 { x, y } = parse::<Center2>(&it.bbox.center)?.position;
            let labels =
                it.results.into_iter().map(|it| (it.hypothesis.class_id, it.hypothesis.score));
            let (labels, center) = (labels.collect(), [x, y]);
            return Ok(Printed::Pixels(Pixels { labels, track: it.id, center, depth: it.depth }));
        }
        let frames = [&array.header.frame_id, &it.header.frame_id];
        let frame = frames.into_iter().find(|frame| !frame.is_empty()).cloned().unwrap_or_default();
        let hypothesis = |result: &ResultWithPose| Hypothesis {
            id: result.hypothesis.class_id.clone(),
            score: result.hypothesis.score,
            pose: (&result.pose.pose).into(),
            covariance: result.pose.covariance.as_slice().try_into().unwrap_or([0.0; 36]),
        };
        let center: ros::geometry::Pose = parse(&it.bbox.center)?;
        let hypotheses = it.results.iter().map(hypothesis).collect();
        let center = Some((&center).into());
        Ok(Printed::Posed(Reported { frame, track: it.id, hypotheses, center }))
    };
    array.detections.into_iter().map(one).collect()
}

#[derive(Deserialize)]
struct Tag {
    tag_id: u64,
    #[serde(default)]
    tag_family: String,
    /// Column or list, metres.
    pose_t: Vec<Coordinate>,
    #[serde(rename = "pose_R")]
    rotation: Option<[[f64; 3]; 3]>,
}

/// numpy prints a column as a list of lists.
#[derive(Deserialize)]
#[serde(untagged)]
enum Coordinate {
    Plain(f64),
    Row([f64; 1]),
}

fn tag(it: Tag) -> Printed {
    let family = it.tag_family.trim_start_matches("b'").trim_end_matches('\'');
    let id = match family {
        "" => it.tag_id.to_string(),
        family => format!("{family}:{}", it.tag_id),
    };
    let coordinate = |axis: usize| match it.pose_t.get(axis) {
        Some(Coordinate::Plain(x) | Coordinate::Row([x])) => *x,
        None => f64::NAN,
    };
    let position = std::array::from_fn(coordinate);
    let orientation = it.rotation.map_or([0.0; 4], quaternion);
    let pose = Pose { position, orientation };
    Printed::Posed(Reported::marker("", &id, pose, [0.0; 36]))
}

/// The quaternion x, y, z, w of a rotation matrix.
fn quaternion(r: [[f64; 3]; 3]) -> [f64; 4] {
    let w = (1.0 + r[0][0] + r[1][1] + r[2][2]).max(0.0).sqrt() / 2.0;
    if w > 0.1 {
        let part = |a: f64, b: f64| (a - b) / (4.0 * w);
        return [part(r[2][1], r[1][2]), part(r[0][2], r[2][0]), part(r[1][0], r[0][1]), w];
    }
    // Near half a turn the greatest part of the axis is the safe divisor.
    let i = (0..3).fold(0, |best, axis| if r[axis][axis] > r[best][best] { axis } else { best });
    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
    let own = (1.0 + r[i][i] - r[j][j] - r[k][k]).max(f64::MIN_POSITIVE).sqrt() / 2.0;
    let mut parts = [0.0; 4];
    (parts[i], parts[3]) = (own, (r[k][j] - r[j][k]) / (4.0 * own));
    (parts[j], parts[k]) = ((r[i][j] + r[j][i]) / (4.0 * own), (r[i][k] + r[k][i]) / (4.0 * own));
    parts
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn printed(line: &Json) -> Vec<Printed> {
        read(line).expect("a known form").unwrap_or_else(|error| panic!("{error}"))
    }

    fn pixels(line: &Json) -> Pixels {
        match printed(line).remove(0) {
            Printed::Pixels(pixels) => pixels,
            Printed::Posed(posed) => panic!("{posed:?}"),
        }
    }

    fn posed(line: &Json) -> Reported {
        match printed(line).remove(0) {
            Printed::Posed(posed) => posed,
            Printed::Pixels(pixels) => panic!("{pixels:?}"),
        }
    }

    fn expected(label: &str, track: &str, depth: Option<f64>) -> Pixels {
        let labels = vec![(label.to_owned(), 0.8)];
        Pixels { labels, track: track.to_owned(), center: [110.0, 70.0], depth }
    }

    #[test]
    fn boxes_of_every_detector_are_read_alike() {
        let ultralytics = json!([{"name": "bowl", "class": 45, "confidence": 0.8, "track_id": 3,
            "box": {"x1": 100.0, "y1": 50.0, "x2": 120.0, "y2": 90.0}}]);
        assert_eq!(pixels(&ultralytics), expected("bowl", "3", None));
        let coco = json!([{"image_id": 1, "category_id": 51, "bbox": [100.0, 50.0, 20.0, 40.0], "score": 0.8,
            "depth": 0.9}]);
        assert_eq!(pixels(&coco), expected("51", "", Some(0.9)));
        let pipeline = json!([{"score": 0.8, "label": "a red block",
            "box": {"xmin": 100, "ymin": 50, "xmax": 120, "ymax": 90}}]);
        assert_eq!(pixels(&pipeline), expected("a red block", "", None));
        let grounded = json!({"scores": [0.8], "boxes": [[100.0, 50.0, 120.0, 90.0]], "labels": [0],
            "text_labels": ["a red block"], "depths": [0.9]});
        assert_eq!(pixels(&grounded), expected("a red block", "", Some(0.9)));
        let flat = json!({"header": {"frame_id": "lens"}, "detections": [{"id": "3", "depth": 0.9,
            "results": [{"hypothesis": {"class_id": "bowl", "score": 0.8}}],
            "bbox": {"center": {"position": {"x": 110.0, "y": 70.0}, "theta": 0.0}, "size_x": 20.0, "size_y": 40.0}}]});
        assert_eq!(pixels(&flat), expected("bowl", "3", Some(0.9)));
    }

    #[test]
    fn poses_of_vision_msgs_and_tags_are_read() {
        let pose = json!({"position": {"x": 0.1, "y": 0.2, "z": 0.9},
            "orientation": {"x": 0.0, "y": 0.0, "z": 0.6, "w": 0.8}});
        let solid = json!({"header": {"frame_id": "lens"}, "detections": [{"id": "7",
            "results": [{"hypothesis": {"class_id": "white", "score": 0.8}, "pose": {"pose": pose, "covariance": []}}],
            "bbox": {"center": pose, "size": {"x": 0.1, "y": 0.1, "z": 0.1}}}]});
        let read = posed(&solid);
        assert_eq!(
            (read.frame.as_str(), read.track.as_str(), read.hypotheses[0].score),
            ("lens", "7", 0.8)
        );
        assert_eq!(read.hypotheses[0].pose, read.center.unwrap());
        let tag = json!([{"tag_family": "b'tag36h11'", "tag_id": 7, "center": [1.0, 2.0],
            "pose_t": [[0.1], [0.2], [0.9]], "pose_R": [[0.28, -0.96, 0.0], [0.96, 0.28, 0.0], [0.0, 0.0, 1.0]]}]);
        let hypothesis = posed(&tag).hypotheses.remove(0);
        assert_eq!(
            (hypothesis.id.as_str(), hypothesis.pose.position),
            ("tag36h11:7", [0.1, 0.2, 0.9])
        );
        let close = hypothesis
            .pose
            .orientation
            .iter()
            .zip([0.0, 0.0, 0.6, 0.8])
            .all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(close, "{hypothesis:?}");
    }

    #[test]
    fn quaternions_turn_as_their_matrices() {
        for rpy in
            [[0.3, -0.2, 2.0], [std::f64::consts::PI, 0.0, 0.4], [3.0, 0.0, 0.0], [0.0, 1.5, 3.0]]
        {
            let turned = perception::Rotation::from_rpy(rpy);
            let column =
                |axis: usize| turned.turn(std::array::from_fn(|n| f64::from(u8::from(n == axis))));
            let columns = [column(0), column(1), column(2)];
            let rows = std::array::from_fn(|row| std::array::from_fn(|k| columns[k][row]));
            let again = ros::rotation::of_quaternion(quaternion(rows));
            for vector in [[1.0, 0.0, 0.0], [0.2, -0.5, 0.7]] {
                let pairs = turned.turn(vector).into_iter().zip(again.turn(vector));
                assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-9), "{rpy:?}");
            }
        }
    }

    #[test]
    fn what_no_detector_prints_is_not_read_and_a_missing_key_is_named() {
        assert_eq!(read(&json!({"seen": []})), None);
        assert_eq!(read(&json!([{"cup": 1}])), None);
        assert_eq!(read(&json!([])), Some(Ok(Vec::new())));
        assert_eq!(read(&json!([null, {"tag_id": 7}])), None, "not an empty look");
        let fractions =
            json!({"scores": [0.8], "boxes": [[0.1, 0.2, 0.3, 0.4]], "labels": ["cup"]});
        assert!(read(&fractions).unwrap().unwrap_err().contains("found fractions"));
        let error = read(&json!([{"box": {"x1": 0, "y1": 0, "x2": 1, "y2": 1}, "name": "cup"}]))
            .unwrap()
            .unwrap_err();
        assert!(error.contains("confidence"), "{error}");
        let uneven =
            json!({"scores": [0.8, 0.7], "boxes": [[0.0, 0.0, 1.0, 1.0]], "labels": ["a"]});
        assert!(read(&uneven).unwrap().unwrap_err().contains("different lengths"));
    }
}
