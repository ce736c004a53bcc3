//! The numbers of connections that the limit of descriptors allows.

/// Most connections other than pages.
const OTHERS_MAX: usize = 96;
/// Fewest connections besides those of pages: a browser opens six to load a page.
const OTHERS_MIN: usize = 16;
/// Descriptors that are kept for everything else.
const RESERVE: usize = 32;

/// Numbers of connections that a limit of descriptors allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Pages.
    pub viewers: usize,
    /// Connections besides.
    pub others: usize,
}

impl Limits {
    /// Returns the most descriptors used with a number of pages.
    pub fn most(viewers_max: usize) -> usize {
        RESERVE + viewers_max + OTHERS_MAX
    }

    /// Divides `free` descriptors: first those to load a page, then pages, then more connections.
    pub fn new(viewers_max: usize, free: usize) -> Self {
        let free = free.saturating_sub(RESERVE);
        let viewers = viewers_max.min(free.saturating_sub(OTHERS_MIN)).max(2);
        let others = free.saturating_sub(viewers).clamp(OTHERS_MIN, OTHERS_MAX);
        Self { viewers, others }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_fit_the_descriptors() {
        let limits = |viewers, others| Limits { viewers, others };
        assert_eq!(Limits::new(32, 100_000), limits(32, OTHERS_MAX));
        assert_eq!(Limits::new(32, 120), limits(32, 56));
        assert_eq!(Limits::new(32, 70), limits(22, OTHERS_MIN));
        assert_eq!(Limits::new(32, 0), limits(2, OTHERS_MIN));
        let most = Limits::most(32);
        assert_eq!(Limits::new(32, most), Limits::new(32, 100_000));
        assert_ne!(Limits::new(32, most - 1), Limits::new(32, most));
    }
}
