//! Many dialogues about perceived objects, each beside the same dialogue about a certain scene.

use baxter::camera::{Camera, CameraSettings, Standing};
use config::Settings;
use messages::Outcome;
use perception::{Change, Detection};
use scene::{ObjectId, Perceived};
use service::{Span, Time};
use vocabulary::Rng;

use super::noisy::NoisyDetector;
use super::table::{Eye, FORGIVEN_M, Happening, TableTop, fits_best};
use super::{Faults, GroupUser, SimulatedGroup};
use crate::settings;

/// Results of many dialogues.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Dialogues.
    pub dialogues: u64,
    /// Those in which something appeared, moved or vanished.
    pub eventful: u64,
    /// Those in which the wanted object was delivered.
    pub right: u64,
    /// Those in which the wanted object fits best once all values of it are known: what answers without
    /// pointing can achieve at best, but for luck.
    pub at_best: u64,
    /// Closings of the fingers at a place that was off by more than a grasp forgives.
    pub beside: u64,
    /// Interactions with more than one delivery.
    pub twice: u64,
    /// Questions, in all.
    pub questions: u64,
    /// Questions of the same dialogues about the certain scene.
    pub questions_certain: u64,
    /// The greatest error of a place at which the fingers closed, metres.
    pub worst_m: f64,
    /// Logs of the dialogues that went wrong.
    pub stories: Vec<String>,
}

/// A camera with noise of 5 mm, a tenth of the objects missed, and qualities 80 to 99 % sure.
fn camera(seed: u64) -> CameraSettings {
    CameraSettings {
        rate_hz: 10.0,
        noise_m: 0.005,
        misses: 0.1,
        delay: Span::from_ms(150),
        sure: (0.8, 0.99),
        hidden_m: 0.15,
        seed,
    }
}

/// Holds dialogues about the shipped bowls under a simulated camera, half of them with something that
/// appears, moves or vanishes meanwhile. `mode` is `remote` or `present`: whether the robot may point.
pub fn perceive(mode: &str, dialogues: u64, seed: u64, faults: fn(u64) -> Faults) -> Tally {
    let certain = settings(&[("dialogue.mode", mode)]);
    // A camera follows what happens at the arm's own speed alone.
    let perceiving = settings(&[
        ("dialogue.mode", mode),
        ("group.perception.enabled", "true"),
        ("arm.time_scale", "1.0"),
    ]);
    let mut found = Tally::default();
    for number in 0..dialogues {
        let seed = seed.wrapping_mul(1_000_003).wrapping_add(number);
        let mut rng = Rng::new(seed);
        let wanted = rng.below(certain.scene.objects().len());
        let happening = if number % 2 == 0 { Happening::Nothing } else { draw(&mut rng, wanted) };
        let at = Time(0) + Span::from_s(2.0 + 8.0 * rng.uniform());
        let eye = Eye::camera(camera(seed));
        let group = converse(&perceiving, wanted, (happening, at), faults(seed), eye);
        let plain = SimulatedGroup::new(certain.clone(), GroupUser::typing(wanted), Faults::none());
        found.add(&group, happening, plain, seed);
    }
    found
}

/// Holds dialogues with users in another room about the shipped bowls, each seen by a noisy detector.
pub fn detect(dialogues: u64, seed: u64) -> Tally {
    let certain = settings(&[]);
    let perceiving = settings(&[("group.perception.enabled", "true"), ("arm.time_scale", "1.0")]);
    let mut found = Tally::default();
    for number in 0..dialogues {
        let seed = seed.wrapping_mul(1_000_003).wrapping_add(number);
        let wanted = (number % certain.scene.objects().len() as u64) as usize;
        let eye = Eye::Detector(NoisyDetector::new(seed));
        let nothing = (Happening::Nothing, Time(0));
        let group = converse(&perceiving, wanted, nothing, Faults::none(), eye);
        let plain = SimulatedGroup::new(certain.clone(), GroupUser::typing(wanted), Faults::none());
        found.add(&group, Happening::Nothing, plain, seed);
    }
    found
}

