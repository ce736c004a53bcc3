//! The secant method for a wrist that is nearly straight.

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
