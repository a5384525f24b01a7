//! Random light, heavy and mixed buildings, and days in them.

use interplay_building::comfort::{Setpoints, Targets};
use interplay_building::control::{ControlError, Controller, DayRecord, Disturbance};
use interplay_building::day::{Surroundings, run_day};
use interplay_building::discretise::Model;
use interplay_building::network::{AMBIENT, Network, Wall, Zone};
use interplay_building::occupancy::Occupancy;
use interplay_building::weather::{Climate, ErrorLevel, Forecast};
use interplay_common::random::Random;

const STEP_S: f64 = 1800.0;
const STEPS: usize = 48;

/// How much heat the walls of a building store.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Construction {
    /// None.
    Light,
    /// All of them: 3000 to 10,000 kJ/K outdoors, 1000 to 5000 between rooms.
    Heavy,
    /// Half of them.
    Mixed,
}

pub struct OrdinaryBuilding {
    pub construction: Construction,
    pub model: Model,
    pub targets: Targets,
    /// Forecast and reality of a day.
    pub day: (Disturbance, Disturbance),
}

/// What became of a design on a building: the cost of each day and how many of them repeated the one before, or why the design
/// was refused at the start.
pub type DesignOutcome = Result<(Vec<f64>, usize), ControlError>;

impl OrdinaryBuilding {
    /// A building of 2 to 6 rooms.
    pub fn new(seed: u64) -> Self {
        let mut random = Random::new(seed, 21);
        let construction = [Construction::Light, Construction::Heavy, Construction::Mixed][seed as usize % 3];
        let count = 2 + (seed as usize * 7) % 5;
        let name = |zone: usize| format!("z{zone}");
        let (mut zones, mut walls) = (Vec::new(), Vec::new());
        let stores = |random: &mut Random| match construction {
            Construction::Light => false,
            Construction::Heavy => true,
            Construction::Mixed => random.chance(0.5),
        };
        for zone in 0..count {
            let capacity_kj_per_k = random.uniform(300.0, 2000.0);
            zones.push(Zone { capacity_kj_per_k, limit_kw: random.uniform(1.0, 3.0), ..Zone::named(name(zone)) });
            let outer = Wall::new(name(zone), AMBIENT, random.uniform(10.0, 50.0));
            let capacity_kj_per_k = random.uniform(3000.0, 10_000.0);
            walls.push(if stores(&mut random) { outer.with_capacity_kj_per_k(capacity_kj_per_k) } else { outer });
            if zone > 0 {
                let before = random.uniform(0.0, zone as f64) as usize;
                let inner = Wall::new(name(before), name(zone), random.uniform(15.0, 80.0));
                let capacity_kj_per_k = random.uniform(1000.0, 5000.0);
                walls.push(if stores(&mut random) { inner.with_capacity_kj_per_k(capacity_kj_per_k) } else { inner });
            }
        }
        let network = Network::new(&zones, &walls).expect("valid by construction");
        let model = Model::exact(&network, STEP_S).expect("a valid step");
        let setpoints = Setpoints {
            occupied_c: (0..count).map(|_| random.uniform(22.0, 25.0)).collect(),
            occupied_weight: 2.0,
            ..Setpoints::default()
        };
        let targets = setpoints.targets(count, STEP_S, STEPS).expect("valid");
        let forecast = Forecast::Uncertain { level: ErrorLevel::Medium };
        let (weather, people) = (Climate::default().weather(seed, 1), Occupancy::default().people(count, seed));
        let surroundings = Surroundings::new(weather, (forecast, seed), people, &network);
        let day = (surroundings.forecast(&model, STEPS, 0), surroundings.actual(&model, STEPS, 0));
        Self { construction, model, targets, day }
    }

    /// The same day some times over, which a controller learns to know; the forecast is wrong in the same way each day.
    pub fn run(&self, controller: Controller, days: usize) -> DesignOutcome {
        let mut controller = controller.controller(&self.model, STEPS)?;
        let mut temperatures_c = vec![27.0; self.model.network().node_count()];
        let mut costs = Vec::new();
        let mut fallbacks = 0;
        for _ in 0..days {
            let record: DayRecord =
                run_day(&self.model, &mut temperatures_c, &mut *controller, &self.targets, &self.day.0, &self.day.1)?;
            costs.push(self.targets.cost(&record.temperatures_c, &record.heat_kw));
            fallbacks = controller.design().fallbacks;
        }
        Ok((costs, fallbacks))
    }
}
