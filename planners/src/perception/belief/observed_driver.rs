//! The belief about one observed driver.

use super::evidence::Evidence;
use super::hypotheses::{Continuing, WishfulHumans};
use super::likelihood::{ObservedMotion, Spread};
use super::settings::Settings;
use super::wishes::wishes;
use crate::drivers::drive::Drive;
use crate::drivers::idm::{self, Idm};
use crate::perception::sensing::Sighting;
use crate::prediction::steadily_along;
use crate::scene::driver_estimate::DriverModel;
use crate::scene::inferred_futures::{Alternative, InferredFutures};
use crate::{Agent, Bicycle, Input, Scene, State, Trajectory};

/// Prior probability that a driver is like our human driver, of whatever style and with whatever wish.
const HUMAN_PRIOR: f64 = 0.9;
/// Problems posed per sighting after which no further wish is looked at.
const MAX_PROBLEMS: usize = 6;
/// Speed below which the steering of a vehicle is not read from its motion, for 1/10 scale cars \[m/s\].
const MIN_STEERED_SPEED_MPS: f64 = 0.05;

/// One observed vehicle with what is believed of its driver.
#[derive(Clone, Debug)]
pub(super) struct ObservedDriver {
    pub name: String,
    settings: Settings,
    humans: Vec<WishfulHumans>,
    idm: Idm,
    idm_plan: Option<Trajectory>,
    unknown_plan: Option<Trajectory>,
    evidence: Evidence,
    /// The hypothesis whose plan is the prediction: the kind of driver and the number of the wish.
    pub model: DriverModel,
    wish: usize,
    /// The wish at which the next look at unlikely ones begins.
    next_wish: usize,
    /// The sighting of which the plans are; none while it is out of sight.
    pub last: Option<Sighting>,
    /// What it did last, as far as is known.
    pub input: Input,
}

impl ObservedDriver {
    /// A driver who is seen for the first time; `scene` is that of the observer.
    pub(super) fn new(observed: &Agent, sighting: &Sighting, scene: &Scene, settings: Settings) -> ObservedDriver {
        let wishes = wishes(observed, &sighting.estimate, scene);
        let styles = settings.style_priors();
        let mut priors: Vec<f64> =
            wishes.iter().flat_map(|wish| styles.map(|style| HUMAN_PRIOR * style * wish.prior)).collect();
        priors.extend([0.5 * (1.0 - HUMAN_PRIOR); 2]);
        let mut driver = ObservedDriver {
            name: observed.name.clone(),
            settings,
            humans: wishes.into_iter().map(WishfulHumans::new).collect(),
            idm: Idm::new(idm_settings(observed)),
            idm_plan: None,
            unknown_plan: None,
            evidence: Evidence::new(&priors),
            model: DriverModel::Unknown,
            wish: 0,
            next_wish: 0,
            last: None,
            input: Input::default(),
        };
        driver.model = driver.likeliest();
        driver
    }

    /// Out of sight: what was believed stays, plans and position are gone.
    pub(super) fn lose_sight(&mut self) {
        self.last = None;
    }

    /// Learns from a new sighting.
    pub(super) fn observe(&mut self, observed: &Agent, sighting: &Sighting, step_s: f64) {
        let Some(last) = self.last else { return };
        let ticks = sighting.tick - last.tick;
        self.input = self.applied_input(observed, &last, sighting, step_s * ticks as f64);
        if self.settings.learning {
            let found = self.log_likelihoods(observed, &last, sighting, step_s);
            self.evidence.observe(&found, self.settings.forgetting, self.settings.floor);
        }
        self.choose();
    }

