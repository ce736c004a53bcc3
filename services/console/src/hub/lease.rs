//! The lease of control: one viewer at a time, and how control changes hands.
//!
//! Pure: times come from outside.

use service::{Span, Time};

use super::ViewerId;

/// Time within which a page may reload without losing control.
pub const RELOAD: Span = Span::from_ms(15_000);

/// The holder of control, and the viewer who has requested it.
#[derive(Clone, Debug)]
pub struct Lease {
    holder: Option<Holder>,
    asked: Option<Asked>,
    handover: Span,
}

#[derive(Clone, Debug)]
struct Holder {
    viewer: ViewerId,
    session: String,
    /// Time at which the connection was lost.
    away: Option<Time>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Asked {
    by: ViewerId,
    until: Time,
}

/// The result of a request for control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taken {
    Granted,
    /// The operator is asked; it gets control then, if it is not kept.
    Asked(Time),
}

impl Lease {
    /// Makes a lease without holder; `handover` is how long an operator has to answer.
    pub fn new(handover: Span) -> Self {
        Self { holder: None, asked: None, handover }
    }

    /// Returns the operator, also while its page reloads.
    pub fn operator(&self) -> Option<ViewerId> {
        self.holder.as_ref().map(|holder| holder.viewer)
    }

    /// Returns whether the operator's page is gone; it may be reloading.
    pub fn is_away(&self) -> bool {
        self.holder.as_ref().is_some_and(|holder| holder.away.is_some())
    }

    /// Returns the viewer who has requested control, and when it gets it.
    pub fn asked(&self) -> Option<(ViewerId, Time)> {
        self.asked.map(|asked| (asked.by, asked.until))
    }

    pub fn holds(&self, viewer: ViewerId) -> bool {
        self.operator() == Some(viewer)
    }

    /// Admits a viewer. The session in control keeps it; a viewer that `wants` control gets a free
    /// lease.
    pub fn joined(&mut self, viewer: ViewerId, session: &str, wants: bool) {
        match &mut self.holder {
            Some(holder) if holder.session == session => {
                (holder.viewer, holder.away) = (viewer, None);
            }
            Some(_) => {}
            None if wants => self.grant(viewer, session),
            None => {}
        }
    }

    pub fn left(&mut self, viewer: ViewerId, now: Time) {
        if self.asked.is_some_and(|asked| asked.by == viewer) {
            self.asked = None;
        }
        if let Some(holder) = self.holder.as_mut().filter(|holder| holder.viewer == viewer) {
            holder.away = Some(now);
        }
    }

    pub fn take(
        &mut self,
        viewer: ViewerId,
        session: &str,
        now: Time,
    ) -> Result<Taken, &'static str> {
        if self.holder.is_none() {
            self.grant(viewer, session);
        }
        if self.holds(viewer) {
            return Ok(Taken::Granted);
        }
        match self.asked {
            Some(asked) if asked.by != viewer => {
                Err("another viewer has requested control; help: try again soon")
            }
            Some(asked) => Ok(Taken::Asked(asked.until)),
            None => {
                let until = now + self.handover;
                self.asked = Some(Asked { by: viewer, until });
                Ok(Taken::Asked(until))
            }
        }
    }

    /// The operator keeps control.
    pub fn keep(&mut self) {
        self.asked = None;
    }

    /// Returns when the lease changes next without a request.
    pub fn deadline(&self) -> Option<Time> {
        let away = self.holder.as_ref().and_then(|holder| holder.away).map(|away| away + RELOAD);
        self.asked.map(|asked| asked.until).into_iter().chain(away).min()
    }

    /// Advances the lease to `now`; returns whether it changed. `session` finds viewers' sessions.
    pub fn tick(&mut self, now: Time, session: impl Fn(ViewerId) -> Option<String>) -> bool {
        if self.deadline().is_none_or(|deadline| now < deadline) {
            return false;
        }
        self.holder = None;
        if let Some(asked) = self.asked.take()
            && let Some(session) = session(asked.by)
        {
            self.grant(asked.by, &session);
        }
        true
    }

    pub fn grant(&mut self, viewer: ViewerId, session: &str) {
        self.holder = Some(Holder { viewer, session: session.to_owned(), away: None });
        self.asked = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: ViewerId = ViewerId(1);
    const B: ViewerId = ViewerId(2);
    const C: ViewerId = ViewerId(3);

    fn at(s: u64) -> Time {
        Time(s * 1_000_000_000)
    }

    fn lease() -> Lease {
        let mut lease = Lease::new(Span::from_ms(10_000));
        lease.joined(A, "a", true);
        lease.joined(B, "b", true);
        lease
    }

    fn pass(lease: &mut Lease, s: u64) -> bool {
        lease.tick(at(s), |viewer| Some(format!("{viewer}")))
    }

    #[test]
    fn lease_is_granted_to_the_first_request() {
        let mut lease = Lease::new(Span::from_ms(10_000));
        lease.joined(C, "c", false);
        assert_eq!(lease.operator(), None, "a viewer is not made operator");
        lease.joined(A, "a", true);
        lease.joined(B, "b", true);
        assert!(lease.holds(A) && !lease.holds(B));
    }

    #[test]
    fn lease_survives_a_reload() {
        let mut lease = lease();
        lease.left(A, at(1));
        assert!(!pass(&mut lease, 15) && lease.is_away());
        lease.joined(C, "a", false);
        assert!(lease.holds(C) && !lease.is_away() && !pass(&mut lease, 60));
        // The old connection is noticed to be dead only after the new one has come.
        lease.left(A, at(61));
        assert!(lease.holds(C) && lease.deadline().is_none());
    }

    #[test]
    fn lease_ends_after_a_long_absence() {
        let mut lease = lease();
        lease.left(A, at(1));
        assert!(pass(&mut lease, 16));
        assert_eq!(lease.operator(), None);
        assert_eq!(lease.take(B, "b", at(17)), Ok(Taken::Granted));
    }

    #[test]
    fn lease_may_be_given_or_kept_on_request() {
        let mut lease = lease();
        assert_eq!(lease.take(B, "b", at(1)), Ok(Taken::Asked(at(11))));
        assert_eq!(
            lease.take(B, "b", at(5)),
            Ok(Taken::Asked(at(11))),
            "asking again changes nothing"
        );
        assert!(lease.take(C, "c", at(2)).is_err());
        lease.keep();
        assert!(lease.holds(A) && lease.asked().is_none());
        assert_eq!(lease.take(C, "c", at(3)), Ok(Taken::Asked(at(13))));
        lease.grant(C, "c");
        assert!(lease.holds(C) && lease.asked().is_none());
    }

    #[test]
    fn lease_changes_hands_without_an_answer() {
        let mut lease = lease();
        assert_eq!(lease.take(B, "b", at(1)), Ok(Taken::Asked(at(11))));
        assert!(!pass(&mut lease, 10));
        assert!(pass(&mut lease, 11));
        assert!(lease.holds(B) && lease.deadline().is_none());
    }

    #[test]
    fn lease_request_ends_with_its_viewer() {
        let mut lease = lease();
        assert!(lease.take(B, "b", at(1)).is_ok());
        lease.left(B, at(2));
        assert!(!pass(&mut lease, 12));
        assert!(lease.holds(A));
    }

    #[test]
    fn lease_of_an_absent_operator_ends_after_the_reload_time() {
        let mut lease = lease();
        lease.left(A, at(0));
        assert_eq!(lease.take(B, "b", at(9)), Ok(Taken::Asked(at(19))));
        assert!(pass(&mut lease, 15));
        assert!(lease.holds(B));
    }
}
