//! Names of the joints in the settings.

use super::*;

fn read(joints: &str) -> Result<Controllers, String> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config"));
    let overrides = [("arm.trajectory.joints".to_owned(), joints.to_owned())];
    let settings = Settings::load(folder, None, &overrides).map_err(|error| error.to_string())?;
    settings.part().map_err(|error| format!("{error:?}"))
}

#[test]
fn five_to_seven_joints_are_named() {
    for joints in [r#"["a", "b", "c", "d", "e"]"#, r#"["a", "b", "c", "d", "e", "f", "g"]"#] {
        assert!(read(joints).is_ok(), "{:?}", read(joints));
    }
    let error = read(r#"["a", "b", "c", "d"]"#).unwrap_err();
    assert!(error.contains("expected the names of five, six or seven joints, found 4"), "{error}");
}
