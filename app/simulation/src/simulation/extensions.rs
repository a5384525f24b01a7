//! Systems and state that a caller adds to the loop.

use std::any::{TypeId, type_name};
use std::collections::HashSet;
use std::sync::Arc;

use bevy_ecs::component::ComponentInfo;
use bevy_ecs::prelude::*;

use crate::phases::Slot;
use crate::simulation::run_error::RunError;
use crate::state::detail::NotCopied;

/// Marks a parameter that belongs to a system, in the name of the system's type.
const LOCAL: &str = "::Local<";
/// Prefix of the components that Bevy itself adds.
const ENGINE: &str = "bevy_ecs::";

type AddSystem = dyn Fn(&mut Schedule) + Send + Sync;
type CopyState = dyn Fn(&World, &mut World) + Send + Sync;

#[derive(Clone)]
struct AddedSystem {
    name: &'static str,
    has_local: bool,
    add: Arc<AddSystem>,
}

#[derive(Clone)]
struct AddedState {
    id: TypeId,
    copy: Arc<CopyState>,
}

/// The systems and the state that a caller has added; every copy of a simulation has its own.
#[derive(Clone, Default)]
pub(crate) struct Extensions {
    systems: Vec<AddedSystem>,
    states: Vec<AddedState>,
}

impl Extensions {
    pub(crate) fn add_system<S, M>(&mut self, slot: Slot, system: S)
    where
        S: IntoSystem<(), (), M> + Clone + Send + Sync + 'static,
        M: 'static,
    {
        let add = move |schedule: &mut Schedule| {
            schedule.add_systems(system.clone().in_set(slot));
        };
        let has_local = type_name::<M>().contains(LOCAL);
        self.systems.push(AddedSystem { name: type_name::<S>(), has_local, add: Arc::new(add) });
    }

    pub(crate) fn add_state<T: Resource>(&mut self, fork: impl Fn(&T) -> T + Send + Sync + 'static) {
        let copy = move |from: &World, to: &mut World| {
            if let Some(state) = from.get_resource::<T>() {
                to.insert_resource(fork(state));
            }
        };
        self.states.push(AddedState { id: TypeId::of::<T>(), copy: Arc::new(copy) });
    }

    pub(crate) fn first_system(&self) -> Option<&'static str> {
        self.systems.first().map(|system| system.name)
    }

    /// Adds the systems to a schedule; `world` contains the simulation's own components.
    ///
    /// # Errors
    /// [`RunError::UnknownState`] if a system names a component or resource that neither the simulation nor the caller has.
    pub(crate) fn add_systems(&self, schedule: &mut Schedule, world: &mut World) -> Result<(), RunError> {
        if self.systems.is_empty() {
            return Ok(());
        }
        let known: HashSet<_> = world.components().iter_registered().map(ComponentInfo::id).collect();
        self.systems.iter().for_each(|system| (system.add)(schedule));
        initialize(schedule, world)?;
        let mut added = world.components().iter_registered().filter(|component| !known.contains(&component.id()));
        match added.find(|component| !is_of_engine(component)) {
            Some(component) => Err(RunError::UnknownState { name: component.name().to_string() }),
            None => Ok(()),
        }
    }

    /// Copies the added resources.
    pub(crate) fn copy_states(&self, from: &World, to: &mut World) {
        self.states.iter().for_each(|state| (state.copy)(from, to));
    }

    /// Refuses state that [`Extensions::copy_states`] does not copy; `own` contains the state that the simulation itself copies.
    ///
    /// # Errors
    /// [`NotCopied`] names a system that keeps a `Local`, or a component or resource that was not registered.
    pub(crate) fn refuse_uncopied(&self, world: &World, own: &World) -> Result<(), NotCopied> {
        if let Some(system) = self.systems.iter().find(|system| system.has_local) {
            let why = "it keeps a `Local`; keep a resource and register it by `with_state`".to_owned();
            return Err(NotCopied { who: format!("the added system `{}`", system.name), why });
        }
        let copied: HashSet<_> = held(own).filter_map(ComponentInfo::type_id).collect();
        let is_copied = |id: TypeId| copied.contains(&id) || self.states.iter().any(|state| state.id == id);
        let mut lost =
            held(world).filter(|component| !is_of_engine(component) && !component.type_id().is_some_and(is_copied));
        match lost.next() {
            Some(component) => {
                let why = "it was not registered by `with_state`".to_owned();
                Err(NotCopied { who: format!("the state `{}`", component.name()), why })
            }
            None => Ok(()),
        }
    }
}

/// Builds a schedule.
///
/// # Errors
/// [`RunError::Loop`] names systems whose order is ambiguous.
pub(crate) fn initialize(schedule: &mut Schedule, world: &mut World) -> Result<(), RunError> {
    let built = schedule.initialize(world);
    built.map(|_| ()).map_err(|error| RunError::Loop(error.to_string(schedule.graph(), world)))
}

/// The components, including resources, that exist in a world.
fn held(world: &World) -> impl Iterator<Item = &ComponentInfo> {
    let is_held = |component: &&ComponentInfo| {
        let mut archetypes = world.archetypes().iter();
        archetypes.any(|archetype| !archetype.is_empty() && archetype.contains(component.id()))
    };
    world.components().iter_registered().filter(is_held)
}

fn is_of_engine(component: &ComponentInfo) -> bool {
    component.name().starts_with(ENGINE)
}
