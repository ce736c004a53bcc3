//! A pointing gesture on the wire.

use crate::schema::wire_struct;
use crate::wire::WireError;
use iceoryx2::prelude::ZeroCopySend;

/// Farthest coordinate that anybody points at, metres. It keeps a mistyped number out.
pub const POINTED_AT_MAX_M: f64 = 100.0;

wire_struct! {
    /// A pointing gesture, or none.
    WireGesture = "Gesture" {
        /// The point that the person points at, metres, frame `base`: x, y, z.
        target_m: [f64; 3],
        /// 1 where there is a gesture, else 0.
        present: u8,
        /// Zero.
        reserved: [u8; 7],
    }
}

impl From<Option<[f64; 3]>> for WireGesture {
    fn from(target_m: Option<[f64; 3]>) -> Self {
        let present = u8::from(target_m.is_some());
        Self { target_m: target_m.unwrap_or_default(), present, ..Self::default() }
    }
}

impl WireGesture {
    /// The point that is pointed at, metres, frame `base`; none without a gesture.
    ///
    /// # Errors
    /// A code or a coordinate that makes no sense.
    pub fn target_m(&self) -> Result<Option<[f64; 3]>, WireError> {
        match self.present {
            0 => Ok(None),
            1 if is_somewhere(&self.target_m) => Ok(Some(self.target_m)),
            1 => Err(WireError::new("pointing target with flag", 1)),
            other => Err(WireError::new("gesture flag", other.into())),
        }
    }
}

/// Returns whether a person can point there: finite, and not farther than [`POINTED_AT_MAX_M`].
pub fn is_somewhere(target_m: &[f64; 3]) -> bool {
    target_m.iter().all(|x| x.abs() <= POINTED_AT_MAX_M)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gesture_round_trips_and_invalid_targets_are_rejected() {
        for target in [None, Some([0.5, -0.25, 0.0]), Some([100.0, 0.0, -100.0])] {
            assert_eq!(WireGesture::from(target).target_m(), Ok(target));
        }
        for x in [f64::NAN, f64::INFINITY, 100.5] {
            assert!(WireGesture::from(Some([0.0, x, 0.0])).target_m().is_err());
        }
        assert!(WireGesture { present: 2, ..WireGesture::default() }.target_m().is_err());
    }
}
