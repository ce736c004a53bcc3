const TABLE: &str = include_str!("wordings.txt");

/// The attributes of a scene, `name = value [spoken], …`, as a file with an object per value.
fn scene_text(head: &str) -> String {
    let mut parts = head.split(" | ");
    let (noun, attributes) = (parts.next().expect("a noun"), parts.next().expect("attributes"));
    let ask = parts.next().map_or(String::new(), |ask| format!("ask_yes_no = \"{ask}\"\n"));
    let mut text = format!("name = \"s\"\nnoun = \"{noun}\"\n");
    let mut first = None;
    for attribute in attributes.split(" + ") {
        let (name, values) = attribute.split_once(" = ").expect("values");
        let value = |value: &str| match value.strip_suffix(']').and_then(|it| it.split_once(" [")) {
            Some((name, spoken)) => format!("{{ name = \"{name}\", spoken = \"{spoken}\" }}"),
            None => format!("\"{value}\""),
        };
        let listed: Vec<String> = values.split(", ").map(value).collect();
        let listed = listed.join(", ");
        text += &format!("[[attributes]]\nname = \"{name}\"\n{ask}values = [{listed}]\n");
        first.get_or_insert((name, values));
    }
    let (name, values) = first.expect("an attribute");
    for (n, value) in values.split(", ").enumerate() {
        let value = value.split(" [").next().unwrap_or_default();
        text +=
            &format!("[[objects]]\nname = \"o{n}\"\nattributes = {{ \"{name}\" = \"{value}\" }}\n");
    }
    text
}

/// Returns whether a line of the table begins a scene.
fn is_scene(line: &str) -> bool {
    line.contains(" | ") && !line.split(" | ").next().is_some_and(|it| it.contains(": "))
}
