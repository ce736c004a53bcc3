//! What looks of a detector make the tracker believe.

use super::*;

/// The probability of a name.
fn chance(chances: &[(String, f64)], name: &str) -> f64 {
    chances.iter().filter(|(known, _)| known == name).map(|(_, p)| p).sum()
}

fn colored(class: &str, color: &str, score: f64) -> Detection {
    let color = vec![(color.to_owned(), score)];
    Detection { attributes: vec![("color".to_owned(), color)], ..seen(class, 0.7, 0.1) }
}

/// The scene's probability that the only object has a value of an attribute.
fn belief(it: &Scenery, attribute: &str, value: &str) -> f64 {
    let scene = it.file.with_objects(&it.tracker.objects());
    let k = scene.attribute_named(attribute).unwrap();
    let (v, object) = (scene.value_named(k, value).unwrap(), &scene.objects()[0]);
    let certain = f64::from(u8::from(object.values[k.index()] == Some(v)));
    object.chances[k.index()].as_ref().map_or(certain, |chances| chances[v.index()])
}

#[test]
fn a_value_seen_once_in_81_looks_is_worth_at_most_one_in_81() {
    let mut it = Scenery::new();
    it.looks(40, &[seen("white", 0.7, 0.1)]);
    it.look(&[colored("white", "metallic", 0.9)]);
    it.looks(40, &[seen("white", 0.7, 0.1)]);
    let metallic = belief(&it, "color", "metallic");
    assert!(metallic <= 1.0 / 81.0, "{metallic}: {:?}", it.tracker.objects());
}

#[test]
fn looks_that_agree_are_as_sure_as_each_and_noise_is_outvoted() {
    // A camera that is in doubt at every look alike stays in doubt.
    let mut it = Scenery::new();
    let values = [("white", 0.8), ("metallic", 0.2)].map(|(name, p)| (name.to_owned(), p));
    let doubtful = Detection {
        attributes: vec![("color".to_owned(), values.to_vec())],
        ..seen("white", 0.7, 0.1)
    };
    it.looks(100, &[doubtful]);
    assert!((belief(&it, "color", "white") - 0.8).abs() < 0.03, "{:?}", it.tracker.objects());
    // One whose every fourth look shows another colour is sure in the end, and not at first.
    let mut it = Scenery::new();
    let noisy = ["metallic", "white", "white", "white"].map(|color| colored("white", color, 0.65));
    noisy[..3].iter().for_each(|look| it.look(std::slice::from_ref(look)));
    let at_first = belief(&it, "color", "white");
    assert!((0.5..0.95).contains(&at_first), "{at_first}");
    (0..10).for_each(|_| noisy.iter().for_each(|look| it.look(std::slice::from_ref(look))));
    assert!(belief(&it, "color", "white") > 0.95, "{:?}", it.tracker.objects());
    // Looks that show two colours equally often leave both.
    let mut it = Scenery::new();
    let even = ["metallic", "white"].map(|color| colored("white", color, 0.9));
    (0..20).for_each(|_| even.iter().for_each(|look| it.look(std::slice::from_ref(look))));
    let white = belief(&it, "color", "white");
    assert!((0.2..0.8).contains(&white), "{white}: {:?}", it.tracker.objects());
}

#[test]
fn what_stands_in_the_place_of_another_object_is_known_after_a_while() {
    let mut it = Scenery::new();
    it.looks(200, &[seen("white", 0.7, 0.1)]);
    it.looks(40, &[seen("metal", 0.7, 0.1)]);
    assert!(chance(&it.tracker.objects()[0].classes, "metal") > 0.9, "{:?}", it.tracker.objects());
}

#[test]
fn what_a_person_states_is_kept_beside_looks_that_do_not_show_it() {
    let mut it = Scenery::new();
    let values = [("white", 0.3), ("metallic", 0.7)].map(|(name, p)| (name.to_owned(), p)).to_vec();
    let attributes = vec![("color".to_owned(), values)];
    it.report("hand", Change::Add(Detection { attributes, ..seen("metal", 0.7, 0.1) })).unwrap();
    it.looks(60, &[seen("metal", 0.7, 0.1)]);
    assert!((belief(&it, "color", "white") - 0.3).abs() < 0.01, "{:?}", it.tracker.objects());
    // Nor does a look that agrees make the others count against it; looks that do not agree do.
    let mut it = Scenery::new();
    it.report("hand", Change::Add(colored("metal", "white", 1.0))).unwrap();
    for times in [60, 20] {
        it.looks(times, &[seen("metal", 0.7, 0.1)]);
        it.look(&[colored("metal", "white", 0.9)]);
        assert!(belief(&it, "color", "white") > 0.9, "{:?}", it.tracker.objects());
    }
    it.looks(60, &[colored("metal", "clear", 0.9)]);
    assert!(belief(&it, "color", "clear") > 0.9, "{:?}", it.tracker.objects());
}

