//! Vertices of mesh files: STL, COLLADA and OBJ. Faces are not needed, since shapes enclose hulls.

mod dae;
mod obj;
mod stl;

use std::fs;
use std::path::{Path, PathBuf};

use nalgebra::Vector3;

use crate::report::Findings;

/// A link is neither longer nor shorter than these, metres: what is, has another unit.
const LONGEST_M: f64 = 3.0;
const SHORTEST_M: f64 = 0.003;

/// Most bytes of a mesh that are read.
const BYTES_MAX: u64 = 256 << 20;

/// Returns the vertices of a mesh, metres; `None` if the file is missing or unreadable, which is reported.
pub(crate) fn vertices(
    written: &str,
    scale: &Vector3<f64>,
    robot: &Path,
    findings: &mut Findings,
) -> Option<Vec<Vector3<f64>>> {
    let Some(path) = locate(written, robot) else {
        findings.lost_meshes.push(written.to_owned());
        return None;
    };
    match read(&path) {
        Ok(vertices) if vertices.is_empty() => {
            findings.missing(format!("mesh {written}: it has no vertices"));
            None
        }
        Ok(vertices) => {
            let scaled = vertices.iter().map(|at| at.component_mul(scale)).collect();
            Some(in_metres(scaled, written, findings))
        }
        Err(why) => {
            findings.missing(format!("mesh {written}: {why}"));
            None
        }
    }
}

fn read(path: &Path) -> Result<Vec<Vector3<f64>>, String> {
    let size = fs::metadata(path).map_err(|error| error.to_string())?.len();
    if size > BYTES_MAX {
        return Err(format!("expected at most {BYTES_MAX} bytes, found {size}"));
    }
    let bytes = fs::read(path).map_err(|error| error.to_string())?;
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let vertices = match ending.as_str() {
        "stl" => stl::vertices(&bytes)?,
        "obj" => obj::vertices(&String::from_utf8_lossy(&bytes)),
        "dae" => dae::vertices(&String::from_utf8_lossy(&bytes))?,
        other => return Err(format!("expected a mesh of .stl, .dae or .obj, found .{other}")),
    };
    Ok(vertices.into_iter().filter(|at| at.iter().all(|part| part.is_finite())).collect())
}

/// Returns the file of a mesh: an absolute path, one beside the robot's file, or, for `package://NAME/REST`, one that ends
/// like it in a folder above the robot's: the folder of a package may have another name than the package.
fn locate(written: &str, robot: &Path) -> Option<PathBuf> {
    let plain = written.strip_prefix("file://").unwrap_or(written);
    let Some(whole) = plain.strip_prefix("package://").or_else(|| plain.strip_prefix("model://"))
    else {
        let direct = [PathBuf::from(plain), robot.with_file_name("").join(plain)];
        return direct.into_iter().find(|path| path.is_file());
    };
    let parts: Vec<&str> = whole.split('/').collect();
    // The name of a file alone says too little.
    let ends = (0..parts.len().saturating_sub(1)).map(|from| parts[from..].join("/"));
    let folders = robot.ancestors().skip(1);
    let mut all = ends.flat_map(|end| folders.clone().map(move |folder| folder.join(&end)));
    all.find(|path| path.is_file())
}

