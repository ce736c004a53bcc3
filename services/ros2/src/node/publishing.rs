//! What the group publishes, for ROS.

use super::Node;
use crate::clock::SystemClock;
use crate::objects;
use crate::types::Text;
use config::Settings;
use service::view::{ArmView, HearingView, Speaker, View, drain, quiet};
use service::{Span, Time};

/// Shortest interval between two publications of the objects or of the state.
const SHOW_EVERY: Span = Span::from_ms(100);

impl Node {
    /// Takes in what the group has published, and passes on what is not a state.
    pub(super) fn take_in(&mut self) {
        let clock = SystemClock::now();
        for states in drain(&self.group.joints) {
            let state = self.names.convert(&states, clock.ros(Time(states.at_ns)));
            self.dds.joint_states.publish(state, &mut self.counters.dropped);
        }
        let mut arrived = self.group.latest.take();
        for receipt in &arrived.receipts {
            if let Some((speaking, answer)) = self.waiting.on_receipt(receipt) {
                self.on_answer(speaking, answer);
            }
        }
        self.latest.update(&arrived);
        if let Some(scene) = arrived.scene.take() {
            self.scene = scene;
            self.objects = None;
        }
        if arrived.view.as_ref().is_some_and(|view| view.scene_key != self.scene.key())
            && let Ok(settings) = Settings::load_snapshot(&self.paths.run())
        {
            self.scene = self.group.latest.set_scene(settings.scene);
        }
        for (speaker, data) in self.lines.take_in(&self.latest, &arrived.receipts) {
            let outlet = match speaker {
                // One that began before this start was published then.
                Speaker::Robot if Time(self.latest.presented.started_ns) >= self.began => {
                    &self.dds.say
                }
                Speaker::Person => &self.dds.heard,
                Speaker::Robot | Speaker::Unmeant | Speaker::System => continue,
            };
            outlet.publish(Text { data }, &mut self.counters.dropped);
        }
        if let Some(world) = quiet(self.group.worlds.latest()) {
            let located = objects::located(&self.group.latest, &world);
            let frames = objects::frames(&self.scene, &located, clock.ros(Time(world.at_ns)));
            self.dds.tf.publish(frames, &mut self.counters.dropped);
            self.world = Some(world);
        }
    }

    /// Publishes objects and state, where they have changed.
    pub(super) fn show(&mut self, now: Time) {
        if now < self.shown + SHOW_EVERY {
            return;
        }
        self.shown = now;
        let belief = self.latest.view.as_ref().map_or(&[][..], |view| &view.belief);
        if let Some(world) = &self.world {
            let world = objects::located(&self.group.latest, world);
            let is_shown = self.objects.as_ref().is_some_and(|(before, shown_belief)| {
                before.objects == world.objects && shown_belief == belief
            });
            if !is_shown {
                let markers = objects::markers(&self.scene, &world, belief);
                self.dds.objects.publish(markers, &mut self.counters.dropped);
                self.objects = Some((world, belief.to_vec()));
            }
        }
        let state = self.state_text();
        if state != self.state {
            self.dds.state.publish(Text { data: state.clone() }, &mut self.counters.dropped);
            self.state = state;
        }
    }

    /// The state as `whichone watch --json` prints it.
    pub(super) fn state_text(&self) -> String {
        let Self { scene, latest, .. } = self;
        let view = View {
            dialogue: latest.dialogue(scene),
            said: self.lines.said(),
            hearing: latest.hearing.as_ref().map(HearingView::new),
            arm: latest.arm.as_ref().map(|arm| ArmView::new(scene, arm)),
            group: self.status.as_ref().ok().map(Box::as_ref),
        };
        // Every view can be written.
        serde_json::to_string(&view).unwrap_or_default()
    }
}
