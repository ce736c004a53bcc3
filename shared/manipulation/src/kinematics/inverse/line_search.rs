//! Golden-section search, and the secant method for a wrist that is nearly straight.

/// Golden section: narrows `(a, b)` towards the least value of `f` with `looks` evaluations; ends early where it
/// is 0, or where it cannot become 0 any more because it falls by at most `steepest` per unit. The
/// caller keeps what `f` saw.
pub(crate) fn narrow(
    (mut a, mut b): (f64, f64),
    looks: usize,
    steepest: f64,
    mut f: impl FnMut(f64) -> f64,
) {
    const SHARE: f64 = 0.618_033_988_749_894_8;
    let (mut c, mut d) = (b - SHARE * (b - a), a + SHARE * (b - a));
    let (mut at_c, mut at_d) = (f(c), f(d));
    for _ in 2..looks {
        let least = at_c.min(at_d);
        if least == 0.0 || least.is_finite() && least > steepest * (b - a) {
            break;
        }
        if at_c < at_d {
            (b, d, at_d) = (d, c, at_c);
            c = b - SHARE * (b - a);
            at_c = f(c);
        } else {
            (a, c, at_c) = (c, d, at_d);
            d = a + SHARE * (b - a);
            at_d = f(d);
        }
    }
}

/// The secant method on the angle between a wrist offset and the one that it leads to.
#[derive(Default)]
pub(crate) struct Secant {
    /// The last turn of the offset and the angle before it, radians; 0 at first.
    turned: f64,
    before: f64,
}

impl Secant {
    /// The greatest turn of the offset in one round, radians.
    const TURN_MAX: f64 = 0.7;

    /// Returns a better offset than `offset`, which leads to `next`.
    pub(crate) fn improve(&mut self, offset: (f64, f64), next: (f64, f64)) -> (f64, f64) {
        let (x, y) = offset;
        let ahead = (x * next.1 - y * next.0).atan2(x * next.0 + y * next.1);
        let slope = (ahead - self.before) / self.turned;
        let turn = if self.turned != 0.0 && slope.abs() > 1e-2 { -ahead / slope } else { ahead };
        self.turned = turn.clamp(-Self::TURN_MAX, Self::TURN_MAX);
        self.before = ahead;
        let (s, c) = self.turned.sin_cos();
        (c * x - s * y, s * x + c * y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_minimum_is_closed_in_on() {
        let mut best = (f64::INFINITY, 0.0);
        let mut looks = 0;
        narrow((-1.0, 3.0), 30, f64::INFINITY, |x| {
            looks += 1;
            let y = (x - 0.7).abs() + 0.5;
            if y < best.0 {
                best = (y, x);
            }
            y
        });
        assert_eq!(looks, 30);
        assert!((best.1 - 0.7).abs() < 1e-5, "{best:?}");
    }

    #[test]
    fn a_zero_and_a_hopeless_range_end_the_search() {
        for (f, steepest, most) in
            [((|_| 0.0) as fn(f64) -> f64, f64::INFINITY, 2), (|x| 0.5 + x, 1.0, 5)]
        {
            let mut looks = 0;
            narrow((0.0, 1.0), 30, steepest, |x| {
                looks += 1;
                f(x)
            });
            assert!(looks <= most, "{looks}");
        }
    }
}