    /// The log-likelihood of each hypothesis: the humans wish by wish, then IDM, then none of these.
    fn log_likelihoods(&self, observed: &Agent, last: &Sighting, sighting: &Sighting, step_s: f64) -> Vec<Option<f64>> {
        let ticks = sighting.tick - last.tick;
        let motion = ObservedMotion {
            end: sighting.measured,
            duration_s: step_s * ticks as f64,
            wheelbase_m: observed.body.wheelbase_m(),
            speed_sd_mps: libm::hypot(sighting.measured_speed_sd_mps, last.speed_sd_mps),
            heading_sd_rad: libm::hypot(sighting.measured_heading_sd_rad, last.heading_sd_rad),
        };
        let Settings { acceleration_sd_mps2, steering_sd_rad, .. } = self.settings;
        let spread = Spread { acceleration_mps2: acceleration_sd_mps2, steering_rad: steering_sd_rad };
        let of = |plan: Option<&Trajectory>, spread: Spread| {
            Some(motion.log_likelihood(plan?.states.get(ticks)?, spread)).filter(|found| found.is_finite())
        };
        let humans = self.humans.iter().flat_map(|humans| &humans.plans).map(|plan| of(plan.as_ref(), spread));
        let others = [of(self.idm_plan.as_ref(), spread), of(self.unknown_plan.as_ref(), spread.of_unknown())];
        humans.chain(others).collect()
    }

    /// What it did between two sightings: read off its motion where that is exact, else what was expected of it.
    fn applied_input(&self, observed: &Agent, last: &Sighting, now: &Sighting, duration_s: f64) -> Input {
        if now.measured_speed_sd_mps > 0.0 || now.measured_heading_sd_rad > 0.0 {
            let expected = self.selected_plan().and_then(|plan| plan.inputs.first().copied());
            return expected.unwrap_or_default();
        }
        let (before, after, model) = (last.estimate, now.estimate, Bicycle::new(&observed.body, duration_s));
        let acceleration_mps2 = (after.speed_mps - before.speed_mps) / duration_s;
        let moves = before.speed_mps > MIN_STEERED_SPEED_MPS * observed.body.time_ratio();
        let steering_rad = if moves {
            let turn = (after.heading_rad - before.heading_rad) / (duration_s * before.speed_mps);
            let slip_rad = libm::asin((model.rear_axle_m() * turn).clamp(-0.9, 0.9));
            libm::atan(libm::tan(slip_rad) * model.wheelbase_m() / model.rear_axle_m())
        } else {
            0.0
        };
        let most_rad = observed.limits.steering_max_rad;
        Input { acceleration_mps2, steering_rad: steering_rad.clamp(-most_rad, most_rad) }
    }

    /// Probabilities of the kinds of driver.
    pub(super) fn probabilities(&self) -> [f64; 5] {
        let all = self.evidence.probabilities();
        let (humans, others) = all.split_at(3 * self.humans.len());
        let mut kinds = [0.0, 0.0, 0.0, others[0], others[1]];
        for (index, p) in humans.iter().enumerate() {
            kinds[index % 3] += p;
        }
        kinds
    }

    fn likeliest(&self) -> DriverModel {
        let probabilities = self.probabilities();
        let better = |a: &DriverModel, b: &DriverModel| {
            let [p_a, p_b] = [a, b].map(|kind| probabilities[kind.index()]);
            p_a.total_cmp(&p_b).then(b.index().cmp(&a.index()))
        };
        DriverModel::ALL.into_iter().max_by(better).unwrap_or(DriverModel::Unknown)
    }

    /// Chooses the hypothesis to plan with: the likeliest one, if it is by the hysteresis likelier than the one chosen before.
    fn choose(&mut self) {
        let hysteresis = self.settings.hysteresis;
        let kinds = self.probabilities();
        let likeliest = self.likeliest();
        if kinds[likeliest.index()] > hysteresis * kinds[self.model.index()] {
            self.model = likeliest;
        }
        let masses = self.wish_masses();
        let best = (0..masses.len()).rev().max_by(|a, b| masses[*a].total_cmp(&masses[*b])).unwrap_or(0);
        if masses[best] > hysteresis * masses[self.wish] {
            self.wish = best;
        }
    }

    /// The probabilities of the wishes: with the style that is chosen, or with any where none is.
    fn wish_masses(&self) -> Vec<f64> {
        let all = self.evidence.probabilities();
        let style = (self.model.index() < 3).then_some(self.model.index());
        let mass = |styles: &[f64]| style.map_or_else(|| styles.iter().sum(), |style| styles[style]);
        all[..3 * self.humans.len()].chunks(3).map(mass).collect()
    }

