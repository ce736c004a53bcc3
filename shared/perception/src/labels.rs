//! Labels of detectors as classes and attributes: names of objects in the scene file, or the scene's
//! own words, as in "a red block".

use scene::{AttributeId, ObjectId, Role, Scene, ValueId, likeliest, plural};

use crate::{Detection, Refusal};

/// Words of a label that say nothing about the object.
const EMPTY: [&str; 12] =
    ["a", "an", "the", "of", "with", "and", "one", "object", "photo", "picture", "is", "that"];

/// Words of a label, and the value that they name; none for a noun.
type Phrase = (Vec<String>, Option<(AttributeId, ValueId)>);

/// Returns whether a label is the name of an object or words of the scene.
pub fn is_known(label: &str, file: &Scene) -> bool {
    file.object_named(label).is_some() || values(label, file).is_some()
}

/// Reads the labels of a detection. Values that it states directly come before those of a label.
///
/// # Errors
/// It has no label, or its likeliest one is not known: the others are no substitute for it.
pub(crate) fn read(mut detection: Detection, file: &Scene) -> Result<Detection, Refusal> {
    detection.classes.retain(|(_, p)| *p > 0.0);
    let labels = &detection.classes;
    if likeliest(labels).is_none_or(|label| !is_known(label, file)) {
        return Err(unknown(&detection, file));
    }
    if labels.iter().all(|(label, _)| file.object_named(label).is_some()) {
        return Ok(detection);
    }
    let mut read = Detection { classes: Vec::new(), ..detection.clone() };
    for (label, p) in labels {
        if file.object_named(label).is_some() {
            add(&mut read.classes, label, *p);
            continue;
        }
        let Some(values) = values(label, file) else { continue };
        let objects = best(&values, file);
        let each = p / objects.len() as f64;
        objects.iter().for_each(|i| add(&mut read.classes, &file.object(*i).name, each));
        for (k, v) in values {
            let attribute = &file.attributes()[k.index()];
            let (name, value) = (&attribute.name, &attribute.values[v.index()].name);
            if detection.attributes.iter().any(|(stated, _)| stated == name) {
                continue;
            }
            match read.attributes.iter_mut().find(|(known, _)| known == name) {
                Some((_, values)) => add(values, value, *p),
                None => read.attributes.push((name.clone(), vec![(value.clone(), *p)])),
            }
        }
    }
    Ok(read)
}

/// The refusal of a detection without a known label.
fn unknown(detection: &Detection, file: &Scene) -> Refusal {
    let known: Vec<&str> = file.objects().iter().map(|object| object.name.as_str()).collect();
    let labels: Vec<&str> = detection.classes.iter().map(|(label, _)| label.as_str()).collect();
    Refusal::NoClass(labels.join("`, `"), known.join(", "))
}

fn add(chances: &mut Vec<(String, f64)>, name: &str, p: f64) {
    match chances.iter_mut().find(|(known, _)| known == name) {
        Some((_, own)) => *own = (*own + p).min(1.0),
        None => chances.push((name.to_owned(), p)),
    }
}

/// The values that a label names; `None` if it has another word, or none but those of places: "table".
fn values(label: &str, file: &Scene) -> Option<Vec<(AttributeId, ValueId)>> {
    let label = words(label);
    let nouns = [file.noun().to_owned(), plural(file.noun())].map(|noun| words(&noun));
    let mut phrases: Vec<Phrase> = nouns.into_iter().map(|noun| (noun, None)).collect();
    for (k, attribute) in file.attributes().iter().enumerate().filter(|(_, it)| !it.by_place) {
        for (v, value) in attribute.values.iter().enumerate() {
            let names = value.synonyms.iter().chain([&value.name, &value.spoken]);
            phrases.extend(names.map(|name| (words(name), Some((k.into(), v.into())))));
        }
    }
    phrases.sort_by_key(|(phrase, _)| std::cmp::Reverse(phrase.len()));
    let (mut found, mut rest, mut is_named) = (Vec::new(), label.as_slice(), false);
    while let Some(first) = rest.first() {
        let named =
            phrases.iter().find(|(phrase, _)| !phrase.is_empty() && rest.starts_with(phrase));
        let Some((phrase, value)) = named else {
            if !EMPTY.contains(&first.as_str()) {
                return None;
            }
            rest = &rest[1..];
            continue;
        };
        found.extend(value.filter(|value| !found.contains(value)));
        let of = |(k, v): (AttributeId, ValueId)| &file.attributes()[k.index()].values[v.index()];
        is_named |= value.is_none_or(|value| of(value).role() != Role::Place);
        rest = &rest[phrase.len()..];
    }
    is_named.then_some(found)
}

/// The objects of the scene file with the most of these values.
fn best(values: &[(AttributeId, ValueId)], file: &Scene) -> Vec<ObjectId> {
    let fits = |i: &ObjectId| values.iter().filter(|(k, v)| file.has(*i, *k, *v)).count();
    let most = file.ids().map(|i| fits(&i)).max();
    file.ids().filter(|i| Some(fits(i)) == most).collect()
}

fn words(text: &str) -> Vec<String> {
    let words = text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    words.map(str::to_lowercase).collect()
}
