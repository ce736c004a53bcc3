//! The bounds on a plan's value.

use super::*;

/// The bound is admissible because no action improves on it anywhere: not picking, not waiting,
/// and no question, at any belief. So it is checked at random beliefs far from the first one.
#[test]
fn no_action_beats_the_upper_bound() {
    for_many_problems(74, |problem, _, reduced, label| {
        let bound = Bound::new(reduced, &problem.costs);
        let mut rng = Rng::new(75);
        for _ in 0..8 {
            let power = 1 + rng.below(12) as i32;
            let mass = random_mass(&mut rng, reduced, power);
            let here = upper(reduced, &bound, &mass);
            let top = mass.iter().zip(&reduced.share).map(|(m, s)| m * s).fold(0.0, f64::max);
            assert!(problem.costs.pick_value(top) <= here + 1e-9, "{label} pick");
            assert!(problem.costs.wait_value() <= here + 1e-9, "{label} wait");
            expect_no_better_question(reduced, &bound, &mass, here, label);
        }
    });
}

#[test]
fn searching_only_tightens_the_bounds() {
    for_many_problems(76, |problem, _, reduced, label| {
        let bound = Bound::new(reduced, &problem.costs);
        let mut search = Search::new(reduced, &bound);
        let mut before = search.root().value;
        let tolerance = 1e-6 * problem.costs.correct;
        for beliefs_max in [2, 8, 32, 128] {
            search.run(Effort { beliefs_max, tolerance, certify: None });
            let after = search.root().value;
            assert!(after.lower >= before.lower && after.upper <= before.upper, "{label}");
            assert!(after.lower <= after.upper, "{label}");
            assert!((after.lower..=after.upper).contains(&after.estimate), "{label}");
            before = after;
        }
    });
}

/// A better plan is still no better than the best one, and rolling it out again gains nothing.
#[test]
fn improving_raises_the_lower_bound_up_to_the_value() {
    for_many_problems(77, |problem, _, reduced, label| {
        let bound = Bound::new(reduced, &problem.costs);
        let tolerance = 1e-6 * problem.costs.correct;
        let mut solved = Search::new(reduced, &bound);
        solved.run(Effort { beliefs_max: 1_000, tolerance, certify: None });
        let mut search = Search::new(reduced, &bound);
        search.roll_out(300);
        let rolled_out = search.root().value;
        search.improve(600);
        let improved = search.root().value;
        assert!(improved.lower >= rolled_out.lower, "{label}");
        assert!(improved.lower <= solved.root().value.upper + 1e-9, "{label}");
        assert!(improved.upper >= solved.root().value.lower - 1e-9, "{label}");
    });
}

/// If a gap remains, the plan beats the one-step `lookahead` by the value of its first questions.
#[test]
fn improving_finds_a_better_plan_on_a_hard_scene() {
    let model =
        Model::new(&random_scene(&mut Rng::new(78), 30, &[6, 6, 6, 6], 0), Params::default());
    let problem = problem(&model, Actions { which: false, ..REMOTE }, Costs::SECONDS);
    let reduced = Reduced::new(&problem, &Belief::uniform(30));
    let bound = Bound::new(&reduced, &problem.costs);
    let mut search = Search::new(&reduced, &bound);
    search.roll_out(5_000);
    let before = search.root().value.lower;
    search.improve(20_000);
    let after = search.root().value.lower;
    assert!(after > before + 0.05, "{before} to {after}");
}

/// How many beliefs it takes to know the value of the six bowls.
#[test]
fn the_bowls_are_solved_in_few_beliefs() {
    let model = Model::new(&bowls(), Params::default());
    for (actions, beliefs_max) in [
        (Actions { which: false, ..REMOTE }, 250),
        (Actions { which: false, ..PRESENT }, 250),
        (REMOTE, 50),
        (CHOOSING, 250),
        (POINTING, 20),
    ] {
        let problem = problem(&model, actions, Costs::SECONDS);
        let reduced = Reduced::new(&problem, &Belief::uniform(6));
        let bound = Bound::new(&reduced, &problem.costs);
        let mut search = Search::new(&reduced, &bound);
        search.run(Effort { beliefs_max, tolerance: 5e-4, certify: None });
        assert!(search.root().value.gap() <= 5e-4, "{actions:?} {:?}", search.root().value);
    }
}

