//! Picks that are announced first, and can be denied.

use super::*;

/// The same problems, with picks that can be denied.
fn for_many_announced(seed: u64, check: impl Fn(&DecisionProblem<'_>, &Reduced, &str)) {
    for_many_problems(seed, |problem, belief, _, label| {
        for (heard, cost_s) in [(0.3, 0.02), (0.8, 0.2), (0.95, 0.0)] {
            // In the unit of these costs.
            let announce = Announce { heard, cost_s: cost_s * problem.costs.correct };
            let problem = DecisionProblem { announce, ..*problem };
            let reduced = Reduced::new(&problem, belief);
            check(&problem, &reduced, &format!("{label} {announce:?}"));
        }
    });
}

/// Value of an announced pick by the equation, given the value after a denial.
fn announced(
    problem: &DecisionProblem<'_>,
    mass: &[f64],
    class: usize,
    after: impl Fn(&[f64]) -> f64,
) -> f64 {
    let (Announce { heard, cost_s }, costs) = (problem.announce, problem.costs);
    let epsilon = problem.model.params().epsilon;
    let epsilon = epsilon.powi(2) / (epsilon.powi(2) + (1.0 - epsilon).powi(2));
    let denies = |c: usize| heard * if c == class { epsilon } else { 1.0 - epsilon };
    let denied: f64 = mass.iter().enumerate().map(|(c, m)| m * denies(c)).sum();
    let then: Vec<f64> = mass.iter().enumerate().map(|(c, m)| m * denies(c) / denied).collect();
    let paid = |c: usize| if c == class { costs.correct } else { -costs.wrong };
    let kept = |(c, m): (usize, &f64)| m * (1.0 - denies(c)) * paid(c);
    let kept: f64 = mass.iter().enumerate().map(kept).sum();
    kept + denied * (costs.discount * after(&then) - cost_s)
}

#[test]
fn announced_picks_are_seen_as_the_equation_has_them() {
    for_many_announced(79, |problem, reduced, label| {
        let bound = Bound::new(reduced, &problem.costs);
        let one_step = OneStepEvaluator::new(reduced, &bound).look_ahead(&reduced.mass);
        let here = reduced.classes() - usize::from(reduced.absent.is_some());
        assert!(!one_step.picks.is_empty() && one_step.picks.len() <= here, "{label}");
        for pick in &one_step.picks {
            let class = pick.class as usize;
            let expected =
                announced(problem, &reduced.mass, class, |mass| upper(reduced, &bound, mass));
            let got = pick.value.upper;
            assert!((got - expected).abs() < 1e-6, "{label}: {got} not {expected}");
            assert!(pick.value.lower <= pick.value.upper, "{label}");
        }
    });
}

/// As for final picks: no action improves on the bound at any belief.
#[test]
fn no_announced_pick_beats_the_upper_bound() {
    for_many_announced(80, |problem, reduced, label| {
        let bound = Bound::new(reduced, &problem.costs);
        let mut rng = Rng::new(81);
        for _ in 0..6 {
            let power = 1 + rng.below(16) as i32;
            let mass = random_mass(&mut rng, reduced, power);
            let here = upper(reduced, &bound, &mass);
            assert!(problem.costs.wait_value() <= here + 1e-9, "{label} wait");
            for class in 0..reduced.classes() {
                let value = match reduced.absent == Some(class) {
                    true => problem.costs.pick_value(mass[class]),
                    false => announced(problem, &mass, class, |m| upper(reduced, &bound, m)),
                };
                assert!(value <= here + 1e-6, "{label} pick {class}: {value} above {here}");
            }
            expect_no_better_question(reduced, &bound, &mass, here, label);
        }
    });
}

/// Announcing distinguishes objects that no question does.
#[test]
fn announcing_tells_doubles_apart() {
    let double = r#"{"attributes":{"color":"red"},"name":"#;
    let scene = scene(&format!(
        r#"{{"objects":[{double}"a"}},{double}"b"}},{{"name":"c","attributes":{{"color":"blue"}}}}]}}"#
    ));
    let model = Model::new(&scene, Params::default());
    let belief = Belief::from_probabilities(&[0.3, 0.3, 0.4]).unwrap();
    let plain = problem(&model, REMOTE, Costs::SECONDS);
    assert_eq!(Reduced::new(&plain, &belief).classes(), 2);
    let announce = Announce { heard: 0.8, cost_s: 6.0 };
    let reduced = Reduced::new(&DecisionProblem { announce, ..plain }, &belief);
    assert_eq!((reduced.classes(), reduced.doubles.len(), &reduced.doubles[0]), (3, 1, &(0..2)));
    assert_eq!(reduced.share, [1.0; 3]);
}
