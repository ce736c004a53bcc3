//! Invalid files: `invalid.txt` holds each and its diagnostics; `UPDATE_EXPECT=1 cargo test -p parts` rewrites the latter.

use expect_test::expect_file;

use super::Folder;

#[test]
fn invalid_files_get_every_diagnostic_with_line_and_help() {
    let mut found = String::new();
    for case in include_str!("invalid.txt").split("--- ").skip(1) {
        let (file, rest) = case.split_once('\n').unwrap();
        let text = rest.split_once("\n+++\n").unwrap().0;
        let complaints = Folder::new(&[(file, text)]).complaints();
        found += &format!("--- {file}\n{text}\n+++\n{complaints}\n");
    }
    expect_file!["invalid.txt"].assert_eq(&found);
}
