//! A camera as the `camera_info` of ROS describes it: pixels to places.

use perception::Frame;

/// Steps of the inversion of the distortion; each leaves a fraction of the error.
const STEPS: usize = 20;
/// Distance from the camera up to which a ray is followed, metres.
const FAR_M: f64 = 10.0;

/// A pinhole camera with distortion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Focal lengths and principal point, pixels: `fx`, `fy`, `cx`, `cy`.
    pinhole: [f64; 4],
    /// Coefficients of `plumb_bob` and `rational_polynomial`: `k1`, `k2`, `p1`, `p2`, `k3` to `k6`.
    distortion: [f64; 8],
}

impl Camera {
    /// Reads the YAML that `camera_calibration` writes, or that `ros2 topic echo` prints.
    ///
    /// # Errors
    /// The matrix is missing, or the distortion is of another model.
    pub fn from_yaml(text: &str) -> Result<Self, String> {
        let matrix = ["camera_matrix", "k", "K"].iter().find_map(|key| numbers(text, key));
        let Some([fx, _, cx, _, fy, cy, ..]) = matrix.as_deref() else {
            return Err(
                "expected `camera_matrix` (or `k`) with nine numbers; help: use the file that \
                 camera_calibration writes, or `ros2 topic echo --once /camera_info`"
                    .to_owned(),
            );
        };
        let is_sound = [cx, cy, fx, fy].iter().all(|number| number.is_finite());
        if !(is_sound && *fx > 0.0 && *fy > 0.0) {
            return Err(format!(
                "expected finite numbers, and focal lengths above 0; found {fx} and {fy}"
            ));
        }
        let model = value(text, "distortion_model").unwrap_or("plumb_bob");
        if !["plumb_bob", "rational_polynomial", ""].contains(&model) {
            return Err(format!(
                "distortion model `{model}`; help: rectify the images, and give the camera_info of those"
            ));
        }
        let stated =
            ["distortion_coefficients", "d", "D"].iter().find_map(|key| numbers(text, key));
        let stated = stated.unwrap_or_default();
        let distortion = std::array::from_fn(|n| stated.get(n).copied().unwrap_or(0.0));
        Ok(Self { pinhole: [*fx, *fy, *cx, *cy], distortion })
    }

    /// Returns the direction of a pixel in the optical frame (x right, y down, z along the axis), z = 1.
    fn ray(&self, [u, v]: [f64; 2]) -> [f64; 3] {
        let ([fx, fy, cx, cy], [k1, k2, p1, p2, k3, k4, k5, k6]) = (self.pinhole, self.distortion);
        let [distorted_x, distorted_y] = [(u - cx) / fx, (v - cy) / fy];
        let (mut x, mut y) = (distorted_x, distorted_y);
        for _ in 0..STEPS {
            let r2 = x * x + y * y;
            let radial =
                (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1.0 + r2 * (k4 + r2 * (k5 + r2 * k6)));
            let dx = 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
            let dy = p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
            (x, y) = ((distorted_x - dx) / radial, (distorted_y - dy) / radial);
        }
        [x, y, 1.0]
    }

    /// Returns the place in frame `base` of a pixel at a depth along the optical axis, metres.
    pub(crate) fn at_depth(&self, frame: &Frame, pixel: [f64; 2], depth: f64) -> [f64; 3] {
        frame.to_base(self.ray(pixel).map(|part| part * depth), 0.0).0
    }

    /// Returns the place in frame `base` where the ray of a pixel reaches the height `z`, metres; `None` if it
    /// does not.
    pub(crate) fn at_height(&self, frame: &Frame, pixel: [f64; 2], z: f64) -> Option<[f64; 3]> {
        let through = self.at_depth(frame, pixel, 1.0);
        let along: [f64; 3] = std::array::from_fn(|axis| through[axis] - frame.xyz[axis]);
        let times = (z - frame.xyz[2]) / along[2];
        let is_ahead = times > 0.0 && times < FAR_M;
        is_ahead.then(|| std::array::from_fn(|axis| frame.xyz[axis] + times * along[axis]))
    }
}

/// The text after `key:` up to the next key at the left edge.
fn section<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let after = at + line.len();
        if let Some(rest) = line.strip_prefix(key).and_then(|rest| rest.strip_prefix(':')) {
            let begin = after - rest.len();
            let is_key = |line: &str| line.starts_with(|c: char| c.is_ascii_alphabetic());
            let more = text[after..].split_inclusive('\n').take_while(|line| !is_key(line));
            return Some(&text[begin..after + more.map(str::len).sum::<usize>()]);
        }
        at = after;
    }
    None
}