/// Returns the share of `draws` of the camera's errors in which the wanted one of the shipped bowls is the likeliest once
/// all values of it are known.
pub fn at_best(draws: u64, seed: u64) -> f64 {
    let file = settings(&[]).scene;
    let places = file.objects().iter().enumerate();
    let standing: Vec<Standing> = places
        .filter_map(|(object, it)| {
            it.placement.map(|it| Standing { object, xyz: it.xyz, yaw: it.yaw })
        })
        .collect();
    let is_best = |number: &u64| {
        let seed = seed.wrapping_mul(1_000_003).wrapping_add(*number);
        let wanted = ObjectId::from(Rng::new(seed).below(standing.len()));
        let mut camera =
            Camera::new(CameraSettings { misses: 0.0, delay: Span(0), ..camera(seed) });
        let looks = camera.look(&file, &standing, &[], Time(1));
        let Some(Change::Look(look)) = looks.into_iter().next().map(|it| it.change) else {
            return false;
        };
        let seen: Vec<Perceived> = (100..).zip(look.seen).map(perceived).collect();
        fits_best(&file, &seen, wanted)
    };
    (0..draws).filter(is_best).count() as f64 / draws as f64
}

/// The object of a detection.
fn perceived((number, seen): (u16, Detection)) -> Perceived {
    Perceived {
        number: ObjectId(number),
        name: number.to_string(),
        classes: seen.classes,
        attributes: seen.attributes,
        xyz: seen.xyz,
        yaw: seen.yaw,
        seen_by: Vec::new(),
        taken: false,
    }
}

fn draw(rng: &mut Rng, wanted: usize) -> Happening {
    let other = (wanted + 1 + rng.below(5)) % 6;
    let angle = std::f64::consts::TAU * rng.uniform();
    let far_m = 0.03 + 0.03 * rng.uniform();
    let by = [far_m * angle.cos(), far_m * angle.sin()];
    match rng.below(4) {
        0 => Happening::Appears(other),
        1 => Happening::Vanishes(other),
        2 => Happening::Moves(other, by),
        _ => Happening::Moves(wanted, by),
    }
}

/// Holds one dialogue with somebody who wants that object.
pub fn converse(
    settings: &Settings,
    wanted: usize,
    happening: (Happening, Time),
    faults: Faults,
    eye: Eye,
) -> SimulatedGroup {
    let mut group = before_eye(settings, wanted, happening, faults, eye);
    group.run();
    group
}

/// A group under the simulated camera before its dialogue.
pub fn before_camera(
    settings: &Settings,
    wanted: usize,
    happening: (Happening, Time),
    faults: Faults,
    seed: u64,
) -> SimulatedGroup {
    before_eye(settings, wanted, happening, faults, Eye::camera(camera(seed)))
}

fn before_eye(
    settings: &Settings,
    wanted: usize,
    happening: (Happening, Time),
    faults: Faults,
    eye: Eye,
) -> SimulatedGroup {
    let table = TableTop::new(&settings.scene, eye, happening);
    let user = GroupUser::typing(wanted);
    SimulatedGroup::new(settings.clone(), user, faults).with_table(table)
}

impl Tally {
    fn add(
        &mut self,
        group: &SimulatedGroup,
        happening: Happening,
        mut plain: SimulatedGroup,
        seed: u64,
    ) {
        plain.run();
        self.dialogues += 1;
        self.eventful += u64::from(happening != Happening::Nothing);
        let grasps = group.table.as_ref().map_or(&[][..], |table| &table.grasps);
        let wanted = group.user.wanted().map(ObjectId::index);
        let delivered = matches!(group.outcome(), Some((Outcome::Delivered, _)));
        let right = delivered && grasps.last().is_some_and(|(object, _)| *object == wanted);
        self.right += u64::from(right);
        let table = group.table.as_ref().zip(group.user.wanted());
        self.at_best += u64::from(table.is_some_and(|(table, wanted)| table.fits_best(wanted)));
        let beside = grasps.iter().filter(|(_, m)| *m > FORGIVEN_M).count() as u64;
        self.beside += beside;
        self.twice += u64::from(grasps.iter().filter(|(object, _)| object.is_some()).count() > 1);
        self.worst_m = grasps.iter().map(|(_, m)| *m).fold(self.worst_m, f64::max);
        self.questions += u64::from(group.questions());
        self.questions_certain += u64::from(plain.questions());
        if !right || beside > 0 {
            let story = group.story();
            let what = format!("seed {seed}, wanted {wanted:?}, {happening:?}, grasps {grasps:?}");
            self.stories.push(format!("{what}\n{story}"));
        }
    }
}
