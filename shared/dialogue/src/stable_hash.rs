//! A stable hash of numbers, for keys that are stored and for beliefs that are looked up.

/// Two independent mixing lanes: keys that differ collide with one chance in about 1e30.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StableHash128 {
    low: u64,
    high: u64,
}

impl Default for StableHash128 {
    fn default() -> Self {
        Self { low: 0x9e37_79b9_7f4a_7c15, high: 0xc2b2_ae3d_27d4_eb4f }
    }
}

impl StableHash128 {
    pub(crate) fn add(self, part: u64) -> Self {
        Self {
            low: (self.low ^ part).wrapping_mul(0xff51_afd7_ed55_8ccd).rotate_left(29),
            high: self.high.wrapping_add(part).wrapping_mul(0xc4ce_b9fe_1a85_ec53).rotate_left(31),
        }
    }

    pub(crate) fn wide(self) -> u128 {
        (u128::from(self.high) << 64) | u128::from(self.low)
    }

    pub(crate) fn narrow(self) -> u64 {
        self.low ^ self.high
    }
}
