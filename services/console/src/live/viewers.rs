//! Live viewers and the messages that wait for each: bounded, the oldest gives way.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Arc;
use std::sync::{Mutex, MutexGuard, PoisonError};

use recording::channels::ChannelId;
use recording::live::Subscription;
use tokio::sync::Notify;

use crate::hub::ViewerId;

/// Most messages that wait for a viewer, and most bytes of them.
const WAITING_MAX: (usize, usize) = (1_024, 4 << 20);

/// A message of a channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// When it was sent, nanoseconds since 1970.
    pub at_ns: u64,
    pub data: Arc<[u8]>,
}

/// A message that is due to a viewer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Due {
    /// Number of the viewer's subscription.
    pub subscription: u32,
    pub message: Message,
}

/// The live viewers. The main loop publishes, the viewers' sockets take.
#[derive(Debug)]
pub struct Viewers {
    /// For each channel that can be subscribed to, whether its latest message is a state.
    channels: BTreeMap<ChannelId, bool>,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    viewers: BTreeMap<ViewerId, Viewer>,
    /// The latest message of each channel that is a state.
    latest: BTreeMap<ChannelId, Message>,
}

#[derive(Debug)]
struct Viewer {
    /// Number of the subscription to each channel.
    subscriptions: BTreeMap<ChannelId, u32>,
    waiting: VecDeque<(ChannelId, Message)>,
    bytes: usize,
    /// Messages lost since the last report.
    lost: u64,
    /// States that were lost, and that no later message in the queue replaces.
    stale: BTreeSet<ChannelId>,
    arrived: Arc<Notify>,
}

impl Viewers {
    /// Makes the table for these channels, each with whether its latest message is a state.
    pub fn new(channels: impl Iterator<Item = (ChannelId, bool)>) -> Self {
        Self { channels: channels.collect(), state: Mutex::default() }
    }

    /// Adds a viewer; returns the notifier of its messages.
    pub fn join(&self, viewer: ViewerId) -> Arc<Notify> {
        let arrived = Arc::new(Notify::new());
        let joined = Viewer {
            subscriptions: BTreeMap::new(),
            waiting: VecDeque::new(),
            bytes: 0,
            lost: 0,
            stale: BTreeSet::new(),
            arrived: Arc::clone(&arrived),
        };
        self.state().viewers.insert(viewer, joined);
        arrived
    }

    /// Removes a viewer with everything that waits for it.
    pub fn leave(&self, viewer: ViewerId) {
        self.state().viewers.remove(&viewer);
    }

    /// Returns the number of viewers.
    pub fn count(&self) -> usize {
        self.state().viewers.len()
    }

    /// Subscribes a viewer to a channel, and sends it the state of the channel.
    ///
    /// # Errors
    /// The channel does not exist, or the viewer is subscribed to it, or uses the number.
    pub fn subscribe(&self, viewer: ViewerId, wanted: Subscription) -> Result<(), String> {
        let (id, channel) = (wanted.id, wanted.channel());
        if !self.channels.contains_key(&channel) {
            return Err(format!("channel {} does not exist", wanted.channel_id));
        }
        let State { viewers, latest } = &mut *self.state();
        let Some(viewer) = viewers.get_mut(&viewer) else { return Ok(()) };
        if viewer.subscriptions.contains_key(&channel) {
            return Err(format!("channel {} is subscribed to already", wanted.channel_id));
        }
        if viewer.subscriptions.values().any(|known| *known == id) {
            return Err(format!("number {id} is another subscription's"));
        }
        viewer.subscriptions.insert(channel, id);
        if let Some(message) = latest.get(&channel) {
            viewer.push(channel, message.clone(), true);
        }
        Ok(())
    }

    /// Ends a subscription; pending messages are dropped.
    ///
    /// # Errors
    /// The viewer has no such subscription.
    pub fn unsubscribe(&self, viewer: ViewerId, id: u32) -> Result<(), String> {
        let state = &mut *self.state();
        let Some(viewer) = state.viewers.get_mut(&viewer) else { return Ok(()) };
        let found = viewer.subscriptions.iter().find(|(_, known)| **known == id);
        let channel = *found.ok_or_else(|| format!("subscription {id} does not exist"))?.0;
        viewer.subscriptions.remove(&channel);
        viewer.stale.remove(&channel);
        let Viewer { waiting, bytes, .. } = viewer;
        waiting.retain(|(of, message)| {
            let is_kept = *of != channel;
            *bytes -= if is_kept { 0 } else { message.data.len() };
            is_kept
        });
        Ok(())
    }

    /// Publishes a message, and keeps it if it is a state. Never waits for a viewer. Returns how
    /// many messages were lost by viewers that do not keep up.
    pub fn publish(&self, channel: ChannelId, at_ns: u64, data: &[u8]) -> u64 {
        let is_state = self.channels.get(&channel).is_some_and(|is_state| *is_state);
        let State { viewers, latest } = &mut *self.state();
        let mut subscribed =
            viewers.values_mut().filter(|it| it.subscriptions.contains_key(&channel)).peekable();
        if !is_state && subscribed.peek().is_none() {
            return 0;
        }
        let message = Message { at_ns, data: data.into() };
        let lost = subscribed.map(|viewer| viewer.push(channel, message.clone(), is_state)).sum();
        if is_state {
            latest.insert(channel, message);
        }
        lost
    }

    /// Forgets the states: nothing is read any more.
    pub fn clear(&self) {
        self.state().latest.clear();
    }

