use super::*;

const POINTS: [Point; 3] = [(1.0, 2.0), (10.0, 30.0), (1000.0, 7.0)];

fn chart() -> Chart {
    let points = || POINTS.to_vec();
    let panel = Panel {
        heading: String::new(),
        x: Axis::up_to("objects", 1000.0),
        y: Axis::up_to("µs", 30.0),
        shapes: vec![(0, Shape::Line(points())), (0, Shape::Marks(points()))],
    };
    Chart {
        title: "cost µs".to_owned(),
        note: String::new(),
        panels: vec![panel],
        columns: 1,
        panel_size: (1200, 840),
        legend: vec!["a<b".to_owned()],
    }
}

#[test]
fn axis_has_its_ticks_at_round_numbers() {
    let texts = |axis: &Axis| -> Vec<String> {
        axis.ticks().iter().map(|(_, text)| text.clone()).collect()
    };
    let axis = Axis::up_to("s", 41.6);
    assert_eq!(texts(&axis), ["0", "10", "20", "30", "40", "50"]);
    assert_eq!([25.0, 99.0].map(|x| axis.position(x)), [0.5, 1.0]);
    assert_eq!(
        texts(&Axis::between("m", -0.11, 0.31)),
        ["-0.2", "-0.1", "0", "0.1", "0.2", "0.3", "0.4"]
    );
    for largest in [0.0, 0.003, 0.7, 1.0, 7.0, 19.0, 123.0, 9_999.0] {
        let axis = Axis::up_to("s", largest);
        assert!(axis.ends().1 >= largest && (4..=9).contains(&axis.ticks().len()), "{axis:?}");
    }
    let shares = Axis::missing("%", [0.9, 0.999, 1.0].into_iter());
    assert!((shares.position(0.99) - 2.0 * shares.position(0.9)).abs() < 1e-12);
    assert_eq!([0.0, 1.0].map(|share| shares.position(share)), [0.0, 1.0]);
    assert_eq!(texts(&shares)[texts(&shares).len() - 2..], ["99.9", "100"]);
}

#[test]
fn chart_is_drawn_with_its_labels_and_marks_and_repeats() {
    let chart = chart();
    let text = svg(&chart).unwrap();
    for word in ["cost µs", "objects", "a&lt;b", "\n1000\n"] {
        assert!(text.contains(word), "{word}: {text}");
    }
    // Each mark with its rim, and one of the legend.
    assert_eq!(text.matches("<polygon").count(), 2 * (POINTS.len() + 1));
    assert_eq!(text, svg(&chart).unwrap());
}

#[test]
fn chart_without_panels_or_too_large_is_rejected() {
    let (nothing, large) =
        (Chart { panels: Vec::new(), ..chart() }, Chart { panel_size: (30_000, 10), ..chart() });
    for broken in [nothing, large] {
        assert!(svg(&broken).is_err());
    }
}