/// A gap of nothing may never be reached, for rounding; the search ends all the same.
#[test]
fn a_search_that_tolerates_nothing_ends() {
    let model = Model::new(&bowls(), Params::default());
    let problem = problem(&model, REMOTE, Costs::SECONDS);
    let reduced = Reduced::new(&problem, &Belief::uniform(6));
    let bound = Bound::new(&reduced, &problem.costs);
    let mut search = Search::new(&reduced, &bound);
    search.run(Effort { beliefs_max: usize::MAX, tolerance: 0.0, certify: None });
    assert!(search.root().value.gap() < 1e-6, "{:?}", search.root().value);
}

/// The easier problem is worth no less than the real one, however much of it is searched, and
/// searching it tightens the bound.
#[test]
fn revealed_errors_bound_the_value() {
    let problems = std::cell::Cell::new(0);
    for_many_problems(82, |problem, _, reduced, label| {
        // The bound takes a while to set up: every fifth problem is checked.
        problems.set(problems.get() + 1);
        if problems.get() % 5 > 0 {
            return;
        }
        let Some(mut easier) = Revealed::of(reduced, &problem.costs) else { return };
        let bound = Bound::new(reduced, &problem.costs);
        let mut search = Search::new(reduced, &bound);
        let tolerance = 1e-6 * problem.costs.correct;
        search.run(Effort { beliefs_max: 1_000, tolerance, certify: None });
        let lower = search.root().value.lower;
        let mut before = f64::INFINITY;
        for (beliefs_max, enough) in
            [(0, lower), (10, lower), (300, lower), (300, f64::NEG_INFINITY)]
        {
            let upper = easier.upper(beliefs_max, enough);
            assert!(lower <= upper + 1e-6, "{label}: {lower} above {upper}");
            assert!(upper <= before + 1e-9, "{label}: {upper} above {before}");
            before = upper;
        }
        // Previous results change the order and the extent of the search, not the bound.
        let afresh = Revealed::of(reduced, &problem.costs);
        let afresh = afresh.map_or(f64::NAN, |mut easier| easier.upper(100_000, f64::NEG_INFINITY));
        let again = easier.upper(100_000, f64::NEG_INFINITY);
        assert!((afresh - again).abs() < 1e-6, "{label}: {afresh} not {again}");
    });
}

/// No question improves on the value of learning the class, whatever it splits.
#[test]
fn no_question_beats_being_told_the_class() {
    let (seed, mut rng) = (83, Rng::new(83));
    for (name, costs) in Costs::PRESETS {
        let kind = |share, classes| told::Kind { share, classes };
        for (p_l, epsilon, kinds) in [
            (0.95, 0.01, vec![kind(1.0, 50)]),
            (0.8, 0.1, vec![kind(0.5, 7)]),
            (0.95, 0.01, vec![kind(0.5, 2), kind(1.0, 48)]),
            (0.99, 0.001, vec![kind(1.0, 400)]),
        ] {
            let params = Params { p_l, epsilon, ..Params::default() };
            let channel = channel::Channel::yes_no(params, &costs, costs.attribute_s);
            let told = told::Told::new(&costs, &channel, &kinds);
            let told::Kind { share, classes } = kinds[0];
            let Some(told) = told else { continue };
            let value = |x: f64| told.value(x, x.ln());
            for _ in 0..20_000 {
                let odds = (16.0 * rng.uniform() - 12.0).exp();
                let x = odds / (1.0 + odds);
                let p = x + (1.0 - x) * rng.uniform().powi(4);
                let split = told.split(p);
                let after = [channel.own, channel.other].into_iter().zip(split.heard);
                let after: f64 = after.map(|(l, heard)| l * value((x * l / heard).min(1.0))).sum();
                let asked = channel.price.pay(after) + split.compensation[0];
                let label = format!("seed {seed} {name} {params:?} x {x} p {p}");
                assert!(asked <= value(x) + 1e-6, "{label}: {asked} above {}", value(x));
                // Least is paid for the others if they are all alike; among those of its own kind
                // it is the same compensation.
                let others =
                    (1.0 - x) / x * told.compensation(((1.0 - x) / (classes - 1) as f64).ln());
                let picked = costs.pick_value(share) - others;
                assert!(kinds.len() > 1 || picked <= value(x) + 1e-6, "{label} picked");
                let another = told.compensation(x.ln()) - costs.wrong;
                assert!(another <= value(x) + 1e-6, "{label} another picked");
            }
        }
    }
}
