//! All state of a world as one typed list: the initial state of a scenario, a snapshot, and the contents of a world.
//!
//! Worlds are made only by [`WorldState::into_world`], so this list contains all state of a world, and a snapshot cannot
//! miss any. Watchers are not state: they stay with the running world.

use bevy_ecs::prelude::*;
use interplay_planners::traffic::Traffic;
use interplay_scenarios::Scenario;

use crate::climate::{Building, BuildingError, ClimateState, Equipment, Gains, Node, NodeState, Temperature};
use crate::measure::{BuildingMeasures, Measures, Subscriptions};
use crate::phases::time_points::TimePoint;
use crate::phases::watch::{Watcher, Watchers};
use crate::physics::{Physics, VehicleBody};
use crate::simulation::spawn::{self, VehicleState};
use crate::state::components::{
    Clock, CurrentFrame, CurrentTraffic, DecidingThreads, Driving, Fleet, HandedIn, Identity, SpareFrames, TrafficRow,
};
use crate::state::detail::NotCopied;

/// All state of a world, except watchers.
pub struct WorldState {
    /// Every vehicle, in the scenario's order.
    pub vehicles: Vec<VehicleState>,
    /// Every temperature of the building, in the order of the network; empty without a building.
    pub nodes: Vec<NodeState>,
    /// Simulated time.
    pub clock: Clock,
    /// The time point of the last tick.
    pub time_point: TimePoint,
    /// The traffic: all state of the vehicles in the loop.
    pub traffic: CurrentTraffic,
    /// The last frame.
    pub current_frame: CurrentFrame,
    /// Measures of the vehicles so far.
    pub measures: Measures,
    /// The bodies.
    pub physics: Physics,
    /// The building and its measures; none without a building.
    pub building: Option<(Building, BuildingMeasures)>,
}

impl WorldState {
    /// The state in which a run of `scenario` begins that measures what it subscribes to.
    ///
    /// # Errors
    /// [`BuildingError`], if the building was not checked when it was loaded, or its plant does not answer.
    pub fn initial(scenario: &Scenario, subscriptions: &Subscriptions) -> Result<Self, BuildingError> {
        let mut physics = Physics::new(scenario);
        let vehicles = spawn::vehicles(scenario, &mut physics);
        let climate = ClimateState::initial(scenario)?;
        let (building, nodes) = match climate {
            Some(ClimateState { building, nodes }) => (Some(building), nodes),
            None => (None, Vec::new()),
        };
        let measured = |building: Building| {
            let measures = BuildingMeasures::new(&building, &scenario.controller());
            (building, measures)
        };
        let clock = Clock {
            tick: 0,
            step_s: scenario.step_s,
            horizon: scenario.horizon_steps,
            ticks_per_plan: scenario.ticks_per_plan,
        };
        let traffic = CurrentTraffic(Traffic {
            step_s: clock.planning_period_s(),
            horizon: clock.horizon,
            road_users: spawn::road_users(scenario),
            ..Traffic::default()
        });
        Ok(WorldState {
            vehicles,
            nodes,
            clock,
            time_point: TimePoint { time_s: 0.0, vehicles: true, building: false },
            traffic,
            current_frame: CurrentFrame::default(),
            measures: Measures::new(scenario, subscriptions),
            physics,
            building: building.map(measured),
        })
    }

    /// Copies the state out of a world.
    ///
    /// # Errors
    /// [`NotCopied`] names the part that cannot be copied.
    pub fn copy_from(world: &World) -> Result<Self, NotCopied> {
        let mut vehicles: Vec<VehicleState> = Vec::new();
        let road_users = &world.resource::<CurrentTraffic>().0.road_users;
        let mut parts = world.try_query::<VehicleParts>();
        for (entity, user) in world.resource::<Fleet>().0.iter().zip(road_users) {
            let found = parts.as_mut().and_then(|parts| parts.get(world, *entity).ok());
            let (identity, row, driving, handed_in, body) =
                found.ok_or_else(|| NotCopied::incomplete(&user.agent.name))?;
            vehicles.push(VehicleState {
                identity: identity.clone(),
                row: *row,
                driving: driving.fork(&identity.name)?,
                handed_in: handed_in.clone(),
                body: *body,
            });
        }
        let mut nodes: Vec<NodeState> = Vec::new();
        for (node, temperature, zone) in world.try_query::<NodeParts>().iter_mut().flat_map(|query| query.iter(world)) {
            let zone = zone.map(|(equipment, gains)| (*equipment, *gains));
            nodes.push(NodeState { node: *node, temperature: *temperature, zone });
        }
        nodes.sort_by_key(|node| node.node.index);
        let building = match (world.get_resource::<Building>(), world.get_resource::<BuildingMeasures>()) {
            (Some(building), Some(measures)) => Some((building.fork()?, measures.clone())),
            _ => None,
        };
        Ok(WorldState {
            vehicles,
            nodes,
            clock: *world.resource(),
            time_point: *world.resource(),
            traffic: world.resource::<CurrentTraffic>().clone(),
            current_frame: world.resource::<CurrentFrame>().clone(),
            measures: world.resource::<Measures>().clone(),
            physics: world.resource::<Physics>().fork(),
            building,
        })
    }