    /// Plans for the hypotheses in a scene that the observed driver sees: for the wish that is chosen, for the likeliest other
    /// one, and in turn for the rest until enough problems have been posed.
    pub(super) fn plan(&mut self, scene: &mut Scene, sighting: &Sighting) {
        self.humans.iter_mut().for_each(WishfulHumans::forget_plans);
        let masses = self.wish_masses();
        let others = (0..masses.len()).filter(|wish| *wish != self.wish);
        let likely = others.rev().max_by(|a, b| masses[*a].total_cmp(&masses[*b]));
        let mut problems = self.humans[self.wish].plan(scene);
        if let Some(likely) = likely {
            problems += self.humans[likely].plan(scene);
        }
        for _ in 0..self.humans.len() {
            if problems >= MAX_PROBLEMS {
                break;
            }
            let wish = self.next_wish;
            self.next_wish = (wish + 1) % self.humans.len();
            if wish != self.wish && Some(wish) != likely {
                problems += self.humans[wish].plan(scene);
            }
        }
        scene.goal = self.humans[0].goal();
        self.idm_plan = self.idm.plan(scene, &InferredFutures::default()).ok().map(|plan| plan.trajectory);
        self.unknown_plan = Some(steady(scene));
        self.last = Some(*sighting);
    }

    /// The plans that are known as of the last sighting, as `motion` makes them present, with their probabilities, which sum to 1.
    pub(super) fn alternatives(&self, motion: impl Fn(&Trajectory) -> Trajectory) -> Vec<Alternative> {
        let humans = self.humans.iter().flat_map(|humans| &humans.plans).map(Option::as_ref);
        let plans = humans.chain([self.idm_plan.as_ref(), self.unknown_plan.as_ref()]);
        let known = plans.zip(self.evidence.probabilities()).enumerate();
        let known = known.filter_map(|(hypothesis, (plan, probability))| Some((hypothesis, plan?, probability)));
        let known: Vec<(usize, &Trajectory, f64)> = known.collect();
        let mass: f64 = known.iter().map(|(.., probability)| probability).sum();
        let alternative = |(hypothesis, plan, probability): (usize, &Trajectory, f64)| Alternative {
            hypothesis,
            probability: probability / mass,
            prediction: motion(plan),
        };
        known.into_iter().map(alternative).collect()
    }

    /// The plan of the chosen hypothesis as of the last sighting.
    pub(super) fn selected_plan(&self) -> Option<&Trajectory> {
        let plan = match self.model {
            DriverModel::Tough | DriverModel::Normal | DriverModel::Nice => {
                self.humans[self.wish].plans[self.model.index()].as_ref()
            }
            DriverModel::Idm => self.idm_plan.as_ref(),
            DriverModel::Unknown => None,
        };
        plan.or(self.unknown_plan.as_ref())
    }

    /// The chosen hypothesis as it goes on.
    pub(super) fn continuing(&self) -> Continuing {
        let humans = &self.humans[self.wish];
        match self.model {
            DriverModel::Tough | DriverModel::Normal | DriverModel::Nice => {
                Continuing::Human(Box::new(humans.driver(self.model.index())), humans.goal())
            }
            DriverModel::Idm => Continuing::Idm(Box::new(self.idm.clone()), self.humans[0].goal()),
            DriverModel::Unknown => Continuing::Unknown,
        }
    }
}

/// The motion of the planning vehicle of a scene at constant velocity.
fn steady(scene: &Scene) -> Trajectory {
    steadily_along(&scene.ego.route, &scene.ego.body, &scene.ego.state, scene.horizon, scene.step_s)
}

/// The intelligent driver model for a vehicle of that size.
fn idm_settings(observed: &Agent) -> idm::Settings {
    let (settings, body) = (idm::Settings::default(), &observed.body);
    idm::Settings { headway_s: settings.headway_s * body.time_ratio(), gap_m: settings.gap_m * body.scale, ..settings }
}

/// Where a plan leads that was made some ticks ago, from the state in which the vehicle is.
pub(super) fn later(plan: &Trajectory, ticks: usize, state: &State) -> Trajectory {
    let mut later = (0..ticks).fold(plan.clone(), |plan, _| plan.shifted());
    if let Some(first) = later.states.first_mut() {
        *first = *state;
    }
    later
}
