//! A stop that is said is an order that outlives this process.

use super::*;

impl Speech {
    /// A new incarnation, from the records.
    fn restart(&mut self) -> Outputs {
        self.node = SpeechNode::recover(Self::config(), self.records.clone()).unwrap();
        self.on(Event::Started)
    }

    fn on(&mut self, event: Event<In<'_>>) -> Outputs {
        let mut effects = Effects::default();
        self.node.on(event, self.now, &mut effects);
        self.records.extend(effects.take_records());
        Outputs(effects.take_outputs())
    }
}

impl Outputs {
    fn stop(&self) -> Option<Time> {
        self.find(|out| if let Out::Stop(given) = out { Some(*given) } else { None })
    }
}

#[test]
fn stop_is_given_again_after_a_restart_until_the_arm_has_carried_it_out() {
    let mut speech = Speech::new();
    speech.type_in(1.0, "stop");
    let given = speech.now;
    speech.now = speech.now + Span::from_s(2.0);
    assert_eq!(
        speech.restart().stop(),
        Some(given),
        "the order's own time: a later release counts"
    );
    speech.take(0.1, In::StopSettled(given));
    assert_eq!(speech.restart().stop(), None);
}

#[test]
fn answer_to_an_earlier_order_settles_nothing() {
    let mut speech = Speech::new();
    speech.inject(1.0, 1, Sound::Text("stop".to_owned()));
    let first = speech.now;
    speech.inject(1.0, 2, Sound::Text("stop".to_owned()));
    let second = speech.now;
    speech.take(0.1, In::StopSettled(first));
    assert_eq!(speech.restart().stop(), Some(second));
}

#[test]
fn repeated_request_orders_one_stop() {
    let mut speech = Speech::before_mark();
    let text = || Sound::Text("stop".to_owned());
    assert!(speech.inject(1.0, 1, text()).stops_motion(), "it waits for no policy");
    let given = speech.now;
    speech.take(0.1, In::StopSettled(given));
    assert!(!speech.inject(0.1, 1, text()).stops_motion(), "the client repeats it");
    speech.take(0.1, In::Mark(AppliedMark::default()));
    let accepted = speech.inject(0.1, 1, text());
    assert!(accepted.receipt().is_some() && !accepted.stops_motion());
}

#[test]
fn order_from_before_a_restart_of_the_machine_is_given_anew() {
    let mut speech = Speech::new();
    speech.type_in(100.0, "stop");
    speech.now = Time(1);
    assert_eq!(speech.restart().stop(), Some(Time(1)));
}
