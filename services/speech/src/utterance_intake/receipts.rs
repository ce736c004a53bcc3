//! Receipts that were sent, so that a repeated request gets the same ones.

use std::collections::VecDeque;

use messages::{Receipt, RequestKey};

use super::push_bounded;
use crate::{Fx, Out};

/// The latest receipts.
#[derive(Default)]
pub(super) struct Receipts {
    sent: VecDeque<Receipt>,
}

impl Receipts {
    pub(super) fn record(&mut self, receipt: Receipt) {
        push_bounded(&mut self.sent, receipt);
    }

    /// Publishes the receipts of a request again. Returns `false` unless it has all of them.
    pub(super) fn repeat(&self, key: RequestKey, fx: &mut Fx) -> bool {
        let receipts = || self.sent.iter().filter(|receipt| receipt.request() == key);
        let segments = receipts().next().map_or(u32::MAX, |receipt| receipt.segments);
        if receipts().count() < segments as usize {
            return false;
        }
        receipts().for_each(|receipt| fx.publish(Out::Receipt(Box::new(*receipt))));
        true
    }
}