    /// Builds a world in this state; `watchers` receive its ticks from now on.
    pub fn into_world(self, watchers: Vec<Box<dyn Watcher>>) -> World {
        let mut world = World::new();
        let fleet = world.spawn_batch(self.vehicles).collect();
        world.insert_resource(Fleet(fleet));
        for NodeState { node, temperature, zone } in self.nodes {
            let mut entity = world.spawn((node, temperature));
            if let Some(zone) = zone {
                entity.insert(zone);
            }
        }
        world.insert_resource(self.clock);
        world.insert_resource(self.time_point);
        world.insert_resource(self.traffic);
        world.insert_resource(self.current_frame);
        world.insert_resource(self.measures.parts());
        world.insert_resource(self.measures);
        world.insert_resource(self.physics);
        world.insert_resource(Watchers::new(watchers));
        world.insert_resource(DecidingThreads::default());
        world.insert_resource(SpareFrames::default());
        if let Some((building, measures)) = self.building {
            world.insert_resource(building);
            world.insert_resource(measures);
        }
        world
    }
}

type NodeParts = (&'static Node, &'static Temperature, Option<(&'static Equipment, &'static Gains)>);

type VehicleParts = (&'static Identity, &'static TrafficRow, &'static Driving, &'static HandedIn, &'static VehicleBody);

#[cfg(test)]
mod tests {
    use std::any::TypeId;
    use std::collections::BTreeMap;

    use interplay_scenarios::{Override, load};

    use super::*;
    use crate::simulation::Simulation;

    /// Number of entities with each component, by its type. Resources are components of separate entities.
    fn census(world: &World) -> BTreeMap<Option<TypeId>, usize> {
        let components = world.components().iter_registered();
        let held = components.map(|component| {
            let archetypes = world.archetypes().iter().filter(|archetype| archetype.contains(component.id()));
            (component.type_id(), archetypes.map(|archetype| archetype.len() as usize).sum())
        });
        held.filter(|(_, count)| *count > 0).collect()
    }

    /// After a run with vehicles, a building and sensors, the copy has every component and resource as often as the original.
    #[test]
    fn a_copied_world_has_every_component() {
        let scenario = load("mixed/garage", &[]).expect("authored");
        let mut simulation = Simulation::new(&scenario).expect("a world");
        for _ in 0..40 {
            simulation.step().expect("the run goes on");
        }
        let mut resumed = simulation.snapshot().expect("all state can be copied").resume().expect("a copy");
        // Both take another step, so both contain what the engine adds when a schedule runs.
        for world in [&mut simulation, &mut resumed] {
            world.step().expect("the run goes on");
        }
        let (running, copied) = (census(&simulation.world), census(&resumed.world));
        let known =
            [TypeId::of::<Driving>(), TypeId::of::<Temperature>(), TypeId::of::<Physics>(), TypeId::of::<Building>()];
        assert!(known.iter().all(|known| running.contains_key(&Some(*known))), "{running:?}");
        assert!(running.len() >= 20, "{running:?}");
        assert_eq!(running, copied);
    }

    /// Frames contain vehicles only in the vehicles' own ticks, and in all of these, with and without a new plan.
    #[test]
    fn frames_of_building_steps_alone_contain_no_vehicles() {
        for period_s in ["0.1", "0.2"] {
            let changes =
                [Override::Set("iterations=1".to_owned()), Override::Set(format!("planning_period_s={period_s}"))];
            let scenario = load("mixed/garage", &changes).expect("authored");
            let mut simulation = Simulation::new(&scenario).expect("a world");
            let mut driven = 0;
            while let Some(frame) = simulation.step().expect("the run goes on") {
                let drives = frame.time_s < scenario.duration_s;
                assert_eq!(
                    frame.vehicles.len(),
                    if drives { scenario.vehicles.len() } else { 0 },
                    "{} s",
                    frame.time_s
                );
                driven += usize::from(drives);
            }
            assert_eq!(driven, scenario.tick_count());
        }
    }
}