/// Guesses the unit by the extent.
fn in_metres(
    mut vertices: Vec<Vector3<f64>>,
    written: &str,
    findings: &mut Findings,
) -> Vec<Vector3<f64>> {
    let low = vertices.iter().fold(Vector3::repeat(f64::MAX), |low, at| low.inf(at));
    let high = vertices.iter().fold(Vector3::repeat(f64::MIN), |high, at| high.sup(at));
    let extent = (high - low).amax();
    let (factor, guess) = match extent {
        long if long > LONGEST_M => (1e-3, "it is taken to be in millimetres"),
        short if short < SHORTEST_M && short > 0.0 => (1e3, "its scale is taken to count twice"),
        _ => return vertices,
    };
    let text = format!("mesh {written} is {extent:.4} m long as written: {guess}");
    findings.assumed(text);
    vertices.iter_mut().for_each(|at| *at *= factor);
    vertices
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(vertices: &[Vector3<f64>]) -> [f64; 3] {
        let high = vertices.iter().fold(Vector3::repeat(f64::MIN), |high, at| high.sup(at));
        high.into()
    }

    #[test]
    fn one_triangle_is_the_same_in_every_format() {
        let folder = tempfile::tempdir().unwrap();
        let robot = folder.path().join("robot.urdf");
        let mut binary = b"solid, as some binary files begin".to_vec();
        binary.resize(80, b' ');
        binary.extend(1u32.to_le_bytes());
        for number in [0.0f32, 0.0, 1.0, 0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.2, 0.3] {
            binary.extend(number.to_le_bytes());
        }
        binary.extend([0, 0]);
        let ascii = "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1e-1 0 0\n\
                     vertex 0 .2 0.3\nendloop\nendfacet\nendsolid";
        let obj = "# a comment\nv 0 0 0\nv 0.1 0 0 1.0\nvn 9 9 9\nv 0 0.2 0.3\nf 1 2 3\n";
        let dae = "<COLLADA xmlns='x'><asset><unit meter='0.01'/></asset><library_geometries>\
            <geometry id='g'><mesh><source id='p'><float_array count='9'>0 0 0 10 0 0 0 20 30</float_array>\
            </source><source id='n'><float_array count='3'>99 99 99</float_array></source>\
            <vertices id='v'><input semantic='POSITION' source='#p'/></vertices></mesh></geometry>\
            </library_geometries><library_visual_scenes><visual_scene><node><node>\
            <instance_geometry url='#g'/></node></node></visual_scene></library_visual_scenes></COLLADA>";
        let files: [(&str, &[u8]); 4] = [
            ("b.stl", &binary),
            ("a.STL", ascii.as_bytes()),
            ("o.obj", obj.as_bytes()),
            ("d.dae", dae.as_bytes()),
        ];
        for (name, bytes) in files {
            fs::write(folder.path().join(name), bytes).unwrap();
            let mut findings = Findings::default();
            let read = vertices(name, &Vector3::repeat(1.0), &robot, &mut findings).unwrap();
            let found = corners(&read).map(|m| (m * 1e6).round() / 1e6);
            assert_eq!(found, [0.1, 0.2, 0.3], "{name}");
            assert!(findings.findings.is_empty(), "{name}: {findings:?}");
        }
    }

    #[test]
    fn damaged_and_missing_meshes_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let robot = folder.path().join("robot.urdf");
        fs::write(folder.path().join("short.stl"), [7u8; 90]).unwrap();
        fs::write(folder.path().join("broken.dae"), "<COLLADA").unwrap();
        let mut findings = Findings::default();
        for name in ["short.stl", "broken.dae", "package://none/there.stl", "image.png"] {
            assert!(vertices(name, &Vector3::repeat(1.0), &robot, &mut findings).is_none());
        }
        assert_eq!(findings.of(crate::report::Kind::Missing).count(), 2, "{findings:?}");
        assert_eq!(findings.lost_meshes, ["package://none/there.stl", "image.png"]);
    }

    #[test]
    fn packages_may_lie_in_folders_of_another_name_and_units_are_guessed() {
        let folder = tempfile::tempdir().unwrap();
        let meshes = folder.path().join("panda/meshes");
        fs::create_dir_all(&meshes).unwrap();
        fs::create_dir_all(folder.path().join("panda/urdf")).unwrap();
        let robot = folder.path().join("panda/urdf/panda.urdf");
        fs::write(meshes.join("link.obj"), "v 0 0 0\nv 100 0 0\nv 0 200 300\n").unwrap();
        let mut findings = Findings::default();
        let written = "package://moveit_panda/meshes/link.obj";
        let read = vertices(written, &Vector3::repeat(1.0), &robot, &mut findings).unwrap();
        assert_eq!(corners(&read).map(|m| (m * 1e6).round() / 1e6), [0.1, 0.2, 0.3]);
        let assumed: Vec<&str> = findings.of(crate::report::Kind::Assumed).collect();
        assert!(assumed[0].contains("millimetres"), "{assumed:?}");
    }
}
