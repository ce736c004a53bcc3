//! The observation of a pointing gesture: the angular model of FETCH-POMDP (Whitney et al., 2017),
//! with a floor.
//!
//! A person who wants `D` points with probability `p_g`; the angle `θ` between the pointing ray and
//! the direction to `D`, both from the person's place, is normal with standard deviation `σ` and
//! mean 0 (it has no sign, so the density is the half of it twice). Taken alone that model would
//! rule objects out for ever: at `σ = 0.15` a gesture one radian off weighs `e^-22`, which no
//! dialogue ever makes up for. But people wave, and trackers fail. So with probability `λ` a
//! gesture is *stray* and says nothing about `D`, its angle uniform on `[0, π]`:
//!
//! `P(g | D) = p_g · ((1 − λ) · 2/(σ√(2π)) · e^(−θ²/2σ²) + λ/π)`
//!
//! The largest weight of a gesture for one object against another is then
//! `1 + (1 − λ)/λ · √(2π)/σ`: 318 with the defaults, some more than one answer (99) and far less
//! than two (9801). `p_g` is the same for every object and moves no belief; it makes the factor a
//! probability.

use vocabulary::gesture::{Direction, Gestures};

/// `ln P(g | D)` for every object; `objects` are the directions to them from the person. `ray` is
/// the pointing ray; `None` if no gesture was seen, which has probability `1 − p_g` for every
/// object.
///
/// An object without a direction (it has no place, or is not here at all) is pointed at in any
/// direction alike: angle uniform on `[0, π]`.
pub(crate) fn log_likelihood(
    model: &Gestures,
    ray: Option<Direction>,
    objects: &[Option<Direction>],
) -> Vec<f64> {
    let Some(ray) = ray else { return vec![(1.0 - model.p_g).ln(); objects.len()] };
    objects
        .iter()
        .map(|object| {
            let density = object.map_or(UNIFORM, |object| density(model, ray.angle(object)));
            (model.p_g * density).ln()
        })
        .collect()
}

/// Density of the angle between ray and wanted object, per radian.
fn density(model: &Gestures, theta: f64) -> f64 {
    let sigmas = theta / model.std_theta_rad;
    let peak = (2.0 / std::f64::consts::PI).sqrt() / model.std_theta_rad;
    (1.0 - model.stray) * peak * (-0.5 * sigmas * sigmas).exp() + model.stray * UNIFORM
}

/// Density of an angle that is uniform on `[0, π]`, per radian.
const UNIFORM: f64 = std::f64::consts::FRAC_1_PI;

#[cfg(test)]
mod tests;
