//! Differences between two versions of a text, as `diff -U0` prints them.

/// Returns the changed lines of `new` against `old`, for a file of that name: replaced lines one for one,
/// and added lines, which is all that [`SceneEdit`](scene_editing::SceneEdit) does.
pub(super) fn unified(file: &str, old: &str, new: &str) -> Vec<String> {
    let (old, new): (Vec<&str>, Vec<&str>) = (old.lines().collect(), new.lines().collect());
    let mut lines = vec![format!("--- {file}"), format!("+++ {file}")];
    let (mut i, mut j) = (0, 0);
    while j < new.len() {
        if old.get(i) == Some(&new[j]) {
            (i, j) = (i + 1, j + 1);
        } else if old.get(i).is_none() || new.get(j + 1) == old.get(i) {
            lines.push(format!("@@ -{i},0 +{} @@", j + 1));
            lines.push(format!("+{}", new[j]));
            j += 1;
        } else {
            lines.push(format!("@@ -{} +{} @@", i + 1, j + 1));
            lines.extend([format!("-{}", old[i]), format!("+{}", new[j])]);
            (i, j) = (i + 1, j + 1);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaced_and_added_lines_are_printed_with_their_numbers() {
        let diff = unified("s.toml", "a\nb\nc\n", "a\nB\nc\nd\n");
        let expected =
            ["--- s.toml", "+++ s.toml", "@@ -2 +2 @@", "-b", "+B", "@@ -3,0 +4 @@", "+d"];
        assert_eq!(diff, expected);
        let diff = unified("s", "a\nc", "a\nb\nc");
        assert_eq!(diff[2..], ["@@ -1,0 +2 @@", "+b"]);
        assert_eq!(unified("s", "a", "a").len(), 2);
    }
}