    /// Takes the next message that is due to a viewer.
    pub fn next(&self, viewer: ViewerId) -> Option<Due> {
        let State { viewers, latest } = &mut *self.state();
        let viewer = viewers.get_mut(&viewer)?;
        loop {
            let (channel, message) = match viewer.pop() {
                Some(next) => next,
                None => {
                    // One that has caught up gets the states that it has lost.
                    let channel = viewer.stale.pop_first()?;
                    let Some(message) = latest.get(&channel) else { continue };
                    (channel, message.clone())
                }
            };
            viewer.stale.remove(&channel);
            if let Some(subscription) = viewer.subscriptions.get(&channel) {
                return Some(Due { subscription: *subscription, message });
            }
        }
    }

    /// Takes the number of messages that a viewer has lost since the last call.
    pub fn take_lost(&self, viewer: ViewerId) -> u64 {
        let state = &mut *self.state();
        state.viewers.get_mut(&viewer).map_or(0, |viewer| std::mem::take(&mut viewer.lost))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // Every change leaves a consistent state.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Viewer {
    /// Adds a message; returns how many others had to give way.
    fn push(&mut self, channel: ChannelId, message: Message, is_state: bool) -> u64 {
        self.bytes += message.data.len();
        self.waiting.push_back((channel, message));
        let mut lost = 0;
        while self.waiting.len() > WAITING_MAX.0
            || (self.bytes > WAITING_MAX.1 && self.waiting.len() > 1)
        {
            let Some((dropped, _)) = self.pop() else { break };
            lost += 1;
            self.stale.insert(dropped);
        }
        // The added messages replace lost ones.
        if is_state {
            self.stale.remove(&channel);
        }
        self.lost += lost;
        self.arrived.notify_one();
        lost
    }

    fn pop(&mut self) -> Option<(ChannelId, Message)> {
        let next = self.waiting.pop_front()?;
        self.bytes -= next.1.data.len();
        Some(next)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STATE: ChannelId = ChannelId(0);
    const EVENTS: ChannelId = ChannelId(1);
    const ONE: ViewerId = ViewerId(1);

    fn viewers() -> Viewers {
        let viewers = Viewers::new([(STATE, true), (EVENTS, false)].into_iter());
        viewers.join(ONE);
        viewers
    }

    fn subscribe(viewers: &Viewers, id: u32, channel: ChannelId) -> Result<(), String> {
        viewers.subscribe(ONE, Subscription { id, channel_id: channel.0 as u64 })
    }

    fn taken(viewers: &Viewers) -> Vec<(u32, u64)> {
        std::iter::from_fn(|| viewers.next(ONE))
            .map(|due| (due.subscription, due.message.at_ns))
            .collect()
    }

    #[test]
    fn state_is_sent_again_to_one_who_subscribes_late() {
        let viewers = viewers();
        viewers.publish(STATE, 1, b"a");
        viewers.publish(STATE, 2, b"b");
        viewers.publish(EVENTS, 3, b"c");
        subscribe(&viewers, 7, STATE).unwrap();
        subscribe(&viewers, 8, EVENTS).unwrap();
        assert_eq!(taken(&viewers), [(7, 2)]);
        viewers.publish(EVENTS, 4, b"d");
        assert_eq!(taken(&viewers), [(8, 4)]);
        viewers.clear();
        viewers.unsubscribe(ONE, 7).unwrap();
        subscribe(&viewers, 7, STATE).unwrap();
        assert_eq!(taken(&viewers), []);
    }

    #[test]
    fn subscriptions_have_one_channel_and_one_number_each() {
        let viewers = viewers();
        subscribe(&viewers, 7, STATE).unwrap();
        assert!(subscribe(&viewers, 8, STATE).unwrap_err().contains("already"));
        assert!(subscribe(&viewers, 7, EVENTS).unwrap_err().contains("another"));
        assert!(subscribe(&viewers, 9, ChannelId(2)).unwrap_err().contains("does not exist"));
        assert!(viewers.unsubscribe(ONE, 9).is_err());
        viewers.publish(STATE, 1, b"a");
        viewers.unsubscribe(ONE, 7).unwrap();
        assert_eq!(taken(&viewers), [], "what waited is of the former subscription");
        subscribe(&viewers, 7, EVENTS).unwrap();
    }

    #[test]
    fn slow_viewer_loses_the_oldest_and_no_state_for_good() {
        let viewers = viewers();
        subscribe(&viewers, 7, STATE).unwrap();
        subscribe(&viewers, 8, EVENTS).unwrap();
        viewers.publish(STATE, 1, b"a");
        for at in 2..5_000 {
            viewers.publish(EVENTS, at, b"d");
        }
        assert_eq!(viewers.take_lost(ONE), 4_999 - WAITING_MAX.0 as u64);
        let found = taken(&viewers);
        assert_eq!(found.len(), WAITING_MAX.0 + 1);
        assert_eq!(found[WAITING_MAX.0 - 1..], [(8, 4_999), (7, 1)]);
        assert_eq!(taken(&viewers), [], "once");
        viewers.leave(ONE);
        assert_eq!((viewers.next(ONE), viewers.count()), (None, 0));
    }

    #[test]
    fn bytes_that_wait_are_bounded() {
        let viewers = viewers();
        subscribe(&viewers, 8, EVENTS).unwrap();
        let large = vec![0; WAITING_MAX.1 / 2];
        for at in 0..10 {
            viewers.publish(EVENTS, at, &large);
        }
        assert_eq!(taken(&viewers), [(8, 8), (8, 9)]);
        viewers.publish(EVENTS, 10, &vec![0; 2 * WAITING_MAX.1]);
        assert_eq!(taken(&viewers), [(8, 10)], "one that is larger is sent alone");
    }
}
