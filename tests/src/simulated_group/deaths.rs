//! Deaths of services, of the client and of the whole group, and what starts again after them.

use dialogue::Model;
use messages::ActKind;

use super::{Inboxes, SimulatedGroup};

impl SimulatedGroup {
    /// Restarts all services with the other scene, each after a delay of its own: what one of them
    /// sends may reach another that still has the former.
    pub(super) fn change_the_scene(&mut self) {
        let is_time = self.view.decision == ActKind::Ask && self.policy.is_up();
        let Some(to) = self.change.take_if(|_| is_time) else { return };
        self.log("the scene changes");
        self.speech.replace::<speech::shell::SpeechProgram>(&to);
        self.grounding.replace::<grounding::shell::GroundingProgram>(&to);
        self.policy.replace::<policy::shell::PolicyProgram>(&to);
        if let Some(arm) = &mut self.arm {
            arm.replace::<arm::shell::ArmProgram<drivers::Shipped>>(&to);
        }
        self.restarts = std::array::from_fn(|_| Some(self.now + self.faults.downtime()));
        let wanted = self.user.wanted().map(|object| &self.scene().object(object).name);
        let wanted = wanted.and_then(|name| to.scene.object_named(name));
        self.user.want(Some(wanted.expect("the wanted object stays")));
        self.model = Model::new(&to.scene, to.dialogue.params);
        let records = self.policy.journal().len();
        self.before = Some((std::mem::replace(&mut self.settings, to), records));
    }

    /// The supervisor dies: every service follows it, and the client finds no group. The person
    /// starts all of it again.
    pub(super) fn kill_everything(&mut self) {
        if !self.faults.group_dies(self.now) {
            return;
        }
        self.log("the group dies");
        self.speech.kill();
        self.grounding.kill();
        self.policy.kill();
        if let Some(arm) = &mut self.arm {
            arm.kill();
        }
        self.inboxes = Inboxes::default();
        let up = self.now + self.faults.client_downtime();
        self.restarts = std::array::from_fn(|_| Some(up + self.faults.downtime()));
        if let Some(client) = &mut self.client {
            (client.arrived, client.history) = Default::default();
            client.kill(up + self.faults.client_downtime());
        }
    }

    pub(super) fn restart(&mut self) {
        let now = self.now;
        let [speech, grounding, policy, arm] =
            self.restarts.each_mut().map(|at| at.take_if(|at| *at <= now).is_some());
        if speech {
            let outputs = self.speech.start(now, &mut self.faults);
            self.saying = None;
            if let Some(client) = &mut self.client {
                client.forget_speech();
            }
            self.route_speech(outputs);
        }
        if grounding {
            let outputs = self.grounding.start(now, &mut self.faults);
            self.route_grounding(outputs);
        }
        if policy {
            let outputs = self.policy.start(now, &mut self.faults);
            self.route_policy(outputs);
        }
        if let Some(host) = self.arm.as_mut().filter(|_| arm) {
            let outputs = host.start(now, &mut self.faults);
            self.route_arm(outputs);
        }
    }

    /// Schedules the restart of a process that has died in its pass.
    pub(super) fn note_death(&mut self, which: usize, is_up: bool, name: &str) {
        if !is_up && self.restarts[which].is_none() {
            self.restarts[which] = Some(self.now + self.faults.downtime());
            self.log(format_args!("{name} dies"));
        }
    }

    /// The speech service dies before it hears of a new question.
    pub(super) fn die_at_question(&mut self, prompt: u64) {
        let is_new = self.client.as_ref().is_some_and(|client| client.is_new(prompt));
        if self.dies_at_questions && is_new && self.restarts[0].is_none() {
            self.speech.kill();
            self.inboxes.speech.clear();
            self.restarts[0] = Some(self.now + self.faults.downtime());
            self.log("speech dies");
        }
    }
}