fn value<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    Some(section(text, key)?.trim().trim_matches(['"', '\'']))
}

/// The numbers of a list, inline or one in a line; of a matrix those of its `data`.
fn numbers(text: &str, key: &str) -> Option<Vec<f64>> {
    let section = section(text, key)?;
    let list = section.split_once("data:").map_or(section, |(_, data)| data);
    let words = list.split([',', '[', ']', ' ', '\n', '\r', '\t']);
    let words = words.filter(|word| !word.is_empty() && *word != "-" && *word != "---");
    let numbers: Vec<f64> = words.map_while(|word| word.parse().ok()).collect();
    (!numbers.is_empty()).then_some(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CALIBRATED: &str = "image_width: 640\nimage_height: 480\ncamera_name: head\ncamera_matrix:\n  rows: 3\n  \
        cols: 3\n  data: [500.0, 0.0, 320.0, 0.0, 510.0, 240.0,\n         0.0, 0.0, 1.0]\ndistortion_model: plumb_bob\n\
        distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [-0.2, 0.05, 0.001, -0.002, 0.0]\nrectification_matrix:\n  \
        rows: 3\n";

    /// A camera 1 m above the table that looks straight down, its image's top towards x.
    fn above() -> Frame {
        let down = std::f64::consts::PI;
        Frame { name: "lens".to_owned(), xyz: [0.6, 0.0, 1.0], rpy: [down, 0.0, -down / 2.0] }
    }

    /// The pixel that shows a direction.
    fn shown(camera: &Camera, [x, y]: [f64; 2]) -> [f64; 2] {
        let ([fx, fy, cx, cy], [k1, k2, p1, p2, k3, ..]) = (camera.pinhole, camera.distortion);
        let r2 = x * x + y * y;
        let radial = 1.0 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
        let dx = 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
        let dy = p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
        [fx * (x * radial + dx) + cx, fy * (y * radial + dy) + cy]
    }

    #[test]
    fn both_forms_of_camera_info_are_read_and_distortion_is_undone() {
        let camera = Camera::from_yaml(CALIBRATED).unwrap();
        assert_eq!(camera.pinhole, [500.0, 510.0, 320.0, 240.0]);
        for direction in [[0.0, 0.0], [0.4, -0.3], [-0.5, 0.4]] {
            let [x, y, _] = camera.ray(shown(&camera, direction));
            assert!((x - direction[0]).abs() < 1e-6 && (y - direction[1]).abs() < 1e-6);
        }
        let echoed = "header:\n  frame_id: lens\ndistortion_model: plumb_bob\nd:\n- -0.2\n- 0.05\n- 0.001\n- -0.002\n\
            - 0.0\nk:\n- 500.0\n- 0.0\n- 320.0\n- 0.0\n- 510.0\n- 240.0\n- 0.0\n- 0.0\n- 1.0\n---\n";
        assert_eq!(Camera::from_yaml(echoed), Ok(camera));
    }

    #[test]
    fn other_lenses_and_files_are_refused_with_help() {
        let fisheye = CALIBRATED.replace("plumb_bob", "equidistant");
        assert!(Camera::from_yaml(&fisheye).unwrap_err().contains("rectify"));
        assert!(Camera::from_yaml("image_width: 640\n").unwrap_err().contains("camera_matrix"));
        assert!(
            Camera::from_yaml(&CALIBRATED.replace("500.0", "0.0")).unwrap_err().contains("above 0")
        );
    }

    #[test]
    fn pixels_are_placed_by_depth_or_by_height() {
        let camera = Camera { pinhole: [500.0, 500.0, 320.0, 240.0], distortion: [0.0; 8] };
        let frame = above();
        // The image's right is the robot's right (-y), its bottom towards the robot (-x).
        for (pixel, xy) in [
            ([320.0, 240.0], [0.6, 0.0]),
            ([420.0, 240.0], [0.6, -0.2]),
            ([320.0, 340.0], [0.4, 0.0]),
        ] {
            let [x, y, z] = camera.at_depth(&frame, pixel, 1.0);
            assert!(
                (x - xy[0]).abs() < 1e-9 && (y - xy[1]).abs() < 1e-9 && z.abs() < 1e-9,
                "{x} {y} {z}"
            );
            let [x, y, z] = camera.at_height(&frame, pixel, 0.0).unwrap();
            assert!(
                (x - xy[0]).abs() < 1e-9 && (y - xy[1]).abs() < 1e-9 && z.abs() < 1e-9,
                "{x} {y} {z}"
            );
        }
        assert_eq!(camera.at_height(&frame, [320.0, 240.0], 2.0), None, "behind the camera");
    }
}