#[test]
fn labels_are_read_by_the_scenes_words() {
    let mut it = Scenery::new();
    it.looks(3, &[seen("a small steel bowl", 0.7, 0.1)]);
    let object = it.tracker.objects().remove(0);
    assert_eq!(object.name, "metal-6");
    assert!(belief(&it, "material", "metal") > 0.99 && belief(&it, "size", "small") > 0.99);
    let mut it = Scenery::new();
    it.looks(30, &[seen("The White Bowl.", 0.7, 0.1)]);
    let classes = it.tracker.objects().remove(0).classes;
    let each = ["white", "white2", "white3"].map(|name| chance(&classes, name));
    assert!(each.iter().all(|p| (p - 1.0 / 3.0).abs() < 0.02), "{classes:?}");
    assert!(belief(&it, "color", "white") > 0.99);
    assert!((belief(&it, "size", "big") - 1.0 / 3.0).abs() < 0.02, "{classes:?}");
    let refused = |classes: &[(&str, f64)]| {
        let classes = classes.iter().map(|(name, p)| ((*name).to_owned(), *p)).collect();
        let seen = vec![Detection { classes, ..seen("white", 0.7, 0.1) }];
        let look = Change::Look(Look { seen, ..Look::default() });
        Scenery::new().report(CAMERA, look).unwrap_err().to_string()
    };
    for unknown in ["a teapot", "a purple bowl", "white elephant", "cabinet", "", "the"] {
        let refused = refused(&[(unknown, 0.95), ("white", 0.05)]);
        assert!(refused.contains(unknown) && refused.contains("white2, white3"), "{refused}");
    }
    assert_eq!(refused(&[]), refused(&[("white", 0.0)]), "no label");
}

#[test]
fn a_look_is_used_but_for_detections_that_are_refused() {
    let mut it = Scenery::new();
    for _ in 0..3 {
        it.now = it.now + Span::from_ms(100);
        let all =
            vec![seen("person", 1.5, 0.0), seen("white", 0.7, 0.1), seen("metal", 600.0, 500.0)];
        let look = Look { at_ns: it.now.ns(), whole: true, seen: all };
        let refused = it.report(CAMERA, Change::Look(look)).unwrap_err();
        assert!(matches!(refused, Refusal::NoClass(..)), "{refused}");
    }
    assert_eq!(it.tracker.objects().iter().map(|it| &it.name).collect::<Vec<_>>(), ["white-6"]);
}

#[test]
fn places_on_another_scale_are_refused_with_a_guess() {
    let mut it = Scenery::new();
    let mut refusal = |change| it.report("hand", change).unwrap_err().to_string();
    for (x, y, guess) in [(600.0, 500.0, "millimetres?"), (60.0, -40.0, "centimetres?")] {
        let refused = refusal(Change::Add(seen("white", x, y)));
        assert!(refused.contains(guess) && refused.contains(&x.to_string()), "{refused}");
        let look = Look { seen: vec![seen("white", x, y)], ..Look::default() };
        assert!(refusal(Change::Look(look)).contains(guess));
    }
    assert!(refusal(Change::Add(seen("white", 9e6, 0.0))).contains("another frame?"));
    it.report("hand", Change::Add(seen("white", 0.7, 0.1))).unwrap();
    let to = Change::Move { object: "6".to_owned(), xyz: [650.0, 0.0, -120.0], yaw: 0.0 };
    let refused = it.report("hand", to).unwrap_err();
    assert!(refused.to_string().contains("millimetres?"), "{refused}");
}

proptest! {
    /// Whatever looks state, chances are chances, and a look more for a name does not make it less
    /// likely.
    #[test]
    fn beliefs_are_probabilities_and_rise_with_agreeing_looks(
        looks in prop::collection::vec((0_usize..3, 0.0_f64..=1.0), 1..90),
    ) {
        let mut it = Scenery::new();
        let colors = ["white", "metallic", "clear"];
        for (color, score) in looks {
            it.look(&[colored("white", colors[color], score)]);
        }
        for object in it.tracker.objects() {
            for (_, values) in object.attributes.iter().chain([&("".to_owned(), object.classes.clone())]) {
                let total: f64 = values.iter().map(|(_, p)| p).sum();
                prop_assert!(total <= 1.0 + 1e-9 && values.iter().all(|(_, p)| *p >= 0.0), "{:?}", values);
            }
        }
        it.looks(3, &[colored("white", "white", 1.0)]);
        let before = belief(&it, "color", "white");
        it.looks(20, &[colored("white", "white", 1.0)]);
        prop_assert!(belief(&it, "color", "white") >= before - 0.11, "{before}");
    }
}
